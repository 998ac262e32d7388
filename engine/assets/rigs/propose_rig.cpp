#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "assets/rigs/body_axes.h"
#include "assets/rigs/foot_homes.h"
#include "assets/rigs/foot_soles.h"
#include "assets/rigs/joint_cones.h"
#include "assets/rigs/limb_pairs.h"
#include "assets/rigs/loose_joints.h"
#include "assets/rigs/rig_setup.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr double straightShare = 0.93;  // of the reach, root to tip: a rest pose beyond it shows no knee

// A leg that rests straight shows no knee: the way its joints leave the line from root to ankle, however
// little, else forward for legs below the body and upward for legs beside it. Knees of two legs with soles go
// forward unless they plainly do not.
std::optional<glm::dvec3> bendOf(const BodyPlan& plan, const Limb& limb, std::vector<glm::dvec3> points) {
  if (limb.sole) points.pop_back();
  if (points.size() < 3) return {};
  double reach = 0;
  for (size_t i = 0; i + 1 < points.size(); ++i) reach += glm::length(points[i + 1] - points[i]);
  if (glm::length(points.back() - points.front()) <= straightShare * reach) return {};
  const glm::dvec3 chord = glm::normalize(points.back() - points.front());
  glm::dvec3 most(0);
  for (const glm::dvec3& p : points) {
    const glm::dvec3 off = (p - points.front()) - chord * glm::dot(p - points.front(), chord);
    if (glm::length(off) > glm::length(most)) most = off;
  }
  const bool human = limb.sole && plan.limbs.size() == 2;
  if (glm::length(most) > (human ? 0.05 : 0.005) * reach) return glm::normalize(most);
  return std::fabs(glm::dot(chord, plan.up)) > 0.7 ? plan.forward : plan.up;
}

// Half the body's length: to the outermost root at least, to the end of what no leg moves at most.
double bodyRadius(const BodyPlan& plan, const glm::dvec3& ground, double longest) {
  std::vector<bool> inLeg(plan.model.nodes.size(), false);
  const double origin = glm::dot(ground, plan.forward);
  double roots = 0, body = 0;
  for (const Limb& limb : plan.limbs) {
    inLeg[static_cast<size_t>(limb.root())] = true;
    roots = std::max(roots, std::fabs(glm::dot(plan.at(limb.root()), plan.forward) - origin));
  }
  for (int i : plan.model.parentsFirst) {
    const int parent = plan.model.nodes[static_cast<size_t>(i)].parent;
    if (parent != -1 && inLeg[static_cast<size_t>(parent)]) inLeg[static_cast<size_t>(i)] = true;
  }
  for (const Model::Vertex& vertex : plan.model.vertices) {
    if (inLeg[plan.model.influences[vertex.firstInfluence].node]) continue;
    body = std::max(body, std::fabs(glm::dot(vertex.position, plan.forward) - origin));
  }
  return std::max({roots, std::min(body, 0.5 * longest), 0.1 * longest});
}

void noteChains(BodyPlan& plan, const RigSetup& setup) {
  size_t inBody = 0, offsets = 0, bent = 0;
  std::vector<std::string> outside;
  for (size_t i = 0; i < plan.limbs.size(); ++i) {
    const Limb& limb = plan.limbs[i];
    const size_t joints = limb.joints.size();
    inBody += limb.inBody > 0;
    offsets += !limb.footJoint;
    if (joints > 1 && !plan.model.isAncestor(limb.joints[joints - 2], limb.joints.back()))
      outside.push_back(plan.model.reference(limb.joints.back()));
    bent += setup.legs[i].bend.has_value();
  }
  if (inBody > 0) {
    plan.note(fmt::format("the first joints of {} chains share one place: they stay with the body", inBody));
  }
  if (offsets > 0)
    plan.note(
        fmt::format("{} feet have no joint where they stand: tipOffset is where their skin does", offsets));
  if (!outside.empty()) {
    plan.note(
        fmt::format("feet that hang from joints outside their legs end them: {}", fmt::join(outside, ", ")));
  }
  for (const RigSetup::Follower& follower : setup.followers)
    plan.note(fmt::format("{} rests on a leg and goes with its bone at {}", follower.joint, follower.bone));
  const size_t settled =
      static_cast<size_t>(std::count_if(setup.legs.begin(), setup.legs.end(),
                                        [](const RigSetup::Leg& leg) { return leg.footBones.has_value(); }));
  if (settled > 0)
    plan.note(fmt::format("{} legs are posed so that their feet rest at home, soles as they are", settled));
  if (bent > 0) plan.note(fmt::format("{} legs rest straight: bend says which way their knees go", bent));
}

// Limits about the rest pose as it will be, bends included.
void limitJoints(BodyPlan& plan, RigSetup& setup) {
  try {
    const Rig rig = buildRig(plan.model, setup, plan.model.name);
    for (size_t i = 0; i < setup.legs.size(); ++i)
      setup.legs[i].coneHalfAngleDegrees = conesOf(rig.legs[i], setup.legs[i].footBones.value_or(0));
  } catch (const Error& error) {
    plan.note(error.detail(plan.model.name));
    setup.legs.clear();
  }
}

void describeLegs(BodyPlan& plan, const std::vector<LimbName>& names, RigSetup& setup) {
  const FootHomes feet = placeFeet(plan);
  setup.origin = feet.origin;
  double height = 0, longest = 0;
  for (size_t i = 0; i < plan.limbs.size(); ++i) {
    const Limb& limb = plan.limbs[i];
    const std::vector<glm::dvec3> points = plan.pointsOf(limb);
    RigSetup::Leg leg;
    leg.name = names[i].name;
    leg.group = names[i].group;
    if (std::find(setup.groups.begin(), setup.groups.end(), leg.group) == setup.groups.end()) {
      setup.groups.push_back(leg.group);
    }
    for (size_t j = limb.inBody; j < limb.joints.size(); ++j) {
      leg.joints.push_back(plan.model.reference(limb.joints[j]));
    }
    if (!limb.footJoint) leg.tipOffset = limb.tip - plan.at(limb.joints.back());
    leg.home = feet.homes[i];
    leg.bend = bendOf(plan, limb, points);
    // One bone alone cannot bring its foot home.
    const size_t foot = limb.sole ? 1 : 0;
    if (points.size() > foot + 2 && (limb.sole || limb.strides || leg.bend)) leg.footBones = foot;
    setup.legs.push_back(std::move(leg));
    height +=
        (plan.height(points.front()) - plan.height(feet.origin)) / static_cast<double>(plan.limbs.size());
    longest = std::max(longest, limb.reach);
  }
  std::sort(setup.groups.begin(), setup.groups.end());
  setup.bodyHeight = std::max(height, 0.1 * longest);
  setup.bodyRadius = bodyRadius(plan, feet.origin, longest);
  setup.followers = findFollowers(plan);
  noteChains(plan, setup);
  limitJoints(plan, setup);
}

bool hasBaseColours(const Look& look) {
  return look &&
         std::any_of(look.materials->list.begin(), look.materials->list.end(), [&](const Material& m) {
           const int image = m.texture(TextureRole::baseColour).image;
           return image != -1 && !look.materials->images[static_cast<size_t>(image)].bytes.empty();
         });
}

// White all over suits no light.
void chooseColour(BodyPlan& plan, RigSetup& setup) {
  if (hasBaseColours(plan.model.look)) return;
  for (const Model::Vertex& vertex : plan.model.vertices) {
    if (glm::length(vertex.colour - glm::vec3(1)) > 0.1f) return;
  }
  if (plan.model.vertices.empty()) return;
  setup.colour = {0.1, 0.085, 0.07};
  plan.note("the model has no colours of its own: colour makes it grey");
}

void pairUp(BodyPlan& plan) {
  const auto pairs = [](BodyPlan& with) {
    dropNamedLimbs(with);
    if (with.limbs.empty()) return;
    findAcross(with);
    pairLimbs(with);
  };
  const size_t found = plan.limbs.size();
  BodyPlan lifted = plan;
  pairs(plan);
  if (found == 0 || (plan.limbs.size() == found && found % 2 == 0)) return;
  // What was left out may have a partner in mid-stride.
  lifted.limbs = findLimbs(plan.model, plan.skin, plan.up, liftedShare).limbs;
  pairs(lifted);
  const auto alone = [](const Limb& limb) { return limb.pair == -1; };
  lifted.limbs.erase(std::remove_if(lifted.limbs.begin(), lifted.limbs.end(), alone), lifted.limbs.end());
  if (lifted.limbs.size() <= plan.limbs.size()) return;
  plan.limbs = std::move(lifted.limbs);
  plan.notes = std::move(lifted.notes);
  plan.left = lifted.left;
  plan.middle = lifted.middle;
}

// Fills what it can; the notes say where it stops.
void propose(BodyPlan& plan, const std::optional<glm::dvec3>& forward, RigProposal& result) {
  RigSetup& setup = result.setup;
  setup.model = std::filesystem::path(plan.model.name).filename().string();
  chooseUp(plan);
  setup.up = plan.up;
  pairUp(plan);
  if (plan.limbs.empty()) {
    if (plan.notes.empty()) plan.note("no chain of joints ends near the ground: there is nothing to walk on");
    return;
  }
  if (forward && glm::length(plan.flat(*forward)) < 0.1 * glm::length(*forward)) {
    plan.note(fmt::format("forward is given along up, which is {}: expected it across", describe(plan.up)));
    return;
  }
  findSoles(plan);
  chooseForward(plan, forward);
  setup.forward = plan.forward;
  const std::vector<LimbName> names = nameLimbs(plan);
  for (size_t i = 0; i < names.size(); ++i) {
    const Limb& limb = plan.limbs[i];
    result.found.push_back(
        {.name = names[i].name, .joints = limb.chain, .root = limb.root(), .footJoint = limb.footJoint});
  }
  if (!canWalk(plan)) return;
  setup.legLength = 1;
  describeLegs(plan, names, setup);
  chooseColour(plan, setup);
}

}  // namespace

RigProposal proposeRig(const Model& model, const gltf::Document* document,
                       const std::optional<glm::dvec3>& forward) {
  RigProposal result;
  const SkinOfNodes skin = skinOfNodes(model);
  BodyPlan plan{.model = model, .skin = skin, .document = document};
  propose(plan, forward, result);
  result.notes = std::move(plan.notes);
  return result;
}

RigProposal proposeRig(const Model& model, const std::optional<glm::dvec3>& forward) {
  return proposeRig(model, nullptr, forward);
}

}  // namespace skitter
