"""Structures: quays, piles, jetties, tanks, blocks, and stones."""

import math

import numpy as np

from ..floor import boulder
from ..materials import solid
from ..parameters import Choice, Number, Switch
from ..shapes import ball, bar, box, cylinder, hull, moved, rotation, torus, tube, union
from .catalogue import Model, thing

FOOT = 1.5  # how far structures go below the mean floor [m]


def rectangle(x0, x1, y0, y1):
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], float)


@thing(
    "quay",
    "a wall of concrete panels with a cap, steel piles, rubber fenders and a ladder; its face looks along -y",
    Number("length_m", 20.0, "", 2, 500),
    Number("freeboard_m", 2.0, "above the water", 0, 10),
    Number("panel_m", 4.0, "width of a panel", 0.5, 20),
    Number("piles_m", 6.0, "between two piles; 0: none", 0, 100),
    Number("pile_diameter_m", 0.6, "", 0.1, 3),
    Number("fenders_m", 12.0, "between two fenders; 0: none", 0, 100),
    Switch("ladder", "true", "at its middle"),
    kind="structure",
)
def quay(rng, p, depth):
    n, top, low, s = p["length_m"], p["freeboard_m"], -depth - FOOT, p["surface"]
    tall = top - low
    solids = [box((n, 1.0, tall), (0, 0.8, low + tall / 2)), box((n, 1.9, 0.8), (0, 0.65, top + 0.2))]
    count = max(1, int(round(n / p["panel_m"])))
    width, rows = n / count, max(1, int(round(tall / 2.5)))
    for i in range(count):
        for row in range(rows):
            back = rng.uniform(0, 0.05)
            solids.append(
                box(
                    (width - 0.1, 0.4, tall / rows - 0.1),
                    (-n / 2 + (i + 0.5) * width, 0.2 + back, low + (row + 0.5) * tall / rows),
                )
            )
    parts, steel = [(union(solids), solid("concrete", s))], []
    outlines = [rectangle(-n / 2, n / 2, 0, 1.6)]
    r = p["pile_diameter_m"] / 2
    if p["piles_m"] > 0:
        for x in np.arange(-n / 2 + min(p["piles_m"], n) / 2, n / 2, p["piles_m"]):
            steel.append(cylinder(r, tall, (x, -1.2 - r, low + tall / 2), sides=28))
            outlines.append(rectangle(x - r, x + r, -1.2 - 2 * r, -1.2))
    if p["ladder"]:
        foot = max(low + FOOT + 0.3, top - 12)
        steel += [bar((x, -0.3, foot), (x, -0.3, top + 0.6), 0.035) for x in (-0.25, 0.25)]
        steel += [bar((-0.25, -0.3, z), (0.25, -0.3, z), 0.015, 6) for z in np.arange(foot + 0.15, top + 0.5, 0.3)]
        steel += [
            bar((x, -0.3, z), (x, 0.1, z), 0.025, 6) for x in (-0.25, 0.25) for z in np.arange(foot + 0.4, top, 2.2)
        ]
        outlines.append(rectangle(-0.3, 0.3, -0.35, 0))
    if steel:
        parts.append((union(steel), solid("carbon_steel", s)))
    if p["fenders_m"] > 0:
        # Piles have their places; a fender is half a pile's distance from the nearest.
        places = np.arange(-n / 2 + min(p["fenders_m"], n) / 4, n / 2, p["fenders_m"])
        fenders = [
            cylinder(0.4, min(6.0, depth), (x, -0.42, -min(6.0, depth) / 2 + 0.5), sides=28)
            for x in places
            if abs(x) > 0.8
        ]
        outlines += [rectangle(x - 0.4, x + 0.4, -0.82, 0) for x in places if abs(x) > 0.8]
        if fenders:
            parts.append((union(fenders), solid("rubber", s)))
    return Model(parts, outlines)


@thing(
    "pile",
    "a single pile from the floor to above the water",
    Number("diameter_m", 0.5, "", 0.05, 5),
    Number("freeboard_m", 1.5, "above the water", -100, 20),
    Number("lean_deg", 0.0, "from the vertical", 0, 30),
    Choice("material", "wood", "", ("wood", "carbon_steel", "concrete")),
    kind="structure",
)
def pile(rng, p, depth):
    top, low = max(p["freeboard_m"], -depth + 0.5), -depth - FOOT
    lean = math.tan(math.radians(p["lean_deg"]))
    r = p["diameter_m"] / 2
    body = tube([(lean * (low + depth), 0, low), (lean * (top + depth), 0, top)], r, 28)
    return Model([(body, solid(p["material"], p["surface"]))])


@thing(
    "jetty",
    "a deck on rows of piles with bracing",
    Number("length_m", 12.0, "", 2, 300),
    Number("width_m", 3.0, "", 1, 50),
    Number("freeboard_m", 1.5, "of its deck above the water", 0.3, 10),
    Number("bay_m", 3.0, "between two rows of piles", 1, 30),
    Number("pile_diameter_m", 0.35, "", 0.1, 2),
    kind="structure",
)
def jetty(rng, p, depth):
    n, w, low, top, r = p["length_m"], p["width_m"], -depth - FOOT, p["freeboard_m"], p["pile_diameter_m"] / 2
    rows = np.linspace(-n / 2 + r, n / 2 - r, max(2, int(round(n / p["bay_m"])) + 1))
    solids, outlines = [], []
    for x in rows:
        for y in (-1, 1):
            y = y * (w / 2 - r)
            solids.append(cylinder(r, top - low, (x, y, (top + low) / 2), sides=24))
            outlines.append(rectangle(x - r, x + r, y - r, y + r))
        brace = min(3.0, depth + top - 0.5)
        for side in (-1, 1):
            aside = x + side * 0.3 * r
            solids.append(
                bar((aside, side * (w / 2 - r), top - brace), (aside, -side * (w / 2 - r), top - 0.2), 0.4 * r, 8)
            )
    solids.append(box((n, w, 0.25), (0, 0, top + 0.125)))
    return Model([(union(solids), solid("wood", p["surface"]))], outlines)


@thing(
    "tank",
    "four walls of a test basin from the floor to above the water; things may be placed within",
    Number("length_m", 12.0, "inside, along x", 1, 200),
    Number("width_m", 8.0, "inside, along y", 1, 200),
    Number("wall_m", 0.3, "thickness", 0.02, 3),
    Number("freeboard_m", 0.5, "above the water", 0, 5),
    Choice("material", "concrete", "", ("concrete", "steel", "fibreglass")),
    kind="structure",
)
def tank(rng, p, depth):
    x, y, t, low, top = p["length_m"] / 2, p["width_m"] / 2, p["wall_m"], -depth - FOOT, p["freeboard_m"]
    walls = box((2 * x + 2 * t, 2 * y + 2 * t, top - low), (0, 0, (top + low) / 2)) - box(
        (2 * x, 2 * y, 2 * (top - low)), (0, 0, (top + low) / 2)
    )
    outlines = [rectangle(-x - t, x + t, s * (y + t / 2) - t / 2, s * (y + t / 2) + t / 2) for s in (-1, 1)]
    outlines += [rectangle(s * (x + t / 2) - t / 2, s * (x + t / 2) + t / 2, -y, y) for s in (-1, 1)]
    return Model([(walls, solid(p["material"], "clean" if p["surface"] == "weathered" else p["surface"]))], outlines)


@thing(
    "concrete_block",
    "a building block with two hollows",
    Number("length_m", 0.39, "", 0.1, 3),
    Number("width_m", 0.19, "", 0.05, 2),
    Number("tall_m", 0.19, "", 0.05, 2),
)
def concrete_block(rng, p):
    x, y, z = p["length_m"], p["width_m"], p["tall_m"]
    hollow = [box((0.37 * x, 0.64 * y, 2 * z), (s * 0.23 * x, 0, z / 2)) for s in (-1, 1)]
    return Model([(box((x, y, z), (0, 0, z / 2)) - union(hollow), solid("concrete", p["surface"]))])


@thing("sinker", "a mooring sinker of concrete with its eye of steel", Number("side_m", 1.2, "", 0.3, 4))
def sinker(rng, p):
    n = p["side_m"]
    a, b = n / 2, 0.42 * n
    body = hull(
        [(x * a, y * a, 0) for x in (-1, 1) for y in (-1, 1)]
        + [(x * b, y * b, 0.55 * n) for x in (-1, 1) for y in (-1, 1)]
    )
    eye = moved(torus(0.12 * n, 0.025 * n, 28, 10), (0, 0, 0.62 * n), rotation(roll=90))
    return Model([(body, solid("concrete", p["surface"])), (eye, solid("carbon_steel", p["surface"]))])


@thing("tetrapod", "an armour block of a breakwater: four legs of concrete", Number("tall_m", 2.0, "", 0.4, 5))
def tetrapod(rng, p):
    n = 0.62 * p["tall_m"]
    directions = [np.array([0, 0, 1.0])] + [
        np.array([math.cos(a) * 0.943, math.sin(a) * 0.943, -1 / 3]) for a in np.arange(3) * 2 * np.pi / 3
    ]
    legs = [tube([(0, 0, 0), each * n], np.array([0.36, 0.24]) * n, 24) for each in directions]
    return Model([(union([*legs, ball(0.37 * n, sides=24)]), solid("concrete", p["surface"]))])


@thing(
    "reef_ball",
    "a hollow dome of concrete with round holes, an artificial reef",
    Number("diameter_m", 1.5, "of its foot", 0.4, 3),
    Number("holes", 18, "", 4, 60, whole=True),
)
def reef_ball(rng, p):
    r = p["diameter_m"] / 2
    dome = ball(r, (0, 0, 0.45 * r), 56) - ball(0.84 * r, (0, 0, 0.45 * r), 56) - box((4 * r, 4 * r, 2 * r), (0, 0, -r))
    dome -= cylinder(0.3 * r, r, (0, 0, 1.4 * r), sides=32)
    holes = []
    for i in range(p["holes"]):
        angle, up = i * 2.399963, math.asin(0.02 + 0.75 * (i + 0.5) / p["holes"])
        out = np.array([math.cos(angle) * math.cos(up), math.sin(angle) * math.cos(up), math.sin(up)])
        hole = rng.uniform(0.11, 0.2) * r
        holes.append(tube([out * 0.6 * r + (0, 0, 0.3 * r), out * 1.3 * r + (0, 0, 0.3 * r)], hole, 20))
    return Model([(dome - union(holes), solid("concrete", p["surface"]))])


@thing(
    "stone",
    "a boulder of random shape",
    Number("diameter_m", 0.8, "", 0.05, 10),
    Choice("material", "rock", "", ("rock", "granite", "limestone")),
)
def stone(rng, p):
    scale = rng.uniform(0.8, 1.2, 3) * p["diameter_m"]
    body = moved(boulder(rng, 24), turn=rotation(*rng.uniform(-180, 180, 3)) * scale)
    return Model([(body, solid(p["material"], p["surface"]))])


@thing(
    "ball",
    "a ball of one matter, to test with",
    Number("diameter_m", 0.3, "", 0.01, 5),
    Choice("material", "steel", "", ("steel", "aluminium", "bronze", "glass", "granite", "concrete", "pvc", "rubber")),
)
def plain_ball(rng, p):
    return Model([(ball(p["diameter_m"] / 2, sides=64), solid(p["material"], p["surface"]))])
