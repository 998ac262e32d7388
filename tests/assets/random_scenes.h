#pragma once

#include <fmt/format.h>

#include <limits>

#include "base/split_mix.h"
#include "skitter/rig.h"
#include "skitter/scene.h"

namespace skitter::test {

// Scenes of random values. Bindings name all members: a new one does not compile until it is drawn here, and
// then fails until the scene's keys have it.
class RandomScenes {
 public:
  explicit RandomScenes(uint64_t seed) : random_(seed) {}

  Scene scene() {
    Scene made;
    auto& [name, terrain, herds, camera, events, obstacles, threats, levels, light, seed] = made;
    name = text();
    terrain = coin() ? decltype(Scene::terrain)(noise()) : terrainFile();
    herds.resize(whole(0, 3));
    for (Herd& each : herds) each = herd();
    camera = this->camera();
    events.resize(whole(0, 3));
    float last = 0;
    for (auto& [at, what] : events) {
      at = last += real(0, 5);
      what = happening();
    }
    obstacles.resize(whole(0, 3));
    for (auto& [shape] : obstacles) shape = this->shape();
    threats.resize(whole(0, 3));
    for (Threat& each : threats) each = threat();
    if (coin()) {
      const float first = real(0, 4000);
      levels =
          Levels{.distances = {first, first, real(4000, 8000)},
                 .most = {static_cast<uint32_t>(whole(0, 9)), 7, static_cast<uint32_t>(whole(0, 1 << 24))}};
    }
    light = this->light();
    seed = random_();
    return made;
  }

 private:
  bool coin() { return whole(0, 1) == 1; }
  uint64_t whole(uint64_t least, uint64_t most) { return least + random_() % (most - least + 1); }
  float real(double least, double most) {
    return static_cast<float>(least + (most - least) * random_.uniform());
  }
  std::string text() { return fmt::format("\"n\xc3\xa4me\" {}\\", random_()); }
  glm::vec2 place() { return {real(-4096, 4096), real(-4096, 4096)}; }
  glm::vec3 point() { return {real(-1e5, 1e5), real(-1e5, 1e5), real(-1e5, 1e5)}; }
  template <typename Enum>
  Enum one(std::initializer_list<Enum> all) {
    return all.begin()[whole(0, all.size() - 1)];
  }
  template <typename Enum, size_t Count>
  Enum one(const std::array<Enum, Count>& all) {
    return all[whole(0, Count - 1)];
  }
  template <typename Value>
  void maybe(std::optional<Value>& value, double least, double most) {
    if (coin()) value = static_cast<Value>(real(least, most));
  }

  decltype(Obstacle::shape) shape() {
    switch (whole(0, 2)) {
      case 0: {
        Disc made;
        auto& [centre, radius] = made;
        centre = place();
        radius = real(0.01, 4096);
        return made;
      }
      case 1: {
        Capsule made;
        auto& [from, to, radius] = made;
        from = place();
        to = place();
        radius = real(0, 4096);
        return made;
      }
      default: {
        ConvexPolygon made;
        auto& [corners] = made;
        const glm::vec2 centre(real(-4000, 4000), real(-4000, 4000));
        const auto count = static_cast<int>(whole(3, 8));
        for (int i = 0; i < count; ++i) {
          const float angle = static_cast<float>(i) * 6.2831853f / static_cast<float>(count);
          corners.push_back(centre + 50.0f * glm::vec2(std::cos(angle), std::sin(angle)));
        }
        return made;
      }
    }
  }
  Light light() {
    Light made;
    auto& [sky, sun, exposure, fog] = made;
    sky = one(allSkies);
    if (coin()) sun = {real(-1000, 1000), real(0.1, 1.57)};
    exposure = real(0.05, 20);
    maybe(fog, 5, 100000);
    return made;
  }
  TerrainNoise noise() {
    TerrainNoise made;
    auto& [columns, rows, spacing, amplitude, wavelength, octaves, gain, seed] = made;
    columns = static_cast<uint32_t>(whole(2, 16384));
    rows = static_cast<uint32_t>(whole(2, 16384));
    spacing = real(0.01, 10);
    amplitude = real(0, 100);
    wavelength = real(1, 100);
    octaves = static_cast<int>(whole(1, 16));
    gain = real(0, 1);
    seed = random_();
    return made;
  }
  TerrainFile terrainFile() {
    TerrainFile made;
    auto& [file, units] = made;
    auto& [spacingX, spacingZ, least, most, scale, exaggeration, columns, rows, voidValue] = units;
    file = "/heights/" + text();
    maybe(spacingX, 0.1, 10);
    maybe(spacingZ, 0.1, 10);
    maybe(least, -100, 0);
    maybe(most, 0, 100);
    maybe(scale, 0.1, 10);
    maybe(exaggeration, 0, 10);
    maybe(columns, 2, 16384);
    maybe(rows, 2, 16384);
    if (coin()) voidValue = -std::numeric_limits<double>::max() * random_.uniform();
    return made;
  }
  ClipCut cut() {
    ClipCut made;
    auto& [clip, name, from, to] = made;
    if (coin()) clip = text();
    name = text();
    from = random_.uniform();
    to = 1 + random_.uniform();
    return made;
  }
  Tuning tuning() {
    Tuning made;
    for (const TuningInfo& info : allTunings) {
      made.*info.member = std::clamp(real(info.least, info.most), info.least, info.most);
      try {
        checkTuning(made, "");
      } catch (const Error&) {
        made.*info.member = info.usual;  // it must be less or more than another
      }
    }
    return made;
  }
  Herd herd() {
    Herd made;
    auto& [rig, controller, clips, cuts, keys, solver, stepping, tuning, agents, reserve, spawn, goal, sizes,
           avoid, ways, threat, forage, phase, colour, tint, hurt, reactions, adapts] = made;
    if (coin()) rig = "/rigs/" + text();
    controller = one(allControllers);
    clips.resize(whole(0, 2));
    for (std::string& clip : clips) clip = text();
    cuts.resize(whole(0, 2));
    for (ClipCut& each : cuts) each = cut();
    keys = static_cast<uint32_t>(whole(Herd::minKeys, Herd::maxKeys));
    solver = one(herdSolvers);
    stepping = one(allSteppings);
    tuning = this->tuning();
    agents = static_cast<uint32_t>(whole(0, 1000000));
    auto& [spawnKind, spacing, centre, heading] = spawn;
    spawnKind = one({Spawn::Kind::lanes, Spawn::Kind::grid});
    spacing = real(0.1, 10);
    centre = place();
    heading = real(-10, 10);
    reserve = static_cast<uint32_t>(whole(0, 1000));
    goal = this->goal();
    sizes.resize(whole(0, Herd::maxSizes));
    for (float& size : sizes) size = real(0.1, 10);
    avoid = coin();
    if (coin()) ways = {real(0, 100), real(0.01, 100), real(0.01, 100)};
    if (coin()) threat = real(0, 4096);
    if (coin()) forage = this->forage();
    maybe(phase, 0, 1);
    if (coin()) colour = {real(0, 1), real(0, 1), real(0, 1)};
    maybe(tint, 0, 1);
    hurt = coin();
    reactions = coin();
    adapts = coin();
    return made;
  }
  Load load() {
    Load made;
    auto& [mass, offset] = made;
    mass = real(0, 4);
    offset = {real(-2, 2), real(-2, 2), real(-2, 2)};
    return made;
  }
  Forage forage() {
    Forage made;
    auto& [nest, food, branches, cell, threshold, power, layHome, layOut, life, patience, rest, load] = made;
    nest = {place(), real(0.1, 10)};
    food.resize(whole(0, 3));
    for (FoodSource& source : food)
      source = {place(), real(0.1, 10), static_cast<uint32_t>(whole(0, FoodSource::maxAmount))};
    branches.resize(whole(0, 2));
    for (Disc& branch : branches) branch = {place(), real(0.1, 10)};
    cell = real(0.2, 10);
    threshold = real(0, 100);
    power = static_cast<uint32_t>(whole(1, Forage::maxPower));
    layHome = real(0, 100);
    layOut = real(0, 100);
    life = real(1, 1000);
    patience = static_cast<uint32_t>(whole(1, 1000));
    rest = real(0, 100);
    load = this->load();
    return made;
  }
  Goal goal() {
    Goal made;
    auto& [kind, target, speed, velocity, places, loop, radius, leader, agent] = made;
    using K = Goal::Kind;
    kind = one({K::cross, K::point, K::none, K::velocity, K::route, K::roam, K::follow, K::flee});
    places.resize(whole(1, 3));
    for (glm::vec2& each : places) each = place();
    loop = coin();
    radius = real(0.01, 100);
    leader = someHerd();
    if (coin()) agent = static_cast<uint32_t>(whole(0, Scene::maxAgents - 1));
    velocity = {real(-10, 10), real(-10, 10)};
    target = place();
    speed = real(0, 10);
    return made;
  }
  decltype(Event::what) happening() {
    switch (whole(0, 12)) {
      case 0:
        return mound();
      case 1:
        return samples();
      case 2: {
        GoalChange made;
        auto& [herd, agents, goal] = made;
        herd = someHerd();
        agents = numbers(0);
        goal = this->goal();
        return made;
      }
      case 3: {
        SpeedChange made;
        auto& [herd, agents, speed] = made;
        herd = someHerd();
        agents = numbers(0);
        speed = real(0, 10);
        return made;
      }
      case 4: {
        Teleport made;
        auto& [herd, moves] = made;
        herd = someHerd();
        for (const uint32_t agent : numbers(1)) moves.push_back({agent, standing()});
        return made;
      }
      case 5: {
        Addition made;
        auto& [herd, arrivals] = made;
        herd = someHerd();
        arrivals.resize(whole(1, 3));
        for (auto& [place, goal] : arrivals) {
          place = standing();
          if (coin()) goal = this->goal();
        }
        return made;
      }
      case 6: {
        Removal made;
        auto& [herd, agents] = made;
        herd = someHerd();
        agents = numbers(1);
        return made;
      }
      case 7: {
        HerdAddition made;
        auto& [herd] = made;
        herd = this->herd();
        return made;
      }
      case 8: {
        LegChange made;
        auto& [herd, agents, share, leg, state, bone] = made;
        herd = someHerd();
        if (coin())
          maybe(share, 0, 1);
        else
          agents = numbers(0);
        leg = text();
        state = one(allLegStates);
        if (coin()) bone = static_cast<uint32_t>(whole(0, Leg::maxBones - 1));
        return made;
      }
      case 9: {
        Push made;
        auto& [herd, agents, share, velocity] = made;
        herd = someHerd();
        if (coin())
          maybe(share, 0, 1);
        else
          agents = numbers(0);
        velocity = {real(-10, 10), real(-10, 10)};
        return made;
      }
      case 10: {
        LoadChange made;
        auto& [herd, agents, share, load] = made;
        herd = someHerd();
        if (coin())
          maybe(share, 0, 1);
        else
          agents = numbers(0);
        load = this->load();
        return made;
      }
      case 11: {
        HerdRemoval made;
        auto& [herd] = made;
        herd = someHerd();
        return made;
      }
      default: {
        ThreatChange made;
        auto& [number, threat] = made;
        number = static_cast<uint32_t>(whole(0, 63));
        threat = this->threat();
        return made;
      }
    }
  }
  Threat threat() {
    Threat made;
    auto& [centre, radius] = made;
    centre = place();
    radius = real(0, 4096);
    return made;
  }
  uint32_t someHerd() { return static_cast<uint32_t>(whole(0, Scene::maxHerds - 1)); }
  std::vector<uint32_t> numbers(uint64_t least) {
    std::vector<uint32_t> made(whole(least, 3));
    for (uint32_t& each : made) each = static_cast<uint32_t>(whole(0, Scene::maxAgents - 1));
    return made;
  }
  Place standing() {
    Place made;
    auto& [position, heading] = made;
    position = place();
    heading = real(-10, 10);
    return made;
  }
  Mound mound() {
    Mound made;
    auto& [centre, radius, height] = made;
    centre = place();
    radius = real(0.1, 10);
    height = real(-3, 3);
    return made;
  }
  HeightSamples samples() {
    HeightSamples made;
    auto& [x, z, columns, rows, heights] = made;
    x = static_cast<uint32_t>(whole(0, 100));
    z = static_cast<uint32_t>(whole(0, 100));
    columns = static_cast<uint32_t>(whole(1, 3));
    rows = static_cast<uint32_t>(whole(1, 3));
    heights.resize(size_t{columns} * rows);
    for (float& height : heights) height = real(-3, 3);
    return made;
  }
  Camera camera() {
    Camera made;
    auto& [kind, position, target, distance, fieldOfView, about, elevation, azimuth, secondsATurn, keys] =
        made;
    kind = one({Camera::Kind::follow, Camera::Kind::fixed, Camera::Kind::orbit, Camera::Kind::path});
    position = point();
    target = point();
    distance = real(0.1, 100);
    fieldOfView = real(0.1, 3);
    if (coin()) about = point();
    elevation = real(-1, 1);
    azimuth = real(-3, 3);
    secondsATurn = real(-60, 60);
    keys.resize(kind == Camera::Kind::path || coin() ? whole(2, 4) : 0);
    float last = 0;
    for (auto& [time, from, at] : keys) {
      time = last += real(0.1, 10);
      from = point();
      at = point();
    }
    return made;
  }

  base::SplitMix64 random_;
};

}  // namespace skitter::test
