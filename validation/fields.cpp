#include "validation/fields.h"

#include "cpu_reference/roundoff.h"

namespace skitter::validation {
namespace {

using reference::own;

glm::dvec4 numbersOf(double value) { return {value, 0, 0, 0}; }
glm::dvec4 numbersOf(uint32_t value) { return {value, 0, 0, 0}; }
glm::dvec4 numbersOf(const glm::dvec2& value) { return {value, 0, 0}; }

template <int roundings, typename Value>
void compareField(const char* quantity, const Value& expected, const Value& got, Sample& sample) {
  if constexpr (roundings != reference::own) {
    const glm::dvec4 want = numbersOf(expected), found = numbersOf(got);
    sample.compare(quantity, glm::length(want - found),
                   roundings * reference::tolerance::roundoff * glm::length(want), want, found);
  }
}

}  // namespace

#define COMPARE(type, name, initial, place, roundings) \
  compareField<roundings>(#name, expected.name, got.name, sample);

void compareFields(const reference::Goal& expected, const reference::Goal& got, Sample& sample) {
  SKITTER_GOAL_FIELDS(COMPARE)
}

void compareFields(const reference::AgentBody& expected, const reference::AgentBody& got, Sample& sample) {
  SKITTER_BODY_FIELDS(COMPARE)
}

void compareFields(const reference::Gait& expected, const reference::Gait& got, Sample& sample) {
  SKITTER_GAIT_FIELDS(COMPARE)
}

void compareFields(const reference::Reaction& expected, const reference::Reaction& got, Sample& sample) {
  SKITTER_REACTION_FIELDS(COMPARE)
}

void compareFields(const reference::Search& expected, const reference::Search& got, Sample& sample) {
  SKITTER_SEARCH_FIELDS(COMPARE)
}

void compareFields(const reference::Step& expected, const reference::Step& got, Sample& sample) {
  SKITTER_STEP_FIELDS(COMPARE)
  SKITTER_ARC_FIELDS(COMPARE)
}

void compareFields(const reference::Foot& expected, const reference::Foot& got, Sample& sample) {
  SKITTER_FOOT_FIELDS(COMPARE)
}

void compareFields(const reference::BonePose& expected, const reference::BonePose& got, Sample& sample) {
  SKITTER_POSE_FIELDS(COMPARE)
}

void compareFields(const reference::Metric& expected, const reference::Metric& got, Sample& sample) {
  SKITTER_METRIC_FIELDS(COMPARE)
}

void compareFields(const reference::Trail& expected, const reference::Trail& got, Sample& sample) {
  SKITTER_TRAIL_FIELDS(COMPARE)
}

#undef COMPARE

}  // namespace skitter::validation
