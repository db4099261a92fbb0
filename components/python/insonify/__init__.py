"""Imaging sonar from a 3-D scene, step by step.

    import insonify

    sim = insonify.Simulation("deploy/minimal.yml", seed=1, overrides={"sonar.range": 30})
    ping = sim.step(insonify.Pose([0, 0, -5]))
    ping.bins.shape     # (beams, bins), float32, the simulator's own memory

Frames are Rock's: the world is x north, y west, z up; a body x forward, y to port, z up. Lengths are metres, angles
radians, times seconds; bearings are positive to port.
"""

from __future__ import annotations

import json
import operator
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from numpy.typing import NDArray

from . import native
from .native import ConfigError

__version__ = native.version
__all__ = ["ConfigError", "Log", "Ping", "Pings", "Pose", "Simulation", "SimulationBatch", "Truth", "read_log"]


@dataclass(eq=False)
class Pose:
    """A body in the world."""

    position: np.ndarray
    """Its origin in the world [m]: north, west, up."""
    orientation_wxyz: np.ndarray = field(default_factory=lambda: np.array([1.0, 0.0, 0.0, 0.0]))
    """The quaternion w, x, y, z that turns vectors of the body into the world."""
    time: float | None = None
    """Time of validity [s]; None: unknown."""

    def __post_init__(self) -> None:
        self.position = _vector(self.position, 3, "position: must be x, y, z")
        self.orientation_wxyz = _vector(self.orientation_wxyz, 4, "orientation_wxyz: must be w, x, y, z")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Pose):
            return NotImplemented
        return (
            np.array_equal(self.position, other.position)
            and np.array_equal(self.orientation_wxyz, other.orientation_wxyz)
            and self.time == other.time
        )

    @classmethod
    def from_matrix(cls, world_from_body: np.ndarray) -> Pose:
        """From a 4 x 4 transform. ValueError if it does not consist of a rotation and a
        translation."""
        matrix = np.asarray(world_from_body, float)
        if matrix.shape != (4, 4) or not np.allclose(matrix[3], [0, 0, 0, 1]):
            raise ValueError(
                "a pose is an insonify.Pose, seven numbers x, y, z and a quaternion w, x, y, z, or a transform; a transform "
                f"is 4 x 4, with a last row of 0 0 0 1; the shape of this is {matrix.shape}"
            )
        rotation = matrix[:3, :3]
        if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-6) or np.linalg.det(rotation) < 0:
            raise ValueError("the upper left 3 x 3 of the transform is no rotation")
        return cls(matrix[:3, 3].copy(), _quaternion(rotation))

    @classmethod
    def from_euler(cls, position: np.ndarray, roll: float = 0, pitch: float = 0, yaw: float = 0) -> Pose:
        """From angles: rotation Rz(yaw) Ry(pitch) Rx(roll) [rad]. A positive pitch looks down, a positive yaw
        turns to port."""
        (cr, sr), (cp, sp), (cy, sy) = ((np.cos(a / 2), np.sin(a / 2)) for a in (roll, pitch, yaw))
        return cls(
            position,
            [
                cr * cp * cy + sr * sp * sy,
                sr * cp * cy - cr * sp * sy,
                cr * sp * cy + sr * cp * sy,
                cr * cp * sy - sr * sp * cy,
            ],
        )

    def matrix(self) -> np.ndarray:
        """The 4 x 4 transform from the body to the world."""
        w, x, y, z = self.orientation_wxyz / np.linalg.norm(self.orientation_wxyz)
        made = np.eye(4)
        made[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
        made[:3, 3] = self.position
        return made


def _vector(values: object, count: int, message: str) -> np.ndarray:
    vector = np.asarray(values, float).reshape(-1)
    if vector.size != count:
        raise ValueError(f"{message}; has {vector.size} numbers")
    return vector


def _quaternion(rotation: np.ndarray) -> np.ndarray:
    """w, x, y, z of a rotation. The largest component is computed first, to avoid dividing by a small number."""
    r = rotation
    squares = np.array(
        [
            1 + r[0, 0] + r[1, 1] + r[2, 2],
            1 + r[0, 0] - r[1, 1] - r[2, 2],
            1 - r[0, 0] + r[1, 1] - r[2, 2],
            1 - r[0, 0] - r[1, 1] + r[2, 2],
        ]
    )
    pivot = int(np.argmax(squares))
    rows = np.array(
        [
            [squares[0], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], squares[1], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
            [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], squares[2], r[1, 2] + r[2, 1]],
            [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], squares[3]],
        ]
    )
    return rows[pivot] / np.linalg.norm(rows[pivot])


class Truth(Mapping):
    """The truth of a ping's bins: arrays [beams, bins] by name, as attributes as well.

    `object` is an index into `objects` (names), -1 where there is none; `share` of that object in the bin's energy;
    `elevation` and `grazing` [rad]; `hits`; `path` (0 direct, 1 and 2 by the surface, 3 by a second bounce,
    4 through a wall, 5 rung in a wall, 6 the water itself); `shadow`.
    """

    def __init__(self, arrays: dict) -> None:
        self._arrays = arrays

    def __getitem__(self, name: str):
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def __getattr__(self, name: str):
        try:
            return self.__dict__["_arrays"][name]
        except KeyError:
            raise AttributeError(name) from None

    def __repr__(self) -> str:
        return f"Truth({', '.join(self)})"


class Ping:
    """One ping: echoes of each beam by slant range."""

    def __init__(self, handle: native.Handle) -> None:
        self._handle = handle
        self._facts = handle.facts()
        self._arrays = dict(handle.arrays())

    def _number(self, name: str) -> float:
        return float("nan") if self._facts[name] is None else self._facts[name]

    @property
    def time(self) -> float:
        """Time of validity in the world [s]."""
        return self._number("time")

    @property
    def bins(self) -> NDArray[np.float32]:
        """[beams, bins]: the simulator's own memory, valid as long as the array. Read-only."""
        return self._arrays["bins"]

    @property
    def bearings(self) -> NDArray[np.float64]:
        """Bearing of each beam [rad], positive to port."""
        return self._arrays["bearings"]

    @property
    def ranges(self) -> NDArray[np.float64]:
        """Slant range at the middle of each bin [m]."""
        return self._arrays["ranges"]

    def __repr__(self) -> str:
        beams, bins = self.bins.shape
        return f"Ping({beams} beams x {bins} bins, {self.ranges[0]:.3g} to {self.ranges[-1]:.4g} m, time={self.time})"

    @property
    def speed_of_sound(self) -> float:
        """[m/s]"""
        return self._number("speed_of_sound")

    @property
    def beam_width(self) -> float:
        """[rad]"""
        return self._number("beam_width")

    @property
    def beam_height(self) -> float:
        """[rad]"""
        return self._number("beam_height")

    @property
    def bin_length(self) -> float:
        """[m]"""
        return self._number("bin_length")

    @property
    def truth(self) -> Truth | None:
        """The truth of the bins; None unless the simulation was made with truth=True."""
        return _truth(self._facts, self._arrays) if "objects" in self._facts else None

    def fan(
        self,
        width: int = 512,
        dynamic_range_db: float = 40,
        reference_db: float | None = None,
        colour_map: str = "amber",
        scale: str = "linear",
        code_bits: int = 8,
    ) -> NDArray[np.uint8]:
        """The ping as a picture [height, width, 3], red first; the arguments are the properties of
        output::FanImageTask. Ahead is up, port is left. ConfigError for an impossible picture."""
        return native.fan(self._handle, width, dynamic_range_db, reference_db, colour_map, scale, code_bits)


def _truth(facts: dict, arrays: dict) -> Truth:
    others = ("bins", "bearings", "ranges", "times")
    return Truth({**{name: array for name, array in arrays.items() if name not in others}, "objects": facts["objects"]})


class Simulation:
    """A deployment that is stepped by one pose at a time.

    Runs the tasks of the deployment that lead to pings, in lockstep. The caller replaces the task that gives the
    vehicle's poses; loggers, pictures and tasks that communicate with other programs are omitted. The same seed and
    the same poses give the same pings, as `insonify run` does. Several simulations may live in one process, each used by one
    thread at a time: other threads run while one renders.

    :param deployment: a file, or a folder with one.
    :param seed: seed of the run; 0: the deployment's own seeds.
    :param overrides: values of "task.property", as for `--set`: anything that JSON can represent.
    :param truth: whether pings have their truth, which takes time.
    :param period: time between two steps [s]; None: the period of the poses in the deployment.

    Warnings of the tasks, such as a range that bins of whole microseconds cannot have, are Python warnings.

    :raises ConfigError: with `file`, `line`, `column` of the first diagnostic, and all of them in `diagnostics`.
    """

    __copy__ = native.refuse_copy

    def __init__(
        self,
        deployment: str,
        seed: int = 0,
        overrides: Mapping[str, object] | None = None,
        *,
        truth: bool = False,
        period: float | None = None,
    ) -> None:
        self._simulation = native.simulation(str(deployment), seed, _assignments(overrides), truth, period)
        facts = self._simulation.facts()
        self._poses, self._pings, self._period = facts["poses"], facts["pings"], facts["period"]
        self._warnings = _Warnings(self._simulation)

    @property
    def poses(self) -> list[str]:
        """Ports whose poses step() takes."""
        return self._poses

    @property
    def pings(self) -> list[str]:
        """Ports whose pings step() returns."""
        return self._pings

    @property
    def period(self) -> float:
        """Time between two steps [s]."""
        return self._period

    @property
    def time(self) -> float:
        """Default time of the next step [s]."""
        return native.time(self._simulation)

    def step(self, pose, time: float | None = None):
        """The ping at a pose: a Pose, seven numbers x, y, z [m] and a quaternion w, x, y, z, or a 4 x 4 transform from
        the body to the world.

        With several vehicles, a dictionary of poses by port; with several sonars, the pings come as one. A ping that
        was not made is None. RuntimeError has the message of a task in error.
        """
        given = pose if isinstance(pose, Mapping) else {self._only(self.poses, "poses"): pose}
        handles = native.step(self._simulation, {port: _numbers(each) for port, each in given.items()}, time, len(self.pings))
        self._warnings.follow()
        made = [handle and Ping(handle) for handle in handles]
        return made[0] if len(made) == 1 else dict(zip(self.pings, made))

    def set(self, values: Mapping[str, object]) -> None:
        """Changes properties from the next step on: values of "task.property", as `overrides`; None removes one or
        resets it to its default. They stay after reset(). The sonar keeps its quality and its data of the scene.

        :raises ConfigError: as for `overrides`; then nothing has changed.
        :raises RuntimeError: for properties that a running task cannot change, such as the file of a scene.
        """
        native.change(self._simulation, _assignments(values, "values"))
        self._warnings.expect()

    def reset(self, seed: int | None = None) -> None:
        """Resets to the start, as if made anew with this seed, not 0; None: the same seed. The scene stays
        loaded."""
        native.reset(self._simulation, seed)

    @staticmethod
    def _only(ports: list[str], what: str) -> str:
        if len(ports) != 1:
            raise ValueError(f"this deployment has several {what}: give a dictionary of {', '.join(ports)}")
        return ports[0]


class Pings:
    """The pings of one step of a batch, in read-only arrays that the step owns."""

    def __init__(self, handle: native.Handle) -> None:
        self._facts, self._arrays = handle.facts(), dict(handle.arrays())

    def __len__(self) -> int:
        return len(self.times)

    @property
    def bins(self) -> NDArray[np.float32]:
        """[simulations, beams, bins]."""
        return self._arrays["bins"]

    @property
    def times(self) -> NDArray[np.float64]:
        """[simulations], time of each ping [s]."""
        return self._arrays["times"]

    @property
    def bearings(self) -> NDArray[np.float64]:
        """[beams], of the first simulation, positive to port [rad]."""
        return self._arrays["bearings"]

    @property
    def ranges(self) -> NDArray[np.float64]:
        """[bins], slant range at the middle of each [m]."""
        return self._arrays["ranges"]

    @property
    def truth(self) -> Truth | None:
        """The truth of the bins, arrays of the shape of `bins`; None unless the batch was made with
        truth=True."""
        return _truth(self._facts, self._arrays) if "objects" in self._facts else None


class SimulationBatch:
    """Several simulations of one deployment on one scene, stepped in parallel: each on one core, one per core at a
    time. Simulation `i` gives the pings of a Simulation with seed `batch.seeds[i]`, bit for bit.

        batch = insonify.SimulationBatch("deploy/harbour_fls.yml", 32, seed=1)
        bins = batch.step(poses).bins                # [32, beams, bins], of poses [32, 7] or [32, 4, 4]

    :param count: number of simulations, 1 to 65535; each takes the memory of its own sonar, and none of the scene.
    Other parameters as for Simulation; the deployment has one vehicle and one sonar.
    """

    __copy__ = native.refuse_copy

    def __init__(
        self,
        deployment: str,
        count: int,
        seed: int = 0,
        overrides: Mapping[str, object] | None = None,
        *,
        truth: bool = False,
        period: float | None = None,
    ) -> None:
        self._batch = native.batch(str(deployment), count, seed, _assignments(overrides), truth, period)
        self._count, self._period = count, self._batch.facts()["period"]
        self._warnings = _Warnings(self._batch)

    def __len__(self) -> int:
        return self._count

    @property
    def period(self) -> float:
        """Time between two steps [s]."""
        return self._period

    @property
    def seeds(self) -> list[int]:
        """Seed of each simulation; 0: the deployment's own."""
        return self._batch.facts()["seeds"]

    def step(self, poses) -> Pings:
        """Returns the ping of each simulation at its pose. Poses are an array [simulations, 7] of x, y, z [m] and a
        quaternion w, x, y, z, an array [simulations, 4, 4] of transforms from the body to the world, or a list of what
        Simulation.step takes. RuntimeError names the first simulation that failed."""
        pings = native.batch_step(self._batch, self._numbers(poses))
        self._warnings.follow()
        return Pings(pings)

    def set(self, values: Mapping[str, object]) -> None:
        """Changes properties of all simulations, as Simulation.set()."""
        native.change(self._batch, _assignments(values, "values"))
        self._warnings.expect()

    def reset(self, which: Sequence[int] | None = None, seeds: Sequence[int] | None = None) -> None:
        """Resets simulations, as if just made, with these seeds, none 0; None: all of them, the same seeds."""
        native.batch_reset(self._batch, len(self), range(len(self)) if which is None else which, seeds)

    def _numbers(self, poses) -> NDArray[np.float64]:
        if isinstance(poses, np.ndarray) and poses.shape == (len(self), 7):
            return np.ascontiguousarray(poses, float)
        if isinstance(poses, np.ndarray) and poses.dtype != object and poses.shape[1:] != (4, 4):
            raise ValueError(f"poses: are an array {list(poses.shape)}; must be [{len(self)}, 7] or [{len(self)}, 4, 4]")
        if len(poses) != len(self):
            raise ValueError(f"poses: are {len(poses)}; the batch has {len(self)} simulations")
        return np.stack([_numbers(each) for each in poses])


class _Warnings:
    """Gives as Python's warnings what the command prints as warnings: those that tasks and plans have after the start, the
    first ping and the first ping after a change of properties, and those of single pings."""

    def __init__(self, stepped: native.Handle) -> None:
        self._stepped, self._known, self._is_due = stepped, [], True
        self._compare()

    def expect(self) -> None:
        """Properties have changed."""
        self._is_due = True
        self._compare()

    def follow(self) -> None:
        """A ping was made. State changes before the first warning, which Python may turn into an exception."""
        was_due, self._is_due = self._is_due, False
        texts = native.warnings_of(self._stepped)
        if was_due:
            self._compare()
        for text in texts:
            warnings.warn(text, stacklevel=3)

    def _compare(self) -> None:
        before, self._known = self._known, self._stepped.facts()["notices"]
        for notice in self._known:
            if notice["is_warning"] and notice not in before:
                warnings.warn(notice["text"], stacklevel=4)


def _assignments(overrides: Mapping[str, object] | None, what: str = "overrides") -> list[str]:
    if overrides is not None and not isinstance(overrides, Mapping):
        raise TypeError(f"{what}: is a {type(overrides).__name__}; must be a mapping from task.property to values")
    return [f"{name}={json.dumps(value, default=_plain)}" for name, value in (overrides or {}).items()]


def _plain(value: object) -> object:
    """Converts a number of numpy, an array, or a path to a value of JSON."""
    return value.tolist() if isinstance(value, (np.generic, np.ndarray)) else str(value)


def _numbers(pose) -> np.ndarray:
    if isinstance(pose, Pose):
        made = pose
    else:
        try:
            numbers = np.asarray(pose, float)
        except (TypeError, ValueError):
            raise ValueError(f"pose: is {pose!r}; must be a Pose, seven numbers or a 4 x 4 transform") from None
        made = Pose(numbers[:3], numbers[3:]) if numbers.shape == (7,) else Pose.from_matrix(numbers)
    return np.concatenate([made.position, made.orientation_wxyz])


class Log(Mapping):
    """The streams of a log by name: each a sequence of samples, with `times` [s], `type` and `metadata`.

    The first file of a log in several files, x.0.log, x.1.log and so on, stands for all of the same run. `files` are
    those that were read; `notice` says which were read with the first, and which are of another run, or is empty."""

    def __init__(self, path: str) -> None:
        self.path = str(path)
        log = native.log(self.path)
        facts = log.facts()
        self.files: list[str] = facts["files"]
        self.notice: str = facts["notice"]
        streams = zip(facts["streams"], log.arrays())
        self._streams = {stream["name"]: _Samples(log, i, stream, times) for i, (stream, (_, times)) in enumerate(streams)}

    def __getitem__(self, name: str) -> _Samples:
        if name not in self._streams:
            raise KeyError(f"{name}: is no stream of the log; there are {', '.join(self._streams)}")
        return self._streams[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._streams)

    def __len__(self) -> int:
        return len(self._streams)

    def __repr__(self) -> str:
        return f"Log({self.path}: {', '.join(f'{name} ({len(samples)})' for name, samples in self.items())})"


class _Samples(Sequence):
    """One stream; samples are read on access. Pings are Ping, poses Pose, pictures arrays."""

    def __init__(self, log: native.Handle, index: int, stream: dict, times: NDArray[np.float64]) -> None:
        self._log, self._index = log, index
        self.name, self.type, self.metadata, self.times = stream["name"], stream["type"], stream["metadata"], times

    def __len__(self) -> int:
        return len(self.times)

    def __getitem__(self, index):
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        try:
            index = operator.index(index)
        except TypeError:
            raise TypeError(f"{self.name}: takes a whole number or a slice; {index!r} is neither") from None
        if not -len(self) <= index < len(self):
            raise IndexError(f"{index}: {self.name} has {len(self)} samples")
        sample = native.sample(self._log, self._index, index + len(self) if index < 0 else index)
        facts = sample.facts()
        if facts["kind"] == "ping":
            return Ping(sample)
        if facts["kind"] == "picture":
            return native.pixels(sample)
        if facts["kind"] in ("text", "integer"):
            return facts["value"]
        arrays = dict(sample.arrays())
        if facts["kind"] == "truth":
            return _truth(facts, arrays)
        if facts["kind"] == "number":
            return float(arrays["number"][0])
        time, *numbers = arrays["numbers"]
        return Pose(numbers[:3], numbers[3:], float(time))

    def __iter__(self):
        return (self[index] for index in range(len(self)))


def read_log(path: str) -> Log:
    """Returns the streams of a log of Rock's format or MCAP, in all of its files. ConfigError for other files."""
    return Log(path)
