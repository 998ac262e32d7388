"""Crowds of legged creatures on uneven ground, animated by Vulkan compute shaders.

Lengths are metres, times seconds and angles radians, where nothing else is said. The world is right-handed
and +Y is up; an unturned creature faces +Z. Keys of scene files and files of figures keep their names, but
for those of events and cuts.
"""

import os
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

__version__: str
no_agent: int
spline_rules: Tuple[str, ...]
spline_states: Tuple[str, ...]

_Path = Union[str, "os.PathLike[str]"]
_Floats = npt.ArrayLike
_Float32s = npt.NDArray[np.float32]
_Float64s = npt.NDArray[np.float64]
_Agents = Union[int, Sequence[int], npt.NDArray[np.uint64]]

class Error(RuntimeError):
    """Wrong input or a failing world, in one line."""

    kind: str

class InputError(Error, ValueError):
    """A wrong argument, or an unreadable or malformed file."""

class DeviceError(Error):
    """No usable Vulkan device, not enough of its memory, or it failed."""

class Device:
    """A Vulkan device, which lives as long as anything that was made on it."""

    def __init__(self, name: Optional[str] = None, *, validation: bool = False) -> None: ...
    @staticmethod
    def list() -> List[Dict[str, Any]]: ...
    @property
    def name(self) -> str: ...
    @property
    def report(self) -> Dict[str, Any]: ...
    def validation_messages(self) -> List[str]: ...

class Tuning:
    """The numbers that a herd's walk depends on, in units that do not depend on its size."""

    def __init__(self, **values: float) -> None: ...
    @staticmethod
    def info() -> Dict[str, Dict[str, Any]]: ...
    def to_dict(self) -> Dict[str, float]: ...
    def __eq__(self, other: object) -> bool: ...
    edgeMargin: float
    slowRadius: float
    acceleration: float
    braking: float
    turnRate: float
    turnAcceleration: float
    turnGain: float
    stretchSlow: float
    stretchStop: float
    errorStop: float
    followLeast: float
    heightTime: float
    tiltTime: float
    maxSlope: float
    bellyClearance: float
    leanGain: float
    leanMost: float
    leanLevel: float
    breathHeight: float
    halfStrideStill: float
    halfStrideMax: float
    dutyStill: float
    dutyGain: float
    dutyLeast: float
    lagShare: float
    swingStill: float
    swingSpeed: float
    cycleMax: float
    windowSlack: float
    windowOpen: float
    liftShare: float
    stretchLift: float
    strayShare: float
    errorLift: float
    rootShare: float
    settleTime: float
    sleepTime: float
    reaimDistance: float
    reaimLatest: float
    groundTolerance: float
    reachMost: float
    reachLeast: float
    reachComfort: float
    slopeLeast: float
    slopeWeight: float
    reachWeight: float
    stepHeight: float
    stepClearance: float
    stepHeightMax: float
    routeWidth: float
    restPull: float
    fadeTime: float
    clipIdle: float
    clipHysteresis: float
    clipRateMost: float
    plantStray: float
    plantTime: float
    poseWalk: float
    springFrequency: float
    springDamping: float
    fallTime: float
    riseTime: float
    lieTime: float
    slideFriction: float

class Spawn:
    """Where the agents of a herd start."""

    kind: str
    spacing: float
    centre: Sequence[float]
    heading: float
    def __init__(self) -> None: ...

class Goal:
    """Where the agents of a herd go."""

    kind: str
    target: Sequence[float]
    velocity: Sequence[float]
    speed: float
    places: Sequence[Sequence[float]]
    loop: bool
    radius: float
    herd: int
    agent: Optional[int]
    def __init__(self) -> None: ...

class ClipCut:
    """A part of a clip under a name of its own."""

    clip: str
    name: str
    start: float
    end: float
    def __init__(self) -> None: ...

class Ways:
    """What ground is to a herd that finds its way (docs/ways.md)."""

    climb: float
    steepest: float
    step: float
    def __init__(self) -> None: ...

class Disc:
    """A disc on the ground."""

    centre: Sequence[float]
    radius: float
    def __init__(self) -> None: ...

class FoodSource:
    """Food that a herd forages for."""

    centre: Sequence[float]
    radius: float
    amount: int
    def __init__(self) -> None: ...

class Load:
    """What an agent carries."""

    mass: float
    offset: Sequence[float]
    def __init__(self, mass: float = 0, offset: Sequence[float] = (0, 0, 0)) -> None: ...

class Forage:
    """How the agents of a herd forage (docs/foraging.md)."""

    nest: Disc
    food: Sequence[FoodSource]
    branches: Sequence[Disc]
    cell: float
    threshold: float
    power: int
    layHome: float
    layOut: float
    life: float
    patience: int
    rest: float
    load: Load
    def __init__(self) -> None: ...

class Herd:
    """Agents with one rig, controller and spawn."""

    rig: str
    controller: str
    clips: Sequence[str]
    cuts: Sequence[ClipCut]
    keys: int
    solver: str
    stepping: str
    tuning: Tuning
    agents: int
    reserve: int
    spawn: Spawn
    goal: Goal
    sizes: Sequence[float]
    avoid: bool
    ways: Optional[Ways]
    threat: float
    forage: Optional[Forage]
    phase: Optional[float]
    colour: Optional[Sequence[float]]
    tint: Optional[float]
    hurt: bool
    reactions: bool
    adapts: bool
    def __init__(self, agents: int = 1000) -> None: ...

class TerrainNoise:
    """Rolling ground, the same for the same numbers."""

    columns: int
    rows: int
    spacing: float
    amplitude: float
    wavelength: float
    octaves: int
    gain: float
    seed: int
    def __init__(self) -> None: ...

class TerrainFile:
    """Ground out of a file."""

    file: _Path
    spacingX: Optional[float]
    spacingZ: Optional[float]
    minHeight: Optional[float]
    maxHeight: Optional[float]
    scale: Optional[float]
    exaggeration: Optional[float]
    columns: Optional[int]
    rows: Optional[int]
    voidValue: Optional[float]
    def __init__(self, file: _Path) -> None: ...

class Heightfield:
    """Ground y = h(x, z), bilinear between samples, its middle at the origin."""

    def __init__(
        self, heights: _Floats, spacing: Tuple[float, float] = (0.5, 0.5), name: str = "array"
    ) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def spacing(self) -> Tuple[float, float]: ...
    @property
    def extent(self) -> Tuple[float, float]: ...
    @property
    def heights(self) -> _Float32s: ...
    def at(self, x: _Floats, z: _Floats) -> Any: ...

class Leg:
    """A limb, from its root to its foot, at rest in model space."""

    @property
    def name(self) -> str: ...
    @property
    def group(self) -> int: ...
    @property
    def home(self) -> Tuple[float, float, float]: ...
    @property
    def reach(self) -> float: ...
    @property
    def lengths(self) -> List[float]: ...

class Rig:
    """A model's legs and their limits."""

    @staticmethod
    def load(file: _Path) -> Rig: ...
    @staticmethod
    def spider() -> Rig: ...
    @property
    def name(self) -> str: ...
    @property
    def legs(self) -> Tuple[Leg, ...]: ...
    @property
    def legLength(self) -> float: ...
    @property
    def bodyHeight(self) -> float: ...
    @property
    def bodyRadius(self) -> float: ...

class CameraKey:
    """Where a camera on a path is at a time."""

    time: float
    position: Sequence[float]
    target: Sequence[float]
    def __init__(self, time: float, position: Sequence[float], target: Sequence[float]) -> None: ...

class Camera:
    """Where pictures are taken from."""

    kind: str
    position: Sequence[float]
    target: Sequence[float]
    distance: float
    fieldOfView: float
    about: Optional[Sequence[float]]
    elevation: float
    azimuth: float
    secondsATurn: float
    keys: Sequence[CameraKey]
    def __init__(self) -> None: ...

class Light:
    """What lights pictures."""

    sky: str
    sun: Optional[Sequence[float]]
    exposure: float
    fog: Optional[float]
    def __init__(self) -> None: ...

class Mound:
    """Ground that rises, or sinks to a pit, with smooth sides."""

    centre: Sequence[float]
    radius: float
    height: float
    def __init__(self, centre: Sequence[float] = (0, 0), radius: float = 1, height: float = 0.5) -> None: ...

class HeightSamples:
    """New heights of a rectangle of the ground's samples."""

    x: int
    z: int
    heights: _Floats
    def __init__(self, x: int, z: int, heights: _Floats) -> None: ...

class GoalChange:
    """A new goal."""

    herd: int
    agents: Sequence[int]
    goal: Goal
    def __init__(self, goal: Goal, herd: int = 0, agents: Sequence[int] = ()) -> None: ...

class SpeedChange:
    """A new speed; goals stay."""

    herd: int
    agents: Sequence[int]
    speed: float
    def __init__(self, speed: float, herd: int = 0, agents: Sequence[int] = ()) -> None: ...

class Move:
    """An agent that is put elsewhere."""

    agent: int
    position: Sequence[float]
    heading: float
    def __init__(self, agent: int, position: Sequence[float], heading: float = 0) -> None: ...

class Teleport:
    """Agents of a herd that are put elsewhere; goals stay."""

    herd: int
    moves: Sequence[Move]
    def __init__(self, moves: Sequence[Move], herd: int = 0) -> None: ...

class Arrival:
    """An agent that comes."""

    position: Sequence[float]
    heading: float
    goal: Optional[Goal]
    def __init__(
        self, position: Sequence[float], heading: float = 0, goal: Optional[Goal] = None
    ) -> None: ...

class Addition:
    """Agents that come, to a herd with a reserve."""

    herd: int
    arrivals: Sequence[Arrival]
    def __init__(self, arrivals: Sequence[Arrival], herd: int = 0) -> None: ...

class Removal:
    """Agents that go, from a herd with a reserve."""

    herd: int
    agents: Sequence[int]
    def __init__(self, agents: Sequence[int], herd: int = 0) -> None: ...

class LegChange:
    """A leg of some agents, of a herd that can be hurt."""

    herd: int
    leg: str
    state: str
    agents: Sequence[int]
    share: Optional[float]
    bone: Optional[int]
    def __init__(
        self,
        leg: str,
        state: str = "lost",
        herd: int = 0,
        agents: Sequence[int] = (),
        share: Optional[float] = None,
        bone: Optional[int] = None,
    ) -> None: ...

class LoadChange:
    """A load of some agents, of a herd that can be hurt."""

    herd: int
    load: Load
    agents: Sequence[int]
    share: Optional[float]
    def __init__(
        self,
        load: Load,
        herd: int = 0,
        agents: Sequence[int] = (),
        share: Optional[float] = None,
    ) -> None: ...

class Push:
    """A push of some agents, of a herd with reactions."""

    herd: int
    velocity: Sequence[float]
    agents: Sequence[int]
    share: Optional[float]
    def __init__(
        self,
        velocity: Sequence[float],
        herd: int = 0,
        agents: Sequence[int] = (),
        share: Optional[float] = None,
    ) -> None: ...

class HerdAddition:
    """A herd that comes; it gets the lowest number that is free."""

    herd: Herd
    def __init__(self, herd: Herd) -> None: ...

class HerdRemoval:
    """A herd that goes."""

    herd: int
    def __init__(self, herd: int) -> None: ...

class ThreatChange:
    """A threat that comes, moves or, with radius 0, goes."""

    number: int
    centre: Sequence[float]
    radius: float
    def __init__(self, number: int, centre: Sequence[float] = (0, 0), radius: float = 1) -> None: ...

_What = Union[
    Mound,
    HeightSamples,
    GoalChange,
    SpeedChange,
    Teleport,
    Addition,
    Removal,
    HerdAddition,
    HerdRemoval,
    ThreatChange,
    LegChange,
    LoadChange,
    Push,
]

class Event:
    """What happens to a crowd while it runs, at a time."""

    at: float
    what: _What
    def __init__(self, at: float, what: _What) -> None: ...

class Scene:
    """Terrain, herds, camera, events and seed: what a crowd is made of."""

    name: str
    seed: int
    camera: Camera
    light: Light
    herds: List[Herd]
    events: List[Event]
    terrain: Union[TerrainNoise, TerrainFile]
    def __init__(self) -> None: ...
    @staticmethod
    def builtin() -> Scene: ...
    @staticmethod
    def load(file: _Path) -> Scene: ...
    @staticmethod
    def parse(json: Union[str, Dict[str, Any]], folder: _Path = "") -> Scene: ...
    @property
    def agent_count(self) -> int: ...
    def load_terrain(self) -> Heightfield: ...
    def to_json(self) -> str: ...

class View:
    """Where a picture is taken from."""

    eye: Sequence[float]
    target: Sequence[float]
    fieldOfView: float
    def __init__(self, eye: Sequence[float], target: Sequence[float], fieldOfView: float = ...) -> None: ...

class Picked:
    """An agent under a ray or near a point."""

    @property
    def herd(self) -> int: ...
    @property
    def agent(self) -> int: ...
    @property
    def distance(self) -> float: ...
    @property
    def place(self) -> Tuple[float, float, float]: ...

class State:
    """A crowd as it was between two ticks, with all that it needs to go on."""

    @staticmethod
    def load(file: _Path) -> State: ...
    @staticmethod
    def parse(
        data: Union[bytes, bytearray, memoryview, npt.NDArray[np.uint8]], name: str = "the state"
    ) -> State: ...
    @property
    def tick(self) -> int: ...
    @property
    def dt(self) -> float: ...
    @property
    def scene(self) -> Scene: ...
    @property
    def terrain(self) -> Heightfield: ...
    @property
    def note(self) -> Any: ...

class Levels:
    """Levels of rate (docs/levels.md): who is far from the camera ticks in every second, fourth or eighth tick."""

    distances: List[float]
    most: List[int]
    def __init__(self, distances: Sequence[float] = ..., most: Sequence[int] = ...) -> None: ...
    @staticmethod
    def load(file_or_default: _Path = "default") -> Levels: ...

class LevelFigures:
    """What became of a level."""

    @property
    def rate(self) -> int: ...
    @property
    def agents(self) -> int: ...
    @property
    def agentTicks(self) -> int: ...
    @property
    def slip(self) -> Optional[float]: ...

class Crowd:
    """The herds of a scene on one terrain, living on one device. Herds and agents are numbered from 0."""

    def __init__(
        self,
        device: Device,
        scene: Scene,
        terrain: Optional[Heightfield] = None,
        *,
        pose: bool = True,
        measure: bool = True,
        watch_every: int = 0,
        feet: bool = False,
        footfalls: int = 0,
        sleep: bool = False,
        fuse: bool = True,
        timestamps: bool = False,
        page_agents: int = 0,
        levels: Optional[Levels] = None,
    ) -> None: ...
    def step(self, ticks: int = 1, dt: Optional[float] = None) -> None: ...
    @property
    def tick(self) -> int: ...
    def look_from(self, camera: Sequence[float]) -> None: ...
    def levels(self) -> List[LevelFigures]: ...
    def edit_heights(self, x: int, z: int, heights: _Floats) -> None: ...
    def terrain(self) -> Heightfield: ...
    def steer(self, goal: Goal, herd: int = 0, agents: Optional[_Agents] = None) -> None: ...
    def steer_to(
        self, targets: _Floats, speed: float = 1, herd: int = 0, agents: Optional[_Agents] = None
    ) -> None: ...
    def steer_by(self, velocities: _Floats, herd: int = 0, agents: Optional[_Agents] = None) -> None: ...
    def set_speed(self, speed: _Floats, herd: int = 0, agents: Optional[_Agents] = None) -> None: ...
    def agent_id(self, agent: int, herd: int = 0) -> int: ...
    def agent_ids(self, herd: int = 0) -> npt.NDArray[np.uint64]: ...
    def has(self, agent: int) -> bool: ...
    def push(self, agents: _Agents, velocities: _Floats) -> None: ...
    def reactions(self, herd: int = 0) -> List[Dict[str, Any]]: ...
    def searches(self, herd: int = 0) -> List[Dict[str, Any]]: ...
    def teleport(self, agents: _Agents, positions: _Floats, headings: _Floats = 0) -> None: ...
    def add(
        self, position: Sequence[float], heading: float = 0, herd: int = 0, goal: Optional[Goal] = None
    ) -> int: ...
    def remove(self, agent: int) -> None: ...
    def cannot_reach(self, herd: int = 0) -> int: ...
    def hurt(
        self, agents: _Agents, leg: Union[int, str], state: str = "lost", bone: Optional[int] = None
    ) -> None: ...
    def heal(self, agents: _Agents) -> None: ...
    def leg_state(self, agent: int, leg: Union[int, str]) -> str: ...
    def carry(self, agents: _Agents, load: Load) -> None: ...
    def carried(self, agent: int) -> Load: ...
    def set_threat(self, number: int, centre: Sequence[float] = (0, 0), radius: float = 1) -> None: ...
    def add_herd(self, herd: Herd) -> Tuple[int, int]: ...
    def remove_herd(self, herd: Tuple[int, int]) -> None: ...
    def has_herd(self, herd: Tuple[int, int]) -> bool: ...
    def herd_id(self, herd: int) -> Tuple[int, int]: ...
    def pick(
        self, start: Sequence[float], direction: Sequence[float], length: float = ...
    ) -> Optional[Picked]: ...
    def nearest(self, point: Sequence[float]) -> Optional[Picked]: ...
    @property
    def herd_count(self) -> int: ...
    @property
    def agent_count(self) -> int: ...
    def agents(self, herd: int = 0) -> int: ...
    def places(self, herd: int = 0) -> int: ...
    def rig(self, herd: int = 0, agent: Optional[int] = None) -> Rig: ...
    def sizes(self, herd: int = 0) -> _Float32s: ...
    @property
    def watch_every(self) -> int: ...
    @property
    def memory_bytes(self) -> int: ...
    def memory_use(self, herd: int = 0) -> Dict[str, int]: ...
    def state_hash(self) -> int: ...
    def sleeping(self) -> int: ...
    def stage_times(self) -> Dict[str, float]: ...
    def positions(self, herd: int = 0) -> _Float64s: ...
    def headings(self, herd: int = 0) -> _Float32s: ...
    def speeds(self, herd: int = 0) -> _Float32s: ...
    def rotations(self, herd: int = 0) -> _Float32s: ...
    def joints(self, herd: int = 0) -> _Float64s: ...
    def footfalls(self, herd: int = 0) -> npt.NDArray[np.void]: ...
    def dropped_footfalls(self, herd: int = 0) -> int: ...
    def fidelity(self, herd: Optional[int] = None) -> Dict[str, Any]: ...
    def agent_fidelity(self, herd: int = 0) -> Dict[str, _Float64s]: ...
    def records(self, herd: int = 0) -> Dict[str, _Float32s]: ...
    def save(self, file: _Path, note: Any = None) -> None: ...
    def save_to_memory(self, note: Any = None) -> npt.NDArray[np.uint8]: ...
    @staticmethod
    def resume(
        device: Device,
        state: State,
        *,
        pose: Optional[bool] = None,
        feet: Optional[bool] = None,
        footfalls: Optional[int] = None,
        sleep: Optional[bool] = None,
        fuse: Optional[bool] = None,
        timestamps: bool = False,
        page_agents: int = 0,
        levels: Optional[Levels] = None,
    ) -> Crowd: ...
    def render(
        self,
        width: int = 1280,
        height: int = 720,
        view: Optional[View] = None,
        detail: float = 1.0,
        scale: float = 1.0,
        footprints: bool = False,
        occlusion: Optional[bool] = None,
    ) -> npt.NDArray[np.uint8]: ...

class ik:
    """The submodule skitter.ik: inverse kinematics of many equal chains at once."""

    solvers: Tuple[str, ...]
    stop_names: Tuple[str, ...]

    class Cone:
        """A bone stays within an angle of its rest direction."""

        halfAngle: float
        def __init__(self, halfAngle: float) -> None: ...

    class Ellipse:
        """A cone with another half-angle toward each side of the bone's frame."""

        px: float
        py: float
        nx: float
        ny: float
        def __init__(self, px: float, py: float, nx: float, ny: float) -> None: ...

    class Hinge:
        """A bone turns about one axis."""

        axis: Sequence[float]
        min: float
        max: float
        def __init__(self, axis: Sequence[float], min: float, max: float) -> None: ...

    class Bone:
        """A bone of a chain, at rest."""

        length: float
        direction: Sequence[float]
        stiffness: float
        def __init__(
            self,
            length: float,
            direction: Sequence[float] = (0, 1, 0),
            limit: Optional[Union[ik.Cone, ik.Ellipse, ik.Hinge]] = None,
            twist: Tuple[float, float] = (0, 0),
            stiffness: float = 1,
        ) -> None: ...

    class Chain:
        """The kind of chain that a batch solves, from its base at 0."""

        def __init__(self, bones: Sequence[ik.Bone], pole: Optional[Sequence[float]] = None) -> None: ...
        @property
        def bones(self) -> Tuple[ik.Bone, ...]: ...
        @property
        def reach(self) -> float: ...
        def rest(self) -> _Float32s: ...

    class Batch:
        """Chains of one kind on a device."""

        def __init__(
            self,
            device: Device,
            chain: ik.Chain,
            chains: int,
            *,
            solver: str = "auto",
            start: str = "rest",
            tolerance: float = ...,
            iterations: int = 0,
            restarts: bool = True,
            rest_pull: Optional[float] = None,
            bases: bool = False,
            rotations: bool = False,
        ) -> None: ...
        def set_targets(self, targets: _Floats) -> None: ...
        def set_bases(self, positions: _Floats, rotations: Optional[_Floats] = None) -> None: ...
        def reset(self) -> None: ...
        def solve(self, targets: Optional[_Floats] = None) -> _Float32s: ...
        def joints(self) -> _Float32s: ...
        def rotations(self) -> _Float32s: ...
        def reports(self) -> npt.NDArray[np.void]: ...
        @property
        def chains(self) -> int: ...
        @property
        def solver(self) -> str: ...
        @property
        def iterations(self) -> int: ...

class Spline:
    """A cubic Hermite spline on the host, computed in double."""

    def __init__(
        self,
        points: _Floats,
        knots: Optional[_Floats] = None,
        *,
        closed: bool = False,
        rule: str = "catmullRom",
        tension: float = 0,
        continuity: float = 0,
        bias: float = 0,
        arriving: Optional[_Floats] = None,
        leaving: Optional[_Floats] = None,
    ) -> None: ...
    @property
    def begin(self) -> float: ...
    @property
    def end(self) -> float: ...
    @property
    def closed(self) -> bool: ...
    @property
    def length(self) -> float: ...
    def position(self, time: _Floats) -> _Float32s: ...
    def velocity(self, time: _Floats) -> _Float32s: ...
    def acceleration(self, time: _Floats) -> _Float32s: ...
    def length_at(self, time: _Floats) -> Any: ...
    def time_at_length(self, length: _Floats) -> Any: ...

class SplineBatch:
    """Splines of equal point counts on a device."""

    def __init__(
        self,
        device: Device,
        points: _Floats,
        knots: Optional[_Floats] = None,
        *,
        closed: bool = False,
        rule: str = "catmullRom",
        tension: float = 0,
        continuity: float = 0,
        bias: float = 0,
        constant_speed: bool = False,
        arriving: Optional[_Floats] = None,
        leaving: Optional[_Floats] = None,
    ) -> None: ...
    @property
    def splines(self) -> int: ...
    def set_clocks(self, start: _Floats, duration: _Floats) -> None: ...
    def travel(self, now: float) -> npt.NDArray[np.void]: ...
    def lengths(self) -> _Float32s: ...

class StageResult:
    """How a stage compared with the reference."""

    @property
    def name(self) -> str: ...
    @property
    def samples(self) -> int: ...
    @property
    def kept(self) -> int: ...
    @property
    def maxError(self) -> float: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def ratio(self) -> float: ...
    @property
    def ties(self) -> int: ...
    @property
    def worst(self) -> str: ...
    @property
    def passed(self) -> bool: ...
    @property
    def why(self) -> str: ...

class Validation:
    """The outcome of validate(), which is true where every stage passed."""

    @property
    def device(self) -> str: ...
    @property
    def ticks(self) -> int: ...
    @property
    def stages(self) -> Dict[str, StageResult]: ...
    @property
    def passed(self) -> bool: ...
    def __bool__(self) -> bool: ...

def validate(
    scene: Scene,
    frames: int = 120,
    device: Optional[Device] = None,
    stages: Optional[Sequence[str]] = None,
    *,
    terrain: Optional[Heightfield] = None,
    dt: float = ...,
    sleep: bool = False,
    fuse: bool = True,
    page_agents: int = 0,
) -> Validation: ...
