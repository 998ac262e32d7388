import json

import numpy as np
import pytest

import skitter
from conftest import SCENE


def test_a_scene_is_read_from_text_a_dict_and_a_file(tmp_path):
    file = tmp_path / "two.json"
    file.write_text(json.dumps(SCENE))
    for scene in (skitter.Scene.parse(SCENE), skitter.Scene.parse(json.dumps(SCENE)), skitter.Scene.load(file)):
        assert [herd.agents for herd in scene.herds] == [20, 3]
        assert [herd.controller for herd in scene.herds] == ["adaptive", "loop"]
        assert scene.terrain.columns == 65
        assert scene.agent_count == 23
    assert skitter.Scene.builtin().agent_count == 1000
    assert skitter.Scene().agent_count == 1000


def test_what_is_set_is_what_a_crowd_is_made_of(scene):
    herd = scene.herds[0]
    herd.agents = 5
    herd.controller = "loop"
    herd.solver = "ccd"
    herd.stepping = "reach"
    herd.keys = 3
    herd.clips = ["walk"]
    herd.cuts = [skitter.ClipCut()]
    herd.goal.kind = "point"
    herd.goal.target = (1, 2)
    herd.goal.speed = 0.5
    herd.spawn.kind = "grid"
    herd.spawn.centre = np.array([3, 4])
    herd.spawn.spacing = 2
    herd.spawn.heading = 0.25
    herd.tuning.stepHeight = 0.25
    assert herd.sizes == ()
    herd.sizes = [1, 0.5]
    assert (herd.phase, herd.colour, herd.tint) == (None, None, None)
    herd.phase, herd.colour, herd.tint = 0.5, (1, 0.5, 0), 0.75
    again = scene.herds[0]
    assert (again.agents, again.controller, again.solver, again.stepping, again.keys) == (5, "loop", "ccd", "reach", 3)
    assert again.clips == ("walk",) and len(again.cuts) == 1 and again.sizes == (1, 0.5)
    assert (again.goal.kind, again.goal.target, again.goal.speed) == ("point", (1, 2), 0.5)
    assert (again.spawn.kind, again.spawn.centre, again.spawn.heading) == ("grid", (3, 4), 0.25)
    assert again.tuning.stepHeight == 0.25
    assert (again.phase, again.colour, again.tint) == (0.5, (1, 0.5, 0), 0.75)
    scene.herds.append(skitter.Herd(7))
    assert scene.agent_count == 5 + 3 + 7
    scene.name, scene.seed = "mine", 5
    scene.camera.kind = "fixed"
    scene.camera.position, scene.camera.target = (0, 5, -5), (0, 0, 0)
    scene.camera.fieldOfView, scene.camera.distance = 1, 5
    assert (scene.name, scene.seed, scene.camera.kind, scene.camera.position) == ("mine", 5, "fixed", (0, 5, -5))
    assert "mine" in repr(scene)


def test_a_camera_orbits_or_follows_a_path(device, scene):
    camera = scene.camera
    camera.kind = "orbit"
    assert camera.about is None and camera.secondsATurn == 30
    camera.about, camera.elevation, camera.azimuth, camera.secondsATurn = (1, 2, 3), 0.5, 1, -10
    assert scene.camera.kind == "orbit" and scene.camera.about == (1, 2, 3)
    again = skitter.Scene.parse(scene.to_json()).camera
    assert (again.elevation, again.azimuth, again.secondsATurn) == (0.5, 1, -10)
    orbiting = skitter.Crowd(device, scene).render(64, 36)
    camera.kind = "path"
    camera.keys = [skitter.CameraKey(0, (0, 9, -9), (0, 0, 0)), skitter.CameraKey(2, (9, 9, 0), (0, 1, 0))]
    keys = skitter.Scene.parse(scene.to_json()).camera.keys
    assert [(key.time, key.position, key.target) for key in keys] == [
        (0, (0, 9, -9), (0, 0, 0)), (2, (9, 9, 0), (0, 1, 0))]  # fmt: skip
    assert not np.array_equal(skitter.Crowd(device, scene).render(64, 36), orbiting)


def test_a_scene_is_written_as_it_is_read(scene):
    scene.herds[0].tuning.stepHeight = 0.25
    again = skitter.Scene.parse(scene.to_json())
    assert again.herds[0].tuning == scene.herds[0].tuning != skitter.Tuning()
    assert again.to_json() == scene.to_json() and json.loads(scene.to_json())["herds"][1]["controller"] == "loop"


def test_a_name_for_a_part_outlives_the_scene(scene):
    herd, terrain, camera = scene.herds[0], scene.terrain, scene.camera
    scene.herds.clear()
    scene.terrain = skitter.TerrainFile("hills.png")
    del scene
    assert herd.agents == 20 and terrain.columns == 65 and camera.kind == "follow"


@pytest.mark.parametrize(
    "spoil, what",
    [
        (lambda s: s.herds.append("a herd"), r"herds\[2\] is 'a herd', expected a Herd"),
        (lambda s: setattr(s, "terrain", 3), "terrain is 3, expected a TerrainNoise"),
        (lambda s: setattr(s.herds[0], "controller", "magic"), 'controller is "magic", expected one of adaptive'),
        (lambda s: setattr(s.herds[0].goal, "kind", "moon"), 'kind is "moon", expected one of cross, point, none, velocity'),
        (lambda s: skitter.Tuning(stepHigh=1), 'tuning has no "stepHigh"'),
        (lambda s: skitter.Scene.parse({"herd": 1}), "herd is no known key"),
        (lambda s: skitter.Scene.load("/no/such.json"), "/no/such.json"),
    ],
)
def test_what_cannot_be_is_refused_by_name(scene, spoil, what):
    with pytest.raises(skitter.InputError, match=what) as caught:
        spoil(scene)
        scene.agent_count
    assert caught.value.kind == "input"
    assert isinstance(caught.value, skitter.Error) and isinstance(caught.value, ValueError)


def test_tuning_has_every_parameter_with_its_range():
    info = skitter.Tuning.info()
    tuning = skitter.Tuning(stepHeight=0.3)
    assert len(info) > 50 and set(info) == set(tuning.to_dict())
    assert tuning.stepHeight == pytest.approx(0.3) and tuning != skitter.Tuning()
    assert skitter.Tuning() == skitter.Tuning()
    for name, row in info.items():
        assert row["least"] <= row["usual"] <= row["most"], name
        assert getattr(skitter.Tuning(), name) == row["usual"]
        assert row["does"] in getattr(skitter.Tuning, name).__doc__
    assert "stepHeight=0.3" in repr(tuning)


def test_ground_is_made_read_and_sampled(tmp_path, scene):
    ground = scene.load_terrain()
    assert ground.heights.shape == (65, 65) and ground.spacing == (0.5, 0.5) and ground.extent == (32, 32)
    assert ground.at(0, 0) == ground.heights[32, 32]
    assert ground.at([0, 0.25], 0).shape == (2,)
    with pytest.raises(ValueError):
        ground.heights[0, 0] = 1
    heights = ground.heights
    del ground
    assert np.isfinite(heights).all()

    slope = np.tile(np.arange(5, dtype=np.float64), (4, 1))
    made = skitter.Heightfield(slope, spacing=(1, 2), name="slope")
    assert made.name == "slope" and made.extent == (4, 6) and made.at(0.5, 0) == pytest.approx(2.5)
    np.save(tmp_path / "slope.npy", slope.astype(np.float32))
    file = skitter.TerrainFile(tmp_path / "slope.npy")
    file.spacingX, file.spacingZ = 1, 2
    assert file.scale is None
    scene.terrain = file
    read = scene.load_terrain()
    assert read.spacing == (1, 2) and np.array_equal(read.heights, slope - 2)
    for wrong in (np.zeros(4), np.zeros((1, 4)), [[0, np.nan], [0, 0]]):
        with pytest.raises(skitter.InputError, match="heights have"):
            skitter.Heightfield(wrong)
    with pytest.raises(skitter.InputError, match="spacing"):
        skitter.Heightfield(slope, spacing=(0, 1))


def test_a_rig_tells_its_legs():
    rig = skitter.Rig.spider()
    assert len(rig.legs) == 8 and rig.legLength == pytest.approx(1)
    leg = rig.legs[0]
    assert leg.name and leg.reach == pytest.approx(sum(leg.lengths)) and len(leg.home) == 3 and leg.group in (0, 1)
    assert rig.bodyHeight > 0 and rig.bodyRadius > 0
    with pytest.raises(skitter.InputError, match="/no/rig.glb"):
        skitter.Rig.load("/no/rig.glb")
