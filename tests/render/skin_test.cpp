// A posed skin: where its surface is and which way it faces, in doubles and from the geometry alone.
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "embedded/normal_frag.h"
#include "embedded/tangent_frag.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "render/bindings.h"
#include "render/composition.h"
#include "render/crowd_drawing.h"
#include "render/ground_map.h"
#include "skitter/records.h"
#include "support/gpu_fixture.h"

namespace skitter::render {
namespace {

constexpr uint32_t kAgent = 2, kPalette = 5;
constexpr glm::dvec3 kPlace{4, 1.5, 7};  // in a tile of its own, one beside that of the picture's origin
constexpr glm::ivec2 kTile{-3, 12}, kPictureTile{-4, 12};

// A joint that takes rest position v to linear * (v - start) + at, relative to the body.
struct Joint {
  glm::dmat3 linear{1};
  glm::dvec3 at{0}, start{0};

  glm::dvec3 moved(const glm::dvec3& v) const { return linear * (v - start) + at; }
};
using Palette = std::array<Joint, kPalette>;

glm::dmat3 turned(double angle, const glm::dvec3& axis) {
  return glm::dmat3(glm::rotate(glm::dmat4(1), angle, glm::normalize(axis)));
}
Palette rotations() {
  return {Joint{turned(0.4, {0, 1, 0.2})},
          {turned(1.9, {1, 2, -1}), {0.3, 0.2, -0.5}, {0.2, 0.1, 0}},
          {turned(-0.8, {3, -1, 1}), {1.1, -0.4, 0.6}, {0.8, 0, 0.3}},
          {turned(2.6, {0, 1, 1}), {-0.7, 0.9, 0.1}, {-0.5, 0.4, 0}},
          {turned(-1.3, {1, 0, 0}), {0.1, -0.6, 1.2}, {0, -0.2, 0.9}}};
}
// Matrices take positions as they were bound, so nothing is subtracted.
Palette matrices(bool sheared) {
  Palette joints = rotations();
  for (Joint& joint : joints) joint.start = {0, 0, 0};
  if (sheared)
    for (Joint& joint : joints)
      joint.linear = joint.linear * glm::dmat3(1.7, 0.3, 0, -0.2, 0.6, 0.1, 0.5, 0, 1.1);
  return joints;
}

struct Influence {
  uint16_t bone;
  double weight;
};

struct Posed {
  glm::dvec3 normal, position;
};
// To the right of an image that the surface wears, at rest.
const glm::dvec3 kTangent = glm::normalize(glm::dvec3(0.8, -0.3, 0));

class SkinTest : public test::GpuLoadTest {
 protected:
  // A triangle whose plane faces `normal` about the rest position `middle`, carried by `influences`: what the
  // crowd's vertex shader makes of it, and what it should.
  void expectPosed(const Palette& palette, bool asMatrices, const std::vector<Influence>& influences) {
    const glm::dvec3 middle(0.4, 0.7, -0.3), normal = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
    const glm::dvec3 x = glm::normalize(glm::cross(normal, glm::dvec3(1, 0, 0))), y = glm::cross(normal, x);
    std::vector<MeshVertex> vertices;
    std::array<glm::dvec3, 3> corners{};
    for (size_t corner = 0; corner < 3; ++corner) {
      const double angle = 2.0943951023931953 * double(corner);
      const glm::dvec3 rest = middle + 4.0 * (std::cos(angle) * x + std::sin(angle) * y);
      MeshVertex vertex{};
      for (size_t i = 0; i < influences.size(); ++i) {
        const Joint& joint = palette.at(influences[i].bone);
        vertex.bones[i] = influences[i].bone;
        vertex.influences[i] = glm::vec4(glm::dvec4(rest - joint.start, influences[i].weight));
        corners[corner] += influences[i].weight * joint.moved(rest);
      }
      vertex.normal = normal;
      vertices.push_back(vertex);
    }
    const glm::dvec3 face = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    Posed expected{face, (corners[0] + corners[1] + corners[2]) / 3.0};
    // Where bones share a surface its normal is the mean of theirs.
    if (influences.size() > 1) {
      expected.normal = {0, 0, 0};
      for (const Influence& i : influences)
        expected.normal += i.weight * (palette.at(i.bone).linear * normal);
      expected.normal = glm::normalize(expected.normal);
    }
    const glm::dvec3 body = kPlace + double(shared::TILE_SIZE) *
                                         glm::dvec3(kTile.x - kPictureTile.x, 0, kTile.y - kPictureTile.y);
    const Posed found =
        draw(vertices, palette, asMatrices, int(influences.size()), face, body + expected.position, false);
    // A few tens of float32 operations on numbers of at most 4. A device places corners to 1/16 pixel at
    // least, so within 1/32 of 0.02 m along both axes.
    EXPECT_LT(glm::distance(glm::normalize(found.normal), expected.normal), 1e-5);
    EXPECT_LT(glm::distance(found.position, body + expected.position), 1e-3);

    // With materials, tangents go with the surface: they are turned and stretched as it is.
    glm::dvec3 tangent(0);
    for (const Influence& i : influences) tangent += i.weight * (palette.at(i.bone).linear * kTangent);
    const Posed worn =
        draw(vertices, palette, asMatrices, int(influences.size()), face, body + expected.position, true);
    EXPECT_LT(glm::distance(glm::normalize(worn.normal), expected.normal), 1e-5);
    EXPECT_LT(glm::distance(worn.position, tangent), 1e-5);
  }

 private:
  // Seen from outside along the face's normal, in a picture of one pixel, 0.02 m wide, about `middle`. With
  // `worn` the model has materials, and the tangent takes the place of the position.
  Posed draw(const std::vector<MeshVertex>& vertices, const Palette& palette, bool asMatrices, int influences,
             const glm::dvec3& face, const glm::dvec3& middle, bool worn) {
    shared::Picture picture{};
    const glm::dvec3 right = glm::normalize(glm::cross(face, glm::dvec3(0.3, 0.1, 1)));
    const glm::dvec3 up = glm::cross(face, right);
    glm::mat4& clip = picture.clipFromPicture[shared::VIEW_CAMERA];
    for (int i = 0; i < 3; ++i) clip[i] = {float(100 * right[i]), float(100 * up[i]), 0, 0};
    clip[3] = {float(-100 * glm::dot(right, middle)), float(-100 * glm::dot(up, middle)), 0.5f, 1};
    picture.tile = {kPictureTile, 100, 0};
    picture.ground = {0, 0, 1, 1};

    gpu::GraphicsInfo info = worn ? wornShading(influences, {.matrices = asMatrices}, Material(), 0)
                                  : crowdShading(influences, {.matrices = asMatrices});
    info.fragment = worn ? embedded::tangent_frag() : embedded::normal_frag();
    std::erase_if(info.bindings, [](const auto& b) {
      return int(b.binding) == shared::DRAW_SHADOW || int(b.binding) >= shared::DRAW_MATERIAL;
    });
    info.colour = vk::Format::eR32G32B32A32Sfloat;
    info.depthUse = gpu::DepthUse::none;
    const gpu::GraphicsPipeline pipeline(context(), info);

    const gpu::Buffer block = uploaded(std::vector{picture}, gpu::BufferUse::uniform);
    const gpu::Buffer bodies = uploaded(bodyRecords());
    const gpu::Buffer poses = uploaded(poseRecords(palette, asMatrices));
    const gpu::Buffer mesh = uploaded(vertices, gpu::BufferUse::vertex);
    MaterialVertex surface;
    surface.tangent = glm::vec4(glm::vec3(kTangent), 1);
    const gpu::Buffer surfaces = uploaded(std::vector(3, surface), gpu::BufferUse::vertex);
    const gpu::Buffer instances = uploaded(std::vector{kAgent}, gpu::BufferUse::vertex);
    const gpu::Image ground = makeGroundMap(
        context(),
        {.name = "flat", .columns = 2, .rows = 2, .spacingX = 9, .spacingZ = 9, .heights = {0, 0, 0, 0}},
        glm::vec3(lightModel({}).towards));
    const vk::raii::Sampler sampler = gpu::makeSampler(context(), {.name = "ground map"});
    const std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &block},
                                         {shared::DRAW_BODY, &bodies},
                                         {shared::DRAW_POSE, &poses},
                                         {shared::DRAW_TINT, &bodies},
                                         {shared::DRAW_GROUND, &ground, *sampler}};
    const gpu::Bindings bindings = pipeline.bind(context(), list);
    const gpu::Image image(
        context(),
        {.format = info.colour, .extent = {1, 2}, .usage = vk::ImageUsageFlagBits::eColorAttachment},
        "posed surface");
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      gpu::transition(cmd, image, gpu::ImageState::discard, gpu::ImageState::colour);
      {
        const gpu::Rendering rendering(cmd, {.colour = &image}, true);
        const shared::CrowdConstants constants{
            .view = shared::VIEW_CAMERA, .palette = kPalette, .firstAgent = 0, .kind = 0};
        pipeline.use(cmd, bindings, gpu::bytesOf(constants));
        const std::array buffers{mesh.handle(), instances.handle(), surfaces.handle()};
        const std::array<vk::DeviceSize, 3> offsets{0, 0, 0};
        cmd.bindVertexBuffers(0, buffers, offsets);
        for (int32_t row = 0; row < 2; ++row) {
          rendering.confine({.offset = {0, row}, .extent = {1, 1}});
          cmd.draw(3, 1, 0, 0);
        }
      }
      gpu::transition(cmd, image, gpu::ImageState::colour, gpu::ImageState::transferSrc);
    });
    const auto texels = gpu::downloadImage<glm::vec4>(context(), image, gpu::ImageState::transferSrc);
    EXPECT_EQ(texels[0].w, 1) << "nothing is drawn: the surface faces away";
    return {glm::dvec3(texels[0]), glm::dvec3(texels[1])};
  }

  template <class T>
  gpu::Buffer uploaded(const std::vector<T>& data, gpu::BufferUse use = gpu::BufferUse::records) {
    gpu::Buffer buffer(context(), data.size() * sizeof(T), "test data", use);
    gpu::upload(context(), buffer, data);
    return buffer;
  }
  static std::vector<glm::vec4> bodyRecords() {
    std::vector<glm::vec4> records((kAgent + 1) * shared::BODY_STRIDE, glm::vec4(0));
    records[kAgent * shared::BODY_STRIDE] =
        glm::vec4(glm::vec3(kPlace), shared::packedTile(float(kTile.x), float(kTile.y)));
    return records;
  }
  // Those of the agents before it are zeros.
  static std::vector<glm::vec4> poseRecords(const Palette& palette, bool asMatrices) {
    const int stride = asMatrices ? shared::MATRIX_STRIDE : shared::POSE_STRIDE;
    std::vector<glm::vec4> records(size_t(int(kAgent * kPalette) * stride), glm::vec4(0));
    for (const Joint& joint : palette) {
      if (asMatrices) {
        for (int row = 0; row < 3; ++row)
          records.push_back(glm::vec4(
              glm::dvec4(joint.linear[0][row], joint.linear[1][row], joint.linear[2][row], joint.at[row])));
      } else {
        const glm::dquat q = glm::quat_cast(joint.linear);
        records.push_back(glm::vec4(glm::dvec4(q.x, q.y, q.z, q.w)));
        records.push_back(glm::vec4(glm::dvec4(joint.at, 0)));
      }
    }
    return records;
  }
};
INSTANTIATE_TEST_SUITE_P(Loads, SkinTest, test::bothLoadPaths(), test::loadPathName);

TEST_P(SkinTest, facesAsItsBonesTurnIt) {
  expectPosed(rotations(), false, {{2, 1}});
  expectPosed(rotations(), false, {{1, 0.7}, {4, 0.3}});
  expectPosed(rotations(), false, {{3, 0.4}, {0, 0.3}, {2, 0.2}, {1, 0.1}});
}

TEST_P(SkinTest, facesAsItsMatricesTurnIt) {
  expectPosed(matrices(false), true, {{1, 0.7}, {4, 0.3}});
  expectPosed(matrices(false), true, {{3, 0.4}, {0, 0.3}, {2, 0.2}, {1, 0.1}});
}

// A normal is no direction along the surface: where a matrix stretches and shears, it stays upright on it.
TEST_P(SkinTest, facesOutwardWhereMatricesStretch) {
  for (uint16_t bone = 0; bone < kPalette; ++bone) expectPosed(matrices(true), true, {{bone, 1}});
}

}  // namespace
}  // namespace skitter::render
