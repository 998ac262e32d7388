// The pictures of `skitter inspect`, drawn in software.
#include "app/rig/rig_picture.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/glm.hpp>

#include "../assets/files.h"
#include "../support/srgb.h"
#include "read_png.h"

namespace skitter::test {
namespace {

constexpr std::array<glm::vec3, 3> places = {{{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}}};

// One leg that is hardly seen, and a level triangle with a corner of each colour.
Rig flatRig() {
  Rig rig;
  rig.groups = {"A"};
  rig.legLength = 0.01f;
  Bone bone;
  bone.direction = {0, 1, 0};
  bone.length = 0.01f;
  Leg leg;
  leg.bones = {bone};
  rig.legs = {leg};
  for (int k = 0; k < 3; ++k) {
    SkinVertex vertex;
    vertex.position = places[static_cast<size_t>(k)];
    vertex.colour = glm::vec3(0);
    vertex.colour[k] = 1;
    rig.vertices.push_back(vertex);
  }
  rig.indices = {0, 1, 2};
  return rig;
}

// The last quarter is the view from above: ahead is up, and the creature's left is on the left.
TEST(RigPicture, ATriangleHasTheColoursOfItsCorners) {
  const TemporaryFolder folder;
  app::drawRig(flatRig(), {400, 400}, folder / "flat.png");
  const Png png((folder / "flat.png").string());
  constexpr float perMetre = 0.88f * 200 / 2;
  const glm::vec3 light = glm::normalize(glm::vec3(-0.3f, 1.5f, 0));
  for (const glm::vec3 shares : {glm::vec3(0.8f, 0.1f, 0.1f), glm::vec3(0.1f, 0.8f, 0.1f),
                                 glm::vec3(0.1f, 0.1f, 0.8f), glm::vec3(0.45f, 0.1f, 0.45f)}) {
    const glm::vec3 at = shares.x * places[0] + shares.y * places[1] + shares.z * places[2];
    const std::array<int, 3> pixel =
        png.at(static_cast<size_t>(300 - perMetre * at.x), static_cast<size_t>(300 - perMetre * at.z));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(pixel[static_cast<size_t>(c)],
                  encodedSrgb((0.45f * shares[c] + 0.55f * 0.6f) * (0.45f + 0.55f * light.y)), 3)
          << "channel " << c << " at " << at.x << ", " << at.z;
  }
  EXPECT_EQ(png.at(210, 210), png.at(390, 210));  // beside it
}

}  // namespace
}  // namespace skitter::test
