import re
import signal
import threading

import pytest

import skitter


def test_every_stage_agrees_with_the_reference(device, scene):
    result = skitter.validate(scene, 30, device)
    assert result and result.passed and (result.device, result.ticks) == (device.name, 30)
    names = list(result.stages)
    assert (names[0], names[-1]) == ("navigate", "footfall")
    assert {"body", "gait", "foothold", "swing", "ik", "pose", "measure"} < set(names)
    for name, stage in result.stages.items():
        assert stage.name == name and stage.passed and stage.why == ""
        assert stage.samples > 0 and stage.kept >= 0 and stage.ties >= 0
        assert 0 <= stage.maxError <= stage.tolerance and 0 <= stage.ratio <= 1
        assert stage.ratio * stage.tolerance == pytest.approx(stage.maxError) and stage.worst.startswith("herd ")
    assert result.stages["navigate"].samples == 30 * 23
    assert "foothold" in str(result) and "30 ticks: passed" in repr(result)


def test_stages_are_those_that_are_asked_for(scene):
    result = skitter.validate(scene, frames=20, stages=["ik", "foothold"], dt=1 / 30, fuse=False, page_agents=7)
    assert list(result.stages) == ["foothold", "ik"] and result


def test_events_and_other_ground_are_replayed(device):
    scene = skitter.Scene.parse(
        {
            "herds": [{"agents": 8, "spawn": {"kind": "grid"}}],
            "events": [{"at": 0.1, "mound": {"radius": 8, "height": 0.4}}],
        }
    )
    ground = skitter.Scene.parse({"terrain": {"columns": 65, "rows": 65, "amplitude": 2}}).load_terrain()
    assert skitter.validate(scene, 30, device, terrain=ground)


def test_sizes_are_replayed_by_themselves(device, scene):
    scene.herds[0].sizes = [0.6, 1.5]
    result = skitter.validate(scene, 30, device)
    assert result, str(result)
    assert result.stages["navigate"].samples == 30 * 23
    assert re.match(r"herd 0, size (0\.6|1\.5): ", result.stages["foothold"].worst)


@pytest.mark.parametrize(
    "herd, options, what",
    [
        ({}, {"frames": 0}, "frames is 0"),
        ({}, {"stages": ["trot"]}, 'stages is "trot", expected one of navigate'),
        ({"controller": "loop"}, {"stages": ["foothold"]}, "stages: no herd of the scene has foothold compared"),
        ({"agents": 0}, {}, "the scene has no agents"),
    ],
)
def test_nothing_to_compare_is_refused(device, herd, options, what):
    scene = skitter.Scene.parse({"herds": [herd]})
    with pytest.raises(skitter.InputError, match=what):
        skitter.validate(scene, device=device, **options)


def test_ctrl_c_ends_a_long_validation(device, scene):
    timer = threading.Timer(0.5, lambda: signal.raise_signal(signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        skitter.validate(scene, 10**6, device)
    timer.join()
