"""Gear of ships, fishers and divers: chains, cables, pipelines, valves, moorings, anchors, hooks, nets, pots,
propellers."""

import math

import numpy as np

from ..materials import solid, wall
from ..parameters import Choice, Number, Switch
from ..places import along
from ..shapes import (
    ball,
    bar,
    box,
    circle,
    cylinder,
    extruded,
    loft,
    moved,
    revolved,
    rotation,
    torus,
    tube,
    union,
    unit,
)
from .catalogue import Model, thing


def lying_path(ground, path, radius, buried, smooth_m, step):
    """The axis of a bar on the floor: heights averaged over smooth_m, in steps."""
    path = along(path, step)
    z = ground.height(path[:, 0], path[:, 1])
    half = int(round(smooth_m / step / 2))
    if half:
        kernel = np.hanning(2 * half + 3)[1:-1]
        z = np.convolve(np.pad(z, half, "edge"), kernel / kernel.sum(), "valid")
    return np.c_[path, z + radius - 2 * radius * buried]


@thing(
    "pipeline",
    "a steel pipe along the floor, a thin wall with what flows in it",
    Number("diameter_m", 0.4, "", 0.05, 3),
    Number("length_m", 20.0, "where an end is drawn", 1, 2000),
    Number("wall_mm", 12, "of steel", 1, 60),
    Choice("fill", "oil", "content", ("oil", "water", "air", "sand")),
    Number("buried", 0.2, "share of its diameter below the floor", 0, 0.95),
    Number("stiffness_m", 6.0, "length over which it bridges the relief", 0, 100),
    kind="line",
)
def pipeline(rng, p, ground, path):
    axis = lying_path(ground, path, p["diameter_m"] / 2, p["buried"], p["stiffness_m"], max(0.25, p["diameter_m"] / 2))
    return Model([(tube(axis, p["diameter_m"] / 2, 24), wall("carbon_steel", p["wall_mm"], p["fill"], p["surface"]))])


@thing(
    "cable",
    "a cable along the floor, armoured with steel",
    Number("diameter_m", 0.06, "", 0.005, 0.4),
    Number("length_m", 20.0, "where an end is drawn", 1, 2000),
    Number("buried", 0.1, "share of its diameter below the floor", 0, 0.95),
    kind="line",
)
def cable(rng, p, ground, path):
    axis = lying_path(ground, path, p["diameter_m"] / 2, p["buried"], 1.0, max(0.1, 2 * p["diameter_m"]))
    return Model([(tube(axis, p["diameter_m"] / 2, 10), solid("steel", p["surface"]))])


@thing(
    "rope",
    "a rope along the floor",
    Number("diameter_m", 0.03, "", 0.004, 0.2),
    Number("length_m", 8.0, "where an end is drawn", 0.5, 500),
    Number("buried", 0.1, "share of its diameter below the floor", 0, 0.95),
    kind="line",
)
def rope(rng, p, ground, path):
    axis = lying_path(ground, path, p["diameter_m"] / 2, p["buried"], 0.3, max(0.08, 2 * p["diameter_m"]))
    return Model([(tube(axis, p["diameter_m"] / 2, 8), solid("rope", p["surface"]))])


def link(bar_radius):
    """A link along x: six bar diameters long and 3.5 wide, as in an anchor chain."""
    d = 2 * bar_radius
    angle = np.arange(16) * 2 * np.pi / 16
    straight = np.where(np.cos(angle) > 1e-9, 1, np.where(np.cos(angle) < -1e-9, -1, 0)) * 1.25 * d
    return tube(
        np.stack([straight + 1.25 * d * np.cos(angle), 1.25 * d * np.sin(angle), 0 * angle], 1),
        bar_radius,
        8,
        closed=True,
    )


def chain_along(axis, bar_radius):
    """Links along points that are four bar diameters apart, each turned a quarter against the
    one before."""
    one = link(bar_radius)
    links = []
    for number, (here, ahead) in enumerate(zip(axis, unit(np.gradient(axis, axis=0)))):
        left = unit(np.cross([0, 0, 1] if abs(ahead[2]) < 0.9 else [0, 1, 0], ahead))
        frame = np.stack([ahead, left, np.cross(ahead, left)], 1)
        links.append(moved(one, here, frame @ rotation(roll=45 + 90 * (number % 2))))
    return links


@thing(
    "chain",
    "an anchor chain along the floor",
    Number("bar_m", 0.03, "diameter of the bar of its links", 0.005, 0.16),
    Number("length_m", 6.0, "where an end is drawn", 0.5, 200),
    Number("buried", 0.2, "share of a link's width below the floor", 0, 0.95),
    kind="line",
    half_width=lambda values: 1.75 * values["bar_m"],
)
def chain(rng, p, ground, path):
    d = p["bar_m"]
    path = along(path, 4 * d)
    z = ground.height(path[:, 0], path[:, 1]) + d * 3.5 * 0.5 * (1 - 2 * p["buried"])
    links = chain_along(np.c_[path, z], d / 2)
    return Model([(each, solid("carbon_steel", p["surface"])) for each in links])


@thing(
    "mooring",
    "a concrete block, a rope or chain that rises from it, and a float of steel with air in it",
    Number("line_m", 6.0, "from block to float", 0.5, 500),
    Number("lean_deg", 8.0, "of the line from the vertical, by current", 0, 70),
    Number("diameter_m", 0.03, "of the rope, or of the chain's bar", 0.004, 0.16),
    Choice("line", "rope", "of the mooring", ("rope", "chain")),
    Number("float_m", 0.6, "diameter of the float", 0.1, 4),
    Number("block_m", 0.9, "side of the block", 0.2, 4),
)
def mooring(rng, p):
    side, tall, s = p["block_m"], 0.6 * p["block_m"], p["surface"]
    block = box((side, side, tall), (0, 0, tall / 2))
    eye = moved(torus(0.09, 0.016, 24, 8), (0, 0, tall + 0.06), rotation(roll=90))
    lean = math.radians(p["lean_deg"])
    share = np.linspace(0, 1, max(8, int(p["line_m"] / 0.2)))[:, None]
    top = np.array([math.sin(lean), 0, math.cos(lean)]) * p["line_m"]
    axis = (
        np.array([0, 0, tall + 0.12])
        + share * top
        + (share - share**2) * np.array([-0.15, 0, 0]) * p["line_m"] * math.sin(lean)
    )
    if p["line"] == "chain":
        line = (union(chain_along(along(axis, 4 * p["diameter_m"]), p["diameter_m"] / 2)), solid("carbon_steel", s))
    else:
        line = (tube(axis, p["diameter_m"] / 2, 8), solid("rope", s))
    r = p["float_m"] / 2
    buoy = ball(r, axis[-1] + (0, 0, r + 0.05), 40) + cylinder(0.025, 0.12, axis[-1] + (0, 0, 0.02), sides=12)
    return Model([(block + eye, solid("concrete", s)), line, (buoy, wall("steel", 4, "air", s))])


@thing(
    "anchor",
    "an admiralty anchor: shank, two arms with flukes, stock and ring",
    Number("length_m", 1.6, "of the shank", 0.3, 6),
)
def anchor(rng, p):
    n = p["length_m"]
    shank = tube([(0, 0, 0), (n, 0, 0)], np.array([0.055, 0.035]) * n, 12)
    angle = np.linspace(-1.05, 1.05, 21)
    arms = tube(
        np.stack([0.42 * n * (1 - np.cos(angle)) - 0.0 * n, 0.42 * n * np.sin(angle), 0 * angle], 1),
        n * (0.05 - 0.02 * np.abs(angle)),
        10,
    )
    flukes = []
    for side in (-1, 1):
        tip = np.array([0.42 * n * (1 - math.cos(1.05)), side * 0.42 * n * math.sin(1.05), 0])
        palm = extruded(np.array([(-0.16, -0.11), (0.1, 0), (-0.16, 0.11)]) * n, 0.03 * n).translate((0, 0, -0.015 * n))
        flukes.append(moved(palm, tip, rotation(yaw=side * 55) @ rotation(roll=90)))
    stock = tube([(0.9 * n, 0, -0.5 * n), (0.9 * n, 0, 0.5 * n)], 0.03 * n, 10)
    knobs = [ball(0.045 * n, (0.9 * n, 0, s * 0.5 * n), 16) for s in (-1, 1)]
    ring = moved(torus(0.08 * n, 0.016 * n, 24, 8), (1.07 * n, 0, 0))
    body = union([shank, arms, stock, ring, *flukes, *knobs])
    # It rests on a fluke and on an end of the stock.
    return Model([(moved(body, turn=rotation(roll=52, pitch=8)), solid("cast_iron", p["surface"]))])


def blade(radius, pitch, width, skew):
    rings = []
    for part in np.linspace(0.12, 1, 12):
        half = width * radius / 2 * np.sin(np.pi * (0.15 + 0.75 * part)) * (1.02 - part**6)
        ring = circle(12) * (half, 0.03 * radius * (1.1 - part))
        turn = math.atan2(pitch, 2 * math.pi * 0.5 * part)
        y = ring[:, 0] * np.cos(turn) - ring[:, 1] * np.sin(turn) + skew * radius * part**2
        z = ring[:, 0] * np.sin(turn) + ring[:, 1] * np.cos(turn)
        rings.append(np.c_[np.full(12, part * radius), y, z])
    return loft(rings)


@thing(
    "hook",
    "a crane hook with its eye",
    Number("length_m", 0.2, "from the eye to the bend", 0.04, 2),
    Choice("matter", "painted_metal", "", ("painted_metal", "steel", "carbon_steel")),
    Switch("upright", "false", "hangs by its eye instead of lying on its side"),
)
def hook(rng, p):
    h = p["length_m"]
    bend = np.radians(np.linspace(35, 275, 19))  # of the bowl, from its top over the bend to the tip
    bowl = [(0.27 * h * np.sin(a), 0, 0.345 * h + 0.27 * h * np.cos(a)) for a in bend]
    path = np.array([(0, 0, 0.84 * h), (0.02 * h, 0, 0.72 * h), (0.09 * h, 0, 0.63 * h)] + bowl)
    thick = np.r_[0.05, 0.05, 0.05, 0.05 + 0.02 * np.sin(np.linspace(0, np.pi, 14)), np.linspace(0.05, 0.012, 5)] * h
    eye = moved(torus(0.1 * h, 0.035 * h, 32, 12), (0, 0, 0.87 * h), rotation(roll=90))
    body = tube(path, thick, 14) + eye
    if not p["upright"]:
        body = moved(body, turn=rotation(roll=90))
    return Model([(body, solid(p["matter"], p["surface"]))])


@thing(
    "valve",
    "a gate valve of a pipe: body with flanges, bonnet, spindle and handwheel",
    Number("bore_m", 0.05, "inner diameter of its pipe", 0.01, 0.8),
    Choice("matter", "painted_metal", "", ("painted_metal", "cast_iron", "bronze", "steel")),
    Switch("upright", "false", "stands on its body instead of lying on its side"),
)
def valve(rng, p):
    d = p["bore_m"]
    metal = [cylinder(0.72 * d, 2.6 * d, axis="x"), ball(0.95 * d), cylinder(0.6 * d, 1.8 * d, (0, 0, 0.9 * d))]
    metal += [cylinder(1.5 * d, 0.3 * d, (s * 1.3 * d, 0, 0), "x") for s in (-1, 1)]
    metal += [cylinder(0.95 * d, 0.25 * d, (0, 0, 1.25 * d)), cylinder(0.16 * d, 2.2 * d, (0, 0, 2.5 * d))]
    body = union(metal) - cylinder(d / 2, 3.2 * d, axis="x")
    top = np.array([0, 0, 3.45 * d])
    wheel = [moved(torus(1.1 * d, 0.12 * d, 40, 10), top), cylinder(0.25 * d, 0.3 * d, top)]
    wheel += [
        bar(top, top + 1.1 * d * np.array([np.cos(a), np.sin(a), 0]), 0.09 * d) for a in np.arange(4) * math.pi / 2
    ]
    body = union([body, *wheel])
    body = moved(body, (0, 0, 1.5 * d)) if p["upright"] else moved(body, turn=rotation(roll=90))
    return Model([(body, solid(p["matter"], p["surface"]))])


@thing(
    "propeller",
    "a ship's propeller of bronze, which lies on a side",
    Number("diameter_m", 1.2, "", 0.2, 9),
    Number("blades", 4, "", 2, 7, whole=True),
    Number("pitch", 0.8, "over its diameter", 0.4, 1.6),
)
def propeller(rng, p):
    r = p["diameter_m"] / 2
    one = blade(r, p["pitch"], rng.uniform(0.5, 0.7), rng.uniform(0, 0.3))
    blades = [moved(one, turn=rotation(yaw=360 * i / p["blades"])) for i in range(p["blades"])]
    hub = revolved(
        [
            (0, -0.28 * r),
            (0.14 * r, -0.28 * r),
            (0.2 * r, -0.2 * r),
            (0.2 * r, 0.2 * r),
            (0.1 * r, 0.36 * r),
            (0, 0.4 * r),
        ],
        40,
    )
    return Model([(union([hub, *blades]), solid("bronze", p["surface"]))])


def twine(points, radius):
    return tube(points, radius, 4)


@thing(
    "net",
    "a trawl net that lies in folds, of knotted twine with floats along its head rope",
    Number("length_m", 5.0, "along the head rope", 0.5, 30),
    Number("width_m", 3.0, "", 0.5, 20),
    Number("mesh_m", 0.2, "between two knots", 0.03, 1),
    Number("twine_mm", 4, "diameter of the twine", 1, 20),
    Number("folds_m", 0.35, "height of its folds", 0.02, 3),
)
def net(rng, p):
    columns = max(3, min(120, int(p["length_m"] / p["mesh_m"])))
    rows = max(3, min(80, int(p["width_m"] / p["mesh_m"])))
    u, v = np.meshgrid(
        np.arange(columns) * p["length_m"] / (columns - 1), np.arange(rows) * p["width_m"] / (rows - 1), indexing="ij"
    )
    fold = np.zeros_like(u)
    for length in (2.4, 1.3, 0.8):
        heading, phase = rng.uniform(0, 2 * np.pi, 2)
        fold += length * np.sin(2 * np.pi * (u * np.cos(heading) + v * np.sin(heading)) / length + phase)
    fold = (fold - fold.min()) / np.ptp(fold)
    x = u - p["length_m"] / 2 + 0.12 * p["mesh_m"] * rng.standard_normal(u.shape)
    y = v - p["width_m"] / 2 + 0.12 * p["mesh_m"] * rng.standard_normal(u.shape)
    points = np.stack([x, y, 0.02 + p["folds_m"] * fold**1.5], -1)
    r = p["twine_mm"] / 2000
    lines = [twine(points[i], r) for i in range(columns)] + [twine(points[:, j], r) for j in range(1, rows)]
    knots = [box((3.2 * r, 3.2 * r, 3.2 * r), points[i, j]) for i in range(0, columns) for j in range(1, rows)]
    head = points[:, 0] + (0, 0, 0.04)
    floats = [ball(0.07, head[i] + (0, 0, 0.03), 16) for i in range(1, columns, max(1, columns // 7))]
    return Model(
        [
            *((each, solid("net", p["surface"])) for each in lines + knots),
            (tube(head, 3 * r, 6), solid("rope", p["surface"])),
            (union(floats), solid("closed_cell_foam", "clean")),
        ]
    )


@thing(
    "lobster_pot",
    "a pot of a steel frame and netting with an entrance, a hand line of rope next to it",
    Number("length_m", 0.9, "", 0.3, 2),
    Number("mesh_m", 0.06, "between two knots", 0.03, 0.3),
)
def lobster_pot(rng, p):
    n, w, h = p["length_m"], 0.62 * p["length_m"], 0.5 * p["length_m"]
    arch = np.array(
        [
            (0, y * w / 2, z * h)
            for y, z in [(-1, 0), (-1, 0.35)]
            + [(-np.cos(a), 0.35 + 0.65 * np.sin(a)) for a in np.linspace(0.2, np.pi - 0.2, 11)]
            + [(1, 0.35), (1, 0)]
        ]
    )
    bar_r = 0.012 * n / 0.9
    frame = [tube(arch + (x * n / 2, 0, 0), bar_r, 8) for x in (-1, 0, 1)]
    frame += [bar((x * n / 2, -w / 2, 0), (x * n / 2, w / 2, 0), bar_r) for x in (-1, 0, 1)]
    frame += [bar((-n / 2, *arch[i, 1:]), (n / 2, *arch[i, 1:]), bar_r) for i in (0, 1, 7, 13, 14)]
    skin = along(arch, p["mesh_m"])
    r = 0.0015
    mesh = [twine([(-n / 2, *each[1:]), (n / 2, *each[1:])], r) for each in skin]
    mesh += [twine(skin + (x, 0, 0), r) for x in np.arange(-n / 2, n / 2 + 1e-6, p["mesh_m"])]
    mesh += [
        twine([(x * n / 2, y, 0), (x * n / 2, y, h * (0.35 + 0.65 * math.sqrt(max(0, 1 - (2 * y / w) ** 2))))], r)
        for x in (-1, 1)
        for y in np.arange(-w / 2 + p["mesh_m"] / 2, w / 2, p["mesh_m"])
    ]
    mesh += [
        twine([(x * n / 2, -w / 2, z), (x * n / 2, w / 2, z)], r)
        for x in (-1, 1)
        for z in np.arange(p["mesh_m"], 0.6 * h, p["mesh_m"])
    ]
    entrance = moved(torus(0.16 * n, bar_r, 24, 8), (0, w * 0.32, 0.55 * h), rotation(roll=70))
    floor = box((n, w, 0.02), (0, 0, 0.01))
    return Model(
        [
            (union(frame + [entrance]), solid("carbon_steel", p["surface"])),
            *((each, solid("net", p["surface"])) for each in mesh),
            (floor, solid("wood", p["surface"])),
        ]
    )


@thing(
    "tripod",
    "an instrument frame of three legs with feet and a housing",
    Number("tall_m", 1.6, "", 0.5, 5),
    Number("spread_m", 2.0, "diameter of the circle of its feet", 0.5, 6),
)
def tripod(rng, p):
    h, r = p["tall_m"], p["spread_m"] / 2
    feet = [np.array([math.cos(a), math.sin(a), 0]) * r for a in np.arange(3) * 2 * np.pi / 3]
    top = [foot * 0.25 + (0, 0, h * 0.8) for foot in feet]
    metal = [bar(foot + (0, 0, 0.05), head, 0.03, 12) for foot, head in zip(feet, top)]
    metal += [cylinder(0.16, 0.05, foot + (0, 0, 0.025), sides=24) for foot in feet]
    middle = [foot * 0.62 + (0, 0, h * 0.41) for foot in feet]
    for ring, radius in ((middle, 0.02), (top, 0.025)):
        metal += [bar(ring[i], ring[(i + 1) % 3], radius, 10) for i in range(3)]
    housing = cylinder(0.1, 0.7 * h, (0, 0, 0.65 * h), sides=32)
    return Model(
        [(union(metal), solid("aluminium", p["surface"])), (housing, wall("aluminium", 8, "air", p["surface"]))]
    )


@thing(
    "fish_cage_ring",
    "a ring of HDPE pipe with a hanging net, of a small cage that sank",
    Number("diameter_m", 4.0, "", 1, 40),
    Number("pipe_m", 0.2, "diameter of its pipe", 0.05, 0.6),
)
def fish_cage_ring(rng, p):
    r, t = p["diameter_m"] / 2, p["pipe_m"] / 2
    rings = [torus(r - s * 1.6 * t, t, 96, 16).translate((0, 0, t)) for s in (0, 2)]
    posts = [
        bar((r * math.cos(a), r * math.sin(a), t), ((r - 0.1) * math.cos(a), (r - 0.1) * math.sin(a), 1.0), 0.4 * t, 8)
        for a in np.arange(12) * np.pi / 6
    ]
    rail = torus(r - 0.1, 0.4 * t, 96, 10).translate((0, 0, 1.0))
    clamps = [
        moved(box((0.3 + 6 * t, 0.15, 2.6 * t), ((r - 1.6 * t), 0, t)), turn=rotation(yaw=30 * i)) for i in range(12)
    ]
    return Model([(union(rings + posts + [rail] + clamps), solid("hdpe", p["surface"]))])
