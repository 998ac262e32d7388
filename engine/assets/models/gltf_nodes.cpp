#include "assets/models/gltf_nodes.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace skitter::gltf {
namespace {

void readTransform(const Source& source, size_t index, Node& to) {
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
    if (std::fabs(glm::length(q) - 1) > 0.01)
      source.fail("{}.rotation has length {}, expected 1", what, glm::length(q));
    to.rotation = glm::normalize(q);
    local = glm::mat4_cast(to.rotation);
  }
  for (int k = 0; k < 3; ++k) local[k] *= to.scale[k];
  if (!node.translation.empty()) {
    to.translation = {node.translation[0], node.translation[1], node.translation[2]};
    local[3] = glm::dvec4(to.translation, 1);
  }
}

void markScene(const Source& source, Document& document) {
  if (source.model.scenes.empty()) {
    for (Node& node : document.nodes) node.inScene = true;
    return;
  }
  const int scene = source.model.defaultScene == -1 ? 0 : source.model.defaultScene;
  source.checkIndex(scene, source.model.scenes.size(), "scene");
  for (int node : source.model.scenes[static_cast<size_t>(scene)].nodes) {
    source.checkIndex(node, document.nodes.size(), fmt::format("a node of scenes[{}]", scene));
    document.nodes[static_cast<size_t>(node)].inScene = true;
  }
}

}  // namespace

void readNodes(const Source& source, Document& document) {
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
