#include "app/run/damage_watch.h"

#include <array>
#include <cmath>
#include <span>

#include "crowd/damage.h"
#include "crowd/events.h"
#include "crowd/herd.h"
#include "crowd/load.h"
#include "crowd/readback.h"
#include "skitter/decode.h"
#include "skitter/records.h"

namespace skitter::app {
namespace {

// In which the others regroup, and the feet come to their new places.
constexpr double regroupSeconds = 2;

bool hurts(const Event& event) {
  const auto* change = std::get_if<LegChange>(&event.what);
  return change != nullptr && change->state != LegState::whole;
}

uint64_t firstTickOf(const Scene& scene, double dt) {
  uint64_t last = 0;
  for (const Event& event : scene.events)
    if (hurts(event)) last = crowd::tickOf(event, dt);
  return last + static_cast<uint64_t>(std::llround(regroupSeconds / dt));
}

Scene withoutDamage(Scene scene) {
  std::erase_if(scene.events,
                [](const Event& event) { return std::holds_alternative<LegChange>(event.what); });
  return scene;
}

// Nothing that only measures or draws.
CrowdOptions bareOptions(const CrowdOptions& options) {
  CrowdOptions bare;
  bare.measure = false;
  bare.sleep = options.sleep;
  bare.pageAgents = options.pageAgents;
  return bare;
}

// The records of one agent or leg.
std::span<const float> recordOf(const std::vector<float>& records, size_t number, int stride) {
  const size_t floats = 4 * static_cast<size_t>(stride);
  return std::span(records).subspan(number * floats, floats);
}

double speedOf(const BodyState& body) { return double{glm::length(body.velocity)}; }

HurtAgent hurtAgentOf(const HerdState& state, size_t agent, const crowd::Damage& damage, const Rig& rig) {
  const BodyState body = bodyOf(recordOf(state.body, agent, shared::BODY_STRIDE));
  const Load load = crowd::loadOf(recordOf(state.carried, agent, shared::CARRIED_STRIDE));
  const glm::dvec3 mass(glm::vec3(0, rig.bodyHeight, 0) + rig.legLength * crowd::combinedCentre(load));
  const glm::dvec3 centre = body.position + glm::dquat(body.rotation) * mass;
  HurtAgent made{.legLength = double{rig.legLength}, .centre = {centre.x, centre.z}};
  const uint32_t idle = damage.pattern().idle;
  for (size_t leg = 0; leg < rig.legs.size(); ++leg) {
    const size_t number = agent * rig.legs.size() + leg;
    const TipState tip = tipOf(recordOf(state.tip, number, shared::TIP_STRIDE), body);
    made.legs.push_back(
        {.tip = {tip.place.x, tip.place.z},
         .carries = (idle >> leg & 1u) == 0,
         .isPlanted = footOf(recordOf(state.foot, number, shared::FOOT_STRIDE), body).planted(),
         .error = double{tip.error}});
  }
  return made;
}

}  // namespace

bool DamageWatch::isOf(const Scene& scene) { return std::ranges::any_of(scene.events, hurts); }

DamageWatch::DamageWatch(Device& device, const Heightfield& terrain, const Scene& scene,
                         const CrowdOptions& options, double dt, const std::optional<Obstacle>& obstacle)
    : dt_(dt), since_(firstTickOf(scene, dt)), ring_(device.context()), obstacle_(obstacle) {
  whole_.emplace(device, terrain, withoutDamage(scene), bareOptions(options));
}

DamageWatch::DamageWatch(Device& device, const Scene& scene, double dt)
    : dt_(dt), since_(firstTickOf(scene, dt)), ring_(device.context()) {}

void DamageWatch::look(const Crowd& crowd) {
  stepWhole();
  if (crowd.tick() < since_) return;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h)
    if (const crowd::Herd& herd = implOf(crowd).herds[h]; !herd.isGone() && herd.from.hurt) lookAt(crowd, h);
}

void DamageWatch::stepWhole() {
  if (!whole_) return;
  whole_->record(ring_.begin(), static_cast<float>(dt_));
  ring_.wait(ring_.submit());
  if (obstacle_) obstacle_->move(*whole_, static_cast<double>(whole_->tick()) * dt_);
}

void DamageWatch::lookAt(const Crowd& crowd, uint32_t herd) {
  constexpr std::array records = {Record::body, Record::foot, Record::tip, Record::hurt, Record::carried};
  constexpr std::array bodies = {Record::body};
  const HerdState state = crowd::downloadRecords(implOf(crowd), herd, records);
  HerdState whole;
  if (whole_) whole = crowd::downloadRecords(implOf(*whole_), herd, bodies);
  for (uint32_t agent = 0; agent < state.agents; ++agent) {
    const Rig& rig = crowd.rig(herd, agent);
    const auto damage =
        crowd::Damage::ofValues(recordOf(state.hurt, agent, shared::hurtStride(rig.legCount())));
    const BodyState body = bodyOf(recordOf(state.body, agent, shared::BODY_STRIDE));
    if (damage.isNone() || !body.present) continue;
    tally_.add(uint64_t{herd} << 32 | agent, crowd.tick(), hurtAgentOf(state, agent, damage, rig));
    if (!whole_) continue;
    const BodyState other = bodyOf(recordOf(whole.body, agent, shared::BODY_STRIDE));
    if (other.present) tally_.addSpeed(speedOf(body), speedOf(other));
  }
}

}  // namespace skitter::app
