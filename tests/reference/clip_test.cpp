#include "cpu_reference/clips/keyframes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cpu_reference/clips/skin.h"

// The reference of clips against closed forms.
namespace skitter::test {
namespace {

using namespace reference;
using glm::dmat4;
using glm::dvec3;
using glm::dvec4;
using enum ClipProperty;
using enum ClipInterpolation;

constexpr double pi = std::numbers::pi;

dvec4 turnAbout(const dvec3& axis, double angle) {
  return dvec4(glm::normalize(axis) * std::sin(angle / 2), std::cos(angle / 2));
}

void expectNear(const dvec4& found, const dvec4& wanted, double tolerance = 1e-14) {
  EXPECT_LT(glm::length(found - wanted), tolerance)
      << found.x << " " << found.y << " " << found.z << " " << found.w;
}
void expectNear(const dvec3& found, const dvec3& wanted, double tolerance = 1e-14) {
  expectNear(dvec4(found, 0), dvec4(wanted, 0), tolerance);
}

TEST(ReferenceClip, StepHoldsUntilTheNextKey) {
  const ClipChannel channel{
      .interpolation = step, .times = {1, 2, 4}, .values = {dvec4(1), dvec4(2), dvec4(3)}};
  EXPECT_EQ(sampleChannel(channel, 0).x, 1);
  EXPECT_EQ(sampleChannel(channel, 1.999).x, 1);
  EXPECT_EQ(sampleChannel(channel, 2).x, 2);
  EXPECT_EQ(sampleChannel(channel, 2, ClipSide::before).x, 1);
  EXPECT_EQ(sampleChannel(channel, 1, ClipSide::before).x, 1);
  EXPECT_EQ(sampleChannel(channel, 4, ClipSide::before).x, 2);
  EXPECT_EQ(sampleChannel(channel, 9).x, 3);
}

TEST(ReferenceClip, LinearIsTheLineBetweenKeys) {
  const ClipChannel channel{.times = {1, 3}, .values = {{0, 2, 4, 0}, {2, -2, 8, 0}}};
  expectNear(sampleChannel(channel, 1.5), {0.5, 1, 5, 0});
  expectNear(sampleChannel(channel, 0), {0, 2, 4, 0});
  expectNear(sampleChannel(channel, 7), {2, -2, 8, 0});
  expectNear(sampleChannel(channel, 3, ClipSide::before), {2, -2, 8, 0});
}

TEST(ReferenceClip, LinearRotationTurnsEvenlyTheShortWay) {
  const dvec3 axis(1, 2, -1);
  for (const double sign : {1.0, -1.0}) {
    const ClipChannel channel{
        .property = rotation, .times = {0, 2}, .values = {turnAbout(axis, 0.3), sign * turnAbout(axis, 1.9)}};
    for (double t = 0; t < 2; t += 0.1)
      expectNear(sampleChannel(channel, t), turnAbout(axis, 0.3 + 0.8 * t), 1e-13);
  }
  // Less than 1e-6 rad apart, and the same.
  const ClipChannel close{
      .property = rotation, .times = {0, 1}, .values = {turnAbout(axis, 1), turnAbout(axis, 1 + 1e-7)}};
  expectNear(sampleChannel(close, 0.5), turnAbout(axis, 1 + 0.5e-7), 1e-13);
}

TEST(ReferenceClip, CubicSplineKeepsACubic) {
  const auto value = [](double t) { return dvec4(t * t * t - t, 2 - t * t, 3 * t, 0); };
  const auto slope = [](double t) { return dvec4(3 * t * t - 1, -2 * t, 3, 0); };
  ClipChannel channel{.interpolation = cubicSpline, .times = {0, 0.5, 2}};
  for (const double t : channel.times)
    for (const dvec4& v : {slope(t), value(t), slope(t)}) channel.values.push_back(v);
  for (double t = 0; t <= 2; t += 0.0625) expectNear(sampleChannel(channel, t), value(t), 1e-13);
  expectNear(sampleChannel(channel, -1), value(0));
  expectNear(sampleChannel(channel, 3), value(2));
}

TEST(ReferenceClip, CubicSplineRotationIsNormalised) {
  const dvec4 a = turnAbout({0, 1, 0}, 0), b = turnAbout({0, 1, 0}, pi / 2), none(0);
  ClipChannel channel{.property = rotation,
                      .interpolation = cubicSpline,
                      .times = {0, 1},
                      .values = {none, a, none, none, b, none}};
  // Without tangents the middle is the mean, along the bisector.
  expectNear(sampleChannel(channel, 0.5), turnAbout({0, 1, 0}, pi / 4));
  for (double t = 0; t <= 1; t += 0.1) EXPECT_NEAR(glm::length(sampleChannel(channel, t)), 1, 1e-14);
  // Opposite keys cancel in the middle: the earlier one counts there.
  channel.values[4] = -a;
  expectNear(sampleChannel(channel, 0.5), a);
}

// A shoulder that turns about z above an arm of two, with a scale that is not even.
const std::vector<ClipNode> armNodes = {{.parent = 2, .translation = {2, 0, 0}},
                                        {.translation = {1, 0, 0}, .scale = {1, 3, 1}},
                                        {.parent = 1, .translation = {0, 1, 0}}};
const std::vector<ClipChannel> armChannels = {
    {.node = 2,
     .property = rotation,
     .times = {0, 2},
     .values = {turnAbout({0, 0, 1}, 0), turnAbout({0, 0, 1}, pi / 2)}},
    {.node = 1, .times = {0, 2}, .values = {{9, 9, 9, 0}, {9, 9, 9, 0}}},
    {.node = 1, .times = {0, 1}, .values = {{1, 0, 0, 0}, {1, 4, -2, 0}}}};

TEST(ReferenceClip, ChildrenFollowTheirParentsWhateverTheOrderInTheFile) {
  EXPECT_EQ(clipTreeOrder(armNodes), (std::vector<int>{1, 2, 0}));
  EXPECT_EQ(clipSeconds(armChannels), 2);
  const double angle = pi / 8;
  const std::vector<dmat4> pose = clipPose(armNodes, armChannels, 0.5);
  expectNear(dvec3(pose[1][3]), {1, 2, -1});
  expectNear(dvec3(pose[2][3]), {1, 2 + 3, -1});
  // Two along the arm, whose rise the root's scale trebles: that shears.
  expectNear(dvec3(pose[0][3]), {1 + 2 * std::cos(angle), 5 + 3 * 2 * std::sin(angle), -1});
  expectNear(dvec3(pose[0][1]), {-std::sin(angle), 3 * std::cos(angle), 0});
  // At rest.
  expectNear(dvec3(clipPose(armNodes, {}, 0)[0][3]), {3, 3, 0});
}

TEST(ReferenceClip, ANodesMatrixStandsForItsChannels) {
  std::vector<ClipNode> nodes = armNodes;
  nodes[1].matrix = dmat4(1);
  expectNear(dvec3(clipPose(nodes, armChannels, 0)[0][3]), {2, 1, 0});
  EXPECT_EQ(clipRoot(nodes, armChannels, {1, 0, 0}), -1);
}

TEST(ReferenceClip, TheRootIsTheHighestThatMovesOverHalfOfTheSkin) {
  std::vector<ClipChannel> channels = armChannels;
  channels.push_back({.node = 0, .times = {0}, .values = {dvec4(0)}});
  EXPECT_EQ(clipRoot(armNodes, channels, {1, 1, 1}), 1);
  EXPECT_EQ(clipRoot(armNodes, channels, {1, 1, 1}, {2}), 1);
  EXPECT_EQ(clipRoot(armNodes, channels, {1, 1, 1}, {1}), -1);
  channels.erase(channels.begin() + 1, channels.begin() + 3);
  EXPECT_EQ(clipRoot(armNodes, channels, {3, 1, 1}), 0);
  EXPECT_EQ(clipRoot(armNodes, channels, {3, 1, 1}, {2}), -1);
  EXPECT_EQ(clipRoot(armNodes, channels, {2, 1, 1}), -1);
  EXPECT_EQ(clipRoot(armNodes, {}, {1, 1, 1}), -1);
}

TEST(ReferenceClip, RootMotionIsTakenOutButForHeight) {
  // From z up and x forward in centimetres.
  const dmat4 P = placement({10, 0, 0}, 0.01, {0, 0, 1}, {1, 0, 0});
  expectNear(dvec3(P * dvec4(110, 0, 0, 1)), {0, 0, 1});
  expectNear(dvec3(P * dvec4(10, 0, 100, 1)), {0, 1, 0});
  expectNear(dvec3(P * dvec4(10, 100, 0, 1)), {1, 0, 0});
  const std::vector<ClipNode> nodes = {{}};
  const std::vector<ClipChannel> channels = {{.times = {0, 4}, .values = {{0, 0, 0, 0}, {800, 0, 40, 0}}}};
  const dvec3 velocity = clipRootVelocity(nodes, channels, 0, P);
  expectNear(velocity, {0, 0, 2});
  const PaletteEntry entry{0, glm::inverse(clipPose(nodes, {}, 0)[0])};
  const std::vector<dmat4> end = paletteAt(P, clipPose(nodes, channels, 4), {{entry}}, velocity, 4);
  expectNear(dvec3(end[0] * dvec4(jointStart(P, entry), 1)), jointStart(P, entry) + dvec3(0, 0.4, 0));
  EXPECT_EQ(clipRootVelocity(nodes, channels, -1, P), dvec3(0));
}

// A palette acts on the vertices at rest as glTF does on those of the file.
TEST(ReferenceClip, ThePaletteSkinsAsGltfDoes) {
  const dmat4 P = placement({1, 2, 3}, 0.5, {0, 1, 0}, {0, 0, 1});
  const int joints[] = {2, 0};
  const std::vector<dmat4> rest = clipPose(armNodes, {}, 0), pose = clipPose(armNodes, armChannels, 1.3);
  const dmat4 inverseBind[] = {glm::inverse(rest[2]), glm::inverse(rest[0])};
  const dmat4 A = bindTransform(rest[2], inverseBind[0]);
  const PaletteEntry entries[] = {{2, inverseBind[0] * glm::inverse(A)},
                                  {0, inverseBind[1] * glm::inverse(A)}};
  const std::vector<SkinWeight> weights = heaviest({{0, 0.75}, {1, 0.25}});
  const dvec3 vertex(2.5, 2, 0.3), placed = P * A * dvec4(vertex, 1);
  const std::vector<dmat4> palette = paletteAt(P, pose, entries, dvec3(0), 1.3);
  expectNear(dvec3((0.75 * palette[0] + 0.25 * palette[1]) * dvec4(placed, 1)),
             skinVertex(P, pose, joints, inverseBind, weights, vertex), 1e-13);
  for (const dmat4& still : paletteAt(P, rest, entries, dvec3(0), 0))
    EXPECT_LT(displacement(still, dmat4(1), dvec3(-1), dvec3(1)), 1e-13);
}

TEST(ReferenceClip, TheFourHeaviestWeightsSumToOne) {
  const std::vector<SkinWeight> four = heaviest({{0, 0.1}, {1, 0.4}, {2, 0.2}, {3, 0.05}, {4, 0.3}});
  ASSERT_EQ(four.size(), 4u);
  EXPECT_EQ(four[0].joint, 1);
  EXPECT_EQ(four[3].joint, 0);
  EXPECT_DOUBLE_EQ(four[0].weight, 0.4);
}

TEST(ReferenceClip, AFlatNodeBindsByNothing) {
  EXPECT_EQ(bindTransform(dmat4(glm::dmat3(1, 0, 0, 0, 1, 0, 0, 0, 0)), dmat4(1)), dmat4(1));
}

TEST(ReferenceClip, FramesArePlayedAndFaded) {
  const ClipFrames frames{{0, 1, 1, 3}, {{dmat4(1)}, {dmat4(2)}, {dmat4(5)}, {dmat4(9)}}};
  EXPECT_EQ(playFrames(frames, 0.25)[0], dmat4(1.25));
  EXPECT_EQ(playFrames(frames, 1)[0], dmat4(5));
  EXPECT_EQ(playFrames(frames, 2)[0], dmat4(7));
  EXPECT_EQ(playFrames(frames, 3)[0], dmat4(9));
  EXPECT_EQ(crossFade({dmat4(1)}, {dmat4(3)}, 0.25)[0], dmat4(1.5));
}

TEST(ReferenceClip, TheDisplacementOfABoxIsThatOfItsWorstCorner) {
  dmat4 doubled(1);
  doubled[0][0] = 2;
  EXPECT_DOUBLE_EQ(displacement(dmat4(1), doubled, {-3, 0, 0}, {1, 5, 5}), 3);
}

}  // namespace
}  // namespace skitter::test
