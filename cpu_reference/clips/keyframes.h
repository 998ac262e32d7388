#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace skitter::reference {

// Keyframed animation as docs/clip.md has it, and glTF 2.0. Rotations are xyzw.

enum class ClipProperty { translation, rotation, scale };
enum class ClipInterpolation { step, linear, cubicSpline };

struct ClipChannel {
  int node = 0;
  ClipProperty property = ClipProperty::translation;
  ClipInterpolation interpolation = ClipInterpolation::linear;
  std::vector<double> times = {};  // rising strictly
  // One a key, w of vectors unused; cubicSpline: three, in-tangent, value, out-tangent.
  std::vector<glm::dvec4> values = {};
};

struct ClipNode {
  int parent = -1;  // none
  glm::dvec3 translation{0};
  glm::dvec4 rotation{0, 0, 0, 1};
  glm::dvec3 scale{1};
  std::optional<glm::dmat4> matrix = {};  // in place of the three, and of any channel
};

// The value from a time on, or the limit from the left. They differ at STEP keys.
enum class ClipSide { at, before };

glm::dvec4 sampleChannel(const ClipChannel&, double t, ClipSide = ClipSide::at);
// The last time of any channel; 0 without channels.
double clipSeconds(const std::vector<ClipChannel>&);
// G_n(t) of every node. Without channels: the rest pose.
std::vector<glm::dmat4> clipPose(const std::vector<ClipNode>&, const std::vector<ClipChannel>&, double t,
                                 ClipSide = ClipSide::at);

// The nodes in the order of the file's tree: breadth first, siblings and roots by index.
std::vector<int> clipTreeOrder(const std::vector<ClipNode>&);
// `skinWeight`: how much of the skin each node carries; `legJoints`: nodes of all legs. -1: there is none.
int clipRoot(const std::vector<ClipNode>&, const std::vector<ClipChannel>&,
             const std::vector<double>& skinWeight, const std::vector<int>& legJoints = {});
// In the model space that `modelFromFile` (P) leads to; `root` may be -1.
glm::dvec3 clipRootVelocity(const std::vector<ClipNode>&, const std::vector<ClipChannel>&, int root,
                            const glm::dmat4& modelFromFile);

// What is baked: times that do not fall (a jump has two frames) and a matrix an entry a frame.
struct ClipFrames {
  std::vector<double> times;
  std::vector<std::vector<glm::dmat4>> matrices;
};
std::vector<glm::dmat4> playFrames(const ClipFrames&, double phase);
// Element by element: (1 - w) from + w to.
std::vector<glm::dmat4> crossFade(const std::vector<glm::dmat4>& from, const std::vector<glm::dmat4>& to,
                                  double w);

}  // namespace skitter::reference
