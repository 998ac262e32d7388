#include "app/viewer/followed.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/viewer/camera_control.h"
#include "cpu_reference/stages/foothold.h"
#include "cpu_reference/stages/pose.h"
#include "cpu_reference/stages/swing.h"
#include "crowd/controller.h"
#include "crowd/page.h"
#include "gpu/transfer.h"
#include "validation/convert.h"

namespace skitter::app {
namespace {

constexpr int splineParts = 24;

HerdState stateOf(const Crowd& crowd, AgentId id) {
  return crowd.download(id.herd, {id.agent, implOf(crowd).herds.at(id.herd).agents});
}

// Bodies alone: a click into a large crowd must not fetch everything else.
std::vector<glm::vec3> placesOf(const Crowd& crowd, uint32_t herd) {
  std::vector<glm::vec3> places;
  for (const crowd::Part& part : crowd::partsOf(implOf(crowd), herd)) {
    constexpr size_t floats = 4 * shared::BODY_STRIDE;
    HerdState state;
    state.body.resize(part.agents * floats);
    gpu::downloadBytes(*implOf(crowd).context, part.page->body, std::as_writable_bytes(std::span(state.body)),
                       part.first * floats * sizeof(float));
    for (size_t agent = 0; agent < part.agents; ++agent) {
      const reference::AgentBody body = validation::bodyOf(state, agent);
      const glm::dvec2 world = body.world();
      places.emplace_back(world.x, body.y, world.y);
    }
  }
  return places;
}

bool isHidden(const Heightfield& ground, const glm::vec3& eye, const glm::vec3& point) {
  const float far = glm::distance(eye, point);
  return far > 0.1f && groundAlong(ground, eye, (point - eye) / far, far).has_value();
}

reference::Creature creatureOf(const crowd::Kind& kind) {
  return validation::creatureOf(kind.rigRecords, kind.legs, kind.bones, kind.groups);
}

glm::dvec3 originOf(const reference::AgentBody& body) {
  const glm::dvec2 world = body.world();
  return {world.x, body.y, world.y};
}

}  // namespace

std::optional<AgentId> agentAt(const Crowd& crowd, const Lens& lens, const glm::vec2& pixel, float most) {
  std::optional<AgentId> best;
  float least = std::numeric_limits<float>::infinity();
  for (uint32_t h = 0; h < crowd.herdCount(); ++h) {
    const std::vector<glm::vec3> places = placesOf(crowd, h);
    for (uint32_t a = 0; a < places.size(); ++a) {
      const Rig& rig = crowd.rig(h, a);
      const glm::vec3 middle = places[a] + glm::vec3(0, rig.bodyHeight, 0);
      const std::optional<glm::vec2> at = lens.pixel(middle);
      if (!at) continue;
      const float radius = 0.7f * rig.legLength * lens.pixelsAMetre(lens.depth(middle));
      const float beside = std::max(0.0f, glm::distance(*at, pixel) - radius);
      // Where several agents cover the pixel, the nearest one hides the others.
      const float score = beside > 0 ? 1e6f + beside : lens.depth(middle);
      if (beside > most || score >= least || isHidden(crowd.terrain(), lens.eye(), middle)) continue;
      least = score;
      best = AgentId{h, a};
    }
  }
  return best;
}

bool hasPlace(const Crowd& crowd, AgentId id) {
  return id.herd < crowd.herdCount() && id.agent < crowd.places(id.herd);
}

AgentId neighbourOf(const Crowd& crowd, AgentId id, bool after) {
  const std::vector<crowd::Herd>& all = implOf(crowd).herds;
  const uint32_t herds = crowd.herdCount();
  if (after ? id.agent + 1 < all[id.herd].agents : id.agent > 0) {
    id.agent += after ? 1u : UINT32_MAX;
    return id;
  }
  do id.herd = (id.herd + (after ? 1 : herds - 1)) % herds;
  while (all[id.herd].agents == 0);
  id.agent = after ? 0 : all[id.herd].agents - 1;
  return id;
}

Followed::Followed(const Crowd& crowd, AgentId id)
    : id_(id),
      herd_(crowd.herdId(id.herd)),
      creature_(creatureOf(implOf(crowd).kindOf(id.herd, id.agent))),
      legLength_(crowd.rig(id.herd, id.agent).legLength),
      bodyHeight_(crowd.rig(id.herd, id.agent).bodyHeight) {
  legs_.resize(crowd.rig(id.herd).legs.size());
  look(crowd);
}

void Followed::look(const Crowd& crowd) {
  before_ = std::move(now_);
  now_ = stateOf(crowd, id_);
  for (size_t leg = 0; leg < legs_.size(); ++leg) lookAtLeg(crowd, leg);
}

void Followed::lookAtLeg(const Crowd& crowd, size_t leg) {
  const crowd::Kind& kind = implOf(crowd).kindOf(id_.herd, id_.agent);
  const reference::Limb& limb = creature_.limbs[leg];
  const reference::AgentBody body = validation::bodyOf(now_, 0);
  const glm::dvec3 origin = originOf(body);
  LegView& view = legs_[leg];
  view.joints.clear();
  view.cones.clear();
  view.spline.clear();

  const std::vector<Bone>& bones = kind.rig.legs[leg].bones;
  const reference::Chain chain = validation::chainOf(now_, leg, kind.bones);
  glm::dquat rotation = body.orientation;
  const std::vector<reference::BonePose> pose = reference::pose(limb, body, chain.directions);
  for (size_t b = 0; b < bones.size(); ++b) {
    const glm::dvec3 apex = origin + pose[b].position, rest = limb.bones[b].direction();
    view.joints.emplace_back(apex);
    if (crowd::traitsOf(kind.controller).keepsLimits && bones[b].coneHalfAngle < 3.1f) {
      const float turned = 2 * std::atan(static_cast<float>(glm::length(chain.directions[b])));
      view.cones.push_back({.apex = apex,
                            .axis = rotation * rest,
                            .halfAngle = bones[b].coneHalfAngle,
                            .length = bones[b].length,
                            .used = turned / bones[b].coneHalfAngle});
    }
    rotation = pose[b].rotation;
    if (b + 1 == bones.size())
      view.joints.emplace_back(apex + rotation * rest * (limb.bones[b].length * limb.reach));
  }

  view.planted = now_.foot.empty() || validation::footOf(now_, leg).progress >= 1;
  if (!crowd::traitsOf(kind.controller).aimsSteps || crowd.tick() == 0) return;
  const auto tick = static_cast<double>(crowd.tick());
  const reference::Step step = validation::stepOf(now_, leg);
  view.planted = step.progress(tick) >= 1;
  view.landing = glm::vec3(origin + step.relative(step.landing, body));
  view.flown = static_cast<float>(reference::eased(step, step.progress(tick)).progress);
  for (int i = 0; i <= splineParts && !view.planted; ++i)
    view.spline.emplace_back(
        origin +
        step.relative(reference::splineAt(step, static_cast<double>(i) / splineParts).position, body));

  const reference::Gait gait = validation::gaitOf(now_, 0);
  const bool lifts = (gait.lift >> leg & 1u) != 0, aims = lifts || (gait.reaim >> leg & 1u) != 0;
  if (!aims) return;
  view.ladder.reset();
  if (before_.step.empty() || before_.tick + 1 != now_.tick) return;
  const reference::FootholdResult result = reference::foothold(
      validation::tuningOf(kind.parameters), validation::heightsOf(crowd.terrain(), kind.parameters), limb,
      body, gait, validation::stepOf(before_, leg), lifts, tick);
  Ladder& ladder = view.ladder.emplace();
  for (const reference::Candidate& candidate : result.candidates)
    ladder.candidates.push_back({glm::vec3(origin + candidate.point), candidate.fits});
}

glm::vec3 Followed::middle() const {
  const reference::AgentBody body = validation::bodyOf(now_, 0);
  return glm::vec3(originOf(body) + body.orientation * glm::dvec3(0, bodyHeight_, 0));
}

float Followed::speed() const { return static_cast<float>(validation::bodyOf(now_, 0).speed); }

}  // namespace skitter::app
