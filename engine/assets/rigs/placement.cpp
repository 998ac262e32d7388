#include "assets/rigs/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "skitter/error.h"

namespace skitter {
namespace {

class Placer {
 public:
  Placer(const Model& model, const RigSetup& setup, const std::string& name, const std::string& path)
      : model_(model), setup_(setup), name_(name), path_(path.empty() ? "" : path + ".") {}

  Placement place() {
    for (size_t i = 0; i < setup_.legs.size(); ++i) findChain(i);
    findCarriers();
    const glm::dvec3 up = glm::normalize(setup_.up);
    const glm::dvec3 forward = glm::normalize(setup_.forward - up * glm::dot(setup_.forward, up));
    result_.rotation = glm::transpose(glm::dmat3(glm::cross(up, forward), up, forward));
    double longest = 0;
    glm::dvec3 feet(0);
    for (const auto& points : result_.points) {
      double reach = 0;
      for (size_t i = 0; i + 1 < points.size(); ++i) reach += glm::length(points[i + 1] - points[i]);
      longest = std::max(longest, reach);
      feet += points.back() / static_cast<double>(result_.points.size());
    }
    result_.origin = setup_.origin.value_or(feet);
    result_.scale = setup_.scale.value_or(1.0);
    if (!setup_.legLength) return std::move(result_);
    if (!(longest > 0)) fail("{}legLength: the legs have length 0", path_);
    result_.scale = *setup_.legLength / longest;
    return std::move(result_);
  }

 private:
  template <typename... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    throw inputError(name_ + ": " + fmt::format(format, std::forward<Arguments>(arguments)...));
  }

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
    const auto [rest, error] = std::from_chars(joint.data() + 1, end, index);
    if (joint.front() == '#' && rest == end && joint.size() > 1) {
      if (error == std::errc{} && index < model_.nodes.size()) return static_cast<int>(index);
      fail("{} is \"{}\", but there are {} nodes", path, joint, model_.nodes.size());
    }
    fail("{}: no node is named \"{}\"", path, joint);
  }

  void findChain(size_t legIndex) {
    const RigSetup::Leg& from = setup_.legs[legIndex];
    std::vector<int> chain;
    std::vector<glm::dvec3> points;
    for (size_t j = 0; j < from.joints.size(); ++j) {
      const std::string path = fmt::format("{}legs[{}].joints[{}]", path_, legIndex, j);
      const int node = findNode(from.joints[j], path);
      for (size_t other = 0; other < result_.chains.size(); ++other) {
        const std::vector<int>& taken = result_.chains[other];
        if (std::find(taken.begin(), taken.end(), node) != taken.end()) {
          fail("{}: \"{}\" is a joint of leg {} already", path, from.joints[j], setup_.legs[other].name);
        }
      }
      // A foot may hang from a joint outside the chain, as those of inverse kinematics do.
      for (size_t before = 0; before < chain.size(); ++before) {
        if (chain[before] != node && !model_.isAncestor(node, chain[before])) continue;
        if (chain[before] == node) fail("{}: \"{}\" is named twice", path, from.joints[j]);
        fail("{}: \"{}\" is above \"{}\"; joints run from root to foot", path, from.joints[j],
             from.joints[before]);
      }
      chain.push_back(node);
      points.push_back(model_.nodes[static_cast<size_t>(node)].position());
    }
    if (from.tipOffset) points.push_back(points.back() + *from.tipOffset);
    result_.chains.push_back(std::move(chain));
    result_.points.push_back(std::move(points));
  }

  void findCarriers() {
    std::vector<Placement::Carrier> own(model_.nodes.size());
    for (size_t leg = 0; leg < result_.chains.size(); ++leg) {
      const size_t bones = result_.points[leg].size() - 1;
      for (size_t j = 0; j < result_.chains[leg].size(); ++j) {
        own[static_cast<size_t>(result_.chains[leg][j])] = {static_cast<int>(leg),
                                                            static_cast<int>(std::min(j, bones - 1))};
      }
    }
    const std::vector<Placement::Carrier> ofLegs = own;
    for (const RigSetup::Follower& follower : setup_.followers) {
      const std::string path = fmt::format("{}follow", path_);
      const auto joint = static_cast<size_t>(findNode(follower.joint, path));
      const auto bone = static_cast<size_t>(findNode(follower.bone, path));
      if (ofLegs[joint].leg != -1) fail("{}: \"{}\" is a joint of a leg", path, follower.joint);
      if (ofLegs[bone].leg == -1) {
        fail("{}.{} is \"{}\", expected a joint of a leg", path, follower.joint, follower.bone);
      }
      own[joint] = ofLegs[bone];
    }
    result_.carriers = own;
    for (const int i : model_.parentsFirst) {
      const auto node = static_cast<size_t>(i);
      const int parent = model_.nodes[node].parent;
      if (own[node].leg == -1 && parent != -1)
        result_.carriers[node] = result_.carriers[static_cast<size_t>(parent)];
    }
  }

  const Model& model_;
  const RigSetup& setup_;
  const std::string& name_;
  const std::string path_;
  Placement result_;
};

}  // namespace

glm::dmat4 Placement::creatureFromModel() const {
  glm::dmat4 matrix(rotation * scale);
  matrix[3] = glm::dvec4(toCreature(glm::dvec3(0)), 1);
  return matrix;
}

Placement placeModel(const Model& model, const RigSetup& setup, const std::string& name,
                     const std::string& path) {
  return Placer(model, setup, name, path).place();
}

}  // namespace skitter
