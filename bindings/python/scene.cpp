#include <cmath>

#include "bindings/python/bind.h"
#include "skitter/rig.h"

namespace skitter::python {
namespace {

using namespace py::literals;

// As scene files name them.
constexpr std::array spawnKinds{"lanes", "grid"};
constexpr std::array goalKinds{"cross", "point", "none", "velocity", "route", "roam", "follow", "flee"};
constexpr std::array cameraKinds{"follow", "fixed", "orbit", "path"};

PythonScene parsedScene(const py::object& json, const std::filesystem::path& folder) {
  const auto text = py::isinstance<py::str>(json) ? json : py::module_::import("json").attr("dumps")(json);
  return PythonScene(parseScene(text.cast<std::string>(), "the scene", folder));
}

void bindGoals(py::module_& module) {
  py::class_<Spawn> spawn(module, "Spawn", "Where the agents of a herd start.");
  spawn.def(py::init<>());
  defineNamed(
      spawn, "kind", &Spawn::kind, spawnKinds,
      "\"lanes\": parallel lanes along +z across the terrain. \"grid\": a square grid about `centre`.");
  spawn.def_readwrite("spacing", &Spawn::spacing, "Metres between lanes, or between agents of a grid.")
      .def_readwrite("centre", &Spawn::centre, "x and z, metres.")
      .def_readwrite("heading", &Spawn::heading, "Radians about +Y; 0 faces +Z.");

  py::class_<Goal> goal(module, "Goal", "Where the agents of a herd go.");
  goal.def(py::init<>());
  defineNamed(
      goal, "kind", &Goal::kind, goalKinds,
      "\"cross\": to the far side of the terrain and back, for ever. \"point\": to `target`, to stand there. "
      "\"none\": nowhere. \"velocity\": by `velocity`. Of herds with ways: \"route\": over `places`. "
      "\"roam\": "
      "within `radius` of `target`. \"follow\": an agent or a herd. \"flee\": out of threats.");
  goal.def_readwrite("target", &Goal::target, "x and z, metres.")
      .def_readwrite("velocity", &Goal::velocity, "x and z, metres per second, of kind \"velocity\".")
      .def_readwrite("speed", &Goal::speed, "Metres per second along the ground, at least 0.")
      .def_property(
          "places", [](const Goal& self) { return py::tuple(py::cast(self.places)); },
          [](Goal& self, std::vector<glm::vec2> places) { self.places = std::move(places); },
          "1 to 16 x and z, metres, of kind \"route\".")
      .def_readwrite("loop", &Goal::loop, "Whether the first place of a route follows the last one.")
      .def_readwrite("radius", &Goal::radius, "Metres about `target`, of kind \"roam\".")
      .def_readwrite("herd", &Goal::leader, "The herd that kind \"follow\" follows.")
      .def_readwrite("agent", &Goal::agent, "A place in that herd; None: its middle.");
}

void bindHerd(py::module_& module) {
  py::class_<ClipCut>(module, "ClipCut", "A part of a clip under a name of its own.")
      .def(py::init<>())
      .def_readwrite("clip", &ClipCut::clip, "The clip it is cut out of.")
      .def_readwrite("name", &ClipCut::name, "What it is called.")
      .def_readwrite("start", &ClipCut::from, "Seconds of the clip; a scene file calls it `from`.")
      .def_readwrite("end", &ClipCut::to, "Seconds of the clip; a scene file calls it `to`.");

  py::class_<Ways>(module, "Ways", "What ground is to a herd that finds its way (docs/ways.md).")
      .def(py::init<>())
      .def_readwrite("climb", &Ways::climb, "How much longer a metre takes for each metre of rise a metre.")
      .def_readwrite("steepest", &Ways::steepest, "Rise over run beyond which ground is impassable.")
      .def_readwrite("step", &Ways::step, "Leg lengths, height of a ledge that is just passable.");

  py::class_<Disc>(module, "Disc", "A disc on the ground.")
      .def(py::init<>())
      .def_readwrite("centre", &Disc::centre, "x and z, metres.")
      .def_readwrite("radius", &Disc::radius, "Metres.");
  py::class_<FoodSource>(module, "FoodSource", "Food that a herd forages for.")
      .def(py::init<>())
      .def_readwrite("centre", &FoodSource::centre, "x and z, metres.")
      .def_readwrite("radius", &FoodSource::radius, "Metres.")
      .def_readwrite("amount", &FoodSource::amount, "Loads.");
  py::class_<Load>(module, "Load", "What an agent carries.")
      .def(py::init([](float mass, const glm::vec3& offset) {
             return Load{mass, offset};
           }),
           "mass"_a = Load{}.mass, "offset"_a = Load{}.offset)
      .def_readwrite("mass", &Load::mass, "Times the agent's own, 0 to 4; 0: it carries nothing.")
      .def_readwrite("offset", &Load::offset,
                     "Of the load's centre from the body's: left, up and forward, -2 to 2 leg lengths.");
  py::class_<Forage>(module, "Forage", "How the agents of a herd forage (docs/foraging.md).")
      .def(py::init<>())
      .def_readwrite("nest", &Forage::nest, "Where they carry food.")
      .def_property(
          "food", [](const Forage& self) { return py::tuple(py::cast(self.food)); },
          [](Forage& self, std::vector<FoodSource> food) { self.food = std::move(food); },
          "The sources, at most 16.")
      .def_property(
          "branches", [](const Forage& self) { return py::tuple(py::cast(self.branches)); },
          [](Forage& self, std::vector<Disc> branches) { self.branches = std::move(branches); },
          "Places in which passages are counted, at most 16.")
      .def_readwrite("cell", &Forage::cell, "Metres a side of the cells in which pheromone is.")
      .def_readwrite("threshold", &Forage::threshold, "k: units as attractive as no pheromone at all.")
      .def_readwrite("power", &Forage::power, "n, 1 to 4.")
      .def_readwrite("layHome", &Forage::layHome, "Units laid in each cell with a load.")
      .def_readwrite("layOut", &Forage::layOut, "Units laid in each cell on a search.")
      .def_readwrite("life", &Forage::life, "Seconds, mean life of pheromone.")
      .def_readwrite("patience", &Forage::patience, "Cells after which a search is given up.")
      .def_readwrite("rest", &Forage::rest, "Seconds, mean stay in the nest.")
      .def_readwrite("load", &Forage::load, "A Load: what food is to who carries it.");

  py::class_<Herd, std::shared_ptr<Herd>> herd(module, "Herd", "Agents with one rig, controller and spawn.");
  herd.def(py::init([](uint32_t agents) {
             Herd made;
             made.agents = agents;
             return made;
           }),
           "agents"_a = 1000, "So many adaptive spiders.");
  herd.def_readwrite(
          "rig", &Herd::rig,
          "\"spider\", a model (.glb, .gltf) or a sidecar (.rig.json), relative to the working directory.")
      .def_property(
          "clips", [](const Herd& self) { return py::tuple(py::cast(self.clips)); },
          [](Herd& self, std::vector<std::string> names) { self.clips = std::move(names); },
          "The clips that play; empty: all that suit.")
      .def_property(
          "cuts", [](const Herd& self) { return py::tuple(py::cast(self.cuts)); },
          [](Herd& self, std::vector<ClipCut> cuts) { self.cuts = std::move(cuts); },
          "Clips cut out of those of the model.")
      .def_readwrite("keys", &Herd::keys, "Key poses of controller \"key-poses\", 2 to 8.")
      .def_readwrite("tuning", &Herd::tuning, "The numbers of its walk.")
      .def_readwrite("agents", &Herd::agents, "How many there are.")
      .def_readwrite("reserve", &Herd::reserve, "Places for more, who come and go while the crowd runs.")
      .def_readwrite("spawn", &Herd::spawn, "Where they start.")
      .def_readwrite("goal", &Herd::goal, "Where they go.")
      .def_property(
          "sizes", [](const Herd& self) { return py::tuple(py::cast(self.sizes)); },
          [](Herd& self, std::vector<float> sizes) { self.sizes = std::move(sizes); },
          "How large its creatures are, times the rig: each draws one of at most 16; empty: 1.")
      .def_readwrite("avoid", &Herd::avoid, "Whether its agents keep clear of those near them.")
      .def_readwrite("threat", &Herd::threat,
                     "Metres around each of its agents that other herds with ways keep off.")
      .def_readwrite("ways", &Herd::ways,
                     "Ways, where agents go around what is in the way; None: they go straight.")
      .def_readwrite("forage", &Herd::forage, "Forage, where agents do; None: they have goals.")
      .def_readwrite("phase", &Herd::phase,
                     "Where in its gait or clip each agent begins, 0 to 1; None: drawn by the seed.")
      .def_readwrite("colour", &Herd::colour, "Linear red, green and blue, 0 to 1; None: the model's.")
      .def_readwrite("tint", &Herd::tint,
                     "How much agents differ in colour, 0 to 1; None: half, by their numbers.")
      .def_readwrite("hurt", &Herd::hurt, "Whether legs of its agents can be hurt.")
      .def_readwrite("reactions", &Herd::reactions, "Whether its agents stumble, fall and get up.")
      .def_readwrite("adapts", &Herd::adapts,
                     "Whether its agents are not told which legs are hurt, and try gaits until one is good.")
      .def("__repr__", [](const Herd& self) {
        return fmt::format("<skitter.Herd of {} agents, {}, {}>", self.agents, self.rig,
                           nameOf(self.controller));
      });
  defineNamed(herd, "controller", &Herd::controller, allControllers,
              "How the legs move: \"adaptive\" and others.");
  defineNamed(herd, "solver", &Herd::solver, herdSolvers, "What solves the legs: \"active-set\" and others.");
  defineNamed(herd, "stepping", &Herd::stepping, allSteppings,
              "When legs of an adaptive herd step: \"gait\" or \"reach\".");
}

// A member of TerrainFile::units.
template <typename Value>
void defineUnit(py::class_<TerrainFile>& bound, const char* name,
                std::optional<Value> HeightfieldUnits::*member, const char* text) {
  bound.def_property(
      name, [=](const TerrainFile& self) { return self.units.*member; },
      [=](TerrainFile& self, std::optional<Value> value) { self.units.*member = value; }, text);
}

void bindTerrain(py::module_& module) {
  py::class_<TerrainNoise>(module, "TerrainNoise", "Rolling ground, the same for the same numbers.")
      .def(py::init<>())
      .def_readwrite("columns", &TerrainNoise::columns, "Samples along x.")
      .def_readwrite("rows", &TerrainNoise::rows, "Samples along z.")
      .def_readwrite("spacing", &TerrainNoise::spacing, "Metres per sample.")
      .def_readwrite("amplitude", &TerrainNoise::amplitude, "Metres, the height of the largest hills.")
      .def_readwrite("wavelength", &TerrainNoise::wavelength, "Metres between the largest hills.")
      .def_readwrite("octaves", &TerrainNoise::octaves, "1 to 16.")
      .def_readwrite("gain", &TerrainNoise::gain, "Ratio of the amplitudes of octaves.")
      .def_readwrite("seed", &TerrainNoise::seed, "What it is drawn from.");

  py::class_<TerrainFile> file(
      module, "TerrainFile",
      "Ground out of a file: .png, .r16, .r32f, .hgt or .npy (docs/terrain.md). What is None "
      "is looked up in the sidecar, then in the file.");
  file.def(py::init([](std::filesystem::path name) {
             return TerrainFile{std::move(name), {}};
           }),
           "file"_a)
      .def_readwrite("file", &TerrainFile::file, "Its name.");
  using Units = HeightfieldUnits;
  defineUnit(file, "spacingX", &Units::spacingX, "Metres per sample along x, before scale.");
  defineUnit(file, "spacingZ", &Units::spacingZ, "Metres per sample along z, before scale.");
  defineUnit(file, "minHeight", &Units::minHeight, "Metres at code 0, before scale.");
  defineUnit(file, "maxHeight", &Units::maxHeight, "Metres at the highest code, before scale.");
  defineUnit(file, "scale", &Units::scale, "Multiplies spacing and heights.");
  defineUnit(file, "exaggeration", &Units::exaggeration, "Multiplies heights.");
  defineUnit(file, "columns", &Units::columns, "Samples along x, of raw files.");
  defineUnit(file, "rows", &Units::rows, "Samples along z, of raw files.");
  defineUnit(file, "voidValue", &Units::voidValue, "A sample of this value has no height.");

  py::class_<Heightfield, std::shared_ptr<Heightfield>>(
      module, "Heightfield", "Ground y = h(x, z), bilinear between samples, its middle at the origin.")
      .def(py::init([](const Floats& heights, std::pair<float, float> spacing, std::string name) {
             if (heights.ndim() != 2 || heights.shape(0) < 2 || heights.shape(1) < 2)
               throw inputError(fmt::format(
                   "heights have shape {}, expected (rows, columns), each at least 2", shapeOf(heights)));
             auto made = std::make_shared<Heightfield>();
             made->name = std::move(name);
             made->rows = static_cast<uint32_t>(heights.shape(0));
             made->columns = static_cast<uint32_t>(heights.shape(1));
             made->spacingX = spacing.first;
             made->spacingZ = spacing.second;
             made->heights.assign(heights.data(), heights.data() + heights.size());
             if (!(spacing.first > 0 && spacing.second > 0))
               throw inputError(fmt::format("spacing is ({}, {}), expected metres above 0", spacing.first,
                                            spacing.second));
             if (!std::all_of(made->heights.begin(), made->heights.end(),
                              [](float h) { return std::isfinite(h); }))
               throw inputError("heights have one that is not finite");
             return made;
           }),
           "heights"_a, "spacing"_a = std::pair(0.5f, 0.5f), "name"_a = "array",
           "Samples in metres, of shape (rows along z, columns along x), and the metres between columns and "
           "rows.")
      .def_property_readonly(
          "name", [](const Heightfield& self) { return self.name; }, "Where it comes from.")
      .def_property_readonly(
          "spacing", [](const Heightfield& self) { return std::pair(self.spacingX, self.spacingZ); },
          "Metres between columns and between rows.")
      .def_property_readonly(
          "extent", [](const Heightfield& self) { return std::pair(self.extentX(), self.extentZ()); },
          "Metres along x and z.")
      .def_property_readonly(
          "heights",
          [](const py::object& self) {
            const auto& field = self.cast<const Heightfield&>();
            py::array_t<float> view({field.rows, field.columns}, field.heights.data(), self);
            view.attr("flags").attr("writeable") = false;
            return view;
          },
          "Samples in metres above mid height, of shape (rows along z, columns along x). A view without a "
          "copy, "
          "read-only.")
      .def(
          "at",
          [](const Heightfield& self, const Floats& x, const Floats& z) {
            return py::vectorize([&self](float atX, float atZ) { return self.at(atX, atZ); })(x, z);
          },
          "x"_a, "z"_a, "Heights at places, metres. Arrays are broadcast.");
}

void bindRig(py::module_& module) {
  py::class_<Leg>(module, "Leg", "A limb, from its root to its foot, at rest in model space.")
      .def_readonly("name", &Leg::name, "Such as \"L1\".")
      .def_readonly("group", &Leg::group, "Legs of one group swing together.")
      .def_readonly("home", &Leg::home, "Where the foot stands, metres.")
      .def_readonly("reach", &Leg::reach, "The sum of its bones, metres.")
      .def_property_readonly(
          "lengths",
          [](const Leg& self) {
            py::list lengths;
            for (const Bone& bone : self.bones) lengths.append(bone.length);
            return lengths;
          },
          "Of its bones from the root on, metres.");
  py::class_<Rig, std::shared_ptr<Rig>>(module, "Rig", "A model's legs and their limits.")
      .def_static("load", &loadRig, "file"_a, "A model (.glb, .gltf) or a sidecar (.rig.json).")
      .def_static("spider", &spiderRig, "The built-in spider.")
      .def_readonly("name", &Rig::name, "Of the model.")
      .def_property_readonly(
          "legs", [](const Rig& self) { return py::tuple(py::cast(self.legs)); }, "Its legs.")
      .def_readonly("legLength", &Rig::legLength, "The longest reach, metres.")
      .def_readonly("bodyHeight", &Rig::bodyHeight, "Of the body's middle above the ground at rest, metres.")
      .def_readonly("bodyRadius", &Rig::bodyRadius, "Half of the body's length, metres.");
}

void bindCameras(py::module_& module) {
  py::class_<CameraKey>(module, "CameraKey", "Where a camera on a path is at a time.")
      .def(py::init([](float time, const glm::vec3& position, const glm::vec3& target) {
             return CameraKey{time, position, target};
           }),
           "time"_a, "position"_a, "target"_a)
      .def_readwrite("time", &CameraKey::time, "Seconds.")
      .def_readwrite("position", &CameraKey::position, "World metres.")
      .def_readwrite("target", &CameraKey::target, "What it looks at, world metres.");
  py::class_<Camera> camera(module, "Camera", "Where pictures are taken from (docs/scene.md).");
  camera.def(py::init<>());
  defineNamed(camera, "kind", &Camera::kind, cameraKinds,
              "\"follow\": behind and above the middle of the crowd. \"fixed\": from `position` at `target`. "
              "\"orbit\": around the middle of the crowd, or `about`. \"path\": through `keys`.");
  camera.def_readwrite("position", &Camera::position, "World metres, of \"fixed\".")
      .def_readwrite("target", &Camera::target, "World metres, of \"fixed\".")
      .def_readwrite("distance", &Camera::distance,
                     "Metres from what it looks at, of \"follow\" and \"orbit\".")
      .def_readwrite("fieldOfView", &Camera::fieldOfView, "Radians, vertical.")
      .def_readwrite("about", &Camera::about, "World metres, of \"orbit\"; None: the middle of the crowd.")
      .def_readwrite("elevation", &Camera::elevation, "Radians above the horizon, of \"orbit\".")
      .def_readwrite("azimuth", &Camera::azimuth, "Radians about +Y from +Z: on which side \"orbit\" begins.")
      .def_readwrite(
          "secondsATurn", &Camera::secondsATurn,
          "Seconds per turn of \"orbit\", counter-clockwise from above; below 0 clockwise; 0: it stays.")
      .def_property(
          "keys", [](const Camera& self) { return py::tuple(py::cast(self.keys)); },
          [](Camera& self, std::vector<CameraKey> keys) { self.keys = std::move(keys); },
          "2 to 1024 CameraKey, of \"path\".");
}

void bindLight(py::module_& module) {
  py::class_<Light> light(module, "Light", "What lights pictures (docs/scene.md).");
  light.def(py::init<>());
  defineNamed(light, "sky", &Light::sky, allSkies, "\"day\", \"overcast\", \"evening\" or \"night\".");
  light
      .def_readwrite("sun", &Light::sun,
                     "Azimuth about +Y from +Z and elevation, radians; None: as of the sky.")
      .def_readwrite("exposure", &Light::exposure, "Times the sky's own.")
      .def_readwrite("fog", &Light::fog, "Metres at which fog has taken 63 %; None: as suits the camera.");
}

}  // namespace

PythonScene::PythonScene(const Scene& scene) : rest(scene), events(eventsOf(scene)) {
  for (const Herd& herd : scene.herds) herds.append(std::make_shared<Herd>(herd));
  terrain = std::visit([](const auto& kind) { return py::cast(kind); }, scene.terrain);
  rest.herds.clear();
  rest.events.clear();
}

Scene PythonScene::scene() const {
  Scene made = rest;
  for (const py::handle herd : herds) {
    if (!py::isinstance<Herd>(herd))
      throw inputError(fmt::format("herds[{}] is {}, expected a Herd", made.herds.size(),
                                   py::repr(herd).cast<std::string>()));
    made.herds.push_back(herd.cast<const Herd&>());
  }
  if (made.herds.size() > Scene::maxHerds)
    throw inputError(fmt::format("{} herds, expected at most {}", made.herds.size(), Scene::maxHerds));
  if (py::isinstance<TerrainNoise>(terrain))
    made.terrain = terrain.cast<TerrainNoise>();
  else if (py::isinstance<TerrainFile>(terrain))
    made.terrain = terrain.cast<TerrainFile>();
  else
    throw inputError(fmt::format("terrain is {}, expected a TerrainNoise or a TerrainFile",
                                 py::repr(terrain).cast<std::string>()));
  made.events = eventsIn(events);
  if (made.events.size() > Scene::maxEvents)
    throw inputError(fmt::format("{} events, expected at most {}", made.events.size(), Scene::maxEvents));
  return made;
}

void bindScene(py::module_& module) {
  bindGoals(module);
  bindHerd(module);
  bindTerrain(module);
  bindRig(module);
  bindCameras(module);
  bindLight(module);
  bindEvents(module);

  py::class_<PythonScene>(module, "Scene",
                          "Terrain, herds, camera, events and seed: what a crowd is made of.")
      .def(py::init([] { return PythonScene(Scene{}); }), "1,000 spiders on generated ground.")
      .def_static(
          "builtin", [] { return PythonScene(builtinScene()); }, "1,000 spiders that cross generated ground.")
      .def_static(
          "load", [](const std::filesystem::path& file) { return PythonScene(loadScene(file)); }, "file"_a,
          "A scene file (docs/scene.md).")
      .def_static(
          "parse", &parsedScene, "json"_a, "folder"_a = std::filesystem::path(),
          "What a scene file has in it, as a str or a dict. File names in it are relative to `folder`.")
      .def_property(
          "name", [](const PythonScene& self) { return self.rest.name; },
          [](PythonScene& self, std::string name) { self.rest.name = std::move(name); }, "For messages.")
      .def_property(
          "seed", [](const PythonScene& self) { return self.rest.seed; },
          [](PythonScene& self, uint64_t seed) { self.rest.seed = seed; },
          "What all randomness is drawn from.")
      .def_property(
          "camera", [](PythonScene& self) -> Camera& { return self.rest.camera; },
          [](PythonScene& self, const Camera& value) { self.rest.camera = value; },
          "Where pictures are taken from.")
      .def_property(
          "light", [](PythonScene& self) -> Light& { return self.rest.light; },
          [](PythonScene& self, const Light& value) { self.rest.light = value; }, "What lights them.")
      .def_readwrite("herds", &PythonScene::herds, "A list of Herd.")
      .def_readwrite("events", &PythonScene::events, "A list of Event, by time.")
      .def_readwrite("terrain", &PythonScene::terrain, "A TerrainNoise or a TerrainFile.")
      .def_property_readonly(
          "agent_count", [](const PythonScene& self) { return self.scene().agentCount(); },
          "Agents of all herds.")
      .def(
          "load_terrain",
          [](const PythonScene& self) {
            const Scene scene = self.scene();
            const py::gil_scoped_release release;
            return std::make_shared<Heightfield>(scene.loadTerrain());
          },
          "The ground, read or generated.")
      .def(
          "to_json", [](const PythonScene& self) { return sceneJson(self.scene()); },
          "The text of a scene file that is read back as an equal scene, with absolute file names.")
      .def("__repr__", [](const PythonScene& self) {
        return fmt::format("<skitter.Scene {} of {} herds>", self.rest.name, py::len(self.herds));
      });
}

}  // namespace skitter::python
