import io

import numpy as np
import pytest

import skitter


def walked(device, scene, ticks=20, **options):
    crowd = skitter.Crowd(device, scene, **options)
    crowd.step(ticks)
    return crowd


def test_a_crowd_goes_on_from_a_file_as_if_it_had_never_stopped(device, scene, tmp_path):
    crowd = walked(device, scene)
    crowd.steer_by(np.tile([1.0, 0.0], (20, 1)))
    crowd.save(tmp_path / "walk.state", {"level": 3, "names": ["\u00fc"]})
    state = skitter.State.load(tmp_path / "walk.state")
    assert (state.tick, state.dt) == (20, pytest.approx(1 / 60)) and "tick 20" in repr(state)
    assert state.note == {"level": 3, "names": ["\u00fc"]}
    assert [herd.agents for herd in state.scene.herds] == [20, 3] and state.terrain.heights.shape == (65, 65)
    again = skitter.Crowd.resume(device, state)
    assert again.tick == 20 and again.state_hash() == crowd.state_hash()
    for each in (crowd, again):
        each.step(20)
    assert again.state_hash() == crowd.state_hash() and again.fidelity() == crowd.fidelity()
    assert np.array_equal(again.render(64, 36), crowd.render(64, 36))
    plain = walked(device, scene, 40)
    assert plain.state_hash() != crowd.state_hash()  # what waited for the next tick is in the state


def test_a_state_in_memory_is_an_array(device, scene):
    crowd = walked(device, scene)
    data = crowd.save_to_memory()
    assert data.dtype == np.uint8 and data.ndim == 1 and bytes(data[:7]) == b"skitter"
    file = io.BytesIO()
    np.save(file, data)
    file.seek(0)
    for kept in (data, bytes(data), memoryview(data), np.load(file)):
        state = skitter.State.parse(kept)
        assert state.note is None and state.tick == 20
        assert skitter.Crowd.resume(device, state).state_hash() == crowd.state_hash()
    state = skitter.State.parse(data)
    data[:] = 0
    assert skitter.Crowd.resume(device, state).state_hash() == crowd.state_hash()


def test_options_are_those_that_were_saved_or_others(device, scene):
    crowd = walked(device, scene, footfalls=1000)
    state = skitter.State.parse(crowd.save_to_memory())
    again = skitter.Crowd.resume(device, state)
    seen = 0
    for _ in range(30):
        again.step()
        seen += len(again.footfalls())
    assert seen > 0 and again.joints().shape == (20, 8, 5, 3)
    other = skitter.Crowd.resume(device, state, pose=False, footfalls=0, feet=True, timestamps=True, page_agents=7)
    other.step(30)
    assert other.state_hash() == again.state_hash() and len(other.footfalls()) == 0
    assert other.stage_times() and "tip" in other.records()
    with pytest.raises(skitter.InputError, match="made with poses"):
        other.joints()


def test_the_ground_is_in_the_state_as_edited(device, scene):
    crowd = walked(device, scene)
    crowd.edit_heights(3, 4, np.full((2, 2), 0.25))
    crowd.step()
    state = skitter.State.parse(crowd.save_to_memory())
    assert (state.terrain.heights[4:6, 3:5] == 0.25).all()
    assert np.array_equal(skitter.Crowd.resume(device, state).terrain().heights, crowd.terrain().heights)


def test_what_is_no_state_is_refused(device, scene, tmp_path):
    crowd = walked(device, scene, 1)
    data = crowd.save_to_memory()
    data[-1000] ^= 1
    with pytest.raises(skitter.InputError, match="is damaged: the checksum differs"):
        skitter.Crowd.resume(device, skitter.State.parse(data))
    for call, what in (
        (lambda: skitter.State.parse(data[:-1], "walk"), "walk: has .* it is not whole"),
        (lambda: skitter.State.parse(b"skitter"), "is no state of a crowd"),
        (lambda: skitter.State.parse(data[::2]), "not contiguous"),
        (lambda: skitter.State.load(tmp_path / "no.state"), "no.state"),
        (lambda: crowd.save(tmp_path / "no" / "walk.state"), "walk.state"),
        (lambda: crowd.save_to_memory(float("nan")), "the note of a state is not JSON"),
    ):
        with pytest.raises(skitter.InputError, match=what):
            call()
    with pytest.raises(TypeError):
        crowd.save_to_memory(object())
