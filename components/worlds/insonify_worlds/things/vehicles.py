"""Wrecks and boats, vehicles, containers and divers."""

import math

import numpy as np

from ..materials import solid, wall
from ..parameters import Choice, Number, Switch
from ..shapes import (
    ball,
    bar,
    box,
    cylinder,
    extruded,
    hull,
    loft,
    moved,
    revolved,
    rotation,
    tube,
    union,
)
from .catalogue import Model, thing


def hull_rings(length, beam, depth, sheer, fullness=0.5, stations=25, sides=20):
    """Sections from stern to bow: deck edge, bilge, keel. The deck is flat, the keel near z = 0."""
    s = np.linspace(-1, 1, stations)
    half = beam / 2 * np.clip(np.where(s > 0, 1 - np.abs(s) ** 2.4, 1 - 0.22 * s**4), 0.02, None)
    draught = depth * np.where(s > 0, 1 - 0.3 * s**4, 1 - 0.25 * s**6)
    angle = np.linspace(np.pi, 2 * np.pi, sides)  # starboard deck edge, keel, port deck edge
    across = np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** fullness
    down = -(np.abs(np.sin(angle)) ** 0.6)
    rake = np.where(s > 0, 0.12 * length * s**4, 0)
    rings = []
    for at, b, d, h, lean in zip(s, half, draught, sheer * s**2, rake):
        z = depth + h + d * down
        x = 0.44 * length * at + lean * (z / depth - 0.35)
        rings.append(np.stack([x, b * across, z], 1))
    return rings


def scaled(rings, share, lift):
    """The rings of a hold: inside the hull's rings and above their keel."""
    middle = np.mean(np.vstack(rings), 0) * (1, 0, 0)
    return [(ring - middle) * (share, share, 1) + middle + (0, 0, lift) for ring in rings]


@thing(
    "wreck",
    "a ship of steel plates on the floor: hull with open holds, coamings, deckhouse, mast, perhaps a torn side",
    Number("length_m", 12.0, "", 4, 120),
    Number("beam_share", 0.27, "beam over length", 0.12, 0.45),
    Number("plate_mm", 8, "", 1, 60),
    Number("list_deg", 15.0, "to starboard", -180, 180),
    Switch("torn", "true", "has a hole in its side"),
)
def wreck(rng, p):
    n, s = p["length_m"], p["surface"]
    beam, depth = n * p["beam_share"], n * p["beam_share"] * 0.55
    rings = hull_rings(n, beam, depth, 0.05 * n)
    body = loft(rings)
    # Holds are open to the water. Walls with the thickness of plates are too thin for triangles, so the hold's sides
    # represent them.
    for x0, x1 in ((-0.02, 0.16), (0.2, 0.34)):
        hold = box(((x1 - x0) * n, 0.6 * beam, depth), ((x0 + x1) / 2 * n, 0, 0.75 * depth))
        body -= hold
        coaming = box(
            ((x1 - x0) * n + 0.03 * n, 0.6 * beam + 0.03 * n, 0.09 * depth + 0.02 * n),
            ((x0 + x1) / 2 * n, 0, depth + 0.03 * depth),
        )
        body += coaming - hold.translate((0, 0, 0.2 * depth)).scale((1, 1, 1))
    house = [
        box((0.2 * n, 0.62 * beam, 0.14 * n), (-0.27 * n, 0, depth + 0.07 * n)),
        box((0.1 * n, 0.5 * beam, 0.08 * n), (-0.25 * n, 0, depth + 0.18 * n)),
        cylinder(0.03 * n, 0.12 * n, (-0.33 * n, 0, depth + 0.19 * n), sides=24),
        box((0.4 * n, 0.02 * n, 0.05 * depth), (-0.25 * n, 0.47 * beam, depth + 0.08 * depth)),
        box((0.4 * n, 0.02 * n, 0.05 * depth), (-0.25 * n, -0.47 * beam, depth + 0.08 * depth)),
    ]
    body = union([body, *house])
    if p["torn"]:
        at, side = rng.uniform(-0.1, 0.25) * n, rng.choice([-1, 1])
        points = rng.normal(0, 1, (14, 3)) * (0.05 * n, 0.1 * n, 0.1 * depth) + (at, side * 0.5 * beam, 0.6 * depth)
        body -= hull(points)
    mast = tube([(0.18 * n, 0, depth), (0.18 * n, 0, depth + 0.32 * n)], np.array([0.012, 0.008]) * n, 12)
    boom = bar((0.18 * n, 0, depth + 0.06 * n), (0.0, 0.18 * beam, depth + 0.18 * n), 0.006 * n)
    turn = rotation(roll=p["list_deg"])
    return Model(
        [
            (moved(body, turn=turn), wall("carbon_steel", p["plate_mm"], "water", s)),
            (moved(mast + boom, turn=turn), solid("carbon_steel", s)),
        ]
    )


@thing(
    "boat",
    "an open boat of wood or fibreglass with thwarts",
    Number("length_m", 4.2, "", 1.5, 15),
    Choice("material", "wood", "", ("wood", "fibreglass", "aluminium")),
    Switch("capsized", "false", "lies keel up"),
)
def boat(rng, p):
    n = p["length_m"]
    beam, depth = 0.36 * n, 0.14 * n
    outside = loft(hull_rings(n, beam, depth, 0.06 * n, 0.6))
    inside = loft(scaled(hull_rings(n, beam, depth, 0.06 * n, 0.6), 0.95, 0.025 * n))
    body = outside - inside - box((2 * n, 2 * n, 0.1 * n), (0, 0, 2 * depth + 0.03 * n))
    thwarts = [box((0.06 * n, 0.9 * beam, 0.012 * n), (x * n, 0, 0.72 * depth)) ^ outside for x in (-0.25, 0.02, 0.22)]
    body = union([body, *thwarts, box((0.8 * n, 0.02 * n, 0.02 * n), (-0.03 * n, 0, -0.002 * n))])
    if p["capsized"]:
        body = moved(body, turn=rotation(roll=180))
    else:
        body = moved(body, turn=rotation(roll=14))
    return Model([(body, solid(p["material"], p["surface"]))])


@thing(
    "container",
    "a shipping container of 20 feet: corrugated steel walls, doors, castings",
    Number("length_m", 6.06, "", 2, 14),
    Number("width_m", 2.44, "", 1, 4),
    Number("tall_m", 2.59, "", 1, 4),
    Number("plate_mm", 2, "", 0.5, 20),
)
def container(rng, p):
    x, y, z = p["length_m"], p["width_m"], p["tall_m"]
    ridges = max(4, int(x / 0.28))
    inside = box((x - 0.08, y - 0.08, z - 0.08), (0, 0, z / 2))
    corrugations = []
    for i in range(ridges):
        at = -x / 2 + 0.15 + (i + 0.5) * (x - 0.3) / ridges
        corrugations += [
            box((0.5 * (x - 0.3) / ridges, 0.04, z - 0.3), (at, s * (y / 2 - 0.02), z / 2)) for s in (-1, 1)
        ]
        corrugations.append(box((0.5 * (x - 0.3) / ridges, y - 0.3, 0.03), (at, 0, z - 0.03)))
    beams = [
        box((0.12, 0.12, z), (sx * (x / 2 - 0.06), sy * (y / 2 - 0.06), z / 2)) for sx in (-1, 1) for sy in (-1, 1)
    ]
    beams += [box((x, 0.12, 0.12), (0, sy * (y / 2 - 0.06), at)) for sy in (-1, 1) for at in (0.06, z - 0.06)]
    beams += [box((0.12, y, 0.12), (sx * (x / 2 - 0.06), 0, at)) for sx in (-1, 1) for at in (0.06, z - 0.06)]
    doors = [cylinder(0.02, z - 0.2, (x / 2 + 0.0, s * y, z / 2), sides=10) for s in (-0.4, -0.1, 0.1, 0.4)]
    doors += [box((0.03, 0.48 * y - 0.1, z - 0.3), (x / 2 - 0.03, s * 0.24 * y, z / 2)) for s in (-1, 1)]
    return Model(
        [(union([inside, *corrugations, *beams, *doors]), wall("carbon_steel", p["plate_mm"], "water", p["surface"]))]
    )


@thing("car", "a car of steel sheet on its wheels, its body full of water", Number("length_m", 4.2, "", 2, 8))
def car(rng, p):
    n = p["length_m"]
    side = (
        np.array(
            [
                (-0.5, 0.07),
                (0.5, 0.07),
                (0.5, 0.15),
                (0.47, 0.19),
                (0.24, 0.225),
                (0.09, 0.335),
                (-0.28, 0.345),
                (-0.43, 0.235),
                (-0.5, 0.22),
            ]
        )
        * n
    )
    width = 0.41 * n
    body = moved(extruded(side, width), (0, width / 2, 0), rotation(roll=90))

    def narrower(points):
        points = np.array(points)
        high = np.clip((points[:, 2] - 0.22 * n) / (0.12 * n), 0, 1)
        points[:, 1] *= 1 - 0.18 * high
        return points

    body = body.refine(3).warp_batch(narrower)
    wheels = []
    for x in (-0.31, 0.3):
        for s in (-1, 1):
            body -= cylinder(0.088 * n, 0.08 * n, (x * n, s * 0.19 * n, 0.078 * n), "y", 32)
            wheels.append(cylinder(0.078 * n, 0.05 * n, (x * n, s * 0.18 * n, 0.078 * n), "y", 40))
    body += union([cylinder(0.015 * n, 0.36 * n, (x * n, 0, 0.078 * n), "y", 12) for x in (-0.31, 0.3)])
    return Model(
        [(body, wall("carbon_steel", 0.8, "water", p["surface"])), (union(wheels), solid("rubber", p["surface"]))]
    )


@thing(
    "auv",
    "a torpedo-shaped vehicle with fins, antenna and propeller",
    Number("diameter_m", 0.2, "", 0.08, 1.5),
    Number("length_m", 1.7, "", 0.5, 8),
    Number("wall_mm", 6, "", 1, 60),
)
def auv(rng, p):
    r, n, s = p["diameter_m"] / 2, p["length_m"], p["surface"]
    nose, tail = 1.6 * r, 4.5 * r
    profile = [(0, 0)] + [(r * math.sin(a), nose * (1 - math.cos(a))) for a in np.linspace(0.25, np.pi / 2, 7)]
    profile += (
        [(r, n - tail)] + [(r * (1 - 0.8 * t**1.5), n - tail + tail * t) for t in np.linspace(0.15, 1, 6)] + [(0, n)]
    )
    body = moved(revolved(profile, 40), (n / 2, 0, 0), rotation(pitch=-90))
    fins = [
        moved(box((0.9 * r, 0.012, 1.3 * r), (-n / 2 + 0.35 * tail, 0, 0.95 * r)), turn=rotation(roll=90 * i))
        for i in range(4)
    ]
    blades = [
        moved(box((0.006, 0.25 * r, 0.8 * r), (-n / 2 - 0.1 * r, 0, 0.45 * r)), turn=rotation(roll=120 * i))
        for i in range(3)
    ]
    mast = box((0.5 * r, 0.02, 1.2 * r), (0.1 * n, 0, 1.4 * r))
    transducer = cylinder(0.35 * r, 0.3 * r, (0.28 * n, 0, -r), sides=20)
    return Model(
        [
            (moved(body, (0, 0, r)), wall("aluminium", p["wall_mm"], "air", s)),
            (moved(union([*fins, *blades, mast, transducer]), (0, 0, r)), solid("pvc", s)),
        ]
    )


@thing("diver", "a diver who swims, with a cylinder and fins", Number("tall_m", 1.8, "of the diver", 1.4, 2.1))
def diver(rng, p):
    k = p["tall_m"] / 1.8
    body = [
        ball(0.115, (0.8, 0, 0.12), 24),
        tube(
            [(0.68, 0, 0.05), (0.55, 0, 0.04), (0.3, 0, 0.02), (0.05, 0, 0), (-0.12, 0, 0)],
            np.array([0.07, 0.17, 0.15, 0.145, 0.14]),
            20,
        ),
    ]
    for side in (-1, 1):
        knee = np.array([-0.55, side * 0.12, -0.1 * side])
        ankle = np.array([-1.0, side * 0.13, 0.06 + 0.08 * side])
        body += [tube([(-0.08, side * 0.09, 0), knee, ankle], np.array([0.09, 0.065, 0.045]), 14)]
        elbow, hand = np.array([0.55, side * 0.32, -0.12]), np.array([0.85, side * 0.2, -0.18])
        body += [
            tube([(0.56, side * 0.17, 0.03), elbow, hand], np.array([0.06, 0.045, 0.04]), 12),
            ball(0.05, hand, 12),
        ]
    fins = [
        hull(
            [
                (-0.98, s * 0.13 - 0.05, 0.05 + 0.08 * s),
                (-0.98, s * 0.13 + 0.05, 0.05 + 0.08 * s),
                (-1.55, s * 0.13 - 0.11, 0.0 + 0.08 * s),
                (-1.55, s * 0.13 + 0.11, 0.08 * s),
                (-0.98, s * 0.13, 0.1 + 0.08 * s),
                (-1.55, s * 0.13, 0.015 + 0.08 * s),
            ]
        )
        for s in (-1, 1)
    ]
    tank = moved(
        revolved(
            [(0, 0), (0.085, 0), (0.09, 0.03), (0.09, 0.5), (0.06, 0.57), (0.025, 0.59), (0.025, 0.66), (0, 0.66)], 28
        ),
        (-0.02, 0, 0.25),
        rotation(pitch=90),
    )

    def grown(solid_):
        return solid_.scale((k, k, k)).translate((0, 0, 0.3 * k))

    return Model(
        [
            (grown(union(body)), solid("human_body")),
            (grown(union(fins)), solid("rubber", "clean")),
            (grown(tank), wall("aluminium", 11, "air", "clean")),
        ]
    )


@thing("rov", "an observation vehicle: frame, float, housings and thrusters", Number("length_m", 0.7, "", 0.3, 3))
def rov(rng, p):
    n = p["length_m"]
    w, h, s = 0.75 * n, 0.6 * n, p["surface"]
    plates = []
    for side in (-1, 1):
        plate = (
            box((n, 0.03 * n, h), (0, side * w / 2, h / 2))
            - box((0.34 * n, n, 0.4 * h), (-0.24 * n, side * w / 2, 0.4 * h))
            - box((0.34 * n, n, 0.4 * h), (0.24 * n, side * w / 2, 0.4 * h))
        )
        plates.append(plate)
    plates += [box((0.04 * n, w, 0.05 * n), (x * n, 0, z * h)) for x in (-0.4, 0, 0.4) for z in (0.08, 0.7)]
    float_block = box((0.96 * n, 0.93 * w, 0.26 * h), (0, 0, 0.9 * h))
    for x in (-0.25, 0.25):
        float_block -= cylinder(0.12 * n, n, (x * n, 0, 0.9 * h), sides=28)
    housing = [cylinder(0.11 * n, 0.7 * n, (0, 0, 0.4 * h), "x", 32) + ball(0.11 * n, (0.35 * n, 0, 0.4 * h), 28)]
    thrusters = []
    for x in (-1, 1):
        for y in (-1, 1):
            at = (x * 0.36 * n, y * 0.3 * w, 0.3 * h)
            ring = revolved(
                [(0.07 * n, -0.04 * n), (0.085 * n, -0.04 * n), (0.085 * n, 0.04 * n), (0.07 * n, 0.04 * n)], 28
            )
            thrusters.append(moved(ring, at, rotation(yaw=45 * x * y) @ rotation(pitch=90)))
            thrusters.append(
                moved(cylinder(0.025 * n, 0.14 * n, sides=14), at, rotation(yaw=45 * x * y) @ rotation(pitch=90))
            )
    return Model(
        [
            (union(plates + thrusters), solid("hdpe", s)),
            (float_block, solid("closed_cell_foam", "clean")),
            (union(housing), wall("aluminium", 4, "air", s)),
        ]
    )
