#pragma once

#include "cpu_reference/stages/adapt.h"
#include "cpu_reference/stages/measure.h"
#include "cpu_reference/types.h"
#include "validation/judge.h"

// What follows from the table of fields (cpu_reference/fields.h).
namespace skitter::validation {

// Compares every field that has no tolerance of its own.
void compareFields(const reference::Goal& expected, const reference::Goal& got, Sample& sample);
void compareFields(const reference::AgentBody& expected, const reference::AgentBody& got, Sample& sample);
void compareFields(const reference::Reaction& expected, const reference::Reaction& got, Sample& sample);
void compareFields(const reference::Search& expected, const reference::Search& got, Sample& sample);
void compareFields(const reference::Gait& expected, const reference::Gait& got, Sample& sample);
void compareFields(const reference::Step& expected, const reference::Step& got, Sample& sample);
void compareFields(const reference::Foot& expected, const reference::Foot& got, Sample& sample);
void compareFields(const reference::BonePose& expected, const reference::BonePose& got, Sample& sample);
void compareFields(const reference::Metric& expected, const reference::Metric& got, Sample& sample);
void compareFields(const reference::Trail& expected, const reference::Trail& got, Sample& sample);

}  // namespace skitter::validation
