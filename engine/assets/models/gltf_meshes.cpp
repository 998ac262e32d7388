#include "assets/models/gltf_meshes.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "assets/models/gltf_accessors.h"
#include "assets/models/gltf_materials.h"

namespace skitter::gltf {
namespace {

// Its factor, red, green, blue and opacity.
glm::dvec4 baseColour(const Source& source, int material, const std::string& what) {
  if (material == -1) return glm::dvec4(1);
  source.checkIndex(material, source.model.materials.size(), what + ".material");
  const auto& factor =
      source.model.materials[static_cast<size_t>(material)].pbrMetallicRoughness.baseColorFactor;
  source.checkFinite(factor, 4, fmt::format("materials[{}].baseColorFactor", material));
  return factor.empty() ? glm::dvec4(1) : glm::dvec4(factor[0], factor[1], factor[2], factor[3]);
}

// -1: none.
int indexAccessor(const tinygltf::Primitive& from) {
  const auto found = from.attributes.find(indexAttribute);
  return found == from.attributes.end() ? -1 : found->second;
}

std::vector<uint32_t> triangles(Source& source, const tinygltf::Primitive& from, size_t vertexCount,
                                const std::string& what) {
  std::vector<uint32_t> indices;
  const int accessor = indexAccessor(from);
  if (accessor == -1) {
    indices.resize(vertexCount);
    for (size_t i = 0; i < vertexCount; ++i) indices[i] = static_cast<uint32_t>(i);
  } else {
    const Values values = readAccessor(source, accessor, {TINYGLTF_TYPE_SCALAR}, true, what + ".indices");
    for (double number : values.numbers) {
      if (number >= static_cast<double>(vertexCount)) {
        source.fail("{}.indices holds {}, but there are {} vertices", what, number, vertexCount);
      }
      indices.push_back(static_cast<uint32_t>(number));
    }
  }
  const int mode = from.mode == -1 ? TINYGLTF_MODE_TRIANGLES : from.mode;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    if (indices.size() % 3 != 0) source.fail("{} has {} indices, no multiple of 3", what, indices.size());
    return indices;
  }
  std::vector<uint32_t> list;
  for (size_t i = 0; i + 2 < indices.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      list.insert(list.end(), {indices[0], indices[i + 1], indices[i + 2]});
    } else {
      list.insert(list.end(), {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    }
  }
  return list;
}

Primitive primitive(Source& source, const tinygltf::Primitive& from, const Materials& materials,
                    const std::string& what) {
  Primitive primitive;
  primitive.positions = toVectors(
      readAccessor(source, from.attributes.at("POSITION"), {TINYGLTF_TYPE_VEC3}, false, what + ".POSITION"));
  const size_t count = primitive.positions.size();
  const auto attribute = [&](const std::string& key, std::initializer_list<int> types, bool integers) {
    Values values;
    const auto found = from.attributes.find(key);
    if (found == from.attributes.end()) return values;
    // Exporters divide weights by a sum of 0, and tangents by a length of 0.
    values = readAccessor(source, found->second, types, integers, what + "." + key, NotFinite::zero);
    if (values.count != 0 && values.count != count)
      source.fail("{}.{} has {} vertices, POSITION {}", what, key, values.count, count);
    if (values.notFinite > 0)
      source.notes.lines.push_back(fmt::format("{}.{} has {} numbers that are not finite: they count as 0",
                                               what, key, values.notFinite));
    return values;
  };
  primitive.normals = toVectors(attribute("NORMAL", {TINYGLTF_TYPE_VEC3}, false));
  const Values colours = attribute("COLOR_0", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, false);
  const glm::dvec4 base = baseColour(source, from.material, what);
  primitive.material = from.material;
  primitive.colours = toVectors(colours);
  primitive.colours.resize(count, glm::dvec3(1));
  primitive.opacities.assign(count, base.w);
  // Both are within 0 to 1 (glTF 2.0 specification, sections 3.7.2.1 and 3.9.2).
  for (glm::dvec3& colour : primitive.colours) colour = glm::clamp(colour * glm::dvec3(base), 0.0, 1.0);
  for (size_t v = 0; v < count; ++v) {
    if (colours.components == 4 && colours.count > 0) primitive.opacities[v] *= colours.numbers[4 * v + 3];
    primitive.opacities[v] = std::clamp(primitive.opacities[v], 0.0, 1.0);
  }
  if (from.material != -1 && isTextured(materials.list[static_cast<size_t>(from.material)])) {
    const Material& material = materials.list[static_cast<size_t>(from.material)];
    for (size_t set = 0; set < primitive.uvs.size(); ++set) {
      const Values uvs = attribute(fmt::format("TEXCOORD_{}", set), {TINYGLTF_TYPE_VEC2}, false);
      for (size_t v = 0; v < uvs.count; ++v)
        primitive.uvs[set].emplace_back(uvs.numbers[2 * v], uvs.numbers[2 * v + 1]);
      const auto looksThere = [&](const Texture& t) {
        return t.image != -1 && t.set == static_cast<int>(set);
      };
      if (uvs.count == 0 && std::any_of(material.textures.begin(), material.textures.end(), looksThere))
        source.notes.lines.push_back(
            fmt::format("{} has no TEXCOORD_{}, where materials[{}] looks textures up: "
                        "(0, 0) counts",
                        what, set, from.material));
    }
    const Values tangents = attribute("TANGENT", {TINYGLTF_TYPE_VEC4}, false);
    // Without a direction for each vertex they are computed instead.
    for (size_t v = 0; v < tangents.count && tangents.notFinite == 0; ++v) {
      const double* at = &tangents.numbers[4 * v];
      primitive.tangents.emplace_back(at[0], at[1], at[2], at[3]);
    }
  }

  std::vector<Values> joints, weights;
  for (int set = 0;; ++set) {
    joints.push_back(attribute(fmt::format("JOINTS_{}", set), {TINYGLTF_TYPE_VEC4}, false));
    // Some exporters write them as floats.
    for (const double joint : joints.back().numbers) {
      if (!(joint >= 0 && joint <= UINT16_MAX && joint == std::trunc(joint)))
        source.fail("{}.JOINTS_{} holds {}, expected the number of a joint", what, set, joint);
    }
    weights.push_back(attribute(fmt::format("WEIGHTS_{}", set), {TINYGLTF_TYPE_VEC4}, false));
    if (joints.back().count != weights.back().count)
      source.fail("{} has JOINTS_{} or WEIGHTS_{} alone", what, set, set);
    if (joints.back().count == 0) break;
    primitive.influencesPerVertex += 4;
  }
  for (size_t vertex = 0; vertex < count; ++vertex) {
    double sum = 0;
    for (size_t k = 0; k < primitive.influencesPerVertex; ++k) {
      const size_t at = 4 * vertex + k % 4;
      const double weight = weights[k / 4].numbers[at];
      if (weight < 0) source.fail("{} has weight {} at vertex {}", what, weight, vertex);
      primitive.influences.push_back({static_cast<uint32_t>(joints[k / 4].numbers[at]), weight});
      sum += weight;
    }
    if (primitive.influencesPerVertex == 0 || sum > 0) continue;
    primitive.influences[vertex * primitive.influencesPerVertex].weight = 1;
    ++primitive.weightless;
  }
  primitive.indices = triangles(source, from, count, what);
  return primitive;
}

// Why nothing of a primitive can be drawn; empty where something can.
std::string whyNothing(const Source& source, const tinygltf::Primitive& from) {
  const auto positions = from.attributes.find("POSITION");
  if (positions == from.attributes.end()) return "has no POSITION";
  const auto accessor = [&](int index) -> const tinygltf::Accessor* {
    const bool fits = index >= 0 && static_cast<size_t>(index) < source.model.accessors.size();
    return fits ? &source.model.accessors[static_cast<size_t>(index)] : nullptr;
  };
  const tinygltf::Accessor* vertices = accessor(positions->second);
  if (vertices && vertices->count == 0) return "has no vertices";
  const tinygltf::Accessor* indices = accessor(indexAccessor(from));
  if (indices && indices->count == 0) return "has no triangles";
  return "";
}

}  // namespace

Mesh readMesh(Source& source, const Materials& materials, size_t index) {
  Mesh mesh;
  for (size_t k = 0; k < source.model.meshes[index].primitives.size(); ++k) {
    const tinygltf::Primitive& from = source.model.meshes[index].primitives[k];
    const std::string what = fmt::format("meshes[{}].primitives[{}]", index, k);
    const int mode = from.mode == -1 ? TINYGLTF_MODE_TRIANGLES : from.mode;
    if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
      source.fail("{} has mode {}, expected 0 to 6", what, mode);
    }
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      source.notes.lines.push_back(fmt::format("{} is points or lines (mode {}): left out", what, mode));
      continue;
    }
    if (const std::string nothing = whyNothing(source, from); !nothing.empty()) {
      source.notes.lines.push_back(fmt::format("{} {}: left out", what, nothing));
      continue;
    }
    if (!from.targets.empty()) source.notes.lines.push_back(what + " has morph targets: not applied");
    mesh.primitives.push_back(primitive(source, from, materials, what));
    for (const Influence& influence : mesh.primitives.back().influences) {
      // Joints without weight are padding, which may hold anything.
      if (influence.weight > 0) mesh.highestJoint = std::max(mesh.highestJoint, influence.joint);
    }
  }
  return mesh;
}

Skin readSkin(Source& source, const Document& document, size_t index) {
  const tinygltf::Skin& from = source.model.skins[index];
  const std::string what = fmt::format("skins[{}]", index);
  if (from.joints.empty()) source.fail("{} has no joints", what);
  Skin skin;
  skin.joints = from.joints;
  for (int joint : skin.joints) source.checkIndex(joint, source.model.nodes.size(), "a joint of " + what);
  skin.nodeFromBind.resize(skin.joints.size(), glm::dmat4(1));
  if (from.inverseBindMatrices == -1) return skin;
  const Values values = readAccessor(source, from.inverseBindMatrices, {TINYGLTF_TYPE_MAT4}, false,
                                     what + ".inverseBindMatrices", NotFinite::kept);
  if (values.count < skin.joints.size()) {
    source.fail("{} has {} inverse bind matrices for {} joints", what, values.count, skin.joints.size());
  }
  size_t useless = 0;
  for (size_t k = 0; k < skin.joints.size(); ++k) {
    const std::span<const double> matrix(values.numbers.data() + 16 * k, 16);
    const auto isFinite = [](double number) { return std::isfinite(number); };
    const auto isZero = [](double number) { return number == 0; };
    if (!std::ranges::all_of(matrix, isFinite) || std::ranges::all_of(matrix, isZero)) {
      const glm::dmat4& rest = document.nodes[static_cast<size_t>(skin.joints[k])].modelFromNode;
      if (glm::determinant(rest) != 0) skin.nodeFromBind[k] = glm::inverse(rest);
      ++useless;
      continue;
    }
    for (size_t e = 0; e < 16; ++e)
      skin.nodeFromBind[k][static_cast<int>(e / 4)][static_cast<int>(e % 4)] = matrix[e];
  }
  if (useless > 0)
    source.notes.lines.push_back(
        fmt::format("{} has {} inverse bind matrices of zeros or of what is no number: their joints are "
                    "bound as they rest",
                    what, useless));
  return skin;
}

}  // namespace skitter::gltf
