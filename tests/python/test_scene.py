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


def every_kind_of_event():
    goal = skitter.Goal()
    goal.kind, goal.target = "point", (5, 6)
    return [
        skitter.Event(0, skitter.Mound((1, 2), height=-0.5)),
        skitter.Event(0.5, skitter.HeightSamples(3, 4, [[1, 2, 3], [4, 5, 6]])),
        skitter.Event(1, skitter.GoalChange(goal, agents=[3, 1])),
        skitter.Event(2, skitter.SpeedChange(0.5, herd=1)),
        skitter.Event(3, skitter.Teleport([skitter.Move(4, (1, -2), 1.5), skitter.Move(0, (0, 0))], herd=1)),
        skitter.Event(4, skitter.Addition([skitter.Arrival((7, 8), -1), skitter.Arrival((0, 1), goal=goal)])),
        skitter.Event(5, skitter.Removal([2, 7])),
        skitter.Event(6, skitter.HerdAddition(skitter.Herd(6))),
        skitter.Event(7, skitter.HerdRemoval(2)),
        skitter.Event(8, skitter.ThreatChange(3, (1, -2), 4)),
        skitter.Event(9, skitter.LegChange("R2", "stuck", herd=1, share=0.25)),
    ]


def test_pushes_are_events(scene):
    scene.herds[0].reactions = True
    scene.events = [skitter.Event(1, skitter.Push((2, -1), share=0.5)), skitter.Event(2, skitter.Push((0, 3), 0, [4]))]
    written = json.loads(scene.to_json())
    assert written["herds"][0]["reactions"] is True
    assert written["events"][0] == {"at": 1, "herd": 0, "share": 0.5, "push": [2, -1]}
    again = skitter.Scene.parse(scene.to_json())
    assert again.herds[0].reactions
    assert [event.what.velocity for event in again.events] == [(2, -1), (0, 3)]
    assert again.events[1].what.agents == (4,)


def test_loads_are_events(scene):
    scene.herds[0].hurt = True
    scene.events = [
        skitter.Event(1, skitter.LoadChange(skitter.Load(0.5, (0, 0.25, -1)), share=0.5)),
        skitter.Event(2, skitter.LoadChange(skitter.Load(), 0, [4])),
    ]
    written = json.loads(scene.to_json())
    assert written["events"][0] == {"at": 1, "herd": 0, "share": 0.5, "load": {"mass": 0.5, "offset": [0, 0.25, -1]}}
    again = skitter.Scene.parse(scene.to_json())
    assert [event.what.load.mass for event in again.events] == [0.5, 0]
    assert again.events[1].what.agents == (4,)


def test_goals_in_series_are_as_in_scene_files(scene):
    herd = scene.herds[0]
    herd.ways = skitter.Ways()
    herd.threat = 2
    herd.goal.kind, herd.goal.places, herd.goal.loop = "route", [(1, 2), (3, 4)], True
    herd.goal.radius, herd.goal.herd, herd.goal.agent = 7, 1, 2
    written = json.loads(scene.to_json())["herds"][0]
    assert written["threat"] == 2 and written["goal"]["places"] == [[1, 2], [3, 4]] and written["goal"]["loop"]
    goal = skitter.Scene.parse(scene.to_json()).herds[0].goal
    assert (goal.kind, goal.places, goal.loop) == ("route", ((1, 2), (3, 4)), True)
    assert (goal.radius, goal.herd, goal.agent) == (7, 1, 2)


def test_events_are_objects_with_the_names_of_scene_files(scene):
    assert scene.events == []
    scene.events = every_kind_of_event()
    written = json.loads(scene.to_json())["events"]
    assert written[0] == {"at": 0, "mound": {"centre": [1, 2], "radius": 1, "height": -0.5}}
    assert written[1]["edit"] == {"x": 3, "z": 4, "columns": 3, "rows": 2, "heights": [1, 2, 3, 4, 5, 6]}
    assert written[2]["agents"] == [3, 1] and written[2]["goal"]["target"] == [5, 6]
    assert (written[3]["herd"], written[3]["speed"]) == (1, 0.5) and "agents" not in written[3]
    assert written[4]["teleport"][0] == {"agent": 4, "position": [1, -2], "heading": 1.5}
    assert "goal" not in written[5]["add"][0] and written[5]["add"][1]["goal"]["kind"] == "point"
    assert written[6]["remove"] == [2, 7]
    assert written[7]["addHerd"]["agents"] == 6 and written[8]["removeHerd"] == 2
    assert written[9]["threat"] == {"number": 3, "centre": [1, -2], "radius": 4}
    assert written[10] == {"at": 9, "herd": 1, "share": 0.25, "leg": "R2", "state": "stuck"}

    events = skitter.Scene.parse(scene.to_json()).events
    assert [event.at for event in events] == [0, 0.5, 1, 2, 3, 4, 5, 6, 7, 8, 9]
    assert [type(event.what) for event in events] == [type(event.what) for event in every_kind_of_event()]
    mound, samples, goal, speed, teleport, addition, removal, comes, goes, threat, leg = (event.what for event in events)
    assert (mound.centre, mound.radius, mound.height) == ((1, 2), 1, -0.5)
    assert (samples.x, samples.z) == (3, 4) and samples.heights.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert (goal.herd, goal.agents, goal.goal.kind, goal.goal.target) == (0, (3, 1), "point", (5, 6))
    assert (speed.herd, speed.agents, speed.speed) == (1, (), 0.5)
    assert [(move.agent, move.position, move.heading) for move in teleport.moves] == [(4, (1, -2), 1.5), (0, (0, 0), 0)]
    first, second = addition.arrivals
    assert (first.position, first.heading, first.goal) == ((7, 8), -1, None) and second.goal.target == (5, 6)
    assert (removal.herd, removal.agents) == (0, (2, 7))
    assert comes.herd.agents == 6 and goes.herd == 2
    assert (threat.number, threat.centre, threat.radius) == (3, (1, -2), 4)
    assert (leg.leg, leg.state, leg.share, leg.agents, leg.bone, leg.herd) == ("R2", "stuck", 0.25, (), None, 1)
    assert "at 7 s: HerdRemoval" in repr(events[-3])


def test_events_change_where_they_are(scene):
    scene.events = every_kind_of_event()
    *others, leg = (event.what for event in scene.events)
    mound, samples, goal, speed, teleport, addition, removal, comes, goes, threat = others
    threat.number, threat.centre, threat.radius = 5, (6, 7), 0
    leg.state, leg.share, leg.agents, leg.bone = "lost", None, [4], 2
    mound.radius, samples.heights, goal.goal.speed, goal.agents = 3, [[7]], 2, ()
    speed.speed, teleport.herd, removal.agents, comes.herd.reserve, goes.herd = 4, 0, [1], 5, 0
    move = skitter.Move(1, (2, 3))
    move.position, move.heading = (4, 5), 0.5
    teleport.moves = [move]
    arrival = skitter.Arrival((1, 1))
    arrival.position, arrival.heading, arrival.goal = (2, 2), 0.25, skitter.Goal()
    addition.arrivals = [arrival]
    scene.events[3].at = 2.5
    written = json.loads(scene.to_json())["events"]
    assert written[0]["mound"]["radius"] == 3
    assert written[1]["edit"] == {"x": 3, "z": 4, "columns": 1, "rows": 1, "heights": [7]}
    assert written[2]["goal"]["speed"] == 2 and "agents" not in written[2]
    assert (written[3]["at"], written[3]["speed"]) == (2.5, 4)
    assert (written[4]["herd"], written[4]["teleport"]) == (0, [{"agent": 1, "position": [4, 5], "heading": 0.5}])
    assert written[5]["add"][0]["position"] == [2, 2] and written[5]["add"][0]["goal"]["kind"] == "cross"
    assert written[6]["remove"] == [1] and written[7]["addHerd"]["reserve"] == 5 and written[8]["removeHerd"] == 0
    assert written[9]["threat"] == {"number": 5, "centre": [6, 7], "radius": 0}
    assert written[10] == {"at": 9, "herd": 1, "agents": [4], "leg": "R2", "state": "lost", "bone": 2}
    event = scene.events.pop(0)
    scene.events.clear()
    del scene
    assert event.what.radius == 3
    event.what = skitter.HerdRemoval(0)
    assert event.what.herd == 0


@pytest.mark.parametrize(
    "spoil, what",
    [
        (lambda s: s.events.append("a mound"), r"events\[0\] is 'a mound', expected an Event"),
        (lambda s: s.events.append(skitter.Event(0, 3)), r"events\[0\]\.what is 3, expected a Mound"),
        (lambda s: skitter.HeightSamples(0, 0, [1, 2]), r"heights have shape \(2,\), expected \(rows, columns\)"),
        (
            lambda s: s.events.extend(skitter.Event(at, skitter.Mound()) for at in (2, 1)),
            r"events\[1\]\.at is 1, expected 2 or later",
        ),
        (lambda s: s.events.append(skitter.Event(0, skitter.Removal([]))), r"events\[0\]\.remove is empty"),
    ],
)
def test_events_that_cannot_be_are_refused_by_name(scene, spoil, what):
    with pytest.raises(skitter.InputError, match=what):
        spoil(scene)
        scene.to_json()


def test_events_happen(device, standing):
    herd = skitter.Herd(3)
    herd.spawn.kind, herd.goal.kind = "grid", "none"
    standing.events = [
        skitter.Event(0.1, skitter.Teleport([skitter.Move(1, (5, -6))])),
        skitter.Event(0.1, skitter.HerdAddition(herd)),
        skitter.Event(0.2, skitter.Removal([0])),
        skitter.Event(0.3, skitter.HerdRemoval(1)),
    ]
    herd.agents = 1000  # the event has a copy
    crowd = skitter.Crowd(device, standing)
    crowd.step(5)
    assert (crowd.herd_count, crowd.agent_count) == (1, 4)
    crowd.step()
    assert (crowd.herd_count, crowd.agent_count, crowd.agents(1)) == (2, 7, 3)
    assert crowd.positions()[1, [0, 2]] == pytest.approx([5, -6], abs=0.1)
    crowd.step(6)
    assert crowd.agents() == 3
    assert crowd.render(64, 36).shape == (36, 64, 4)
    crowd.step(6)
    assert not crowd.has_herd((1, 0)) and crowd.agent_count == 3
    assert crowd.render(64, 36).shape == (36, 64, 4)
    assert len(skitter.State.parse(crowd.save_to_memory()).scene.events) == 4
    assert skitter.validate(standing, 30, device)
