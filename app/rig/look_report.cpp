#include "app/rig/look_report.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "skitter/error.h"

namespace skitter::app {
namespace {

// An image of a model, looked into.
struct SeenImage {
  std::string name;   // as messages have it, without the model's
  std::string fault;  // why it is a flat colour; else
  uint32_t width = 0, height = 0;
};

std::vector<SeenImage> imagesOf(const Model& model) {
  std::vector<SeenImage> seen;
  if (!model.look) return seen;
  const size_t prefix = model.name.size() + 2;
  for (const ImageFile& file : model.look.materials->images) {
    SeenImage& image = seen.emplace_back();
    image.name = file.name.substr(prefix);
    try {
      const Texels texels = decodeImage(file);
      image.width = texels.width;
      image.height = texels.height;
    } catch (const Error& error) {
      image.fault = std::string(error.what()).substr(prefix);
    }
  }
  return seen;
}

std::string describeMaterial(const Material& material) {
  std::string text = fmt::format("\"{}\": metallic {:.3g}, roughness {:.3g}", material.name,
                                 material.metallic, material.roughness);
  for (const TextureRole role : allTextureRoles) {
    const Texture& texture = material.texture(role);
    if (texture.image == -1) continue;
    text += fmt::format(", {} of images[{}]", nameOf(role), texture.image);
  }
  if (material.emissive != glm::vec3(0)) {
    text += fmt::format(", emits {:.3g} {:.3g} {:.3g}", material.emissive.x, material.emissive.y,
                        material.emissive.z);
  }
  if (material.alphaCutoff > 0) text += fmt::format(", cut out below {:.3g}", material.alphaCutoff);
  if (material.doubleSided) text += ", on both sides";
  return text;
}

nlohmann::ordered_json describeTextures(const Material& material) {
  nlohmann::ordered_json textures = nlohmann::ordered_json::object();
  for (const TextureRole role : allTextureRoles) {
    const Texture& texture = material.texture(role);
    if (texture.image == -1) continue;
    textures[nameOf(role)] = {{"image", texture.image},
                              {"texCoord", texture.set},
                              {"scale", {texture.scale.x, texture.scale.y}},
                              {"rotation", texture.rotation},
                              {"offset", {texture.offset.x, texture.offset.y}}};
  }
  return textures;
}

}  // namespace

void printLook(const Model& model) {
  if (!model.look) {
    fmt::print("  look    colours at the vertices alone\n");
    return;
  }
  const std::vector<SeenImage> images = imagesOf(model);
  fmt::print("  look    {} materials, {} images\n", model.look.materials->list.size(), images.size());
  for (const Material& material : model.look.materials->list)
    fmt::print("          {}\n", describeMaterial(material));
  for (const SeenImage& image : images) {
    if (image.fault.empty())
      fmt::print("          {}: {} x {} texels\n", image.name, image.width, image.height);
    else
      fmt::print("          {}: drawn as a flat colour\n", image.fault);
  }
}

void describeLook(const Model& model, nlohmann::ordered_json& to) {
  nlohmann::ordered_json materials = nlohmann::ordered_json::array(),
                         images = nlohmann::ordered_json::array();
  if (model.look) {
    for (const Material& material : model.look.materials->list) {
      materials.push_back({{"name", material.name},
                           {"metallic", material.metallic},
                           {"roughness", material.roughness},
                           {"emissive", {material.emissive.x, material.emissive.y, material.emissive.z}},
                           {"alphaCutoff", material.alphaCutoff},
                           {"doubleSided", material.doubleSided},
                           {"textures", describeTextures(material)}});
    }
  }
  for (const SeenImage& image : imagesOf(model)) {
    images.push_back(
        {{"name", image.name}, {"width", image.width}, {"height", image.height}, {"fault", image.fault}});
  }
  to["materials"] = std::move(materials);
  to["images"] = std::move(images);
}

}  // namespace skitter::app
