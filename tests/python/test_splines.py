import numpy as np
import pytest

import skitter

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], float)


def test_a_spline_meets_its_points():
    spline = skitter.Spline(CORNERS, knots=[0, 1, 2, 4])
    assert (spline.begin, spline.end, spline.closed) == (0, 4, False)
    assert spline.position([0, 1, 2, 4]) == pytest.approx(CORNERS, abs=1e-6)
    assert spline.position(1).shape == (3,) and spline.position(np.zeros((2, 5))).shape == (2, 5, 3)
    step = 1e-4
    assert (spline.position(0.5 + step) - spline.position(0.5 - step)) / (2 * step) == pytest.approx(
        spline.velocity(0.5), abs=1e-2)  # fmt: skip
    assert spline.acceleration([0.5]).shape == (1, 3)
    assert spline.length > 3 and spline.length_at(4) == pytest.approx(spline.length)
    times = np.array([0.3, 1.7, 3.9])
    assert spline.time_at_length(spline.length_at(times)) == pytest.approx(times)


def test_rules_and_closed_splines():
    assert "kochanekBartels" in skitter.spline_rules
    ring = skitter.Spline(CORNERS, closed=True)
    assert ring.closed and ring.end == 4 and ring.position(4.5) == pytest.approx(ring.position(0.5))
    rests = skitter.Spline(CORNERS, rule="zero")
    assert np.abs(rests.velocity([0, 1, 2])).max() == 0
    straight = skitter.Spline([[0, 0, 0], [1, 0, 0]], rule="given", arriving=[[1, 0, 0], [1, 0, 0]])
    assert straight.position(0.25) == pytest.approx((0.25, 0, 0))
    tense = skitter.Spline(CORNERS, rule="kochanekBartels", tension=1, continuity=0, bias=0)
    assert np.abs(tense.velocity([1])).max() == 0
    with pytest.raises(skitter.InputError, match='rule is "magic"'):
        skitter.Spline(CORNERS, rule="magic")
    with pytest.raises(skitter.InputError):
        skitter.Spline(CORNERS[:1])


def test_a_batch_travels_as_one_spline_does(device):
    points = np.stack([CORNERS, 2 * CORNERS])
    batch = skitter.SplineBatch(device, points, constant_speed=True)
    batch.set_clocks([0, 1], 2)
    motions = batch.travel(1)
    assert batch.splines == 2 and motions.dtype.names == ("position", "velocity", "travelled", "state")
    assert [skitter.spline_states[state] for state in motions["state"]] == ["moving", "moving"]
    spline = skitter.Spline(CORNERS)
    halfway = spline.position(spline.time_at_length(spline.length / 2))
    assert motions["position"][0] == pytest.approx(halfway, abs=1e-3)
    assert motions["position"][1] == pytest.approx((0, 0, 0), abs=1e-3)
    assert batch.lengths() == pytest.approx([spline.length, 2 * spline.length], rel=1e-3)
    given = skitter.SplineBatch(device, CORNERS[None], rule="given", arriving=np.ones((1, 4, 3)))
    assert given.lengths().shape == (1,)
    with pytest.raises(skitter.InputError, match=r"points have shape \(4, 3\)"):
        skitter.SplineBatch(device, CORNERS)
    with pytest.raises(skitter.InputError, match="start has shape"):
        batch.set_clocks([0, 1, 2], 1)
