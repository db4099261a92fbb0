"""The description of a thing, and the table of all."""

import difflib
from dataclasses import dataclass
from typing import Callable

from ..materials import STATES
from ..parameters import Choice, Number, Point, Text

THINGS = {}
CREASE_DEG = 40.0  # edges with blunter angles are smooth


@dataclass
class Model:
    """Pairs of a closed solid and its material, in the thing's own axes: z up, standing near z = 0, x ahead.

    `outlines` are convex polygons [n, 2] that other things keep clear of; absent: the convex hull of all from
    above."""

    parts: list
    outlines: list = None


@dataclass
class Thing:
    """A thing. `kind` sets how it is placed and built: a body (rng, values) rests on the floor; a line (rng,
    values, ground, path) is laid along a path on it; a structure (rng, values, depth) has its z from the water
    surface."""

    name: str
    about: str
    parameters: list
    build: Callable
    kind: str = "body"
    half_width: Callable = None  # width of the strip that a line occupies, by its values [m]

    def all_parameters(self):
        return self.parameters + PLACING[self.kind] + COMMON


COMMON = [
    Choice(
        "surface", "weathered", "of its materials: clean, weathered (rough, Lambert's law), fouled (overgrown)", STATES
    ),
]
PLACING = {
    "body": [
        Number("heading_deg", None, "of its x axis from north to west; absent: any", -360, 360),
        Number("tilt_deg", 0.0, "against the floor, about any level axis", 0, 180),
        Number("buried", 0.03, "share of its height below the floor", 0, 0.95),
        Number("height_m", 0.0, "of its lowest point above the floor; 0: it stands on it", 0, 1000),
    ],
    "line": [
        Point("from_m", None, "where it begins; absent: drawn"),
        Point("to_m", None, "where it ends; absent: drawn"),
        Number("heading_deg", None, "from begin to end, where these are drawn; absent: any", -360, 360),
        Number("meander_m", 0.5, "how far it leaves the straight line", 0, 50),
    ],
    "structure": [
        Number("heading_deg", 0.0, "of its x axis from north to west; absent: north", -360, 360),
    ],
}
# Keys of a recipe's entry in addition to the thing's own parameters.
ENTRY = [
    Number("count", 1, "how many", 0, 2000, whole=True),
    Text("name", None, "of its nodes, before their number; absent: that of the thing"),
    Number("x_m", None, "north of its middle; absent: anywhere on the floor", -1e5, 1e5),
    Number("y_m", None, "west of its middle; absent: anywhere on the floor", -1e5, 1e5),
    Number("gap_m", 0.1, "room kept free about it", 0, 100),
]


def thing(name, about, *parameters, kind="body", half_width=lambda values: values["diameter_m"] / 2):
    """Adds the function below it to the table."""

    def add(build):
        assert name not in THINGS
        THINGS[name] = Thing(name, about, list(parameters), build, kind, half_width)
        return build

    return add


def may_be_thing(given):
    """The alternatives to a wrong name, for messages."""
    near = difflib.get_close_matches(given, THINGS, 1) if isinstance(given, str) else []
    return (f"did you mean {near[0]}? " if near else "") + f"may be {', '.join(THINGS)}"
