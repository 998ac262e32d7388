#include "skitter/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <new>
#include <system_error>

#include "bend.h"
#include "embedded/spider_glb.h"
#include "file.h"
#include "gltf.h"
#include "model.h"
#include "rig_setup.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr double minBoneLength = 1e-6;  // metres
constexpr double maxCoordinate = 1e4;   // metres

// A model and its setup become a rig: legs and skin in metres, +Y up, facing +Z, the origin below the body.
class RigBuilder {
 public:
  RigBuilder(const Model& model, const RigSetup& setup, const std::string& name, const std::string& path)
      : model_(model), setup_(setup), name_(name), path_(path.empty() ? "" : path + ".") {}

  Rig build() {
    for (size_t i = 0; i < setup_.legs.size(); ++i) findChain(i);
    place();
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
      if (from.bend) bendLeg(rig, i, rotation_ * *from.bend, from.bendDegrees);
    }
    return rig;
  }

 private:
  template <typename... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    throw inputError(name_ + ": " + fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  std::string pathOf(size_t leg) const { return fmt::format("{}legs[{}]", path_, leg); }

  int findNode(const std::string& joint, const std::string& path) const {
    std::vector<size_t> found;
    for (size_t i = 0; i < model_.nodes.size(); ++i) {
      if (model_.nodes[i].name == joint) found.push_back(i);
    }
    if (found.size() > 1) {
      fail("{}: two nodes are named \"{}\": #{} and #{}", path, joint, found[0], found[1]);
    }
    if (found.size() == 1) return static_cast<int>(found[0]);
    size_t index = 0;
    const char* end = joint.data() + joint.size();
    if (joint.front() == '#' && std::from_chars(joint.data() + 1, end, index).ptr == end &&
        joint.size() > 1) {
      if (index < model_.nodes.size()) return static_cast<int>(index);
      fail("{} is \"{}\", but there are {} nodes", path, joint, model_.nodes.size());
    }
    fail("{}: no node is named \"{}\"", path, joint);
  }

  void findChain(size_t legIndex) {
    const RigSetup::Leg& from = setup_.legs[legIndex];
    std::vector<int> chain;
    std::vector<glm::dvec3> points;
    for (size_t j = 0; j < from.joints.size(); ++j) {
      const std::string path = fmt::format("{}.joints[{}]", pathOf(legIndex), j);
      const int node = findNode(from.joints[j], path);
      for (size_t other = 0; other < chains_.size(); ++other) {
        if (std::find(chains_[other].begin(), chains_[other].end(), node) != chains_[other].end()) {
          fail("{}: \"{}\" is a joint of leg {} already", path, from.joints[j], setup_.legs[other].name);
        }
      }
      if (j > 0 && !model_.isAncestor(chain.back(), node)) {
        fail("{}: \"{}\" is no descendant of \"{}\"; joints run from root to foot", path, from.joints[j],
             from.joints[j - 1]);
      }
      chain.push_back(node);
      points.push_back(model_.nodes[static_cast<size_t>(node)].position());
    }
    if (from.tipOffset) points.push_back(points.back() + *from.tipOffset);
    chains_.push_back(std::move(chain));
    points_.push_back(std::move(points));
  }

  // How the model becomes the creature: turned, moved and scaled.
  void place() {
    const glm::dvec3 up = glm::normalize(setup_.up);
    const glm::dvec3 forward = glm::normalize(setup_.forward - up * glm::dot(setup_.forward, up));
    rotation_ = glm::transpose(glm::dmat3(glm::cross(up, forward), up, forward));
    double longest = 0;
    glm::dvec3 feet(0);
    for (const auto& points : points_) {
      double reach = 0;
      for (size_t i = 0; i + 1 < points.size(); ++i) reach += glm::length(points[i + 1] - points[i]);
      longest = std::max(longest, reach);
      feet += points.back() / static_cast<double>(points_.size());
    }
    origin_ = setup_.origin.value_or(feet);
    scale_ = setup_.scale.value_or(1.0);
    if (!setup_.legLength) return;
    if (!(longest > 0)) fail("{}legLength: the legs have length 0", path_);
    scale_ = *setup_.legLength / longest;
  }

  // `describe` says what is there, should it lie too far away.
  template <typename Describe>
  glm::dvec3 toCreature(const glm::dvec3& position, const Describe& describe) const {
    const glm::dvec3 p = rotation_ * ((position - origin_) * scale_);
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
    for (const glm::dvec3& point : points_[index]) points.push_back(toCreature(point, [&] { return path; }));
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
    if (setup_.bodyHeight) height = *setup_.bodyHeight * scale_;
    if (setup_.bodyRadius) radius = *setup_.bodyRadius * scale_;
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

  // A node that is no joint of a leg moves with its nearest ancestor that is one, else with the body.
  std::vector<uint16_t> mapPalette(const Rig& rig) const {
    std::vector<int> own(model_.nodes.size(), -1);
    for (size_t leg = 0; leg < chains_.size(); ++leg) {
      const size_t bones = rig.legs[leg].bones.size();
      for (size_t j = 0; j < chains_[leg].size(); ++j) {
        own[static_cast<size_t>(chains_[leg][j])] =
            1 + static_cast<int>(leg) * rig.maxBones() + static_cast<int>(std::min(j, bones - 1));
      }
    }
    std::vector<uint16_t> palette(model_.nodes.size(), 0);
    for (int i : model_.parentsFirst) {
      const auto node = static_cast<size_t>(i);
      const int parent = model_.nodes[node].parent;
      palette[node] = own[node] != -1 ? static_cast<uint16_t>(own[node])
                      : parent == -1  ? uint16_t{0}
                                      : palette[static_cast<size_t>(parent)];
    }
    return palette;
  }

  void addSkin(Rig& rig) const {
    const std::vector<uint16_t> palette = mapPalette(rig);
    rig.vertices.reserve(model_.vertices.size());
    for (size_t v = 0; v < model_.vertices.size(); ++v) {
      const Model::Vertex& from = model_.vertices[v];
      SkinVertex vertex;
      vertex.position = glm::vec3(toCreature(from.position, [v] { return fmt::format("vertex {}", v); }));
      vertex.normal = glm::vec3(rotation_ * glm::dvec3(from.normal));
      vertex.colour = from.colour * glm::vec3(setup_.colour);
      weigh(from, palette, vertex);
      rig.vertices.push_back(vertex);
    }
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
  std::vector<std::vector<int>> chains_;         // a leg's joints
  std::vector<std::vector<glm::dvec3>> points_;  // a leg's joints and tip, in the model's units and axes
  glm::dmat3 rotation_{1};
  glm::dvec3 origin_{0};
  double scale_ = 1;
};

Rig rigOfExtras(const gltf::Document& document, const Model& model, const std::string& name) {
  RigSetup setup = readRigSetup(document.extras, name, "skitter", false);
  setup.origin = glm::dvec3(0);
  return buildRig(model, setup, name, "skitter");
}

Rig rigOfSidecar(const std::filesystem::path& sidecar) {
  const RigSetup setup = loadRigSetup(sidecar);
  const std::filesystem::path file = sidecar.parent_path() / setup.model;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw inputError(fmt::format("{}: model is \"{}\", but there is no file {}", sidecar.string(),
                                 setup.model, file.string()));
  }
  return buildRig(loadModel(file), setup, sidecar.string(), "");
}

}  // namespace

int Rig::maxBones() const {
  size_t most = 0;
  for (const Leg& leg : legs) most = std::max(most, leg.bones.size());
  return static_cast<int>(most);
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

Rig parseRig(std::span<const uint8_t> gltf, const std::string& name) {
  const gltf::Document document = gltf::parse(gltf, name);
  if (document.extras.is_null()) {
    throw inputError(fmt::format(
        "{}: has no legs: a rig needs `skitter` in the extras of its scene or of a node (docs/rig.md)",
        name));
  }
  return rigOfExtras(document, makeModel(document, name), name);
}

Rig loadRig(const std::filesystem::path& file) {
  const std::string name = file.string();
  if (file.extension() == ".json") return rigOfSidecar(file);
  std::error_code ignored;
  const std::filesystem::path sidecar = sidecarOf(file);
  if (std::filesystem::exists(sidecar, ignored) && std::filesystem::exists(file, ignored)) {
    const RigSetup setup = loadRigSetup(sidecar);
    if (std::filesystem::path(setup.model).filename() != file.filename()) {
      throw inputError(fmt::format("{}: model is \"{}\", but the file beside it is {}", sidecar.string(),
                                   setup.model, file.filename().string()));
    }
    return buildRig(loadModel(file), setup, sidecar.string(), "");
  }
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const gltf::Document document = gltf::parse(readFile(file), name, folder);
  if (document.extras.is_null()) {
    throw inputError(fmt::format("{}: has no legs: run `skitter rig {}` to propose {} (docs/rig.md)", name,
                                 name, sidecar.filename().string()));
  }
  return rigOfExtras(document, makeModel(document, name), name);
}

Rig spiderRig() { return parseRig(embedded::spider_glb(), "spider.glb"); }

}  // namespace skitter
