import pytest

import skitter

SCENE = {
    "terrain": {"kind": "noise", "columns": 65, "rows": 65},
    "herds": [{"agents": 20}, {"agents": 3, "controller": "loop"}],
}


# Four who stand and look along +z, in the middle of ground that is flat.
STANDING = {
    "terrain": {"columns": 65, "rows": 65, "amplitude": 0},
    "herds": [{"agents": 4, "reserve": 2, "spawn": {"kind": "grid"}, "goal": {"kind": "none"}}],
}


@pytest.fixture(scope="session")
def device():
    return skitter.Device()


@pytest.fixture
def scene():
    return skitter.Scene.parse(SCENE)


@pytest.fixture
def standing():
    return skitter.Scene.parse(STANDING)
