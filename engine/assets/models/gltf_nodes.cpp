#include "assets/models/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace skitter::gltf {
namespace {

void readTransform(Source& source, size_t index, Node& to) {
  const tinygltf::Node& node = source.model.nodes[index];
  const std::string what = fmt::format("nodes[{}]", index);
  source.checkFinite(node.matrix, 16, what + ".matrix");
  source.checkFinite(node.translation, 3, what + ".translation");
  source.checkFinite(node.rotation, 4, what + ".rotation");
  source.checkFinite(node.scale, 3, what + ".scale");
  glm::dmat4& local = to.parentFromNode;
  to.hasMatrix = !node.matrix.empty();
  if (to.hasMatrix) {
    for (int k = 0; k < 16; ++k) local[k / 4][k % 4] = node.matrix[static_cast<size_t>(k)];
    return;
  }
  if (!node.scale.empty()) to.scale = {node.scale[0], node.scale[1], node.scale[2]};
  if (!node.rotation.empty()) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(q);
    const auto note = [&](const char* done) {
      source.notes.add(done,
                       fmt::format("{}.rotation has length {:.3g}, expected 1: {}",
                                   nodeLabel(index, source.file.json.at("nodes")[index]), length, done));
    };
    // Exporters write rotations of nothing but zeros, and such as have been scaled or rounded.
    if (length < 1e-6) {
      note("not turned");
    } else {
      if (std::fabs(length - 1) > 0.01) note("scaled to it");
      to.rotation = glm::normalize(q);
    }
    local = glm::mat4_cast(to.rotation);
  }
  if (to.scale.x == 0 || to.scale.y == 0 || to.scale.z == 0)
    source.notes.add("flat", fmt::format("{}.scale holds 0: what it moves has no size",
                                         nodeLabel(index, source.file.json.at("nodes")[index])));
  for (int k = 0; k < 3; ++k) local[k] *= to.scale[k];
  if (!node.translation.empty()) {
    to.translation = {node.translation[0], node.translation[1], node.translation[2]};
    local[3] = glm::dvec4(to.translation, 1);
  }
}

// The default scene; where the file names none, the first that places a mesh, else the first.
int chosenScene(Source& source) {
  const auto& scenes = source.model.scenes;
  if (source.model.defaultScene != -1) {
    source.checkIndex(source.model.defaultScene, scenes.size(), "scene");
    return source.model.defaultScene;
  }
  const auto placesMesh = [&](const tinygltf::Scene& scene) {
    std::vector<int> left = scene.nodes;
    // A tree has each node once, so that one with cycles, which is refused later, ends here, too.
    for (size_t k = 0; k < left.size() && k <= source.model.nodes.size(); ++k) {
      if (left[k] < 0 || static_cast<size_t>(left[k]) >= source.model.nodes.size()) continue;
      const tinygltf::Node& node = source.model.nodes[static_cast<size_t>(left[k])];
      if (node.mesh != -1) return true;
      left.insert(left.end(), node.children.begin(), node.children.end());
    }
    return false;
  };
  const auto found = std::find_if(scenes.begin(), scenes.end(), placesMesh);
  const int chosen = found == scenes.end() ? 0 : static_cast<int>(found - scenes.begin());
  if (scenes.size() > 1)
    source.notes.lines.push_back(
        fmt::format("has {} scenes and names none of them: scenes[{}] counts", scenes.size(), chosen));
  return chosen;
}

void markScene(Source& source, Document& document) {
  if (source.model.scenes.empty()) {
    for (Node& node : document.nodes) node.inScene = true;
    return;
  }
  const int scene = chosenScene(source);
  for (int node : source.model.scenes[static_cast<size_t>(scene)].nodes) {
    source.checkIndex(node, document.nodes.size(), fmt::format("a node of scenes[{}]", scene));
    document.nodes[static_cast<size_t>(node)].inScene = true;
  }
}

}  // namespace

void readNodes(Source& source, Document& document) {
  const size_t count = source.model.nodes.size();
  document.nodes.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const tinygltf::Node& from = source.model.nodes[i];
    Node& node = document.nodes[i];
    node.name = from.name;
    node.mesh = from.mesh;
    node.skin = from.skin;
    if (node.mesh != -1)
      source.checkIndex(node.mesh, source.model.meshes.size(), fmt::format("nodes[{}].mesh", i));
    if (node.skin != -1)
      source.checkIndex(node.skin, source.model.skins.size(), fmt::format("nodes[{}].skin", i));
    for (int child : from.children) {
      source.checkIndex(child, count, fmt::format("a child of nodes[{}]", i));
      int& parent = document.nodes[static_cast<size_t>(child)].parent;
      if (parent != -1) source.fail("nodes[{}] is a child of nodes[{}] and of nodes[{}]", child, parent, i);
      parent = static_cast<int>(i);
    }
  }
  auto& order = document.parentsFirst;
  for (size_t i = 0; i < count; ++i) {
    if (document.nodes[i].parent == -1) order.push_back(static_cast<int>(i));
  }
  for (size_t k = 0; k < order.size(); ++k) {
    const auto& children = source.model.nodes[static_cast<size_t>(order[k])].children;
    order.insert(order.end(), children.begin(), children.end());
  }
  if (order.size() != count) source.fail("{} nodes are their own ancestors", count - order.size());

  markScene(source, document);
  for (int i : order) {
    Node& node = document.nodes[static_cast<size_t>(i)];
    readTransform(source, static_cast<size_t>(i), node);
    node.modelFromNode = node.parentFromNode;
    if (node.parent == -1) continue;
    const Node& parent = document.nodes[static_cast<size_t>(node.parent)];
    node.modelFromNode = parent.modelFromNode * node.modelFromNode;
    node.inScene = node.inScene || parent.inScene;
  }
}

}  // namespace skitter::gltf
