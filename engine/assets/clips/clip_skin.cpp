#include "assets/clips/clip_skin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "assets/materials/tangents.h"
#include "skitter/error.h"

namespace skitter {
namespace {

bool canInvert(const glm::dmat4& matrix) {
  const glm::dmat3 linear(matrix);
  const double columns = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  const double volume = std::fabs(glm::determinant(linear));
  return std::isfinite(volume) && volume > 1e-12 * columns;
}

class SkinBinder {
 public:
  SkinBinder(const RigSource& source, const Placement& placement, ClipSet& set)
      : document_(source.document),
        model_(source.model),
        setup_(source.setup),
        name_(source.name),
        placement_(placement),
        set_(set) {}

  ClipSkin bind() {
    skin_.creatureFromModel = placement_.creatureFromModel();
    modelFromCreature_ = glm::inverse(skin_.creatureFromModel);
    rank_.resize(document_.nodes.size());
    for (size_t k = 0; k < document_.parentsFirst.size(); ++k) {
      rank_[static_cast<size_t>(document_.parentsFirst[k])] = k;
    }
    skin_.weightBelow.resize(document_.nodes.size(), 0);
    skin_.inLeg.resize(document_.nodes.size(), false);
    for (size_t i = 0; i < document_.nodes.size(); ++i) {
      const gltf::Node& node = document_.nodes[i];
      if (!node.inScene || node.mesh == -1) continue;
      bindMesh(static_cast<int>(i));
    }
    if (set_.vertices.empty()) fail("has no mesh with triangles");
    set_.indices = model_.indices;
    set_.look.materials = model_.look.materials;
    addLegs();
    sortEntries();
    describeJoints();
    sumWeights();
    measure();
    return std::move(skin_);
  }

 private:
  template <typename... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    throw inputError(name_ + ": " + fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  const glm::dmat4& restOf(int node) const {
    return document_.nodes[static_cast<size_t>(node)].modelFromNode;
  }

  // The entry of a node and a constant, found or made.
  size_t entryOf(int node, const glm::dmat4& nodeFromBind) {
    const glm::dmat4 nodeFromBound = nodeFromBind * modelFromCreature_;
    for (const size_t entry : entriesOf_[node]) {
      if (skin_.entries[entry].nodeFromBound == nodeFromBound) return entry;
    }
    if (skin_.entries.size() == ClipSet::maxJoints) {
      fail("its skin is moved by over {} joints", ClipSet::maxJoints);
    }
    entriesOf_[node].push_back(skin_.entries.size());
    skin_.entries.push_back({node, nodeFromBound, false, {}, {}});
    return skin_.entries.size() - 1;
  }

  void bindMesh(int nodeIndex) {
    const gltf::Node& node = document_.nodes[static_cast<size_t>(nodeIndex)];
    const gltf::Skin* skin = node.skin == -1 ? nullptr : &document_.skins[static_cast<size_t>(node.skin)];
    glm::dmat4 modelFromVertex = restOf(nodeIndex);
    if (skin) {
      size_t first = 0;
      for (size_t k = 1; k < skin->joints.size(); ++k) {
        if (rank_[static_cast<size_t>(skin->joints[k])] < rank_[static_cast<size_t>(skin->joints[first])]) {
          first = k;
        }
      }
      modelFromVertex = restOf(skin->joints[first]) * skin->nodeFromBind[first];
    }
    if (!canInvert(modelFromVertex)) modelFromVertex = glm::dmat4(1);
    const glm::dmat4 vertexFromModel = glm::inverse(modelFromVertex);
    std::map<uint32_t, size_t> known;  // entries of the skin's joints
    const auto entryOfJoint = [&](uint32_t joint) {
      if (const auto found = known.find(joint); found != known.end()) return found->second;
      return known[joint] = skin ? entryOf(skin->joints[joint], skin->nodeFromBind[joint] * vertexFromModel)
                                 : entryOf(nodeIndex, vertexFromModel);
    };
    for (const gltf::Primitive& part : document_.meshes[static_cast<size_t>(node.mesh)].primitives) {
      for (size_t v = 0; v < part.positions.size(); ++v) {
        const std::vector<gltf::Influence> influences =
            skin ? heaviest(part, v) : std::vector<gltf::Influence>{{0, 1.0}};
        const glm::dvec3 model(modelFromVertex * glm::dvec4(part.positions[v], 1));
        addVertex(placement_.toCreature(model), influences, entryOfJoint);
      }
    }
  }

  // The four heaviest joints of a vertex, their weights scaled to a sum of 1.
  static std::vector<gltf::Influence> heaviest(const gltf::Primitive& part, size_t v) {
    std::vector<gltf::Influence> kept;
    for (size_t k = 0; k < part.influencesPerVertex; ++k) {
      const gltf::Influence& influence = part.influences[v * part.influencesPerVertex + k];
      if (influence.weight == 0) continue;
      const auto same = std::find_if(kept.begin(), kept.end(), [&](const gltf::Influence& other) {
        return other.joint == influence.joint;
      });
      if (same == kept.end()) {
        kept.push_back(influence);
      } else {
        same->weight += influence.weight;
      }
    }
    std::stable_sort(kept.begin(), kept.end(),
                     [](const gltf::Influence& a, const gltf::Influence& b) { return a.weight > b.weight; });
    if (kept.size() > 4) kept.resize(4);
    double total = 0;
    for (const gltf::Influence& influence : kept) total += influence.weight;
    for (gltf::Influence& influence : kept) influence.weight /= total;
    return kept;
  }

  // Colour and normal are the model's, the normal taken back from rest to where the vertex was bound.
  template <typename EntryOf>
  void addVertex(const glm::dvec3& position, const std::vector<gltf::Influence>& influences,
                 const EntryOf& entryOfJoint) {
    const Model::Vertex& from = model_.vertices[set_.vertices.size()];
    for (int k = 0; k < 3; ++k) {
      if (!(std::fabs(position[k]) <= maxCoordinate)) {
        fail("vertex {} was bound at {} m, expected within {} m", set_.vertices.size(), position[k],
             maxCoordinate);
      }
    }
    SkinVertex vertex;
    vertex.position = glm::vec3(position);
    vertex.colour = from.colour * glm::vec3(setup_.colour);
    glm::dmat3 restFromBound(0);
    for (size_t k = 0; k < influences.size(); ++k) {
      const size_t entry = entryOfJoint(influences[k].joint);
      ClipSkin::Entry& to = skin_.entries[entry];
      vertex.bones[k] = static_cast<uint16_t>(entry);
      vertex.weights[k] = static_cast<float>(influences[k].weight);
      to.hold(glm::dvec3(vertex.position));
      skin_.weightBelow[static_cast<size_t>(to.node)] += influences[k].weight;
      restFromBound += influences[k].weight * glm::dmat3(restOf(to.node) * to.nodeFromBound);
    }
    const glm::dvec3 bound = glm::transpose(restFromBound) * glm::dvec3(from.normal);
    const double length = glm::length(bound);
    vertex.normal = length > 1e-30 && std::isfinite(length)
                        ? glm::vec3(bound / length)
                        : glm::vec3(placement_.rotation * glm::dvec3(from.normal));
    if (model_.look) addLook(restFromBound);
    set_.vertices.push_back(vertex);
  }

  void addLook(const glm::dmat3& restFromBound) {
    MaterialVertex vertex = model_.look.vertices[set_.vertices.size()];
    const glm::dmat3 boundFromRest =
        canInvert(glm::dmat4(restFromBound)) ? glm::inverse(restFromBound) : placement_.rotation;
    vertex.tangent = glm::vec4(turnedTangent(boundFromRest, glm::dvec4(vertex.tangent)));
    set_.look.vertices.push_back(vertex);
  }

  size_t legEntry(int node) {
    for (const size_t entry : entriesOf_[node]) {
      if (canInvert(skin_.entries[entry].nodeFromBound)) return entry;
    }
    const glm::dmat4& rest = restOf(node);
    return entryOf(node, canInvert(rest) ? glm::inverse(rest) : glm::dmat4(1));
  }

  void addLegs() {
    for (size_t l = 0; l < placement_.chains.size(); ++l) {
      const std::vector<int>& chain = placement_.chains[l];
      ClipLeg leg;
      const auto add = [&](int node, const glm::dvec4& local) {
        const size_t entry = legEntry(node);
        const glm::vec3 start(glm::inverse(skin_.entries[entry].nodeFromBound) * local);
        skin_.entries[entry].hold(glm::dvec3(start));
        leg.joints.push_back(static_cast<uint16_t>(entry));
        leg.starts.push_back(start);
      };
      for (const int node : chain) add(node, {0, 0, 0, 1});
      if (placement_.points[l].size() > chain.size()) {
        const glm::dmat4& rest = restOf(chain.back());
        const glm::dvec4 tip(placement_.points[l].back(), 1);
        add(chain.back(), canInvert(rest) ? glm::inverse(rest) * tip : glm::dvec4(0, 0, 0, 1));
      }
      set_.legs.push_back(std::move(leg));
    }
  }

  // Parents first; and the nodes that have to be known for them.
  void sortEntries() {
    std::vector<size_t> order(skin_.entries.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      return rank_[static_cast<size_t>(skin_.entries[a].node)] <
             rank_[static_cast<size_t>(skin_.entries[b].node)];
    });
    std::vector<uint16_t> place(order.size());
    std::vector<ClipSkin::Entry> sorted;
    for (size_t k = 0; k < order.size(); ++k) {
      place[order[k]] = static_cast<uint16_t>(k);
      sorted.push_back(skin_.entries[order[k]]);
    }
    skin_.entries = std::move(sorted);
    for (SkinVertex& vertex : set_.vertices) {
      for (size_t k = 0; k < 4; ++k)
        vertex.bones[k] = vertex.weights[k] > 0 ? place[vertex.bones[k]] : uint16_t{0};
    }
    for (ClipLeg& leg : set_.legs) {
      for (uint16_t& joint : leg.joints) joint = place[joint];
    }
    std::vector<bool> needed(document_.nodes.size(), false);
    for (const ClipSkin::Entry& entry : skin_.entries) {
      for (int node = entry.node; node != -1 && !needed[static_cast<size_t>(node)];
           node = document_.nodes[static_cast<size_t>(node)].parent) {
        needed[static_cast<size_t>(node)] = true;
      }
    }
    for (const int node : document_.parentsFirst) {
      if (needed[static_cast<size_t>(node)]) skin_.nodes.push_back(node);
    }
  }

  void describeJoints() {
    for (const int i : skin_.nodes)
      skin_.inLeg[static_cast<size_t>(i)] = placement_.carriers[static_cast<size_t>(i)].leg != -1;
    for (const ClipSkin::Entry& entry : skin_.entries) {
      const Placement::Carrier& carrier = placement_.carriers[static_cast<size_t>(entry.node)];
      ClipJoint joint;
      joint.name = model_.reference(entry.node);
      joint.leg = carrier.leg;
      joint.bone = carrier.bone;
      set_.joints.push_back(std::move(joint));
    }
  }

  void sumWeights() {
    for (double& weight : skin_.weightBelow) weight /= static_cast<double>(set_.vertices.size());
    for (auto node = document_.parentsFirst.rbegin(); node != document_.parentsFirst.rend(); ++node) {
      const int parent = document_.nodes[static_cast<size_t>(*node)].parent;
      if (parent != -1) {
        skin_.weightBelow[static_cast<size_t>(parent)] += skin_.weightBelow[static_cast<size_t>(*node)];
      }
    }
  }

  void measure() {
    glm::dvec3 least(HUGE_VAL), most(-HUGE_VAL);
    for (const Model::Vertex& vertex : model_.vertices) {
      const glm::dvec3 p = placement_.toCreature(vertex.position);
      least = glm::min(least, p);
      most = glm::max(most, p);
    }
    set_.size = glm::length(most - least);
  }

  const gltf::Document& document_;
  const Model& model_;
  const RigSetup& setup_;
  const std::string& name_;
  const Placement& placement_;
  ClipSet& set_;
  ClipSkin skin_;
  glm::dmat4 modelFromCreature_{1};
  std::vector<size_t> rank_;                      // of each node in parentsFirst
  std::map<int, std::vector<size_t>> entriesOf_;  // of a node
};

}  // namespace

void ClipSkin::Entry::hold(const glm::dvec3& point) {
  least = hasBox ? glm::min(least, point) : point;
  most = hasBox ? glm::max(most, point) : point;
  hasBox = true;
}

ClipSkin bindSkin(const RigSource& source, const Placement& placement, ClipSet& set) {
  return SkinBinder(source, placement, set).bind();
}

}  // namespace skitter
