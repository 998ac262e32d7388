import gc
import pathlib
import signal
import threading
import time
import warnings

import numpy as np
import pytest

import skitter

DT = 1 / 60


def test_a_crowd_walks_to_where_it_looks(device, scene):
    crowd = skitter.Crowd(device, scene)
    before = crowd.positions()
    crowd.step(60)
    assert (crowd.tick, crowd.agent_count, crowd.herd_count, crowd.agents(1)) == (60, 23, 2, 3)
    way = crowd.positions() - before
    assert way.shape == (20, 3) and way.dtype == np.float64
    walked = np.hypot(way[:, 0], way[:, 2])
    assert 0.5 < walked.mean() < 1.2
    headings = crowd.headings()
    assert (way[:, 0] * np.sin(headings) + way[:, 2] * np.cos(headings) > 0.9 * walked).all()
    assert crowd.speeds() == pytest.approx(np.ones(20), abs=0.3)
    assert np.linalg.norm(crowd.rotations(), axis=1) == pytest.approx(np.ones(20), abs=1e-5)


def test_joints_are_bones_apart_and_feet_are_where_the_device_has_them(device, scene):
    crowd = skitter.Crowd(device, scene, feet=True)
    crowd.step(30)
    joints = crowd.joints()
    assert joints.shape == (20, 8, 5, 3)
    for number, leg in enumerate(crowd.rig().legs):
        lengths = np.linalg.norm(np.diff(joints[:, number], axis=1), axis=2)
        assert lengths == pytest.approx(np.broadcast_to(leg.lengths, lengths.shape), abs=1e-4)
    tips = crowd.positions()[:, None] + crowd.records()["tip"][..., :3]
    assert joints[:, :, -1] == pytest.approx(tips, abs=1e-3)
    bare = skitter.Crowd(device, scene, pose=False)
    with pytest.raises(skitter.InputError, match="made with poses"):
        bare.joints()


def test_agents_have_the_sizes_of_their_places(device, scene):
    assert skitter.Crowd(device, scene).sizes().tolist() == [1] * 20
    scene.herds[0].sizes = [2, 0.5]
    crowd = skitter.Crowd(device, scene)
    sizes = crowd.sizes()
    assert sizes.dtype == np.float32 and set(sizes.tolist()) == {2, 0.5} and (np.diff(sizes) <= 0).all()
    assert (crowd.rig().legLength, crowd.rig(0, 19).legLength) == pytest.approx((2, 0.5))
    crowd.step(30)
    lengths = np.linalg.norm(np.diff(crowd.joints(), axis=2), axis=3)
    large = np.array([leg.lengths for leg in crowd.rig().legs])
    assert lengths == pytest.approx(sizes[:, None, None] / 2 * large, abs=1e-3)
    with pytest.raises(skitter.InputError, match="herd 0, agent 20: expected one of its 20 places"):
        crowd.rig(0, 20)
    scene.herds[0].sizes = [30]
    with pytest.raises(skitter.InputError, match=r"herds\[0\].sizes\[0\] is 30, expected 0.05 to 20"):
        skitter.Crowd(device, scene)


def test_ticks_at_once_and_one_by_one_are_the_same(device, scene):
    first, second = skitter.Crowd(device, scene), skitter.Crowd(device, scene, pose=False, measure=False)
    first.step(20)
    for _ in range(20):
        second.step()
    assert first.state_hash() == second.state_hash()
    first.step(0)
    assert first.tick == 20
    first.step(1, DT)
    assert first.state_hash() != second.state_hash()
    with pytest.raises(skitter.InputError, match="keeps its first dt"):
        first.step(1, 1 / 30)
    first.step()
    assert first.tick == 22


def test_footfalls_are_a_structured_array(device, scene):
    crowd = skitter.Crowd(device, scene, footfalls=1000)
    seen = 0
    for tick in range(1, 61):
        crowd.step()
        events = crowd.footfalls()
        assert events.dtype.names == ("agent", "leg", "tick", "seconds", "place", "speed")
        assert (events["tick"] == tick).all() and events["seconds"] == pytest.approx(tick * DT)
        assert (events["agent"] < 20).all() and (events["leg"] < 8).all() and events["place"].shape == (len(events), 3)
        seen += len(events)
    assert seen > 100 and crowd.dropped_footfalls() == 0
    assert len(skitter.Crowd(device, scene).footfalls()) == 0


def test_fidelity_has_the_names_of_files_of_figures(device, scene):
    crowd = skitter.Crowd(device, scene)
    crowd.step(60)
    both, herd = crowd.fidelity(), crowd.fidelity(0)
    assert both["agentTicks"] == 23 * 60 and herd["agentTicks"] == 20 * 60
    assert herd["stances"] > 0 and 0 <= herd["slip"] < 0.01 and herd["limitViolation"] >= 0
    each = crowd.agent_fidelity()
    assert set(each) == set(herd) and each["agentTicks"].tolist() == [60] * 20
    assert crowd.watch_every == 1
    rare = skitter.Crowd(device, scene, watch_every=4)
    assert rare.watch_every == 4


def test_arrays_keep_the_memory_that_was_read(device, scene):
    crowd = skitter.Crowd(device, scene)
    crowd.step(30)
    for array in (
        crowd.positions(), crowd.headings(), crowd.speeds(), crowd.rotations(), crowd.joints(),
        crowd.agent_fidelity()["agentTicks"], crowd.records()["step"], crowd.render(32, 32), crowd.agent_ids(),
        crowd.save_to_memory(),
    ):  # fmt: skip
        assert array.size > 0 and array.flags.c_contiguous and array.flags.writeable and not array.flags.owndata


def test_records_are_copies_by_name(device, scene):
    crowd = skitter.Crowd(device, scene)
    crowd.step(10)
    records = crowd.records()
    assert records["body"].shape == (20, 16) and records["step"].shape == (20, 8, 8) and "foot" in records
    assert "foot" not in skitter.Crowd(device, scene, measure=False).records()
    before = records["body"].copy()
    crowd.step()
    assert np.array_equal(records["body"], before) and not np.array_equal(crowd.records()["body"], before)


def test_herds_that_are_not_there_are_refused(device, scene):
    crowd = skitter.Crowd(device, scene, footfalls=10)
    for ask in (
        crowd.agents, crowd.places, crowd.agent_ids, crowd.herd_id, crowd.rig, crowd.sizes, crowd.positions,
        crowd.headings, crowd.speeds, crowd.rotations, crowd.joints, crowd.footfalls, crowd.dropped_footfalls,
        crowd.fidelity, crowd.agent_fidelity, crowd.records, crowd.memory_use,
    ):  # fmt: skip
        with pytest.raises(skitter.InputError, match="herd 2: expected one of the crowd's 2 herds"):
            ask(2)


def test_a_crowd_tells_its_cost(device, scene):
    crowd = skitter.Crowd(device, scene, timestamps=True)
    crowd.step()
    times = crowd.stage_times()
    assert sum(times.values()) > 0 and any("gait" in name for name in times)
    assert skitter.Crowd(device, scene).stage_times() == {}
    uses = [crowd.memory_use(herd) for herd in range(2)]
    assert sum(sum(use.values()) for use in uses) == crowd.memory_bytes > 0
    assert "23 agents at tick 1" in repr(crowd)


def test_the_ground_is_given_and_edited(device, scene):
    flat = skitter.Heightfield(np.zeros((65, 65), np.float32), name="flat")
    crowd = skitter.Crowd(device, scene, flat)
    crowd.step(2)
    assert np.abs(crowd.positions()[:, 1]).max() < 0.1
    crowd.edit_heights(0, 0, np.full((65, 65), 0.5))
    crowd.step(60)
    assert (crowd.terrain().heights == 0.5).all()
    assert crowd.positions()[:, 1] == pytest.approx(np.full(20, 0.5), abs=0.1)
    with pytest.raises(skitter.InputError):
        crowd.edit_heights(64, 0, np.zeros((2, 2)))
    with pytest.raises(skitter.InputError, match="heights have shape"):
        crowd.edit_heights(0, 0, np.zeros(3))


def test_who_stands_sleeps(device):
    scene = skitter.Scene.parse({"herds": [{"agents": 10, "goal": {"kind": "none"}}]})
    crowd = skitter.Crowd(device, scene, sleep=True)
    assert crowd.sleeping() == 0
    crowd.step(600)
    assert crowd.sleeping() == 10


def test_who_is_far_from_the_camera_ticks_less_often(device):
    scene = skitter.Scene.parse({"herds": [{"agents": 16}]})
    assert skitter.Crowd(device, scene).levels() == []
    usual = skitter.Levels.load()
    assert usual.distances == [20, 60, 180] and usual.most == skitter.Levels().most == [1000, 9000, 90000]
    with pytest.raises(skitter.InputError, match="none.json"):
        skitter.Levels.load("none.json")
    with pytest.raises(skitter.InputError, match="distances"):
        skitter.Crowd(device, scene, levels=skitter.Levels(distances=(20, 10, 180)))
    crowd = skitter.Crowd(device, scene, levels=skitter.Levels(distances=(5, 10, 20)))
    crowd.step(8)
    assert [level.rate for level in crowd.levels()] == [1, 2, 4, 8]
    assert crowd.levels()[0].agentTicks == 8 * 16
    with pytest.raises(skitter.InputError):
        crowd.look_from((float("nan"), 0, 0))
    crowd.look_from((0, 500, 0))
    crowd.step(800)
    slow = crowd.levels()[3]
    assert slow.agents == 16 and slow.agentTicks >= 16 * 90 and 0 <= slow.slip < 0.05


def test_a_picture_is_an_array(device, scene):
    crowd = skitter.Crowd(device, scene)
    crowd.step(10)
    picture = crowd.render(160, 90)
    assert picture.shape == (90, 160, 4) and picture.dtype == np.uint8 and picture[..., :3].std() > 5
    assert np.array_equal(picture, crowd.render(160, 90))
    x, y, z = crowd.positions()[0]
    view = skitter.View((x, y + 3, z - 3), (x, y, z), 0.9)
    other = crowd.render(160, 90, view)
    assert not np.array_equal(picture, other)
    assert view.target == pytest.approx((x, y, z)) and view.fieldOfView == pytest.approx(0.9) and len(view.eye) == 3
    assert crowd.render(80, 60).shape == (60, 80, 4)
    assert not np.array_equal(picture, crowd.render(160, 90, detail=100000))
    assert np.array_equal(picture, crowd.render(160, 90))
    with pytest.raises(skitter.InputError, match="detail is 0.1, expected 0.25 to 100000"):
        crowd.render(160, 90, detail=0.1)
    assert np.array_equal(picture, crowd.render(160, 90, footprints=True))  # nobody has left one yet
    assert np.array_equal(picture, crowd.render(160, 90, occlusion=True))
    enlarged = crowd.render(160, 90, scale=0.5)
    assert enlarged.shape == picture.shape and 0 < np.abs(enlarged - picture.astype(float))[..., :3].mean() < 12
    with pytest.raises(skitter.InputError, match="scale is 1.01, expected 0.25 to 1"):
        crowd.render(160, 90, scale=1.01)
    with pytest.raises(skitter.InputError):
        crowd.render(0, 10)
    with pytest.raises(skitter.InputError):
        skitter.Crowd(device, scene, pose=False).render(16, 16)


def test_an_image_that_cannot_be_decoded_is_a_warning(device, tmp_path):
    assets = pathlib.Path(__file__).parent.parent.parent / "assets"
    model = bytearray((assets / "piebald.glb").read_bytes())
    model[model.index(b"IDAT") + 40] ^= 1
    (tmp_path / "piebald.glb").write_bytes(model)
    (tmp_path / "piebald.rig.json").write_bytes((assets / "piebald.rig.json").read_bytes())
    scene = skitter.Scene.parse('{"herds": [{"agents": 1, "rig": "piebald.glb"}]}', folder=str(tmp_path))
    crowd = skitter.Crowd(device, scene)
    with pytest.warns(UserWarning, match=r"images\[0\]: corrupt PNG: .*drawn as a flat colour"):
        crowd.render(32, 32)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        crowd.render(32, 32)  # it was said


def test_ctrl_c_ends_a_long_step_between_two_ticks(device, scene):
    crowd = skitter.Crowd(device, scene)
    crowd.step()
    timer = threading.Timer(0.5, lambda: signal.raise_signal(signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        crowd.step(10**9)
    timer.join()
    done = crowd.tick
    assert 1 < done < 10**9
    other = skitter.Crowd(device, scene)
    other.step(done)
    assert crowd.state_hash() == other.state_hash()


def test_other_threads_run_and_take_turns(device, scene):
    crowds = [skitter.Crowd(device, scene) for _ in range(2)]
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0)

    threads = [threading.Thread(target=crowd.step, args=(100,)) for crowd in crowds]
    counter = threading.Thread(target=count)
    counter.start()
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    stop.set()
    counter.join()
    assert counted[0] > 10
    assert crowds[0].tick == 100 and crowds[0].state_hash() == crowds[1].state_hash()


def test_a_device_lives_as_long_as_its_crowd(scene):
    device = skitter.Device(validation=True)
    assert device.name and device.name in repr(device) and device.report["type"] in (
        "discrete", "integrated", "virtual", "cpu", "other")  # fmt: skip
    crowd = skitter.Crowd(device, scene)
    name = device.name
    crowd.step(3)
    crowd.render(64, 64)
    assert device.validation_messages() == []
    del device
    gc.collect()
    crowd.step(3)
    assert crowd.tick == 6
    listed = skitter.Device.list()
    assert [each["name"] for each in listed if each["chosen"]] == [name]
    with pytest.raises(skitter.DeviceError, match="no such device") as caught:
        skitter.Device("no such device")
    assert caught.value.kind == "device"
