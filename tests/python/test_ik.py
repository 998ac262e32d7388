import numpy as np
import pytest

import skitter
from skitter import ik


def arm(**first):
    return ik.Chain([ik.Bone(1, (1, 0, 0), **first), ik.Bone(1, (1, 0, 0)), ik.Bone(1, (1, 0, 0))])


def test_tips_reach_their_targets(device):
    chain = arm()
    assert chain.reach == 3 and chain.rest().tolist() == [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]
    batch = ik.Batch(device, chain, 100)
    targets = np.random.default_rng(1).uniform(-1, 1, (100, 3))
    joints = batch.solve(targets)
    assert joints.shape == (100, 4, 3)
    assert joints[:, 3] == pytest.approx(targets, abs=3e-3)
    assert np.linalg.norm(np.diff(joints, axis=1), axis=2) == pytest.approx(np.ones((100, 3)), abs=1e-4)
    reports = batch.reports()
    assert (reports["error"] < 1e-3).all() and {ik.stop_names[s] for s in reports["stop"]} == {"tolerance"}
    assert (reports["iterations"] <= batch.iterations).all()
    assert batch.chains == 100 and batch.solver in ik.solvers
    batch.set_targets(targets[::-1].copy())
    assert batch.solve() == pytest.approx(batch.joints())
    assert batch.joints()[::-1, 3] == pytest.approx(targets, abs=3e-3)


@pytest.mark.parametrize("limit", [ik.Cone(0.5), ik.Ellipse(0.5, 0.4, 0.5, 0.4), ik.Hinge((0, 0, 1), -0.5, 0.5)])
def test_limits_hold(device, limit):
    bones = ik.Batch(device, arm(limit=limit), 1).solve([[0, 2, 0]])
    first = bones[0, 1] / np.linalg.norm(bones[0, 1])
    assert np.arccos(first[0]) <= 0.5 + 1e-3


def test_bases_and_rotations_are_the_worlds(device):
    batch = ik.Batch(device, arm(), 2, bases=True, rotations=True, solver="fabrik", start="previous")
    quarter = [0, 0, np.sqrt(0.5), np.sqrt(0.5)]
    batch.set_bases([[10, 0, 0], [0, 10, 0]], [[0, 0, 0, 1], quarter])
    batch.reset()
    joints = batch.solve([[12, 1, 0], [0, 12, 1]])
    assert joints[:, 3] == pytest.approx(np.array([[12, 1, 0], [0, 12, 1]]), abs=1e-2)
    rotations = batch.rotations()
    assert rotations.shape == (2, 3, 4)
    assert np.linalg.norm(rotations, axis=2) == pytest.approx(np.ones((2, 3)), abs=1e-4)


def test_a_straight_chain_is_not_rotated(device):
    batch = ik.Batch(device, arm(), 1, rotations=True)
    batch.solve([[3, 0, 0]])
    assert batch.rotations()[0] == pytest.approx(np.tile([0, 0, 0, 1], (3, 1)), abs=0.1)


def test_what_cannot_be_is_refused(device):
    batch = ik.Batch(device, arm(), 2)
    for call, what in (
        (lambda: ik.Chain([]), "bone"),
        (lambda: ik.Chain([ik.Bone(-1)]), "length"),
        (lambda: ik.Batch(device, arm(), 1, solver="magic"), 'solver is "magic", expected one of auto'),
        (lambda: ik.Batch(device, arm(), 1, start="here"), 'start is "here"'),
        (lambda: batch.solve(np.zeros((3, 3))), "3 targets, expected 2"),
        (lambda: batch.solve(np.zeros((2, 2))), r"targets has shape \(2, 2\), expected \(..., 3\)"),
    ):
        with pytest.raises(skitter.InputError, match=what):
            call()
    bone = ik.Bone(2, limit=ik.Cone(1), twist=(-1, 1), stiffness=2)
    assert (bone.length, bone.direction, bone.stiffness) == (2, (0, 1, 0), 2)
    assert ik.Chain([bone], pole=(0, 0, 1)).bones[0].length == 2
