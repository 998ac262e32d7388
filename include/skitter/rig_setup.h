#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "skitter/export.h"
#include "skitter/model.h"
#include "skitter/rig.h"

namespace skitter {

// A rig, less its model: its legs, and which way it stands. The content of a sidecar, NAME.rig.json
// (docs/rig.md). Positions and lengths are the model's own: its units, axes and origin. Only legLength and
// scale are about metres.
struct RigSetup {
  struct Leg {
    std::string name, group;
    std::vector<std::string> joints;      // root to foot; names, or #INDEX into the file's nodes
    std::optional<glm::dvec3> tipOffset;  // from the last joint to the foot, where that joint is not the foot
    std::optional<glm::dvec3> home;  // where the foot stands; unset: on the ground under the foot at rest
    std::vector<double> coneHalfAngleDegrees;  // one per bone; empty: unlimited
    std::optional<glm::dvec3> bend;            // the way the leg's middle goes from its rest before it walks
    double bendDegrees = 30;                   // by so much, at the middle of a straight leg
    // Set: the leg rests with its foot at home, and this many of its last bones, the foot's, keep the way
    // they point in the model.
    std::optional<size_t> footBones;
  };
  // A joint outside the legs whose skin goes with a leg's bone.
  struct Follower {
    std::string joint;  // a name, or #INDEX
    std::string bone;   // the joint of a leg at which the bone starts
  };

  std::string model;                // the file, relative to the sidecar's folder
  std::optional<double> scale;      // metres per unit; else
  std::optional<double> legLength;  // metres of the longest leg; else scale 1
  glm::dvec3 forward{0, 0, 1}, up{0, 1, 0};
  std::optional<glm::dvec3> origin;  // on the ground below the body; unset: amid the feet, at their height
  std::optional<double> bodyHeight, bodyRadius;
  glm::dvec3 colour{1};             // linear RGB that the model's colours are multiplied by
  std::vector<std::string> groups;  // in the order in which they step
  std::vector<Leg> legs;
  std::vector<Follower> followers;  // what is below such a joint goes with it, too
};

// Throws Error(input) that names the file and the key.
SKITTER_API RigSetup loadRigSetup(const std::filesystem::path& sidecar);
SKITTER_API RigSetup parseRigSetup(const std::string& json, const std::string& name);
// The sidecar's text.
SKITTER_API std::string writeRigSetup(const RigSetup& setup);

// Where a model's sidecar lies by default: NAME.rig.json beside NAME.glb.
SKITTER_API std::filesystem::path sidecarOf(const std::filesystem::path& model);

// `name` begins messages. Throws Error(input) naming the key that does not fit the model.
SKITTER_API Rig buildRig(const Model& model, const RigSetup& setup, const std::string& name);

// A chain that ends near the ground, as found in a model.
struct FoundLeg {
  std::string name;         // L1, R1, ... front to back
  std::vector<int> joints;  // nodes, root to foot, those within the body included
  int root = -1;            // the node among them where the leg begins
  bool footJoint = true;    // the last joint is the foot
};

struct RigProposal {
  RigSetup setup;                  // without legs where none was found
  std::vector<FoundLeg> found;     // in the order of setup.legs
  std::vector<std::string> notes;  // what was decided and why, a line each
};

// Legs by geometry and names; docs/rig.md states the rules. `forward`, a direction in the model's axes across
// its up, overrules what feet, names and knees say.
SKITTER_API RigProposal proposeRig(const Model& model, const std::optional<glm::dvec3>& forward = {});

}  // namespace skitter
