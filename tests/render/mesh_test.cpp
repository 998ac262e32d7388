#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <memory>
#include <numbers>
#include <tuple>

#include "render/mesh.h"
#include "render/ribbons.h"

namespace skitter::render {
namespace {

glm::vec3 positionAtRest(const Rig& rig, const MeshVertex& vertex) {
  const auto restStart = [&](uint32_t entry) {
    if (entry == 0) return glm::vec3(0);
    return rig.legs[(entry - 1) / uint32_t(rig.maxBones())]
        .bones[(entry - 1) % uint32_t(rig.maxBones())]
        .start;
  };
  glm::vec3 position(0);
  for (int i = 0; i < 4; ++i)
    position += vertex.influences[i].w * (glm::vec3(vertex.influences[i]) + restStart(vertex.bones[i]));
  return position;
}

TEST(Mesh, everyLevelIsCoarserAndWithinItsRange) {
  const Rig rig = spiderRig();
  const MeshData mesh = makeMesh(rig, limbsOf(rig));
  EXPECT_EQ(mesh.lods[0].indexCount, rig.indices.size());
  for (size_t i = 0; i < mesh.lods.size(); ++i) {
    const MeshLod& lod = mesh.lods[i];
    EXPECT_GT(lod.indexCount, 0u);
    EXPECT_EQ(lod.indexCount % 3, 0u);
    if (i > 0) {
      EXPECT_LT(float(lod.indexCount), 0.8f * float(mesh.lods[i - 1].indexCount)) << "level " << i;
    }
    for (uint32_t k = 0; k < lod.indexCount; ++k)
      ASSERT_LT(uint32_t(lod.firstVertex) + mesh.indices[lod.firstIndex + k], mesh.vertices.size());
  }
}

TEST(Mesh, verticesAtRestAreWhereTheRigHasThem) {
  const Rig rig = spiderRig();
  const MeshData mesh = makeMesh(rig, limbsOf(rig));
  // Level 0 keeps the rig's triangles, in an order of its own: the sums over all corners agree.
  glm::dvec3 expected(0), found(0);
  for (const uint32_t index : rig.indices) expected += glm::dvec3(glm::abs(rig.vertices[index].position));
  for (uint32_t k = 0; k < mesh.lods[0].indexCount; ++k) {
    const MeshVertex& vertex = mesh.vertices[mesh.indices[mesh.lods[0].firstIndex + k]];
    float weight = 0;
    for (const glm::vec4& influence : vertex.influences) weight += influence.w;
    ASSERT_NEAR(weight, 1.0f, 1e-3f);
    found += glm::dvec3(glm::abs(positionAtRest(rig, vertex)));
  }
  EXPECT_LT(glm::length(found - expected), 1e-4 * glm::length(expected));
}

// Each triangle with corners of its own, of one normal and colour.
Rig facetted(const Rig& smooth) {
  Rig rig = smooth;
  rig.vertices.clear();
  rig.indices.clear();
  for (size_t i = 0; i < smooth.indices.size(); ++i) {
    const size_t first = i - i % 3;
    const auto corner = [&](size_t k) { return smooth.vertices[smooth.indices[first + k]].position; };
    SkinVertex vertex = smooth.vertices[smooth.indices[i]];
    vertex.normal = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    vertex.colour = glm::abs(vertex.normal);
    rig.vertices.push_back(vertex);
    rig.indices.push_back(uint32_t(i));
  }
  return rig;
}

// The rig's own at the finest level; at a coarser one, where vertices share a position, the mean of their
// normals.
TEST(Mesh, everyLevelWearsTheRigsNormalsAndColours) {
  const Rig rig = facetted(spiderRig());
  const MeshData mesh = makeMesh(rig, limbsOf(rig));
  for (size_t level = 0; level < mesh.lods.size(); ++level) {
    for (uint32_t k = 0; k < mesh.lods[level].indexCount; k += 7) {
      const uint32_t index =
          uint32_t(mesh.lods[level].firstVertex) + mesh.indices[mesh.lods[level].firstIndex + k];
      const MeshVertex& vertex = mesh.vertices[index];
      if (vertex.halfWidth != 0) continue;  // below
      const glm::vec3 position = positionAtRest(rig, vertex);
      glm::vec3 normal(0);
      float nearest = 2;
      for (const SkinVertex& skin : rig.vertices) {
        if (glm::distance(skin.position, position) > 1e-6f) continue;
        normal += skin.normal;
        nearest = std::min(
            nearest, glm::distance(skin.normal, vertex.normal) + glm::distance(skin.colour, vertex.colour));
      }
      if (level > 0) nearest = glm::distance(glm::normalize(normal), vertex.normal);
      ASSERT_LT(nearest, 1e-5f) << "level " << level << ", vertex " << index;
    }
  }
}

// A tube of 40 rings about the z axis, a metre long, whose rings have colours.
struct Tube {
  static constexpr uint32_t rings = 40, sides = 12;
  std::vector<SkinVertex> vertices;
  std::vector<uint32_t> indices;

  explicit Tube(const std::function<float(uint32_t)>& greyOf) {
    for (uint32_t ring = 0; ring < rings; ++ring)
      for (uint32_t side = 0; side < sides; ++side) {
        const double angle = 2 * std::numbers::pi * side / sides;
        SkinVertex vertex{};
        vertex.normal = {std::cos(angle), std::sin(angle), 0};
        vertex.position = 0.1f * vertex.normal + glm::vec3(0, 0, float(ring) / float(rings - 1));
        vertex.colour = glm::vec3(greyOf(ring));
        vertices.push_back(vertex);
      }
    for (uint32_t ring = 0; ring + 1 < rings; ++ring)
      for (uint32_t side = 0; side < sides; ++side) {
        const uint32_t a = ring * sides + side, b = ring * sides + (side + 1) % sides;
        for (const uint32_t corner : {a, b, a + sides, b, b + sides, a + sides}) indices.push_back(corner);
      }
  }
};

// Where there is no room for the colours of a surface there is room for their mean.
TEST(Mesh, coarseLevelsHaveTheMeanColour) {
  const Tube tube([](uint32_t ring) { return float(ring % 2); });
  const std::vector<Surface> surfaces = surfacesOf(tube.vertices, tube.indices);
  ASSERT_EQ(surfaces.size(), 4u);
  for (size_t level = 2; level < surfaces.size(); ++level) {
    const Surface& surface = surfaces[level];
    ASSERT_LT(surface.indices.size(), tube.indices.size() / 4);
    double area = 0, off = 0;  // root mean square over the surface, from corner to corner
    for (size_t i = 0; i < surface.indices.size(); ++i) {
      const auto corner = [&](size_t k) { return surface.vertices[surface.indices[i - i % 3 + k]].position; };
      const double size = double(glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))));
      area += size;
      off += size * std::pow(double(surface.vertices[surface.indices[i]].colour.r) - 0.5, 2);
    }
    EXPECT_LT(std::sqrt(off / area), 0.2) << "level " << level;
  }
}

// A band is no edge, but the first coarse level keeps it.
TEST(Mesh, theFirstCoarseLevelKeepsBands) {
  const auto greyOf = [](uint32_t ring) { return ring >= 16 && ring < 24 ? 0.5f : 0.05f; };
  const Tube tube(greyOf);
  const std::vector<Surface> surfaces = surfacesOf(tube.vertices, tube.indices);
  ASSERT_GT(surfaces.size(), 1u);
  const Surface& surface = surfaces[1];
  ASSERT_LT(surface.indices.size(), tube.indices.size() / 2);
  double area = 0, off = 0;  // in the middle of triangles
  for (size_t i = 0; i < surface.indices.size(); i += 3) {
    const auto corner = [&](size_t k) { return surface.vertices[surface.indices[i + k]]; };
    const glm::vec3 a = corner(0).position, b = corner(1).position, c = corner(2).position;
    const double size = double(glm::length(glm::cross(b - a, c - a)));
    const float ring = (a.z + b.z + c.z) / 3 * float(Tube::rings - 1);
    const float grey = (corner(0).colour.r + corner(1).colour.r + corner(2).colour.r) / 3;
    area += size;
    off += size * double(std::abs(grey - greyOf(uint32_t(std::lround(ring)))));
  }
  EXPECT_LT(off / area, 0.03);
}

// docs/stages/pictures.md, cull and Ribbons.
constexpr double kShares[] = {1, 0.35, 0.12, 0.04, 0.015}, kNearest[] = {1e9, 150, 75, 25, 10};
constexpr double kRibbonPixels = 3.5, kBendPixels = 1;
constexpr size_t kLastWaists = 2;

Ribbons ribbonsAt(const Rig& rig, const MeshData& mesh, size_t level) {
  const double pixel = mesh.radius / kNearest[level];
  return ribbonsOf(rig, float(kRibbonPixels * pixel), float(kBendPixels * pixel), level <= kLastWaists);
}

size_t indexCountOf(const Ribbons& found) {
  size_t count = 0;
  for (const Ribbon& ribbon : found.ribbons) count += ribbon.waist ? 12 : 6;
  return count;
}

TEST(Mesh, levelsHaveTheirShareOfTheTrianglesAndRibbons) {
  const Rig rig = spiderRig();
  const MeshData mesh = makeMesh(rig, limbsOf(rig));
  for (size_t i = 0; i < mesh.lods.size(); ++i) {
    const Ribbons thin = ribbonsAt(rig, mesh, i);
    const double share = kShares[i] * double(thin.others.size()), ribbons = double(indexCountOf(thin));
    EXPECT_LE(mesh.lods[i].indexCount, share + ribbons) << "level " << i;
    // The largest error that is allowed may end the collapsing of edges earlier at the coarser levels.
    EXPECT_GE(mesh.lods[i].indexCount, (i == 1 ? 0.95 * share : 0) + ribbons) << "level " << i;
  }
}

const Bone& boneOf(const Rig& rig, uint16_t entry) {
  const auto most = size_t(rig.maxBones());
  return rig.legs[(entry - 1u) / most].bones[(entry - 1u) % most];
}
glm::vec3 placeOf(const Rig& rig, const Ribbon::End& end) {
  return boneOf(rig, end.bone).start + end.along * boneOf(rig, end.bone).direction;
}

// The corners of a quad between two sections of a ribbon, the first of which is the `number`-th.
void expectQuad(const Rig& rig, const MeshData& mesh, const uint32_t* corner,
                const std::vector<Ribbon::End>& sections, size_t number) {
  const glm::vec3 near = placeOf(rig, sections[number]);
  double sides = 0;
  for (int i = 0; i < 6; ++i) {
    const MeshVertex& vertex = mesh.vertices[corner[i]];
    const bool last =
        vertex.bones[0] != sections[number].bone || glm::distance(positionAtRest(rig, vertex), near) > 1e-6f;
    const size_t at = number + last;
    const Ribbon::End &here = sections[at], &neighbour = sections[at == 0 ? 1 : at - 1];
    EXPECT_EQ(vertex.bones[0], here.bone);
    EXPECT_LT(glm::distance(positionAtRest(rig, vertex), placeOf(rig, here)), 1e-6f);
    EXPECT_NEAR(std::abs(vertex.halfWidth), here.radius, 2e-6f);
    EXPECT_EQ(vertex.colour, here.colour);
    // The neighbour is the second influence, without weight.
    EXPECT_EQ(vertex.bones[1], neighbour.bone);
    EXPECT_EQ(vertex.influences[1], glm::vec4(neighbour.along * neighbour.direction, 0));
    const float out = at > 0 ? 1.0f : -1.0f;
    sides += std::copysign(1.0, out * vertex.halfWidth);
  }
  EXPECT_EQ(sides, 0) << "both triangles lie on one side";
}

TEST(Mesh, ribbonsLieBetweenTheirEnds) {
  const Rig rig = spiderRig();
  const MeshData mesh = makeMesh(rig, limbsOf(rig));
  EXPECT_EQ(mesh.influences, 2);
  for (size_t level = 0; level < mesh.lods.size(); ++level) {
    const Ribbons thin = ribbonsAt(rig, mesh, level);
    const MeshLod& lod = mesh.lods[level];
    std::vector<uint32_t> corners;
    for (uint32_t i = lod.indexCount - uint32_t(indexCountOf(thin)); i < lod.indexCount; ++i)
      corners.push_back(uint32_t(lod.firstVertex) + mesh.indices[lod.firstIndex + i]);
    const uint32_t* corner = corners.data();
    for (const Ribbon& ribbon : thin.ribbons) {
      std::vector<Ribbon::End> sections{ribbon.from, ribbon.to};
      if (ribbon.waist) sections.insert(sections.begin() + 1, *ribbon.waist);
      for (size_t number = 0; number + 1 < sections.size(); ++number, corner += 6)
        expectQuad(rig, mesh, corner, sections, number);
    }
  }
}

// Clips move the spider's own joints: from afar its legs are ribbons between the same places.
TEST(Mesh, legsOfClipsAreRibbonsToo) {
  const Rig rig = spiderRig();
  const ClipSet set = spiderClips();
  const MeshData mesh = makeMesh(rig, limbsOf(rig)), ofClips = makeMesh(set, limbsOf(set));
  const auto ribbonVertices = [](const MeshData& data, size_t level) {
    const size_t next =
        level + 1 < data.lods.size() ? size_t(data.lods[level + 1].firstVertex) : data.vertices.size();
    std::vector<MeshVertex> found;
    for (auto v = size_t(data.lods[level].firstVertex); v < next; ++v)
      if (data.vertices[v].halfWidth != 0) found.push_back(data.vertices[v]);
    return found;
  };
  // The last level, at which all bones are thin, whatever the radius that clips keep within.
  const std::vector<MeshVertex> expected = ribbonVertices(mesh, 4), found = ribbonVertices(ofClips, 4);
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_GE(found.size(), 4 * rig.legs.size());
  for (size_t i = 0; i < found.size(); ++i) {
    // Entries of matrices start at the origin.
    EXPECT_LT(glm::distance(glm::vec3(found[i].influences[0]), positionAtRest(rig, expected[i])), 1e-4f) << i;
    EXPECT_NEAR(found[i].halfWidth, expected[i].halfWidth, 1e-4f) << i;
    const ClipJoint& joint = set.joints[found[i].bones[0]];
    const int bone = expected[i].bones[0] - 1;
    EXPECT_EQ(joint.leg, bone / rig.maxBones()) << i;
    EXPECT_EQ(joint.bone, bone % rig.maxBones()) << i;
  }
}

// A bone of the spider's first leg with rings of skin about it, in place of the spider's own skin.
Rig tube(size_t bone, const std::vector<std::pair<float, float>>& rings) {
  Rig rig = spiderRig();
  rig.vertices.clear();
  rig.indices.clear();
  const Bone& carrier = rig.legs[0].bones[bone];
  const glm::vec3 x = glm::normalize(glm::cross(carrier.direction, glm::vec3(0.3f, 1, 0.2f))),
                  y = glm::cross(carrier.direction, x);
  for (const auto& [along, radius] : rings)
    for (int i = 0; i < 6; ++i) {
      const float turn = float(i) * 1.0471976f;
      SkinVertex vertex;
      vertex.position =
          carrier.start + along * carrier.direction + radius * (std::cos(turn) * x + std::sin(turn) * y);
      vertex.colour = glm::vec3(along / carrier.length);
      // The lightest of three weights is another bone's.
      vertex.bones[0] = 0;
      vertex.bones[1] = uint16_t(1 + bone);
      vertex.bones[2] = uint16_t(2 + bone);
      vertex.weights[0] = 0.3f;
      vertex.weights[1] = 0.5f;
      vertex.weights[2] = 0.2f;
      rig.vertices.push_back(vertex);
    }
  for (uint32_t i = 0; i + 2 < rig.vertices.size(); ++i)
    rig.indices.insert(rig.indices.end(), {i, i + 1, i + 2});
  return rig;
}

TEST(Ribbons, taperAsTheirBonesDo) {
  const float length = spiderRig().legs[0].bones[1].length;
  const Rig rig = tube(1, {{0.0f, 0.06f}, {0.5f * length, 0.05f}, {length, 0.04f}});
  const Ribbons found = ribbonsOf(rig, 0.061f, 0, false);
  ASSERT_EQ(found.ribbons.size(), 1u);
  EXPECT_TRUE(found.others.empty());
  const Ribbon& ribbon = found.ribbons[0];
  EXPECT_EQ(ribbon.from.bone, 2);
  EXPECT_EQ(ribbon.to.bone, 2);
  EXPECT_NEAR(ribbon.from.along, 0, 1e-6f);
  EXPECT_NEAR(ribbon.to.along, length, 1e-6f);
  EXPECT_NEAR(ribbon.from.radius, 0.06f, 1e-6f);
  EXPECT_NEAR(ribbon.to.radius, 0.04f, 1e-6f);
  // The middle's grey is in both, and a thousandth of the other end's colour.
  EXPECT_NEAR(ribbon.from.colour.x, (0.5f * 0.501f + 0.001f) / 1.503f, 1e-5f);
  EXPECT_NEAR(ribbon.to.colour.x, (0.5f * 0.501f + 1.001f) / 1.503f, 1e-5f);
}

// Dark and thin at its joints, light and thick between them, as a spider's leg is.
TEST(Ribbons, haveAWaistWhereASingleBoneDiffersInTheMiddle) {
  const float length = spiderRig().legs[0].bones[1].length;
  Rig rig = tube(1, {{0.0f, 0.02f}, {0.25f * length, 0.03f}, {0.5f * length, 0.04f}, {length, 0.01f}});
  for (SkinVertex& vertex : rig.vertices) {
    const float from = vertex.colour.x;
    vertex.colour = glm::vec3(1 - std::abs(2 * from - 1), 0, 0);
  }
  const Ribbon ribbon = ribbonsOf(rig, 1, 0, true).ribbons.at(0);
  ASSERT_TRUE(ribbon.waist);
  EXPECT_NEAR(ribbon.from.radius, 0.02f, 2e-4f);
  EXPECT_NEAR(ribbon.waist->radius, 0.04f, 2e-4f);
  EXPECT_NEAR(ribbon.to.radius, 0.01f, 2e-4f);
  EXPECT_NEAR(ribbon.from.colour.x, 0, 5e-3f);
  EXPECT_NEAR(ribbon.waist->colour.x, 1, 5e-3f);
  EXPECT_NEAR(ribbon.to.colour.x, 0, 5e-3f);
  EXPECT_EQ(ribbon.waist->bone, ribbon.from.bone);
  EXPECT_NEAR(ribbon.waist->along, 0.5f * length, 1e-6f);
  EXPECT_FALSE(ribbonsOf(rig, 1, 0, false).ribbons.at(0).waist);
  // A bone that tapers evenly has none, nor has a ribbon that spans several bones.
  EXPECT_FALSE(ribbonsOf(tube(1, {{0, 0.06f}, {0.5f * length, 0.05f}, {length, 0.04f}}), 1, 0, true)
                   .ribbons.at(0)
                   .waist);
  for (const Ribbon& whole : ribbonsOf(spiderRig(), 1, 1, true).ribbons) EXPECT_FALSE(whole.waist);
}

TEST(Ribbons, areOfThinBonesAlone) {
  const float length = spiderRig().legs[0].bones[1].length;
  const Rig rig = tube(1, {{0.0f, 0.04f}, {length, 0.06f}});
  EXPECT_EQ(ribbonsOf(rig, 0.059f, 0, false).ribbons.size(), 0u);
  EXPECT_EQ(ribbonsOf(rig, 0.059f, 0, false).others, rig.indices);
  EXPECT_EQ(ribbonsOf(rig, 0.061f, 0, false).ribbons.size(), 1u);
  EXPECT_EQ(ribbonsOf(spiderRig(), 0, 1, false).ribbons.size(), 0u);
}

// What lies beyond a joint is a ribbon's, too; a single ring has one radius; a bone is never shorter than
// itself.
TEST(Ribbons, coverTheirBonesAndSkin) {
  const float length = spiderRig().legs[0].bones[2].length;
  const Ribbon longer =
      ribbonsOf(tube(2, {{-0.1f, 0.02f}, {length + 0.2f, 0.02f}}), 1, 0, false).ribbons.at(0);
  EXPECT_NEAR(longer.from.along, -0.1f, 1e-6f);
  EXPECT_NEAR(longer.to.along, length + 0.2f, 1e-6f);
  const Ribbon ring = ribbonsOf(tube(2, {{0.3f * length, 0.02f}}), 1, 0, false).ribbons.at(0);
  EXPECT_EQ(ring.from.along, 0);
  EXPECT_EQ(ring.to.along, length);
  EXPECT_NEAR(ring.from.radius, 0.02f, 1e-6f);
  EXPECT_NEAR(ring.to.radius, 0.02f, 1e-6f);
}

// A ribbon ends where a joint within it would be too far off.
TEST(Ribbons, spanBonesThatAreAlmostStraight) {
  const Rig rig = spiderRig();
  const auto ends = [&](float bend) {
    std::vector<std::pair<int, int>> found;
    for (const Ribbon& ribbon : ribbonsOf(rig, 1, bend, false).ribbons)
      if (ribbon.to.bone <= rig.maxBones()) found.emplace_back(ribbon.from.bone, ribbon.to.bone);
    return found;
  };
  using Ends = std::vector<std::pair<int, int>>;
  EXPECT_EQ(ends(0), (Ends{{1, 1}, {2, 2}, {3, 3}, {4, 4}}));
  // Twice the area of the triangle of joints by its base: how far the first knee is off.
  const std::vector<Bone>& bones = rig.legs[0].bones;
  const glm::vec3 base = bones[2].start - bones[0].start;
  const float off = glm::length(glm::cross(base, bones[1].start - bones[0].start)) / glm::length(base);
  EXPECT_EQ(ends(0.99f * off).front(), std::pair(1, 1));
  EXPECT_EQ(ends(1.01f * off).front(), std::pair(1, 2));
  EXPECT_EQ(ends(0.06f), (Ends{{1, 2}, {3, 4}}));
  EXPECT_EQ(ends(1), (Ends{{1, 4}}));
  // A thick bone parts the thin ones about it.
  const Ribbons parted = ribbonsOf(rig, 0.045f, 1, false);
  EXPECT_EQ(parted.ribbons[0].to.bone, 1);
  EXPECT_EQ(parted.ribbons[1].from.bone, 3);
  EXPECT_EQ(parted.ribbons[1].to.bone, 4);
  EXPECT_FALSE(parted.others.empty());
}

// A joint beyond the ends is on their line, and yet far from both.
TEST(Ribbons, doNotSpanBonesThatFoldBack) {
  Rig rig = spiderRig();
  std::vector<Bone>& bones = rig.legs[0].bones;
  bones.resize(2);
  const float bend = 0.5f * std::min(bones[0].length, bones[1].length);
  const auto spans = [&] { return ribbonsOf(rig, 1, bend, false).ribbons[0].to.bone > 1; };
  bones[1].direction = bones[0].direction;
  EXPECT_TRUE(spans());
  bones[1].direction = -bones[0].direction;
  EXPECT_FALSE(spans());
}

TEST(Ribbons, ofSeveralBonesHaveTheColoursOfBothEnds) {
  Rig rig = spiderRig();
  const auto bones = size_t(rig.maxBones());
  for (SkinVertex& vertex : rig.vertices) {
    const size_t bone =
        (vertex.bones[std::max_element(vertex.weights, vertex.weights + 4) - vertex.weights] - 1) % bones;
    vertex.colour = {bone < 2 ? 0 : 1, 0.25f, 1};
  }
  const Ribbon whole = ribbonsOf(rig, 1, 1, false).ribbons.at(0);
  ASSERT_EQ(whole.from.bone, 1);
  ASSERT_EQ(whole.to.bone, 4);
  EXPECT_LT(whole.from.colour.x, 0.45f);
  EXPECT_GT(whole.to.colour.x, 0.55f);
  for (const Ribbon::End& end : {whole.from, whole.to}) {
    EXPECT_NEAR(end.colour.y, 0.25f, 1e-6f);
    EXPECT_NEAR(end.colour.z, 1, 1e-6f);
  }
}

// A triangle between a thin bone and the body is no ribbon's.
TEST(Ribbons, leaveTheBodyAlone) {
  const Rig rig = spiderRig();
  const Ribbons all = ribbonsOf(rig, 1, 0, false);
  EXPECT_EQ(all.ribbons.size(), 32u);
  const auto hangsOnTheBody = [&](uint32_t index) {
    const SkinVertex& vertex = rig.vertices[index];
    float body = 0, legs = 0;
    for (int i = 0; i < 4; ++i) {
      float& heaviest = vertex.bones[i] == 0 ? body : legs;
      heaviest = std::max(heaviest, vertex.weights[i]);
    }
    return body >= legs;
  };
  size_t body = 0;
  for (auto t = rig.indices.begin(); t != rig.indices.end(); t += 3)
    body += std::any_of(t, t + 3, hangsOnTheBody);
  EXPECT_EQ(all.others.size(), 3 * body);
}

// The furthest that a skin gets from its body: each leg straight, pointing away from it.
double furthestPosed(const Rig& rig) {
  double furthest = 0;
  for (const SkinVertex& vertex : rig.vertices) {
    glm::vec3 place(0);
    for (int i = 0; i < 4; ++i) {
      if (vertex.bones[i] == 0) {
        place += vertex.weights[i] * vertex.position;
        continue;
      }
      const Leg& leg = rig.legs[size_t((vertex.bones[i] - 1) / rig.maxBones())];
      const auto last = size_t((vertex.bones[i] - 1) % rig.maxBones());
      const glm::vec3 away = glm::normalize(leg.root());
      glm::vec3 start = leg.root();
      for (size_t k = 0; k < last; ++k) start += leg.bones[k].length * away;
      const glm::quat turn(leg.bones[last].direction, away);
      place += vertex.weights[i] * (start + turn * (vertex.position - leg.bones[last].start));
    }
    furthest = std::max(furthest, double(glm::length(place)));
  }
  return furthest;
}

TEST(Mesh, itsSphereHoldsEveryPose) {
  Rig rig = spiderRig();
  EXPECT_GE(double(makeMesh(rig, limbsOf(rig)).radius), furthestPosed(rig) - 1e-5);
  EXPECT_LE(double(makeMesh(rig, limbsOf(rig)).radius), furthestPosed(rig) * 1.01);
  // Toes reach beyond the foot.
  for (SkinVertex& vertex : rig.vertices) {
    if (vertex.bones[0] == 0 || (vertex.bones[0] - 1) % rig.maxBones() + 1 != rig.maxBones()) continue;
    const Leg& leg = rig.legs[size_t((vertex.bones[0] - 1) / rig.maxBones())];
    vertex.position += 0.2f * leg.bones.back().direction;
  }
  EXPECT_GE(double(makeMesh(rig, limbsOf(rig)).radius), furthestPosed(rig) - 1e-5);
  EXPECT_LE(double(makeMesh(rig, limbsOf(rig)).radius), furthestPosed(rig) * 1.01);
}

// The spider in two materials, one to each side, each cut in two: beyond the cut coordinates are one further.
Rig wornSpider() {
  Rig rig = spiderRig();
  const Rig plain = rig;
  auto materials = std::make_shared<Materials>();
  materials->list.resize(2);
  rig.look.materials = materials;
  rig.vertices.clear();
  rig.indices.clear();
  std::map<std::tuple<uint32_t, bool, bool>, uint32_t> known;
  for (size_t i = 0; i < plain.indices.size(); ++i) {
    glm::vec3 middle(0);
    for (size_t k = i - i % 3; k < i - i % 3 + 3; ++k) middle += plain.vertices[plain.indices[k]].position;
    const auto [place, isNew] =
        known.try_emplace({plain.indices[i], middle.x > 0, middle.z > 0}, uint32_t(rig.vertices.size()));
    rig.indices.push_back(place->second);
    if (!isNew) continue;
    rig.vertices.push_back(plain.vertices[plain.indices[i]]);
    const glm::vec3 at = rig.vertices.back().position;
    MaterialVertex vertex;
    vertex.uv[0] = glm::vec2(at.x, at.y) + (middle.z > 0 ? 1.0f : 0.0f);
    vertex.uv[1] = {at.z, at.y};
    vertex.tangent = {glm::normalize(glm::vec3(at.z, 0.1f, at.x)), 1};
    vertex.opacity = 0.5f;
    vertex.material = middle.x > 0;
    rig.look.vertices.push_back(vertex);
  }
  return rig;
}

TEST(Mesh, everyLevelKeepsTextureCoordinatesAndMaterials) {
  const Rig rig = wornSpider();
  const MeshData mesh = makeMesh(rig, limbsOf(rig));
  ASSERT_EQ(mesh.worn.size(), mesh.vertices.size());
  ASSERT_EQ(mesh.parts.size(), 3u);
  for (size_t level = 0; level < mesh.lods.size(); ++level) {
    uint32_t indices = 0;
    for (const MeshPart& part : mesh.parts) {
      const MeshLod& run = part.lods[level];
      indices += run.indexCount;
      EXPECT_EQ(run.indexCount % 3, 0u);
      for (uint32_t k = 0; k < run.indexCount; ++k) {
        const uint32_t index = uint32_t(run.firstVertex) + mesh.indices[run.firstIndex + k];
        const MeshVertex& vertex = mesh.vertices[index];
        ASSERT_EQ(vertex.halfWidth != 0, part.material == -1) << "level " << level;
        if (part.material == -1) continue;
        const MaterialVertex& worn = mesh.worn[index];
        ASSERT_EQ(worn.material, part.material) << "level " << level;
        EXPECT_NEAR(glm::length(glm::vec3(worn.tangent)), 1, 1e-5f);
        EXPECT_EQ(worn.tangent.w, 1);
        EXPECT_EQ(worn.opacity, 0.5f);
        // As the skin has them at this place, on one side of the cut or the other.
        const glm::vec3 at = positionAtRest(rig, vertex);
        EXPECT_LT(glm::distance(worn.uv[1], {at.z, at.y}), 1e-5f);
        const glm::vec2 beyond = worn.uv[0] - glm::vec2(at.x, at.y);
        EXPECT_LT(std::min(glm::length(beyond), glm::distance(beyond, glm::vec2(1))), 1e-5f);
      }
      // No triangle spans the cut.
      for (uint32_t t = 0; part.material != -1 && t < run.indexCount; t += 3) {
        float sides = 0;
        for (uint32_t k = t; k < t + 3; ++k) {
          const uint32_t index = uint32_t(run.firstVertex) + mesh.indices[run.firstIndex + k];
          sides += std::round(mesh.worn[index].uv[0].x - positionAtRest(rig, mesh.vertices[index]).x);
        }
        EXPECT_TRUE(sides == 0 || sides == 3) << "level " << level << ", triangle " << t / 3;
      }
    }
    EXPECT_EQ(indices, mesh.lods[level].indexCount) << "level " << level;
  }
  // Cuts keep some edges, but levels are coarser still.
  EXPECT_LT(2 * mesh.lods[1].indexCount, mesh.lods[0].indexCount);
  EXPECT_LT(2 * mesh.lods[3].indexCount, mesh.lods[1].indexCount);
}

// Shading does not show where a texture is cut.
TEST(Mesh, coarseLevelsHaveOneNormalOnBothSidesOfACut) {
  const MeshData mesh = makeMesh(wornSpider(), limbsOf(wornSpider()));
  int shared = 0;
  for (size_t level = 1; level < mesh.lods.size(); ++level) {
    std::map<std::tuple<uint32_t, float, float, float>, glm::vec3> normals;
    const MeshLod& lod = mesh.lods[level];
    for (uint32_t k = 0; k < lod.indexCount; ++k) {
      const MeshVertex& vertex = mesh.vertices[uint32_t(lod.firstVertex) + mesh.indices[lod.firstIndex + k]];
      if (vertex.halfWidth != 0) continue;
      const glm::vec4 at = vertex.influences[0];
      const auto [known, isNew] = normals.try_emplace({vertex.bones[0], at.x, at.y, at.z}, vertex.normal);
      shared += !isNew;
      EXPECT_EQ(known->second, vertex.normal);
    }
  }
  EXPECT_GT(shared, 100);
}

TEST(Mesh, aSkinWithoutMaterialsHasNoParts) {
  const MeshData mesh = makeMesh(spiderRig(), limbsOf(spiderRig()));
  EXPECT_TRUE(mesh.worn.empty());
  EXPECT_TRUE(mesh.parts.empty());
}

TEST(Mesh, aRigWithoutSkinIsLegal) {
  Rig rig = spiderRig();
  rig.vertices.clear();
  rig.indices.clear();
  EXPECT_EQ(makeMesh(rig, limbsOf(rig)).lods[0].indexCount, 0u);
}

}  // namespace
}  // namespace skitter::render
