"""The part in C++, by its C interface: components/python/Interface.hpp."""

from __future__ import annotations

import atexit
import ctypes
import json
import math
import operator
import os
import pathlib
import threading
import weakref
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


class ConfigError(ValueError):
    """A deployment, a scene or a log that cannot be used."""

    __module__ = "insonify"

    def __init__(self, message: str, diagnostics: Sequence[dict] = ()) -> None:
        super().__init__(message)
        self.diagnostics = list(diagnostics)
        """All diagnostics, each with `file`, `line`, `column`, `path` and `message`."""
        first = self.diagnostics[0] if self.diagnostics else {}
        self.file: str | None = first.get("file")
        self.line: int | None = first.get("line")
        self.column: int | None = first.get("column")


class _Array(ctypes.Structure):
    _fields_ = [
        ("name", ctypes.c_char_p),
        ("type", ctypes.c_char_p),
        ("numbers", ctypes.c_void_p),
        ("shape", ctypes.c_uint64 * 3),
        ("dimensions", ctypes.c_uint32),
    ]


class _Calls:
    """Calls of C++ that run. At the end of the interpreter it waits for those of other threads, because the end of the
    process would destroy what they use. Further ones never begin."""

    def __init__(self) -> None:
        self._changed, self._count, self._is_over = threading.Condition(), 0, False

    def __enter__(self) -> None:
        with self._changed:
            while self._is_over and threading.current_thread() is not threading.main_thread():
                self._changed.wait()
            self._count += 1

    def __exit__(self, *_error) -> None:
        with self._changed:
            self._count -= 1
            self._changed.notify_all()

    def end(self) -> None:
        with self._changed:
            self._is_over = True
            self._changed.wait_for(lambda: self._count == 0)


class _Functions:
    """The functions of the library, by their names without `insonify_`."""

    def __getattr__(self, name: str):
        function = getattr(_library, "insonify_" + name)

        def call(*arguments):
            with _calls:
                return function(*arguments)

        setattr(self, name, call)
        return call


_calls, _functions = _Calls(), _Functions()
atexit.register(_calls.end)
os.register_at_fork(after_in_child=_calls.__init__)  # threads that were in a call stayed in the parent
_text, _handle, _size = ctypes.c_char_p, ctypes.c_void_p, ctypes.c_size_t
_library = ctypes.CDLL(str(pathlib.Path(__file__).with_name("_insonify.so")))
for _name, _result, *_arguments in (
    ("error", _text),
    ("version", _text),
    ("free", None, _handle),
    ("facts", _text, _handle),
    ("arrays", _size, _handle, ctypes.POINTER(_Array), _size),
    ("simulation", _handle, _text, ctypes.c_uint64, ctypes.POINTER(_text), _size, ctypes.c_int, ctypes.POINTER(ctypes.c_double)),
    ("step", ctypes.c_int, _handle, ctypes.POINTER(_text), _handle, _size, ctypes.POINTER(ctypes.c_double), ctypes.POINTER(_handle)),
    ("time", ctypes.c_double, _handle),
    ("set", ctypes.c_int, _handle, ctypes.POINTER(_text), _size),
    ("warnings", _text, _handle),
    ("reset", ctypes.c_int, _handle, ctypes.POINTER(ctypes.c_uint64)),
    ("batch", _handle, _text, ctypes.c_uint64, ctypes.POINTER(_text), _size, ctypes.c_int, ctypes.POINTER(ctypes.c_double), _size),
    ("batch_step", _handle, _handle, _handle),
    ("batch_reset", ctypes.c_int, _handle, _handle, _handle, _size),
    ("fan", _handle, _handle, ctypes.c_uint32, ctypes.c_double, ctypes.POINTER(ctypes.c_double), _text, _text, ctypes.c_int),
    ("log", _handle, _text),
    ("sample", _handle, _handle, _size, _size),
):
    _function = getattr(_library, "insonify_" + _name)
    _function.restype, _function.argtypes = _result, _arguments

_ERRORS = {error.__name__: error for error in (IndexError, MemoryError, RuntimeError, TypeError, ValueError)}


def _raise() -> None:
    error = json.loads(_library.insonify_error())
    if error["kind"] == "ConfigError":
        raise ConfigError(error["message"], error["diagnostics"])
    raise _ERRORS[error["kind"]](error["message"])


version = _library.insonify_version().decode()


def refuse_copy(*_others):
    raise TypeError(
        "a simulation, log or ping cannot be copied or sent to another process; make the simulation or read the log there, "
        "and send arrays of pings"
    )


class Handle:
    """A handle of an object in C++: facts, and arrays, which stay valid as long as they are
    referenced."""

    def __init__(self, pointer: int | None) -> None:
        if pointer is None:
            _raise()
        self.pointer = pointer
        weakref.finalize(self, _functions.free, pointer).atexit = False  # at exit, other threads may still use it

    def __reduce_ex__(self, _protocol):
        refuse_copy()

    def facts(self):
        facts = _functions.facts(self.pointer)
        if facts is None:
            _raise()
        return json.loads(facts)

    def arrays(self) -> list[tuple[str, NDArray]]:
        """Read-only arrays by name."""
        room = 16
        while True:
            found = (_Array * room)()
            count = _functions.arrays(self.pointer, found, room)
            if count == ctypes.c_size_t(-1).value:
                _raise()
            if count <= room:
                return [(each.name.decode(), self._view(each)) for each in found[:count]]
            room = count

    def _view(self, array: _Array) -> NDArray:
        shape, kind = tuple(array.shape[: array.dimensions]), np.dtype(array.type.decode())
        size = kind.itemsize * int(np.prod(shape))
        if not size:
            return np.empty(shape, kind)
        memory = (ctypes.c_char * size).from_address(array.numbers)
        memory.owner = self
        view = np.ndarray(shape, kind, memory)
        view.flags.writeable = False
        return view


def _whole(name: str, number: int, end: int, first: int = 0) -> int:
    """A number from `first` to below `end`; numbers of numpy too."""
    try:
        whole = operator.index(number)
    except TypeError:
        raise TypeError(f"{name}: is {number!r}; must be a whole number") from None
    if not first <= whole < end:
        raise ValueError(f"{name}: is {whole}; may be {first} to {end - 1}")
    return whole


def _optional(name: str, number: float | None):
    """A pointer to the value; None: null."""
    try:
        finite = number is None or math.isfinite(number)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name}: is {number!r}; must be a number") from None
    if not finite:
        raise ValueError(f"{name}: is {number}; must be finite")
    return None if number is None else ctypes.byref(ctypes.c_double(number))


def simulation(deployment: str, seed: int, overrides: Sequence[str], truth: bool, period: float | None) -> Handle:
    seed, period = _whole("seed", seed, 2**64), _optional("period", period)
    texts = (_text * len(overrides))(*(each.encode() for each in overrides))
    return Handle(_functions.simulation(os.fsencode(deployment), seed, texts, len(texts), truth, period))


def step(simulation: Handle, poses: dict[str, NDArray], time: float | None, count: int) -> list[Handle | None]:
    """Steps with poses of seven numbers each: x, y, z [m] and a quaternion w, x, y, z. Returns
    `count` pings."""
    ports = (_text * len(poses))(*(port.encode() for port in poses))
    numbers = np.array([*poses.values()], float).reshape(len(poses), 7)
    made = (_handle * count)()
    at = _optional("time", time)
    if _functions.step(simulation.pointer, ports, numbers.ctypes.data, len(ports), at, made):
        _raise()
    return [each and Handle(each) for each in made]


def time(simulation: Handle) -> float:
    value = _functions.time(simulation.pointer)
    if value != value:  # NaN: it failed
        _raise()
    return value


def change(stepped: Handle, assignments: Sequence[str]) -> None:
    texts = (_text * len(assignments))(*(each.encode() for each in assignments))
    if _functions.set(stepped.pointer, texts, len(texts)):
        _raise()


def warnings_of(stepped: Handle) -> list[str]:
    """What the simulations have warned of since the last call."""
    texts = _functions.warnings(stepped.pointer)
    if texts is None:
        _raise()
    return [] if texts == b"[]" else json.loads(texts)


def reset(simulation: Handle, seed: int | None) -> None:
    given = None if seed is None else ctypes.byref(ctypes.c_uint64(_whole("seed", seed, 2**64)))
    if _functions.reset(simulation.pointer, given):
        _raise()


def batch(
    deployment: str, count: int, seed: int, overrides: Sequence[str], truth: bool, period: float | None
) -> Handle:
    count, seed, period = _whole("count", count, 2**16, 1), _whole("seed", seed, 2**64), _optional("period", period)
    texts = (_text * len(overrides))(*(each.encode() for each in overrides))
    return Handle(_functions.batch(os.fsencode(deployment), seed, texts, len(texts), truth, period, count))


def batch_step(batch: Handle, poses: NDArray[np.float64]) -> Handle:
    """Steps with poses [simulations, 7]: x, y, z [m] and a quaternion w, x, y, z. Returns all
    pings as one sample."""
    return Handle(_functions.batch_step(batch.pointer, poses.ctypes.data))


def batch_reset(batch: Handle, count: int, which: Sequence[int], seeds: Sequence[int] | None) -> None:
    asked = [_whole("which", each, 2**16, -(2**16)) for each in which]
    for each in asked:
        if each < 0:
            raise IndexError(f"there is no simulation {each} of {count}")
    numbers = np.array(asked, np.uintp)
    given = None if seeds is None else np.array([_whole("seeds", each, 2**64) for each in seeds], np.uint64)
    if given is not None and given.shape != numbers.shape:
        raise ValueError(f"seeds: are {len(given)}; there are {len(numbers)} simulations to reset")
    if _functions.batch_reset(
        batch.pointer, numbers.ctypes.data, None if given is None else given.ctypes.data, len(numbers)
    ):
        _raise()


def fan(
    ping: Handle, width: int, dynamic_range_db: float, reference_db: float | None, colour_map: str, scale: str, code_bits: int
) -> NDArray[np.uint8]:
    """A picture [height, width, 3], red first."""
    width, code_bits = _whole("width", width, 2**32), _whole("code_bits", code_bits, 2**31)
    reference_db = _optional("reference_db", reference_db)
    painted = _functions.fan(
        ping.pointer, width, dynamic_range_db, reference_db, colour_map.encode(), scale.encode(), code_bits
    )
    return pixels(Handle(painted))


def pixels(picture: Handle) -> NDArray[np.uint8]:
    return dict(picture.arrays())["pixels"].copy()


def log(path: str) -> Handle:
    return Handle(_functions.log(os.fsencode(path)))


def sample(log: Handle, stream: int, index: int) -> Handle:
    whole = operator.index(index)
    if whole < 0:
        raise IndexError("no such sample")
    return Handle(_functions.sample(log.pointer, stream, whole))
