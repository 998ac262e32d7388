#include "assets/models/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "assets/files/json.h"
#include "assets/materials/decode_image.h"
#include "assets/models/gltf_accessors.h"

namespace skitter::gltf {
namespace {

using Json = nlohmann::json;

constexpr uint64_t maxImageBytes = uint64_t{1} << 30;  // of all images, as the files have them

// Nothing, where the object has no such member or is no object.
const Json* memberOf(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

struct Range {
  double least, most;
};
constexpr Range share{0, 1}, any{-1e6, 1e6};

class MaterialReader {
 public:
  explicit MaterialReader(Source& source) : source_(source) {}

  Materials read() {
    materials_.list.resize(source_.model.materials.size());
    std::set<int> worn;
    for (const tinygltf::Mesh& mesh : source_.model.meshes)
      for (const tinygltf::Primitive& part : mesh.primitives) worn.insert(part.material);
    for (size_t i = 0; i < materials_.list.size(); ++i) {
      if (worn.contains(static_cast<int>(i)))
        materials_.list[i] =
            material(objectAt("materials", static_cast<int>(i)), fmt::format("materials[{}]", i));
    }
    return std::move(materials_);
  }

 private:
  template <typename... Arguments>
  void note(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    source_.notes.lines.push_back(fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  Material material(const Json& from, const std::string& what) {
    Material made;
    const Json* name = memberOf(from, "name");
    if (name && name->is_string()) made.name = name->get<std::string>();
    if (const Json* pbr = memberOf(from, "pbrMetallicRoughness")) {
      const std::string path = what + ".pbrMetallicRoughness";
      made.metallic = number(*pbr, "metallicFactor", 1, share, path);
      made.roughness = number(*pbr, "roughnessFactor", 1, share, path);
      made.texture(TextureRole::baseColour) = texture(*pbr, "baseColorTexture", path);
      made.texture(TextureRole::metallicRoughness) = texture(*pbr, "metallicRoughnessTexture", path);
    }
    made.texture(TextureRole::normal) = texture(from, "normalTexture", what);
    made.texture(TextureRole::occlusion) = texture(from, "occlusionTexture", what);
    made.texture(TextureRole::emissive) = texture(from, "emissiveTexture", what);
    if (const Json* normal = memberOf(from, "normalTexture"))
      made.normalScale = number(*normal, "scale", 1, any, what + ".normalTexture");
    if (const Json* occlusion = memberOf(from, "occlusionTexture"))
      made.occlusionStrength = number(*occlusion, "strength", 1, share, what + ".occlusionTexture");
    made.emissive = numbers<3>(from, "emissiveFactor", {0, 0, 0}, share, what);
    made.doubleSided = memberOf(from, "doubleSided") && *memberOf(from, "doubleSided") == true;
    made.alphaCutoff = alphaCutoff(from, what);
    return made;
  }

  float alphaCutoff(const Json& from, const std::string& what) {
    const Json* mode = memberOf(from, "alphaMode");
    if (!mode || *mode == "OPAQUE") return 0;
    if (*mode == "MASK") return number(from, "alphaCutoff", 0.5f, {0, 1e6}, what);
    if (*mode == "BLEND") {
      note("{}.alphaMode is BLEND: drawn as MASK, what is half opaque and more is solid", what);
      return 0.5f;
    }
    note("{}.alphaMode is {}, expected OPAQUE, MASK or BLEND: drawn as OPAQUE", what, describeJson(*mode));
    return 0;
  }

  float number(const Json& object, const char* key, float usual, Range range, const std::string& what) {
    const Json* found = memberOf(object, key);
    if (!found) return usual;
    if (found->is_number() && found->get<double>() >= range.least && found->get<double>() <= range.most)
      return found->get<float>();
    note("{}.{} is {}, expected {} to {}: counts as {}", what, key, describeJson(*found), range.least,
         range.most, usual);
    return usual;
  }

  template <int count>
  glm::vec<count, float> numbers(const Json& object, const char* key, const glm::vec<count, float>& usual,
                                 Range range, const std::string& what) {
    const Json* found = memberOf(object, key);
    if (!found) return usual;
    const auto fits = [&](const Json& each) {
      return each.is_number() && each.get<double>() >= range.least && each.get<double>() <= range.most;
    };
    if (!found->is_array() || found->size() != count || !std::all_of(found->begin(), found->end(), fits)) {
      note("{}.{} is {}, expected {} numbers from {} to {}: left out", what, key, describeJson(*found), count,
           range.least, range.most);
      return usual;
    }
    glm::vec<count, float> values = usual;
    for (int k = 0; k < count; ++k) values[k] = (*found)[static_cast<size_t>(k)].get<float>();
    return values;
  }

  // Its place in a list of the file; -1, with a note, where there is none.
  int indexOf(const Json* index, const char* listName, const std::string& what) {
    const Json* list = memberOf(source_.file.json, listName);
    const size_t count = list && list->is_array() ? std::min(list->size(), maxObjects) : 0;
    if (index && index->is_number_unsigned() && index->get<uint64_t>() < count) return index->get<int>();
    note("{} is {}, but there are {} of these: left out", what, index ? describeJson(*index) : "missing",
         count);
    return -1;
  }
  const Json& objectAt(const char* listName, int index) const {
    return source_.file.json.at(listName)[static_cast<size_t>(index)];
  }

  Texture texture(const Json& object, const char* key, const std::string& owner) {
    const Json* info = memberOf(object, key);
    if (!info) return {};
    const std::string what = owner + "." + key;
    const int index = indexOf(memberOf(*info, "index"), "textures", what + ".index");
    if (index == -1) return {};
    const Json& from = objectAt("textures", index);
    const std::string path = fmt::format("textures[{}]", index);
    Texture made;
    int set = coordinatesOf(*info);
    if (const Json* extensions = memberOf(*info, "extensions")) {
      if (const Json* transform = memberOf(*extensions, "KHR_texture_transform")) {
        made.offset = numbers<2>(*transform, "offset", {0, 0}, any, what);
        made.scale = numbers<2>(*transform, "scale", {1, 1}, any, what);
        made.rotation = number(*transform, "rotation", 0, any, what);
        if (memberOf(*transform, "texCoord")) set = coordinatesOf(*transform);
      }
    }
    if (set < 0) {
      note("{} uses other texture coordinates than TEXCOORD_0 and TEXCOORD_1: left out", what);
      return {};
    }
    made.set = set;
    if (const Json* sampler = memberOf(from, "sampler")) {
      const int place = indexOf(sampler, "samplers", path + ".sampler");
      if (place != -1) made.sampler = samplerOf(objectAt("samplers", place));
    }
    if (const std::string format = onlyFormat(from); !format.empty()) {
      note("{} has its image as {} alone, expected PNG or JPEG: drawn as a flat colour", path, format);
      return made;
    }
    const int image = indexOf(memberOf(from, "source"), "images", path + ".source");
    if (image != -1) made.image = imageOf(image);
    return made;
  }

  // The format that an extension says a texture's only image has, and the extension; empty where it has
  // another.
  static std::string onlyFormat(const Json& texture) {
    const Json* extensions = memberOf(texture, "extensions");
    if (!extensions || memberOf(texture, "source")) return "";
    for (const auto& [extension, format] : {std::pair{"KHR_texture_basisu", "KTX2"},
                                            {"EXT_texture_webp", "WebP"},
                                            {"EXT_texture_avif", "AVIF"},
                                            {"MSFT_texture_dds", "DDS"}})
      if (memberOf(*extensions, extension)) return fmt::format("{} ({})", format, extension);
    return "";
  }

  // 0 or 1, else -1.
  static int coordinatesOf(const Json& object) {
    const Json* set = memberOf(object, "texCoord");
    if (!set) return 0;
    return set->is_number_unsigned() && set->get<uint64_t>() < 2 ? set->get<int>() : -1;
  }

  // The numbers are OpenGL's. Another than these leaves it to us.
  static TextureSampler samplerOf(const Json& from) {
    using Wrap = TextureSampler::Wrap;
    using Mips = TextureSampler::Mips;
    const auto code = [&](const char* key) {
      const Json* found = memberOf(from, key);
      return found && found->is_number_unsigned() ? found->get<uint64_t>() : 0;
    };
    const auto wrap = [&](const char* key) {
      return code(key) == 33071 ? Wrap::clamp : code(key) == 33648 ? Wrap::mirror : Wrap::repeat;
    };
    TextureSampler made{.wrapS = wrap("wrapS"), .wrapT = wrap("wrapT")};
    made.magNearest = code("magFilter") == 9728;
    const uint64_t min = code("minFilter");
    made.minNearest = min == 9728 || min == 9984 || min == 9986;
    made.mips = min == 9728 || min == 9729   ? Mips::none
                : min == 9984 || min == 9985 ? Mips::nearest
                                             : Mips::linear;
    return made;
  }

  // Into Materials::images, which has each image of the file once.
  int imageOf(int index) {
    if (const auto known = images_.find(index); known != images_.end()) return known->second;
    const int place = static_cast<int>(materials_.images.size());
    images_[index] = place;
    materials_.images.push_back(readImage(objectAt("images", index), index));
    return place;
  }

  ImageFile readImage(const Json& from, int index) {
    const Json *name = memberOf(from, "name"), *uri = memberOf(from, "uri");
    std::string path = fmt::format("images[{}]", index);
    const bool beside = uri && uri->is_string() && uri->get_ref<const std::string&>().rfind("data:", 0) != 0;
    if (const Json* called = beside ? uri : name; called && called->is_string())
      path += fmt::format(" ({})", describeJson(*called));
    ImageFile image{.name = fmt::format("{}: {}", source_.name, path), .bytes = {}, .fault = {}};
    try {
      image.bytes = bytesOf(from, path);
      imageBytes_ += image.bytes.size();
      if (imageBytes_ > maxImageBytes) source_.fail("{}: all images take over {} bytes", path, maxImageBytes);
      if (const std::string other = notAnImage(image.bytes); !other.empty())
        source_.fail("{}: {}", path, other);
    } catch (const Error& error) {
      image.bytes.clear();
      image.fault = error.what();
      note("{}: drawn as a flat colour", image.fault.substr(source_.name.size() + 2));
    }
    return image;
  }

  std::vector<uint8_t> bytesOf(const Json& from, const std::string& path) const {
    if (const Json* uri = memberOf(from, "uri")) {
      if (!uri->is_string()) source_.fail("{}.uri is {}, expected a string", path, describeJson(*uri));
      return readUri(source_.file, uri->get<std::string>(), fmt::format("{}: {}", source_.name, path));
    }
    const Json* view = memberOf(from, "bufferView");
    if (!view || !view->is_number_unsigned() || view->get<uint64_t>() >= source_.model.bufferViews.size()) {
      source_.fail("{}.bufferView is {}, but there are {} of these", path,
                   view ? describeJson(*view) : "missing", source_.model.bufferViews.size());
    }
    const std::span<const uint8_t> bytes = viewedBytes(source_, view->get<int>(), path);
    return {bytes.begin(), bytes.end()};
  }

  Source& source_;
  Materials materials_;
  std::map<int, int> images_;  // places in Materials::images by those in the file
  uint64_t imageBytes_ = 0;
};

}  // namespace

Materials readMaterials(Source& source) { return MaterialReader(source).read(); }

bool isTextured(const Material& material) {
  return std::any_of(material.textures.begin(), material.textures.end(),
                     [](const Texture& texture) { return texture.image != -1; });
}

bool isPlain(const Material& material) {
  return !isTextured(material) && material.alphaCutoff == 0 && !material.doubleSided &&
         material.emissive == glm::vec3(0);
}

}  // namespace skitter::gltf
