#include "skitter/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <system_error>

#include "assets/materials/tangents.h"
#include "assets/rigs/bend.h"
#include "assets/rigs/placement.h"
#include "assets/rigs/rig_setup.h"
#include "assets/rigs/rig_source.h"
#if defined(SKITTER_SPIDER_GAITS)
#include "embedded/spider_gaits.h"
#endif
#include "embedded/spider_glb.h"
#include "skitter/clip.h"
#include "skitter/error.h"
#include "skitter/rig_gaits.h"

namespace skitter {
namespace {

constexpr double minBoneLength = 1e-6;  // metres

// A model and its setup become a rig: legs and skin in metres, +Y up, facing +Z, the origin below the body.
class RigBuilder {
 public:
  RigBuilder(const Model& model, const RigSetup& setup, const std::string& name, const std::string& path)
      : model_(model),
        setup_(setup),
        name_(name),
        path_(path.empty() ? "" : path + "."),
        placement_(placeModel(model, setup, name, path)) {}

  Rig build() {
    Rig rig;
    rig.name = std::filesystem::path(model_.name).stem().string();
    rig.groups = setup_.groups;
    for (size_t i = 0; i < setup_.legs.size(); ++i) addLeg(i, rig);
    rig.legLength = 0;
    for (const Leg& leg : rig.legs) rig.legLength = std::max(rig.legLength, leg.reach);
    setBody(rig);
    addSkin(rig);
    for (size_t i = 0; i < setup_.legs.size(); ++i) {
      const RigSetup::Leg& from = setup_.legs[i];
      const glm::dvec3 bend = placement_.rotation * from.bend.value_or(glm::dvec3(0));
      if (from.footBones)
        settleLeg(rig, i, *from.footBones, bend);
      else if (from.bend)
        bendLeg(rig, i, bend, from.bendDegrees);
    }
    return rig;
  }

 private:
  template <typename... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    throw inputError(name_ + ": " + fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  std::string pathOf(size_t leg) const { return fmt::format("{}legs[{}]", path_, leg); }

  // `describe` says what is there, should it lie too far away.
  template <typename Describe>
  glm::dvec3 toCreature(const glm::dvec3& position, const Describe& describe) const {
    const glm::dvec3 p = placement_.toCreature(position);
    for (int k = 0; k < 3; ++k) {
      if (!(std::fabs(p[k]) <= maxCoordinate)) {
        fail("{} rests at {} m, expected within {} m", describe(), p[k], maxCoordinate);
      }
    }
    return p;
  }

  void addLeg(size_t index, Rig& rig) const {
    const RigSetup::Leg& from = setup_.legs[index];
    const std::string path = pathOf(index);
    Leg leg;
    leg.name = from.name;
    leg.group =
        static_cast<int>(std::find(rig.groups.begin(), rig.groups.end(), from.group) - rig.groups.begin());
    std::vector<glm::dvec3> points;
    for (const glm::dvec3& point : placement_.points[index])
      points.push_back(toCreature(point, [&] { return path; }));
    double reach = 0;
    for (size_t i = 0; i + 1 < points.size(); ++i) {
      const double length = glm::length(points[i + 1] - points[i]);
      if (!(length >= minBoneLength)) {
        fail("{}: the bone at \"{}\" has length {}, expected at least {}", path, from.joints[i], length,
             minBoneLength);
      }
      Bone bone;
      bone.joint = from.joints[i];
      bone.start = glm::vec3(points[i]);
      bone.direction = glm::vec3((points[i + 1] - points[i]) / length);
      bone.length = static_cast<float>(length);
      // 180 keeps the exact value that means unlimited.
      const double degrees = from.coneHalfAngleDegrees.empty() ? 180 : from.coneHalfAngleDegrees[i];
      if (degrees < 180) bone.coneHalfAngle = static_cast<float>(degrees * 3.14159265358979323846 / 180);
      reach += length;
      leg.bones.push_back(std::move(bone));
    }
    leg.reach = static_cast<float>(reach);
    glm::dvec3 home = points.back();
    home.y = 0;
    if (from.home) home = toCreature(*from.home, [&] { return path + ".home"; });
    leg.home = glm::vec3(home);
    const double distance = glm::length(home - points.front());
    if (distance > 1.001 * reach) {
      fail("{}{} is {:.3g} m from the leg's root, its bones reach {:.3g} m", path,
           from.home ? ".home" : "'s foot on the ground", distance, reach);
    }
    rig.legs.push_back(std::move(leg));
  }

  void setBody(Rig& rig) const {
    double height = 0, radius = 0.1 * static_cast<double>(rig.legLength);
    for (const Leg& leg : rig.legs) {
      height += static_cast<double>(leg.root().y) / static_cast<double>(rig.legs.size());
      radius = std::max(radius, std::fabs(static_cast<double>(leg.root().z)));
    }
    if (setup_.bodyHeight) height = *setup_.bodyHeight * placement_.scale;
    if (setup_.bodyRadius) radius = *setup_.bodyRadius * placement_.scale;
    if (!(height > 0)) {
      fail("{}bodyHeight is missing and the legs' roots lie {:.3g} m above the ground, expected over 0",
           path_, height);
    }
    if (!(height <= maxCoordinate && radius <= maxCoordinate)) {
      fail("the body is {:.3g} m high and {:.3g} m long to each end, expected up to {} m", height, radius,
           maxCoordinate);
    }
    rig.bodyHeight = static_cast<float>(height);
    rig.bodyRadius = static_cast<float>(radius);
  }

  std::vector<uint16_t> mapPalette(const Rig& rig) const {
    std::vector<uint16_t> palette;
    for (const Placement::Carrier& carrier : placement_.carriers)
      palette.push_back(
          static_cast<uint16_t>(carrier.leg == -1 ? 0 : 1 + carrier.leg * rig.maxBones() + carrier.bone));
    return palette;
  }

  void addSkin(Rig& rig) const {
    const std::vector<uint16_t> palette = mapPalette(rig);
    rig.vertices.reserve(model_.vertices.size());
    for (size_t v = 0; v < model_.vertices.size(); ++v) {
      const Model::Vertex& from = model_.vertices[v];
      SkinVertex vertex;
      vertex.position = glm::vec3(toCreature(from.position, [v] { return fmt::format("vertex {}", v); }));
      vertex.normal = glm::vec3(placement_.rotation * glm::dvec3(from.normal));
      vertex.colour = from.colour * glm::vec3(setup_.colour);
      weigh(from, palette, vertex);
      rig.vertices.push_back(vertex);
    }
    rig.look = model_.look;
    for (MaterialVertex& vertex : rig.look.vertices)
      vertex.tangent = glm::vec4(turnedTangent(placement_.rotation, glm::dvec4(vertex.tangent)));
    rig.indices = model_.indices;
    if (rig.indices.empty()) fail("has no mesh with triangles");
  }

  // The vertex keeps the four heaviest palette entries.
  void weigh(const Model::Vertex& from, const std::vector<uint16_t>& palette, SkinVertex& vertex) const {
    struct Entry {
      uint16_t bone;
      double weight;
    };
    std::vector<Entry> entries;
    for (uint32_t k = 0; k < from.influences; ++k) {
      const Model::Influence& influence = model_.influences[from.firstInfluence + k];
      const uint16_t bone = palette[influence.node];
      const auto same =
          std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.bone == bone; });
      if (same == entries.end()) {
        entries.push_back({bone, influence.weight});
      } else {
        same->weight += influence.weight;
      }
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.weight > b.weight; });
    if (entries.size() > 4) entries.resize(4);
    double kept = 0;
    for (const Entry& entry : entries) kept += entry.weight;
    for (size_t k = 0; k < entries.size(); ++k) {
      vertex.bones[k] = entries[k].bone;
      vertex.weights[k] = static_cast<float>(entries[k].weight / kept);
    }
  }

  const Model& model_;
  const RigSetup& setup_;
  const std::string& name_;
  const std::string path_;
  const Placement placement_;
};

}  // namespace

int Rig::maxBones() const {
  size_t most = 0;
  for (const Leg& leg : legs) most = std::max(most, leg.bones.size());
  return static_cast<int>(most);
}

std::vector<glm::vec3> Rig::restStarts() const {
  std::vector<glm::vec3> starts = {glm::vec3(0)};
  for (const Leg& leg : legs)
    for (size_t i = 0; i < static_cast<size_t>(maxBones()); ++i)
      starts.push_back(leg.bones[std::min(i, leg.bones.size() - 1)].start);
  return starts;
}

Rig buildRig(const Model& model, const RigSetup& setup, const std::string& name, const std::string& path) {
  try {
    return RigBuilder(model, setup, name, path).build();
  } catch (const std::bad_alloc&) {
    throw inputError(fmt::format("{}: does not fit into memory", name));
  }
}

Rig buildRig(const Model& model, const RigSetup& setup, const std::string& name) {
  return buildRig(model, setup, name, "");
}

namespace {

Rig buildRig(const RigSource& source) {
  return buildRig(source.model, source.setup, source.name, source.path);
}

}  // namespace

Rig parseRig(std::span<const uint8_t> gltf, const std::string& name) {
  return buildRig(parseRigSource(gltf, name));
}

Rig loadRig(const std::filesystem::path& file) {
  Rig rig = buildRig(loadRigSource(file, NoLegs::refused));
  const std::filesystem::path gaits = gaitsOf(file);
  std::error_code ignored;
  if (std::filesystem::exists(gaits, ignored)) rig.gaits = loadGaits(gaits, rig);
  return rig;
}

Rig proposedRig(const std::filesystem::path& file) {
  const RigSource source = loadRigSource(file, NoLegs::proposed);
  if (source.setup.legs.empty()) {
    throw inputError(fmt::format("{}: has no legs, and none are found: write {} (docs/rig.md)", source.name,
                                 sidecarOf(file).filename().string()));
  }
  return buildRig(source);
}

Rig spiderRig() {
  Rig rig = parseRig(embedded::spider_glb(), "spider.glb");
#if defined(SKITTER_SPIDER_GAITS)
  const std::span<const uint8_t> gaits = embedded::spider_gaits();
  rig.gaits = parseGaits(std::string(gaits.begin(), gaits.end()), "spider.gaits.json", rig);
#endif
  return rig;
}

}  // namespace skitter
