#include "made_models.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <tuple>

#include "creature.h"

namespace skitter::test {
namespace {

using Names = std::vector<std::string>;
using Points = std::vector<glm::dvec3>;

const glm::dvec3 up(0, 1, 0);

glm::dquat about(const glm::dvec3& axis, double angle) { return glm::angleAxis(angle, glm::normalize(axis)); }

// Points of a leg in the vertical plane through `from` along `out`: bones by length and degrees above level.
Points legPoints(const glm::dvec3& from, const glm::dvec3& out,
                 const std::vector<std::pair<double, double>>& bones) {
  Points points{from};
  for (const auto& [length, degrees] : bones) {
    const double angle = glm::radians(degrees);
    points.push_back(points.back() + length * (std::cos(angle) * out + std::sin(angle) * up));
  }
  return points;
}

// A foot's way over a cycle, from where it rests: back along the ground for `duty` of it, then forward
// through the air.
glm::dvec3 step(double phase, double duty, double stride, double lift) {
  phase -= std::floor(phase);
  if (phase < duty) return {0, 0, stride * (0.5 - phase / duty)};
  const double share = (phase - duty) / (1 - duty);
  return {0, lift * std::sin(std::numbers::pi * share), stride * (share - 0.5)};
}

// Six legs of six joints. It faces -X, but its joints called left are on its right. All legs begin in one
// point of the body, and each ends in a joint near the ground.
Glb hexapod() {
  Creature creature;
  const auto body = static_cast<int>(creature.joint("root", -1, {0.8, 1.4, 0}, {-0.8, 1.4, 0}, 0.4));
  for (const auto& [row, ahead] :
       {std::pair("middle", 0.0), std::pair("front", 0.7), std::pair("back", -0.7)}) {
    for (const auto& [side, z] : {std::pair("r", 1.0), std::pair("l", -1.0)}) {
      const glm::dvec3 out(-std::sin(ahead), 0, z * std::cos(ahead));
      const Points points =
          legPoints({0, 1.4, 0}, out, {{0.8, 0}, {0.7, 20}, {2, 50}, {1.3, -60}, {2, -83}, {0.05, -83}});
      Names names;
      for (int k = 0; k < 6; ++k)
        names.push_back(std::string("leg_") + row + "_" + side + "_" + std::to_string(k));
      creature.limb(names, body, points, 0.06);
    }
  }
  creature.meshName = "spider";
  return creature.glb();
}

// One chain of seven joints. Two of them lie in one place.
Glb singleLeg() {
  Creature creature;
  creature.limb({"root", "leg1", "leg2", "leg3", "leg4", "leg5", "leg_tip"}, -1,
                {{0, 0, 0},
                 {0, 1.3, 0},
                 {0, 1.3, 0},
                 {0, 1.5, 0.8},
                 {0, 3, 2.2},
                 {0, 2, 3},
                 {0, 0, 3.1},
                 {0, -0.05, 3.1}},
                0.1);
  return creature.glb();
}

// Eight legs of five joints; no joint at the feet, but a target of inverse kinematics by each, a root of its
// own. Its only clip stands, breathes, and then walks on the spot.
Glb spider() {
  Creature creature;
  const glm::dvec3 middle(0, 0.75, 0.2);
  const auto body = static_cast<int>(creature.joint("Body", -1, {0, 0.75, -0.4}, middle, 0.4));
  const auto neck = static_cast<int>(creature.joint("NeckBase", body, middle, {0, 0.8, 0.6}, 0.2));
  const size_t head = creature.joint("Head", neck, {0, 0.8, 0.6}, {0, 0.8, 1.2}, 0.25);
  for (const auto& [side, x] : {std::pair("L", 1.0), std::pair("R", -1.0)}) {
    creature.limb({std::string("JawBase.") + side, std::string("Pincer.") + side}, static_cast<int>(head),
                  {{0.1 * x, 0.75, 1.2}, {0.15 * x, 0.7, 1.5}, {0.1 * x, 0.6, 1.7}}, 0.05);
  }
  const size_t abdomen =
      creature.limb({"Body.001", "Body.002"}, body, {{0, 0.75, -0.4}, {0, 0.9, -0.9}, {0, 1, -2.2}}, 0.5) + 1;
  struct Leg {
    size_t root;
    glm::dvec3 tip, out;
    bool second;
  };
  std::vector<Leg> legs;
  for (int row = 0; row < 4; ++row) {
    for (const auto& [side, x] : {std::pair("L", 1.0), std::pair("R", -1.0)}) {
      const double angle = glm::radians(std::array{40.0, 75.0, 105.0, 140.0}[static_cast<size_t>(row)]);
      const glm::dvec3 out(x * std::sin(angle), 0, std::cos(angle));
      const Points points = legPoints(middle, out, {{0.9, 0}, {1.5, 50}, {0.8, 10}, {0.9, -40}, {1.4, -80}});
      Names names;
      for (const char* part : {"Base.", "Upper.", "Mid.", "Lower.", "Shin."})
        names.push_back("Leg" + std::to_string(row + 1) + part + side);
      legs.push_back(
          {creature.limb(names, body, points, 0.04), points.back(), out, (row + (x > 0)) % 2 == 0});
    }
  }
  for (size_t leg = 0; leg < legs.size(); ++leg) {
    creature.joint("Leg" + std::to_string(leg / 2 + 1) + "IK." + (leg % 2 ? "R" : "L"), -1, legs[leg].tip,
                   legs[leg].tip, 0);
  }
  const double walkEnds = madeSpiderWalks + 1.5 * madeSpiderCycle;
  creature.clip("Take", 5, 121, [&](Pose& pose, double time) {
    pose.stretch(abdomen, 1 + 0.05 * std::sin(2 * time));
    pose.turn(head, about(up, 0.1 * std::sin(3 * time)));
    if (time < madeSpiderWalks || time > walkEnds) return;
    for (const Leg& leg : legs) {
      const glm::dvec3 way = step((time - madeSpiderWalks) / madeSpiderCycle + (leg.second ? 0.5 : 0), 0.5,
                                  0.5 * madeSpiderSpeed * madeSpiderCycle, 0.2);
      pose.move(leg.root, {0, 0, way.z});
      pose.turn(leg.root + 1, about(glm::cross(leg.out, up), way.y));
    }
  });
  return creature.glb();
}

// A beast some 140 units long whose forelegs rest straight. Its mesh has no indices.
Glb fox() {
  Creature creature;
  const auto root = static_cast<int>(creature.limb({"RootJoint", "Root"}, -1, {{}, {}, {}}, 0)) + 1;
  const size_t hip = creature.limb({"Hip", "Spine1", "Spine2"}, root,
                                   {{0, 40, -30}, {0, 41, -10}, {0, 42, 10}, {0, 43, 30}}, 6);
  const size_t neck =
      creature.limb({"Neck", "Head"}, static_cast<int>(hip) + 2, {{0, 43, 30}, {0, 55, 42}, {0, 57, 62}}, 4);
  struct Leg {
    size_t root;
    glm::dvec3 end;
    double phase;
  };
  std::vector<Leg> legs;
  for (const auto& [side, x] : {std::pair("Right", -7.0), std::pair("Left", 7.0)}) {
    const std::string name = side;
    const size_t arm =
        creature.limb({name + "UpperArm", name + "ForeArm", name + "Hand"}, static_cast<int>(hip) + 2,
                      {{x, 42, 30}, {x, 22, 29}, {x, 1, 30}, {x, 1, 30.5}}, 0.8);
    const size_t leg =
        creature.limb({name + "Leg1", name + "Leg2", name + "Foot1", name + "Foot2"}, static_cast<int>(hip),
                      {{x, 40, -30}, {x, 25, -22}, {x, 12, -34}, {x, 1, -28}, {x, 1, -27.5}}, 0.8);
    legs.push_back({arm, {x, 1, 30}, x > 0 ? 0 : 0.5});
    legs.push_back({leg, {x, 12, -34}, x > 0 ? 0.75 : 0.25});
  }
  creature.limb({"Tail1", "Tail2", "Tail3"}, static_cast<int>(hip),
                {{0, 40, -30}, {0, 38, -42}, {0, 36, -54}, {0, 35, -78}}, 2);
  creature.indexed = false;

  const auto gait = [&](double seconds, double duty, double speed) {
    return [&legs, hip, seconds, duty, speed](Pose& pose, double time) {
      pose.move(hip, {0, -4, 0});
      for (const Leg& leg : legs)
        pose.reach(leg.root, leg.end + step(time / seconds + leg.phase, duty, speed * duty * seconds, 6));
    };
  };
  creature.clip("Survey", 3.4, 69,
                [&](Pose& pose, double time) { pose.turn(neck, about(up, 0.5 * std::sin(2 * time))); });
  creature.clip("Walk", 0.7, 21, gait(0.7, 0.6, madeFoxWalk));
  creature.clip("Run", 0.55, 21, gait(0.55, 0.35, madeFoxRun));
  return creature.glb();
}

// One that stands on two legs, its nodes without names under a matrix that turns +Z up, its weights not of
// sum 1.
Glb figure() {
  Creature creature;
  const auto hips = static_cast<int>(creature.joint("", -1, {0, 0.9, 0}, {0, 1.05, 0}, 0.1));
  std::vector<size_t> limbs;
  for (const double x : {0.1, -0.1}) {
    limbs.push_back(creature.limb(
        Names(4), hips, {{x, 0.9, 0}, {x, 0.48, 0.02}, {x, 0.08, 0}, {x, 0.02, 0.1}, {x, 0.02, 0.14}}, 0.02));
  }
  const size_t spine =
      creature.limb(Names(4), hips, {{0, 1.05, 0}, {0, 1.2, 0}, {0, 1.4, 0}, {0, 1.5, 0}, {0, 1.7, 0}}, 0.08);
  for (const double x : {1.0, -1.0}) {
    limbs.push_back(
        creature.limb(Names(3), static_cast<int>(spine) + 1,
                      {{0.15 * x, 1.4, 0}, {0.4 * x, 1.4, 0}, {0.65 * x, 1.4, 0}, {0.8 * x, 1.4, 0}}, 0.03));
  }
  creature.named = false;
  creature.zUp = true;
  creature.weightSum = 0.9;
  creature.clip(
      "", 1.25, 2,
      [&](Pose& pose, double time) {
        for (size_t k = 0; k < limbs.size(); ++k)
          pose.turn(limbs[k], about({1, 0, 0}, (k % 2 ? 0.4 : -0.4) * time));
      },
      true);
  return creature.glb();
}

// One that stands on two legs and faces +Z. Its right foot has no toe, so the line between the feet is 24
// degrees aslant.
Glb biped() {
  Creature creature;
  const auto hips = static_cast<int>(creature.joint("Hips", -1, {0, 0.9, 0}, {0, 1.05, 0}, 0.1));
  for (const auto& [side, x, toe] : {std::tuple("L", 0.1, 0.1), std::tuple("R", -0.1, 0.01)}) {
    const std::string end = std::string(".") + side;
    creature.limb({"Thigh" + end, "Shin" + end, "Foot" + end, "Toe" + end}, hips,
                  {{x, 0.9, 0}, {x, 0.48, 0.02}, {x, 0.08, 0}, {x, 0.02, toe}, {x, 0.02, toe + 0.04}}, 0.02);
    creature.limb({"Arm" + end, "Forearm" + end}, hips, {{4 * x, 1.4, 0}, {6.5 * x, 1.4, 0}, {8 * x, 1.4, 0}},
                  0.03);
  }
  creature.limb({"Spine", "Chest"}, hips, {{0, 1.05, 0}, {0, 1.3, 0}, {0, 1.7, 0}}, 0.08);
  return creature.glb();
}

// Eight wide legs of three bones, some of which point along its way, feet without joints, and six vertices
// whose weights are 0 / 0.
Glb crawler() {
  Creature creature;
  const auto body = static_cast<int>(creature.joint("Body", -1, {0, 0.5, -0.6}, {0, 0.5, 0.5}, 0.3));
  creature.joint("Head", body, {0, 0.5, 0.5}, {0, 0.5, 0.9}, 0.15);
  for (int row = 0; row < 4; ++row) {
    for (const auto& [side, x] : {std::pair("L", 1.0), std::pair("R", -1.0)}) {
      const double angle = glm::radians(std::array{15.0, 55.0, 125.0, 165.0}[static_cast<size_t>(row)]);
      const glm::dvec3 out(x * std::sin(angle), 0, std::cos(angle));
      const Points points = legPoints(glm::dvec3(0, 0.5, 0.05 - 0.1 * row) + 0.25 * out, out,
                                      {{0.3, 20}, {0.9, 10}, {1.0, -50}});
      Names names;
      for (const char* part : {"Coxa", "Femur", "Tibia"})
        names.push_back("Leg" + std::to_string(row + 1) + part + "." + side);
      creature.limb(names, body, points, 0.05);
    }
  }
  Glb glb = creature.glb();
  const size_t weights = glb.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"];
  const std::vector<float> nothing(size_t{6} * 4, std::numeric_limits<float>::quiet_NaN());
  std::memcpy(glb.data(weights), nothing.data(), nothing.size() * sizeof(float));
  return glb;
}

// Two joints that are no leg, without names, under a matrix.
Glb column() {
  Creature creature;
  const size_t lower = creature.limb(Names(2), -1, {{0, 0, 0}, {0, 4, 0}, {0, 8, 0}}, 1);
  creature.named = false;
  creature.zUp = true;
  creature.clip(
      "", 2, 3,
      [&](Pose& pose, double time) {
        pose.turn(lower + 1, about({0, 0, 1}, 0.8 * std::sin(0.5 * time)));
      },
      true);
  return creature.glb();
}

Glb empty() {
  Glb glb;
  glb.json = {{"asset", {{"version", "2.0"}}}, {"buffers", {{{"byteLength", 0}}}}, {"scene", 0}};
  return glb;
}

size_t addMesh(Glb& glb, const std::vector<float>& positions, const std::vector<uint16_t>& indices) {
  const size_t at = glb.append(positions, "VEC3");
  glb.json["meshes"].push_back(
      {{"primitives", {{{"attributes", {{"POSITION", at}}}, {"indices", glb.append(indices, "SCALAR")}}}}});
  return glb.json["meshes"].size() - 1;
}

// A strip of quads, two vertices a row.
struct Strip {
  std::vector<float> positions;
  std::vector<uint16_t> indices;
};
Strip strip(size_t rows) {
  Strip strip;
  for (size_t row = 0; row < rows; ++row) {
    const float y = 2 * static_cast<float>(row) / static_cast<float>(rows - 1);
    strip.positions.insert(strip.positions.end(), {-0.5f, y, 0, 0.5f, y, 0});
    if (row == 0) continue;
    for (const size_t corner : {2 * row - 2, 2 * row - 1, 2 * row, 2 * row - 1, 2 * row + 1, 2 * row})
      strip.indices.push_back(static_cast<uint16_t>(corner));
  }
  return strip;
}

// The smallest skin, two joints below the node of the mesh, the upper of which nods.
Glb simpleSkin(const std::string& interpolation) {
  Glb glb = empty();
  const Strip skin = strip(5);
  addMesh(glb, skin.positions, skin.indices);
  std::vector<uint8_t> joints;
  std::vector<float> weights, times, turns;
  for (size_t v = 0; v < 10; ++v) {
    const float share = 0.25f * static_cast<float>(v / 2);
    joints.insert(joints.end(), {0, 1, 0, 0});
    weights.insert(weights.end(), {1 - share, share, 0, 0});
  }
  auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = glb.append(joints, "VEC4");
  attributes["WEIGHTS_0"] = glb.append(weights, "VEC4");
  std::vector<float> bind;
  for (int joint = 0; joint < 2; ++joint)
    bind.insert(bind.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1});
  glb.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", glb.append(bind, "MAT4")}}};
  glb.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"children", {1}}},
                       {{"translation", {0, 1, 0}}, {"children", {2}}},
                       {{"rotation", {0, 0, 0, 1}}}};
  glb.json["scenes"] = {{{"nodes", {0}}}};
  for (int k = 0; k < 12; ++k) {
    times.push_back(0.5f * static_cast<float>(k));
    const double half = 0.4 * std::sin(0.5 * k);
    turns.insert(turns.end(), {0, 0, static_cast<float>(std::sin(half)), static_cast<float>(std::cos(half))});
  }
  glb.animate(2, "rotation", interpolation, times, turns);
  return glb;
}
Glb simpleSkinLinear() { return simpleSkin("LINEAR"); }
Glb simpleSkinStep() { return simpleSkin("STEP"); }

// Positions of a cube's corners, and its triangles.
Strip cube() {
  Strip cube;
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) cube.positions.push_back(corner >> axis & 1 ? 0.5f : -0.5f);
  }
  cube.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return cube;
}

// Nine cubes without a skin, each moved by a clip of its own: three kinds of channel by three interpolations.
// Its picture is missing.
Glb interpolations() {
  Glb glb = empty();
  const Strip corners = cube();
  addMesh(glb, corners.positions, corners.indices);
  addMesh(glb, {-6, -1, -6, 6, -1, -6, -6, -1, 6, 6, -1, 6}, {0, 2, 3, 0, 3, 1});
  const std::vector<float> times = {0, 0.4f, 0.8f, 1.2f, 5 / 3.0f};
  std::vector<size_t> roots;
  for (const char* path : {"scale", "rotation", "translation"}) {
    for (const char* interpolation : {"STEP", "LINEAR", "CUBICSPLINE"}) {
      const size_t node = roots.size();
      glb.json["nodes"].push_back({{"mesh", 0}, {"translation", {3 * (node % 3), 3 * (node / 3), 0}}});
      glb.json["animations"].push_back({{"name", std::string(interpolation) + " " + path}});
      std::vector<float> values;
      for (size_t key = 0; key < times.size(); ++key) {
        const auto wave = static_cast<float>(std::sin(1.7 * static_cast<double>(key)));
        const bool turns = path == std::string("rotation");
        std::vector<float> value, slope;
        if (turns) {
          value = {0, std::sin(0.8f * wave), 0, std::cos(0.8f * wave)};
          slope = {0, 0.5f, 0, 0};
        } else {
          const bool grows = path == std::string("scale");
          for (const size_t axis : {size_t{0}, size_t{1}, size_t{2}}) {
            const float rest =
                grows ? 1 : static_cast<float>(axis == 2 ? 0 : 3 * (axis == 0 ? node % 3 : node / 3));
            value.push_back(rest + 0.4f * wave * static_cast<float>(axis));
          }
          slope = {0.2f, -0.1f, 0.3f};
        }
        const bool cubic = interpolation == std::string("CUBICSPLINE");
        if (cubic) values.insert(values.end(), slope.begin(), slope.end());
        values.insert(values.end(), value.begin(), value.end());
        if (cubic) values.insert(values.end(), slope.begin(), slope.end());
      }
      glb.animate(node, path, interpolation, times, values);
      roots.push_back(node);
    }
  }
  glb.json["nodes"].push_back({{"name", "Light"}, {"translation", {0, 6, 9}}});
  glb.json["nodes"].push_back({{"name", "Camera"}, {"translation", {0, 5, 29}}, {"scale", {1, 0.4, 1}}});
  glb.json["nodes"].push_back({{"name", "Plane"}, {"mesh", 1}});
  roots.insert(roots.end(), {9, 10, 11});
  glb.json["scenes"] = {{{"nodes", roots}}};
  glb.json["images"] = {{{"uri", "none.png"}}};
  glb.json["textures"] = {{{"source", 0}}};
  return glb;
}

// A plate whose four corners follow ten joints each, with an end marker on every joint, and an armature that
// is a hundred times as large and lies on its back, by matrices.
Glb plate() {
  Glb glb = empty();
  addMesh(glb, {-1, 0, -1, 1, 0, -1, -1, 0, 1, 1, 0, 1}, {0, 2, 3, 0, 3, 1});
  auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  for (size_t set = 0; set < 3; ++set) {
    std::vector<uint8_t> joints;
    std::vector<float> weights;
    for (size_t v = 0; v < 4; ++v) {
      for (size_t k = 4 * set; k < 4 * set + 4; ++k) {
        joints.push_back(static_cast<uint8_t>(k % 10));
        weights.push_back(k < 10 ? 0.1f : 0);
      }
    }
    attributes["JOINTS_" + std::to_string(set)] = glb.append(joints, "VEC4");
    attributes["WEIGHTS_" + std::to_string(set)] = glb.append(weights, "VEC4");
  }
  const nlohmann::json large = {100, 0, 0, 0, 0, 0, -100, 0, 0, 100, 0, 0, 0, 0, 0, 1};
  auto& nodes = glb.json["nodes"];
  nodes = {{{"name", "RootNode"}, {"children", {1, 22}}}, {{"name", "Armature"}, {"matrix", large}}};
  std::vector<float> bind;
  std::vector<size_t> joints;
  for (int joint = 0; joint < 10; ++joint) {
    const float x = 0.2f * static_cast<float>(joint) - 1;
    const std::string name = "Bone.00" + std::to_string(joint);
    joints.push_back(nodes.size());
    nodes[1]["children"].push_back(nodes.size());
    nodes.push_back({{"name", name},
                     {"matrix", {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, x, 0, 0, 1}},
                     {"children", {nodes.size() + 1}}});
    nodes.push_back({{"name", name + "_end"}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1}}});
    bind.insert(bind.end(), {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, -x, 0, 0, 1});
  }
  nodes.push_back({{"name", "Plane"}, {"mesh", 0}, {"skin", 0}, {"matrix", large}});
  glb.json["skins"] = {{{"joints", joints}, {"inverseBindMatrices", glb.append(bind, "MAT4")}}};
  glb.json["scenes"] = {{{"nodes", {0}}}};
  return glb;
}

Glb one(const std::vector<float>& positions, const std::vector<uint16_t>& indices) {
  Glb glb = empty();
  addMesh(glb, positions, indices);
  glb.json["nodes"] = {{{"mesh", 0}}};
  glb.json["scenes"] = {{{"nodes", {0}}}};
  return glb;
}

// Three positions of a strip lie elsewhere, by a sparse accessor.
Glb sparse() {
  const Strip skin = strip(7);
  Glb glb = one(skin.positions, skin.indices);
  glb.append(std::vector<uint16_t>{8, 10, 12}, "SCALAR");
  glb.append(std::vector<float>{1, 2, 0, 3, 3, 0, 5, 4, 0}, "VEC3");
  const size_t last = glb.json["bufferViews"].size() - 1;
  glb.json["accessors"][0]["sparse"] = {{"count", 3},
                                        {"indices", {{"bufferView", last - 1}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", last}}}};
  return glb;
}

// A triangle whose vertices are 16 bytes apart.
Glb strided() {
  Glb glb = one({0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9}, {0, 1, 2});
  glb.json["bufferViews"][0]["byteStride"] = 16;
  glb.json["accessors"][0]["count"] = 3;
  return glb;
}

// A cube with a vertex for each corner of each face, placed by a matrix.
Glb byMatrix() {
  const Strip corners = cube();
  std::vector<float> positions;
  std::vector<uint16_t> indices;
  for (size_t face = 0; face < 6; ++face) {
    // A face's two triangles have six corners; these are its four.
    for (const size_t k : {0, 1, 2, 5}) {
      const size_t corner = corners.indices[6 * face + k];
      for (size_t axis = 0; axis < 3; ++axis) positions.push_back(corners.positions[3 * corner + axis]);
    }
    for (const size_t k : {0, 1, 2, 0, 2, 3}) indices.push_back(static_cast<uint16_t>(4 * face + k));
  }
  Glb glb = one(positions, indices);
  glb.json["nodes"][0]["matrix"] = {0, 0, -2, 0, 0, 2, 0, 0, 2, 0, 0, 0, 1, 2, 3, 1};
  return glb;
}

constexpr MadeModel models[] = {
    {"hexapod.glb", hexapod},
    {"leg.glb", singleLeg},
    {"spider.gltf", spider},
    {"fox.glb", fox},
    {"column.glb", column},
    {"figure.glb", figure},
    {"biped.glb", biped},
    {"crawler.glb", crawler},
    {"simple_skin.gltf", simpleSkinLinear},
    {"step_skin.gltf", simpleSkinStep},
    {"interpolations.gltf", interpolations},
    {"plate.glb", plate},
    {"sparse.gltf", sparse},
    {"strided.gltf", strided},
    {"matrix.gltf", byMatrix},
};

}  // namespace

std::span<const MadeModel> madeModels() { return models; }

void writeMadeModels(const std::filesystem::path& folder) {
  for (const MadeModel& model : models) model.make().write(folder / model.file);
}

}  // namespace skitter::test
