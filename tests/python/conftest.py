import pytest

import skitter

SCENE = {
    "terrain": {"kind": "noise", "columns": 65, "rows": 65},
    "herds": [{"agents": 20}, {"agents": 3, "controller": "loop"}],
}


@pytest.fixture(scope="session")
def device():
    return skitter.Device()


@pytest.fixture
def scene():
    return skitter.Scene.parse(SCENE)
