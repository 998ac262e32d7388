// How materials are shaded, held in doubles against docs/stages/pictures.md at every pixel of a small
// picture.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "render/bindings.h"
#include "render/composition.h"
#include "render/crowd_drawing.h"
#include "render/shading_reference.h"
#include "render/textures.h"
#include "render/tint.h"
#include "skitter/records.h"
#include "support/gpu_fixture.h"
#include "support/image_bytes.h"

namespace skitter::render {
namespace {

constexpr int kPixels = 8;  // a side, and texels of a texture: one a pixel
constexpr glm::dvec3 kBody{0.5, 1, -0.25}, kEye{0.7, 2.2, 3}, kColour{0.9, 0.6, 0.8}, kTint{0.9, 1.1, 0.7};
constexpr double kOpacity = 0.8;

// The surface is the plane z = 0 about the body, seen straight on from +Z, 2 m to a side; its normals lean.
glm::dvec3 normalAt(double x, double y) { return glm::normalize(glm::dvec3(0.4 * x, 0.3 * y - 0.2, 1)); }

// A picture of random texels, none of them too dark.
Texels randomTexels(uint32_t seed) {
  return test::texelsOf(kPixels, kPixels, [seed](uint32_t x, uint32_t y) {
    const auto draw = [&](uint32_t k) {
      uint32_t h = (x * 73856093u) ^ (y * 19349663u) ^ (k * 83492791u) ^ (seed * 2654435761u);
      h ^= h >> 13;
      h *= 0x5bd1e995u;
      return int(40 + (h >> 15) % 200);
    };
    return glm::ivec4(draw(0), draw(1), draw(2), draw(3));
  });
}
// Texels of normals that lean by up to 40 degrees.
Texels normalTexels() {
  Texels texels = randomTexels(9);
  for (size_t i = 0; i < texels.rgba.size(); i += 4) {
    texels.rgba[i] = uint8_t(64 + texels.rgba[i] / 2);
    texels.rgba[i + 1] = uint8_t(64 + texels.rgba[i + 1] / 2);
    texels.rgba[i + 2] = uint8_t(200 + texels.rgba[i + 2] / 8);
  }
  return texels;
}

struct Shot {
  Material material;
  std::vector<Texels> images;  // as the material's textures name them
  bool fromBehind = false, lightness = false;
  double slack = 0;  // linear light by which a device may filter colours otherwise
};

// Which of `size` texels a coordinate falls on, in texels.
int texelAt(double place, int size, TextureSampler::Wrap wrap) {
  const auto at = int(std::floor(place));
  const auto within = [at](int period) { return (at % period + period) % period; };
  switch (wrap) {
    case TextureSampler::Wrap::clamp:
      return std::clamp(at, 0, size - 1);
    case TextureSampler::Wrap::mirror:
      return std::min(within(2 * size), 2 * size - 1 - within(2 * size));
    case TextureSampler::Wrap::repeat:
      break;
  }
  return within(size);
}

// A texture at a pixel: the mean of the texels about it, weighed by their nearness, or the one that it lies
// on. Texels of colours are taken `off` codes further. Second coordinates are those that the first ones are.
std::optional<glm::dvec4> lookedUp(const Shot& shot, TextureRole role, int column, int row, double off) {
  const Texture& texture = shot.material.texture(role);
  if (texture.image == -1) return {};
  glm::dvec2 place = glm::dvec2(column + 0.5, row + 0.5) / double(kPixels);
  if (texture.set == 0) place = glm::dvec2(texture.scale) * place + glm::dvec2(texture.offset);
  place *= kPixels;
  const auto texel = [&](double x, double y) {
    const int i = texelAt(x, kPixels, texture.sampler.wrapS), j = texelAt(y, kPixels, texture.sampler.wrapT);
    const uint8_t* t = &shot.images[size_t(texture.image)].rgba[size_t(4 * (j * kPixels + i))];
    glm::dvec4 value = glm::dvec4(t[0], t[1], t[2], t[3]) / 255.0;
    for (int k = 0; isColour(role) && k < 3; ++k) value[k] = test::decodedSrgb(t[k] + off);
    return value;
  };
  if (texture.sampler.magNearest) return texel(place.x, place.y);
  const glm::dvec2 first = glm::floor(place - 0.5), share = place - 0.5 - first;
  const auto across = [&](double y) { return glm::mix(texel(first.x, y), texel(first.x + 1, y), share.x); };
  return glm::mix(across(first.y), across(first.y + 1), share.y) + glm::dvec4(off * shot.slack);
}

// The colour of a pixel: docs/stages/pictures.md, Materials.
std::optional<glm::dvec3> expectedAt(const Shot& shot, int column, int row, double off) {
  const Material& m = shot.material;
  const double x = (column + 0.5) / kPixels * 2 - 1, y = 1 - (row + 0.5) / kPixels * 2;
  const auto at = [&](TextureRole role) { return lookedUp(shot, role, column, row, off); };
  const glm::dvec4 base = at(TextureRole::baseColour).value_or(glm::dvec4(1));
  if (m.alphaCutoff > 0 && kOpacity * base.a < double(m.alphaCutoff)) return {};
  glm::dvec3 colour = kColour * glm::dvec3(base);
  if (shot.lightness) colour = glm::dvec3(glm::dot(colour, {0.2126, 0.7152, 0.0722}));
  colour *= kTint;
  const glm::dvec4 surface = at(TextureRole::metallicRoughness).value_or(glm::dvec4(1));
  const double red = at(TextureRole::occlusion).value_or(glm::dvec4(1)).r;
  const double occlusion = 1 + double(m.occlusionStrength) * (red - 1);
  glm::dvec3 normal = normalAt(x, y);
  // The image's right is +X, its top +Y.
  if (const auto bump = at(TextureRole::normal))
    normal = test::bentBy(255.0 * glm::dvec3(*bump), normal, {1, 0, 0}, 1, double(m.normalScale));
  if (shot.fromBehind) normal = -normal;

  // The sky's share is found at the corners, at y = -1 and 3, and is linear between them.
  const double open = (0.3 + 0.7 * (y + 1) / 4) * occlusion;
  return test::developedLight(test::lightOf(
      {.colour = colour,
       .metallic = double(m.metallic) * surface.b,
       .roughness = double(m.roughness) * surface.g,
       .open = open,
       .glow = glm::dvec3(m.emissive) * glm::dvec3(at(TextureRole::emissive).value_or(glm::dvec4(1))),
       .normal = normal,
       .toEye = glm::normalize(kEye - (kBody + glm::dvec3(x, y, 0))),
       .toSun = lightModel({}).towards}));
}

// No pixel of the shot is smoother. docs/stages/pictures.md has no roughness below 0.16, and a texture may
// ask for any.
double leastRoughness(const Shot& shot) {
  const Material& m = shot.material;
  return m.texture(TextureRole::metallicRoughness).image == -1 ? std::max(0.16, double(m.roughness)) : 0.16;
}

class MaterialShadingTest : public test::GpuLoadTest {
 protected:
  void expectShaded(const Shot& shot) {
    const std::vector<glm::vec4> found = draw(shot);
    int drawn = 0;
    for (int row = 0; row < kPixels; ++row)
      for (int column = 0; column < kPixels; ++column) {
        const glm::dvec4 pixel(found[size_t(row * kPixels + column)]);
        const std::optional<glm::dvec3> least = expectedAt(shot, column, row, -1),
                                        exact = expectedAt(shot, column, row, 0),
                                        most = expectedAt(shot, column, row, 1);
        ASSERT_EQ(pixel.w, exact ? 1 : 0) << column << ", " << row;
        if (!exact) continue;
        ++drawn;
        // A device may take a colour for one of half a code beside it, and lavapipe's polynomial is as far
        // off again: the result lies between those of the codes beside. All else is float32 on numbers of
        // about 1. The highlight enlarges errors most: a few roundings of 1 are divided by its least width.
        for (int k = 0; k < 3; ++k) {
          const double rounding = 16 * 0x1p-24 / std::pow(leastRoughness(shot), 4);
          EXPECT_GT(pixel[k], std::min((*least)[k], (*most)[k]) - rounding) << column << ", " << row;
          EXPECT_LT(pixel[k], std::max((*least)[k], (*most)[k]) + rounding) << column << ", " << row;
        }
      }
    EXPECT_GT(drawn, 0);
  }

  std::vector<glm::vec4> draw(const Shot& shot) {
    auto materials = std::make_shared<Materials>();
    materials->list = {shot.material};
    for (const Texels& image : shot.images) materials->images.push_back(test::pngFile(image));
    std::vector<std::string> notes;
    const Textures textures(context(), materials, notes);
    EXPECT_TRUE(notes.empty());

    gpu::GraphicsInfo info = wornShading(1, {.tinted = true}, shot.material, textures.has(0));
    info.colour = vk::Format::eR32G32B32A32Sfloat;
    info.depthUse = gpu::DepthUse::none;
    std::ranges::copy(lightConstants(lightModel({})), std::back_inserter(info.constants));
    const gpu::GraphicsPipeline pipeline(context(), info);
    const gpu::Buffer block = uploaded(std::vector{pictureBlock()}, gpu::BufferUse::uniform);
    const gpu::Buffer bodies = uploaded(std::vector{glm::vec4(glm::vec3(kBody), shared::packedTile(0, 0)),
                                                    glm::vec4(0), glm::vec4(0), glm::vec4(0)});
    const gpu::Buffer poses = uploaded(std::vector{glm::vec4(0, 0, 0, 1), glm::vec4(0)});
    const float flags = float(shared::TINT_VARIED | (shot.lightness ? shared::TINT_LIGHTNESS : 0));
    const gpu::Buffer tints = uploaded(std::vector{glm::vec4(glm::vec3(kTint), flags)});
    const gpu::Image ground = makeGroundMap(
        context(),
        {.name = "flat", .columns = 2, .rows = 2, .spacingX = 9, .spacingZ = 9, .heights = {0, 0, 0, 0}},
        glm::vec3(lightModel({}).towards));
    const gpu::Image shadow(
        context(),
        {.format = vk::Format::eD32Sfloat, .extent = {8, 4}, .usage = vk::ImageUsageFlagBits::eSampled},
        "shadow map");
    gpu::uploadImage(context(), shadow, std::vector<float>(32, 1.0f));
    const vk::raii::Sampler linear = gpu::makeSampler(context(), {.name = "ground map"}),
                            compared = gpu::makeSampler(context(), {.name = "shadow comparison",
                                                                    .filter = vk::Filter::eNearest,
                                                                    .compare = vk::CompareOp::eLessOrEqual});
    std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &block},
                                   {shared::DRAW_BODY, &bodies},
                                   {shared::DRAW_POSE, &poses},
                                   {shared::DRAW_TINT, &tints},
                                   {shared::DRAW_GROUND, &ground, *linear},
                                   {shared::DRAW_SHADOW, &shadow, *compared}};
    textures.bind(0, list);
    const gpu::Bindings bindings = pipeline.bind(context(), list);
    return rendered(pipeline, bindings, shot.fromBehind);
  }

 private:
  static shared::Picture pictureBlock() {
    shared::Picture picture{};
    glm::mat4& clip = picture.clipFromPicture[shared::VIEW_CAMERA];
    clip = glm::mat4(1);
    clip[2][2] = 0;
    clip[3] = {glm::vec3(-kBody.x, -kBody.y, 0.5), 1};
    for (int cascade = 0; cascade < 2; ++cascade) {
      glm::mat4& sunClip = picture.clipFromPicture[shared::VIEW_CAMERA + 1 + cascade];
      sunClip = glm::mat4(0.1f);
      sunClip[3] = {0, 0, 0.5f, 1};
      sunClip[2][2] = 0;
    }
    picture.eye = glm::vec4(glm::vec3(kEye), 0.01f);
    picture.forward = {0, 0, -1, 1000};
    picture.sun = glm::vec4(glm::vec3(lightModel({}).towards), 0);
    picture.tile = {0, 0, 1000, 0};  // no fog
    picture.ground = {0, 0, 1, 1};
    picture.shadow = {0.01f, 0.01f, 0, 4};
    return picture;
  }

  // A triangle over all of the picture, along which all that it has is linear.
  std::vector<glm::vec4> rendered(const gpu::GraphicsPipeline& pipeline, const gpu::Bindings& bindings,
                                  bool fromBehind) {
    std::vector<MeshVertex> vertices;
    std::vector<MaterialVertex> worn;
    std::vector<glm::vec2> corners{{-1, -1}, {3, -1}, {-1, 3}};
    if (fromBehind) std::swap(corners[1], corners[2]);
    for (const glm::vec2& corner : corners) {
      MeshVertex& vertex = vertices.emplace_back();
      vertex.influences[0] = {corner, 0, 1};
      vertex.normal = {0.4f * corner.x, 0.3f * corner.y - 0.2f, 1};
      vertex.colour = glm::vec3(kColour);
      MaterialVertex& surface = worn.emplace_back();
      surface.uv[0] = {0.5f + 0.5f * corner.x, 0.5f - 0.5f * corner.y};
      surface.uv[1] = {0.5f - 0.5f * corner.y, 0.5f + 0.5f * corner.x};
      surface.tangent = {1, 0, 0, 1};
      surface.opacity = float(kOpacity);
    }
    const gpu::Buffer mesh = uploaded(vertices, gpu::BufferUse::vertex);
    const gpu::Buffer surfaces = uploaded(worn, gpu::BufferUse::vertex);
    const gpu::Buffer instances = uploaded(std::vector<uint32_t>{0}, gpu::BufferUse::vertex);
    const gpu::Image image(context(),
                           {.format = vk::Format::eR32G32B32A32Sfloat,
                            .extent = {kPixels, kPixels},
                            .usage = vk::ImageUsageFlagBits::eColorAttachment},
                           "shaded surface");
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      gpu::transition(cmd, image, gpu::ImageState::discard, gpu::ImageState::colour);
      {
        const gpu::Rendering rendering(cmd, {.colour = &image}, true);
        const shared::CrowdConstants constants{
            .view = shared::VIEW_CAMERA, .palette = 1, .firstAgent = 0, .kind = 0};
        pipeline.use(cmd, bindings, gpu::bytesOf(constants));
        cmd.bindVertexBuffers(0, std::array{mesh.handle(), instances.handle(), surfaces.handle()},
                              std::array<vk::DeviceSize, 3>{0, 0, 0});
        cmd.draw(3, 1, 0, 0);
      }
      gpu::transition(cmd, image, gpu::ImageState::colour, gpu::ImageState::transferSrc);
    });
    return gpu::downloadImage<glm::vec4>(context(), image, gpu::ImageState::transferSrc);
  }

  template <class T>
  gpu::Buffer uploaded(const std::vector<T>& data, gpu::BufferUse use = gpu::BufferUse::records) {
    gpu::Buffer buffer(context(), data.size() * sizeof(T), "test data", use);
    gpu::upload(context(), buffer, data);
    return buffer;
  }
};
INSTANTIATE_TEST_SUITE_P(Loads, MaterialShadingTest, test::bothLoadPaths(), test::loadPathName);

Texture nearest(int image) { return {.image = image, .sampler = {.magNearest = true, .minNearest = true}}; }

Shot shotOf(const std::function<void(Shot&)>& change = [](Shot&) {}) {
  Shot shot;
  shot.material.metallic = 0;
  shot.material.roughness = 0.6f;
  change(shot);
  return shot;
}

TEST_P(MaterialShadingTest, FactorsAlone) {
  expectShaded(shotOf());
  expectShaded(shotOf([](Shot& s) {
    s.material.metallic = 1;
    s.material.roughness = 0.35f;
    s.material.emissive = {0.1f, 0.2f, 0.05f};
  }));
  expectShaded(shotOf([](Shot& s) {
    s.material.metallic = 1;
    s.material.roughness = 1;
  }));
}

TEST_P(MaterialShadingTest, EachTextureHasItsRole) {
  for (const TextureRole role : allTextureRoles) {
    expectShaded(shotOf([role](Shot& s) {
      s.images = {role == TextureRole::normal ? normalTexels() : randomTexels(uint32_t(role))};
      s.material.texture(role) = nearest(0);
      s.material.metallic = 0.7f;
      s.material.roughness = 1;  // times that of the texture, from 40 / 255 on
      s.material.emissive = {0.3f, 0.2f, 0.4f};
      s.material.normalScale = 0.7f;
      s.material.occlusionStrength = 0.6f;
    }));
  }
}

TEST_P(MaterialShadingTest, AllTexturesAtOnceByBothCoordinates) {
  // The second coordinates are turned by 90 degrees and mirrored; the transform undoes both.
  const auto second = [](int image) {
    Texture texture = nearest(image);
    texture.set = 1;
    texture.rotation = 1.57079632679f;
    texture.scale = {-1, 1};
    return texture;
  };
  const Texture undone = second(0);
  for (const glm::vec2 uv : {glm::vec2(0.1f, 0.2f), glm::vec2(0.8f, 0.3f)}) {
    const glm::vec3 from(uv.y, uv.x, 1);
    ASSERT_LT(glm::distance(uv, {glm::dot(undone.rows()[0], from), glm::dot(undone.rows()[1], from)}), 1e-6f);
  }
  expectShaded(shotOf([&](Shot& s) {
    s.images = {randomTexels(1), randomTexels(2), normalTexels(), randomTexels(3)};
    s.material.texture(TextureRole::baseColour) = second(0);
    s.material.texture(TextureRole::metallicRoughness) = nearest(1);
    s.material.texture(TextureRole::occlusion) = nearest(1);
    s.material.texture(TextureRole::normal) = second(2);
    s.material.texture(TextureRole::emissive) = nearest(3);
    s.material.emissive = {0.2f, 0.2f, 0.2f};
    s.material.metallic = 1;
    s.material.roughness = 1;
  }));
}

TEST_P(MaterialShadingTest, MasksTintsAndBacks) {
  const auto coloured = [](Shot& s) {
    s.images = {randomTexels(5)};
    s.material.texture(TextureRole::baseColour) = nearest(0);
  };
  expectShaded(shotOf([&](Shot& s) {
    coloured(s);
    s.material.alphaCutoff = 0.4f;
  }));
  expectShaded(shotOf([&](Shot& s) {
    coloured(s);
    s.lightness = true;
  }));
  Shot behind = shotOf(coloured);
  behind.fromBehind = true;
  for (const glm::vec4& pixel : draw(behind)) EXPECT_EQ(pixel.w, 0) << "it has one side";
  behind.material.doubleSided = true;
  expectShaded(behind);
}

TEST_P(MaterialShadingTest, SamplersWrapAndTakeTheNearestTexel) {
  using Wrap = TextureSampler::Wrap;
  for (const Wrap wrapS : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
    for (const Wrap wrapT : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
      expectShaded(shotOf([&](Shot& s) {
        s.images = {randomTexels(6)};
        // From one image before to one behind. Pixels hit the middles of texels.
        Texture texture{.image = 0, .scale = {3, -3}, .offset = {-1, 2}};
        texture.sampler = {.wrapS = wrapS,
                           .wrapT = wrapT,
                           .magNearest = true,
                           .minNearest = true,
                           .mips = TextureSampler::Mips::none};
        s.material.texture(TextureRole::baseColour) = texture;
      }));
}

TEST_P(MaterialShadingTest, SamplersMixTheTexelsAboutAPlace) {
  const uint32_t bits = context().physical().getProperties().limits.subTexelPrecisionBits;
  expectShaded(shotOf([&](Shot& s) {
    s.images = {randomTexels(7)};
    Texture texture{.image = 0, .scale = {0.4f, 0.7f}, .offset = {-0.1f, 0.6f}};
    texture.sampler.wrapS = TextureSampler::Wrap::mirror;
    s.material.texture(TextureRole::baseColour) = texture;
    // A weight may be off by a step in either direction; texels of random codes differ by less than 0.9.
    s.slack = 2 * 0.9 / double(1u << bits);
  }));
}

// Far smaller than its texels, a board of black and white has the mean of its light, and in a texture of
// numbers the mean of its numbers.
TEST_P(MaterialShadingTest, SmallTexturesAreTheirMeans) {
  const Texels board = test::texelsOf(64, 64, [](uint32_t x, uint32_t y) {
    const int value = (x + y) % 2 * 255;
    return glm::ivec4(value, value, value, 255);
  });
  const Texels lightMean =
      test::texelsOf(kPixels, kPixels, [](uint32_t, uint32_t) { return glm::ivec4(188, 188, 188, 255); });
  const Texels numberMean =
      test::texelsOf(kPixels, kPixels, [](uint32_t, uint32_t) { return glm::ivec4(128, 128, 128, 255); });
  const auto drawn = [&](TextureRole role, const Texels& image) {
    Shot shot = shotOf();
    shot.images = {image};
    shot.material.texture(role).image = 0;
    shot.material.roughness = 1;
    return draw(shot);
  };
  for (const auto& [role, mean] : {std::pair(TextureRole::baseColour, &lightMean),
                                   std::pair(TextureRole::metallicRoughness, &numberMean)}) {
    const std::vector<glm::vec4> small = drawn(role, board), flat = drawn(role, *mean);
    for (size_t i = 0; i < small.size(); ++i)
      EXPECT_LT(glm::distance(small[i], flat[i]), 1e-5f) << nameOf(role) << ", pixel " << i;
  }
}

// Images that cannot be decoded are left out and named, once.
TEST_P(MaterialShadingTest, BrokenImagesAreFlatColoursAndNoted) {
  auto materials = std::make_shared<Materials>();
  Material& material = materials->list.emplace_back();
  materials->images = {{.name = "crab.glb: images[0]", .bytes = {1, 2, 3}, .fault = {}},
                       {.name = "crab.glb: images[1]", .bytes = {}, .fault = "crab.glb: no such file"},
                       test::pngFile(randomTexels(1))};
  material.texture(TextureRole::baseColour).image = 0;
  material.texture(TextureRole::emissive).image = 0;
  material.texture(TextureRole::normal).image = 1;
  material.texture(TextureRole::occlusion).image = 2;
  TextureStore store;
  const Textures& textures = store.of(context(), materials);
  EXPECT_EQ(textures.has(0), 1 << int(TextureRole::occlusion));
  EXPECT_EQ(store.notes(),
            (std::vector<std::string>{"crab.glb: images[0]: is neither PNG nor JPEG: drawn as a flat colour",
                                      "crab.glb: no such file: drawn as a flat colour"}));
  // The same materials, loaded once more, are those.
  EXPECT_EQ(&store.of(context(), std::make_shared<Materials>(*materials)), &textures);
  EXPECT_EQ(store.notes().size(), 2u);
}

}  // namespace
}  // namespace skitter::render
