import numpy as np
import pytest

import skitter


def velocity(x, z):
    goal = skitter.Goal()
    goal.kind, goal.velocity = "velocity", (x, z)
    return goal


def ways(crowd, ticks=60):
    """How far the four agents go along z in so many ticks."""
    before = crowd.positions()[:4, 2].copy()
    crowd.step(ticks)
    return crowd.positions()[:4, 2] - before


def test_goals_are_for_all_for_each_and_for_some(device, standing):
    crowd = skitter.Crowd(device, standing)
    crowd.steer(velocity(0, 1))
    assert (ways(crowd) > 0.3).all()
    velocities = np.zeros((6, 2))
    velocities[1] = (0, 0.5)
    crowd.steer_by(velocities)
    crowd.step(60)
    assert ways(crowd) == pytest.approx([0, 0.5, 0, 0], abs=0.1)
    ids = crowd.agent_ids()
    crowd.steer_by([[0, 1], [0, 0]], agents=ids[:2])
    crowd.step(60)
    assert ways(crowd) == pytest.approx([1, 0, 0, 0], abs=0.2)
    crowd.steer_to(crowd.positions()[2:4, [0, 2]] + (0, 5), speed=0.5, agents=ids[2:4])
    crowd.steer(velocity(0, 0), agents=int(ids[0]))
    crowd.step(60)
    assert ways(crowd) == pytest.approx([0, 0, 0.5, 0.5], abs=0.1)
    crowd.steer(velocity(0, 0))
    crowd.step(60)
    targets = crowd.positions()[:, [0, 2]]
    targets[0] += (0, 5)
    crowd.steer_to(targets)
    crowd.step(60)
    assert ways(crowd) == pytest.approx([1, 0, 0, 0], abs=0.2)


def test_speeds_are_for_all_for_each_and_for_some(device, standing):
    crowd = skitter.Crowd(device, standing)
    crowd.steer(velocity(0, 1))
    crowd.set_speed(0.25)
    crowd.step(60)
    assert ways(crowd) == pytest.approx(np.full(4, 0.25), abs=0.1)
    ids = crowd.agent_ids()
    crowd.set_speed(np.full(6, 0.5))
    crowd.set_speed(0, agents=ids[2])
    crowd.set_speed([1, 0.25], agents=ids[:2])
    crowd.step(60)
    assert ways(crowd) == pytest.approx([1, 0.25, 0, 0.5], abs=0.15)


def test_what_cannot_be_changes_nothing(device, standing):
    crowd, other = skitter.Crowd(device, standing), skitter.Crowd(device, standing)
    ids = crowd.agent_ids()
    for call, what in (
        (lambda: crowd.steer_by(np.zeros((4, 2))), "found 4 goals, expected 6, one a place"),
        (lambda: crowd.steer_to([1, 2, 3]), r"targets has shape \(3,\), expected \(agents, 2\)"),
        (lambda: crowd.steer_to(np.zeros((3, 2)), agents=ids[:2]), "3 targets, expected 2, one an agent"),
        (lambda: crowd.steer(velocity(0, 1), agents=[skitter.no_agent]), "herd 1023"),
        (lambda: crowd.steer(velocity(0, 1001)), "the length of goal.velocity is 1001 m/s"),
        (lambda: crowd.steer(velocity(0, 1), 1), "herd 1: expected one of the crowd's 1 herds"),
        (lambda: crowd.set_speed(-1), "the speed is -1 m/s, expected 0 to 1000"),
        (lambda: crowd.set_speed([1, 2]), "found 2 speeds, expected 6, one a place"),
        (lambda: crowd.set_speed([1, 2], agents=ids[:3]), r"speed has shape \(2,\), expected one number or \(3,\)"),
        (lambda: crowd.teleport(ids[:2], (1, 2)), "1 positions, expected 2, one an agent"),
        (lambda: crowd.teleport(ids[0], (100, 0)), "x is 100 m, expected -16 to 16"),
        (lambda: crowd.agent_id(4), "herd 0, agent 4"),
        (lambda: crowd.remove(skitter.no_agent), "herd 1023"),
        (lambda: crowd.add_herd(skitter.Herd(2**24)), "expected at most"),
        (lambda: crowd.remove_herd((1, 0)), "herd 1 of generation 0"),
        (lambda: crowd.pick((0, 0, 0), (0, 0, 0)), r"direction is \(0, 0, 0\)"),
        (lambda: crowd.pick((0, 0, 0), (0, 1, 0), -1), "length is -1"),
        (lambda: crowd.nearest((0, np.inf, 0)), "point is"),
    ):
        with pytest.raises(skitter.InputError, match=what):
            call()
    crowd.step(2)
    other.step(2)
    assert crowd.state_hash() == other.state_hash()


# Four who find their way, and one who stands; a wall over the whole ground is north of them.
WALLED = {
    "terrain": {"columns": 65, "rows": 65, "amplitude": 0},
    "obstacles": [{"capsule": {"from": [-40, 6], "to": [40, 6], "radius": 0.3}}],
    "herds": [
        {"agents": 4, "ways": {}, "spawn": {"kind": "grid"}, "goal": {"kind": "point", "target": [0, 10]}},
        {"agents": 1, "spawn": {"kind": "grid", "centre": [6, -2]}, "goal": {"kind": "none"}},
    ],
}


def series(kind, **members):
    goal = skitter.Goal()
    goal.kind, goal.speed = kind, 2
    for name, value in members.items():
        setattr(goal, name, value)
    return goal


def farthest(crowd, place):
    """How far the farthest of herd 0 is from a place."""
    return np.linalg.norm(crowd.positions()[:, [0, 2]] - place, axis=1).max()


def test_goals_in_series_are_set_while_the_crowd_runs(device):
    crowd = skitter.Crowd(device, skitter.Scene.parse(WALLED))
    crowd.step()
    crowd.steer(series("route", places=[(0, 4), (-5, 3)]))
    crowd.step(600)
    assert farthest(crowd, (-5, 3)) < 1
    # In a loop nobody stands.
    crowd.steer(series("route", places=[(0, 4), (-5, 3)], loop=True))
    crowd.step(60)
    before = crowd.positions()
    crowd.step(30)
    assert (np.linalg.norm(crowd.positions() - before, axis=1) > 0.2).sum() >= 2
    crowd.steer(series("roam", target=(3, -4), radius=3))
    crowd.step(600)
    assert farthest(crowd, (3, -4)) < 3 + 2
    for agent in (None, 0):
        crowd.steer(series("follow", herd=1, agent=agent))
        crowd.step(900)
        assert farthest(crowd, (6, -2)) < 1.5
        crowd.steer(series("point", target=(-5, 3)))
        crowd.step(900)
        assert farthest(crowd, (-5, 3)) < 1
    # Some of them have one of their own.
    ids = crowd.agent_ids()
    crowd.steer(series("flee"), agents=ids[:2])
    crowd.set_threat(0, (-5, 3), 2)
    crowd.step(300)
    assert np.linalg.norm(crowd.positions()[:2, [0, 2]] - (-5, 3), axis=1).min() > 2
    crowd.steer(series("follow", herd=1), agents=ids[2:])
    crowd.step(900)
    assert np.linalg.norm(crowd.positions()[2:4, [0, 2]] - (6, -2), axis=1).max() < 1.5


def test_goals_in_series_that_cannot_be_are_refused(device):
    crowd = skitter.Crowd(device, skitter.Scene.parse(WALLED))
    for goal, what in (
        (series("route"), "goal.places are 0, expected 1 to 16"),
        (series("route", places=[(0, 0)] * 17), "goal.places are 17, expected 1 to 16"),
        (series("roam", radius=0), "goal.radius is 0 m, expected 0.01 to 4096"),
        (series("follow", herd=2), "herd 2"),
        (series("follow", herd=1, agent=1), "goal.agent is 1, expected less than 1, the places of herd 1"),
    ):
        with pytest.raises(skitter.InputError, match=what):
            crowd.steer(goal)
    with pytest.raises(skitter.InputError, match="expected a herd with ways"):
        crowd.steer(series("flee"), herd=1)


def test_who_cannot_reach_a_goal_is_counted(device):
    crowd = skitter.Crowd(device, skitter.Scene.parse(WALLED))
    assert (crowd.cannot_reach(), crowd.cannot_reach(1)) == (4, 0)
    crowd.steer_to([[0, -8]] * 4)
    crowd.step()
    assert crowd.cannot_reach() == 0
    with pytest.raises(skitter.InputError, match="herd 2: expected one of the crowd's 2 herds"):
        crowd.cannot_reach(2)


def test_goals_that_are_no_number_are_refused(device):
    crowd = skitter.Crowd(device, skitter.Scene.parse(WALLED))
    crowd.step()
    before = crowd.state_hash()
    nan = float("nan")
    targets = np.zeros((4, 2))
    targets[2, 1] = nan
    with pytest.raises(skitter.InputError, match="herd 0, agent 2: goal.target z is nan m, expected -4096 to 4096"):
        crowd.steer_to(targets)
    with pytest.raises(skitter.InputError, match="the length of goal.velocity is nan m/s"):
        crowd.steer_by(targets)
    for kind, member, value, what in (
        ("cross", "speed", nan, "goal.speed is nan m/s"),
        ("point", "target", (nan, 0), "goal.target x is nan m"),
        ("route", "places", [(0, 1), (0, nan)], "a goal.places z is nan m"),
        ("roam", "radius", nan, "goal.radius is nan m, expected 0.01 to 4096"),
        ("follow", "speed", nan, "goal.speed is nan m/s"),
        ("flee", "speed", nan, "goal.speed is nan m/s"),
    ):
        wrong = skitter.Goal()
        wrong.kind = kind
        setattr(wrong, member, value)
        with pytest.raises(skitter.InputError, match=what):
            crowd.steer(wrong)
        scene = skitter.Scene.parse(WALLED)
        scene.herds[0].goal = wrong
        with pytest.raises(skitter.InputError, match=what):
            skitter.Crowd(device, scene)
    assert crowd.state_hash() == before


def test_agents_are_put_elsewhere(device, standing):
    crowd = skitter.Crowd(device, standing)
    crowd.teleport(crowd.agent_id(2), (3, -4), 1)
    crowd.teleport(crowd.agent_ids()[:2], [[-5, 5], [5, 5]], [0.5, -0.5])
    crowd.step()
    assert crowd.positions()[:3, [0, 2]] == pytest.approx(np.array([[-5, 5], [5, 5], [3, -4]]), abs=0.05)
    assert crowd.headings()[:3] == pytest.approx([0.5, -0.5, 1], abs=0.1)
    turned = crowd.rotations()[2]
    assert turned * np.sign(turned[3]) == pytest.approx([0, np.sin(0.5), 0, np.cos(0.5)], abs=0.05)


def test_agents_come_and_go(device, standing):
    crowd = skitter.Crowd(device, standing)
    ids = crowd.agent_ids()
    assert (crowd.agents(), crowd.places(), crowd.agent_count) == (4, 6, 4)
    assert (ids == skitter.no_agent).tolist() == [False] * 4 + [True] * 2 and crowd.agent_id(3) == ids[3]
    first = crowd.add((5, -5), 1)
    second = crowd.add((-5, -5), goal=velocity(0, 1))
    with pytest.raises(skitter.InputError, match="all of its 6 places are taken"):
        crowd.add((0, 0))
    crowd.step(60)
    assert crowd.agents() == 6 and crowd.agent_ids()[4:].tolist() == [first, second]
    assert crowd.positions()[4, [0, 2]] == pytest.approx((5, -5), abs=0.1)
    assert crowd.positions()[5, 2] > -4.7
    crowd.remove(first)
    assert not crowd.has(first) and crowd.has(second)
    with pytest.raises(skitter.InputError, match="nobody"):
        crowd.remove(first)
    crowd.step()
    assert crowd.positions()[4, 1] < -9e5 and crowd.agent_ids()[4] == skitter.no_agent
    again = crowd.add((5, -5))
    assert again != first and crowd.has(again) and not crowd.has(first)


def test_legs_are_hurt_and_heal(device, standing):
    standing.herds[0].hurt = True
    standing.herds[0].goal = velocity(0, 1)
    crowd = skitter.Crowd(device, standing, feet=True)
    ids = crowd.agent_ids()[:4]
    crowd.hurt(ids[0], "R2")
    crowd.hurt(ids[1:3], 4, "stuck")
    crowd.hurt(ids[3], leg="L1", state="lost", bone=3)
    assert crowd.leg_state(ids[0], "R2") == "lost" and crowd.leg_state(ids[0], "L2") == "whole"
    assert [crowd.leg_state(agent, "L3") for agent in ids] == ["whole", "stuck", "stuck", "whole"]
    began = crowd.positions()[:4, 2].copy()
    crowd.step(120)
    lost, stuck = crowd.records()["hurt"][:4, :2].T
    assert lost.tolist() == [8, 0, 0, 1] and stuck.tolist() == [0, 16, 16, 0]
    assert (crowd.positions()[:4, 2] > began + 1).all()
    crowd.heal(ids[1:])
    assert crowd.leg_state(ids[1], 4) == "whole" and crowd.leg_state(ids[0], 3) == "lost"
    crowd.step()

    before = crowd.state_hash()
    for spoil, what in (
        (lambda: crowd.hurt(ids[0], "R9"), r'has no leg "R9"'),
        (lambda: crowd.hurt(ids[0], 8), "leg is 8, expected less than 8"),
        (lambda: crowd.hurt(ids[0], "R2", "broken"), 'state is "broken", expected one of whole, lame, stuck, lost'),
        (lambda: crowd.hurt(ids[0], "R2", bone=4), "bone is 4, expected less than 4"),
        (lambda: crowd.hurt(skitter.no_agent, 0), "herd"),
        (lambda: crowd.leg_state(ids[0], "R9"), "has no leg"),
    ):
        with pytest.raises(skitter.InputError, match=what):
            spoil()
    assert crowd.state_hash() == before
    standing.herds[0].hurt = False
    whole = skitter.Crowd(device, standing)
    with pytest.raises(skitter.InputError, match="hurt is false, expected a herd whose legs can be hurt"):
        whole.hurt(whole.agent_id(0), "R2")


def test_agents_try_gaits(device, standing):
    standing.herds[0].hurt = standing.herds[0].adapts = True
    standing.herds[0].goal = velocity(0, 1)
    crowd = skitter.Crowd(device, standing)
    crowd.hurt(crowd.agent_id(1), "R2")
    crowd.step(260)
    at_ease, searches = crowd.searches()[:2]
    assert at_ease == {"phase": "at ease", "trials": 0, "best": 0}
    assert searches["phase"] in ("searching", "settled") and searches["trials"] == 1 and 0.5 < searches["best"] <= 1
    with pytest.raises(skitter.InputError, match="adapts is true, expected false where agents carry"):
        crowd.carry(crowd.agent_id(0), skitter.Load(1))


def test_agents_carry_loads(device, standing):
    standing.herds[0].hurt = True
    crowd = skitter.Crowd(device, standing)
    ids = crowd.agent_ids()[:3]
    crowd.carry(ids[0], skitter.Load(0.5, (0, 0.25, -1)))
    crowd.carry(ids[1:], skitter.Load(2))
    crowd.carry(ids[2], skitter.Load())
    crowd.step()
    assert [crowd.carried(agent).mass for agent in ids] == [0.5, 2, 0]
    assert tuple(crowd.carried(ids[0]).offset) == (0, 0.25, -1)
    assert crowd.records()["carried"][0].tolist() == [0, 0.25, -1, 0.5]
    with pytest.raises(skitter.InputError, match="load.mass is 5"):
        crowd.carry(ids[0], skitter.Load(5))
    standing.herds[0].hurt = False
    free = skitter.Crowd(device, standing)
    with pytest.raises(skitter.InputError, match="hurt is false, expected true where agents carry"):
        free.carry(free.agent_id(0), skitter.Load(1))


def test_herds_come_and_go(device, standing):
    crowd = skitter.Crowd(device, standing)
    crowd.step()
    picture = crowd.render(64, 36)
    herd = skitter.Herd(3)
    herd.controller = "loop"
    added = crowd.add_herd(herd)
    assert added == (1, 0) == crowd.herd_id(1) and crowd.has_herd(added) and crowd.has_herd(crowd.herd_id(0))
    crowd.step()
    assert (crowd.herd_count, crowd.agent_count) == (2, 7) and crowd.positions(1).shape == (3, 3)
    assert crowd.render(64, 36).shape == picture.shape
    crowd.remove_herd(added)
    assert not crowd.has_herd(added) and crowd.places(1) == 0
    crowd.step()
    assert crowd.render(64, 36).shape == picture.shape
    assert crowd.add_herd(skitter.Herd(1)) == (1, 2)


def test_an_agent_is_picked_by_a_ray_or_by_a_point(device, standing):
    crowd = skitter.Crowd(device, standing)
    crowd.step()
    x, y, z = crowd.positions()[2]
    picked = crowd.pick((x, y + 10, z), (0, -1, 0))
    assert (picked.herd, picked.agent) == (0, 2) and 5 < picked.distance < 10
    assert picked.place == pytest.approx((x, y + 10 - picked.distance, z))
    assert crowd.pick((x, y + 10, z), (0, -1, 0), 1) is None
    near = crowd.nearest((x, y + 10, z))
    assert near.agent == 2 and 9 < near.distance < 10
