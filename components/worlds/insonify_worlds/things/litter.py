"""Things that were thrown away or lost: tires, cans, bottles, cartons, barrels, crates, bicycles."""

import numpy as np

from ..materials import solid, wall
from ..parameters import Choice, Number, Switch
from ..shapes import bar, box, cylinder, hull, moved, revolved, rotation, torus, tube, union
from .catalogue import Model, thing


@thing(
    "tire",
    "a tire of a car or lorry: hollow, open towards its middle",
    Number("diameter_m", 0.63, "over the tread", 0.06, 4),
    Number("width_m", 0.2, "of the tread", 0.015, 1.5),
    Number("rim_share", 0.6, "diameter of the opening over that of the tread", 0.4, 0.8),
    Switch("upright", "false", "stands on its tread instead of lying on a side"),
)
def tire(rng, p):
    outer, half = p["diameter_m"] / 2, p["width_m"] / 2
    inner, skin = outer * p["rim_share"], min(0.06 * p["diameter_m"] / 2, 0.4 * half)
    tall = outer - inner
    outside = [
        (inner, 0.62),
        (inner + 0.35 * tall, 0.96),
        (inner + 0.6 * tall, 1.0),
        (outer - 0.12 * tall, 0.86),
        (outer, 0.7),
    ]
    profile = [(r, z * half) for r, z in outside] + [(r, -z * half) for r, z in reversed(outside)]
    # The hollow is the outside offset inwards, open between the beads.
    inside = [
        (inner - min(0.01, 0.2 * inner), 0.62 * half - skin),
        (inner + 0.35 * tall, 0.96 * half - skin),
        (outer - 1.5 * skin, 0.8 * half - skin),
    ]
    hollow = [(r, z) for r, z in inside] + [(r, -z) for r, z in reversed(inside)]
    body = revolved(profile, 64) - revolved(hollow, 64)
    if p["upright"]:
        body = moved(body, (0, 0, outer), rotation(roll=90))
    return Model([(body, solid("rubber", p["surface"]))])


@thing(
    "can",
    "a drink can with its neck and hollow bottom, full of water",
    Number("diameter_m", 0.066, "", 0.04, 0.3),
    Number("length_m", 0.115, "", 0.05, 0.5),
    Number("wall_mm", 0.1, "of aluminium", 0.05, 5),
    Choice("fill", "water", "content", ("water", "air", "sand")),
    Switch("upright", "false", "stands instead of lying on its side"),
)
def can(rng, p):
    r, h = p["diameter_m"] / 2, p["length_m"]
    profile = [
        (0, 0.06 * h),
        (0.6 * r, 0.03 * h),
        (0.72 * r, 0),
        (0.8 * r, 0),
        (r, 0.07 * h),
        (r, 0.87 * h),
        (0.82 * r, 0.98 * h),
        (0.82 * r, h),
        (0.76 * r, h),
        (0.74 * r, 0.97 * h),
        (0, 0.97 * h),
    ]
    return lying(revolved(profile, 40), p, [wall("aluminium", p["wall_mm"], p["fill"], p["surface"])])


def lying(body, p, materials, radius=None):
    """A round body, on its side unless it is upright."""
    if not p["upright"]:
        body = moved(body, turn=rotation(pitch=90))
    return Model([(body, materials[0])])


@thing(
    "bottle",
    "a glass bottle with neck and punt",
    Number("diameter_m", 0.075, "", 0.04, 0.4),
    Number("length_m", 0.3, "", 0.1, 1.2),
    Number("wall_mm", 3, "of glass", 0.5, 15),
    Choice("fill", "water", "content", ("water", "air", "sand")),
    Switch("upright", "false", "stands instead of lying on its side"),
)
def bottle(rng, p):
    r, h = p["diameter_m"] / 2, p["length_m"]
    profile = [
        (0, 0.05 * h),
        (0.6 * r, 0.02 * h),
        (0.8 * r, 0),
        (r, 0.015 * h),
        (r, 0.6 * h),
        (0.93 * r, 0.66 * h),
        (0.6 * r, 0.74 * h),
        (0.42 * r, 0.8 * h),
        (0.38 * r, 0.95 * h),
        (0.45 * r, 0.955 * h),
        (0.45 * r, 0.98 * h),
        (0.38 * r, h),
        (0, h),
    ]
    return lying(revolved(profile, 40), p, [wall("glass", p["wall_mm"], p["fill"], p["surface"])])


@thing(
    "plastic_bottle",
    "a bottle of thin plastic with a waist and a screw cap",
    Number("diameter_m", 0.065, "", 0.03, 0.4),
    Number("length_m", 0.22, "with its cap", 0.08, 1.2),
    Choice("matter", "pet", "of the wall", ("pet", "polypropylene", "hdpe", "pvc")),
    Number("wall_mm", 0.3, "of its wall; near half a wavelength it is transparent", 0.1, 5),
    Choice("fill", "water", "content", ("water", "air", "sand")),
    Switch("upright", "false", "stands instead of lying on its side"),
)
def plastic_bottle(rng, p):
    r, h = p["diameter_m"] / 2, p["length_m"]
    shape = [(0, 0.04), (0.5, 0.03), (0.75, 0), (0.95, 0.01), (1, 0.05), (1, 0.28), (0.88, 0.33), (0.88, 0.42)]
    shape += [(1, 0.47), (1, 0.62), (0.85, 0.72), (0.55, 0.82), (0.36, 0.88), (0.34, 0.9), (0, 0.9)]
    body = revolved([(x * r, z * h) for x, z in shape], 40)
    cap = revolved([(0, 0.9 * h), (0.42 * r, 0.9 * h), (0.42 * r, 0.985 * h), (0.38 * r, h), (0, h)], 40)
    turn = rotation(pitch=0 if p["upright"] else 90)
    return Model(
        [
            (moved(body, turn=turn), wall(p["matter"], p["wall_mm"], p["fill"], p["surface"])),
            (moved(cap, turn=turn), solid("polypropylene", p["surface"])),
        ]
    )


@thing(
    "carton",
    "a drink carton with a gable",
    Number("length_m", 0.07, "", 0.03, 0.6),
    Number("width_m", 0.07, "", 0.03, 0.6),
    Number("tall_m", 0.22, "with its gable", 0.05, 0.8),
    Number("wall_mm", 0.5, "of paper", 0.2, 8),
    Choice("fill", "water", "content", ("water", "air")),
    Switch("upright", "false", "stands instead of lying on its side"),
)
def carton(rng, p):
    x, y, z = p["length_m"] / 2, p["width_m"] / 2, p["tall_m"]
    eaves, ridge, rim = z - min(1.1 * y, 0.4 * z), z - min(0.25 * y, 0.1 * z), 0.02 * y
    corners = [(sx * x, sy * y, at) for sx in (-1, 1) for sy in (-1, 1) for at in (0, eaves)]
    corners += [(sx * x, sy * rim, ridge) for sx in (-1, 1) for sy in (-1, 1)]
    fin = box((2 * x, 2 * rim, z - ridge + 0.01 * z), (0, 0, (z + ridge - 0.01 * z) / 2))
    return lying(hull(corners) + fin, p, [wall("paper", p["wall_mm"], p["fill"], p["surface"])])


@thing(
    "barrel",
    "a steel drum of 200 l with two hoops",
    Number("diameter_m", 0.585, "", 0.2, 1.5),
    Number("length_m", 0.88, "", 0.3, 3),
    Number("wall_mm", 1.2, "of steel", 0.3, 10),
    Choice("fill", "water", "content", ("water", "air", "oil", "mud", "sand")),
    Switch("upright", "false", "stands instead of lying on its side"),
)
def barrel(rng, p):
    r, h = p["diameter_m"] / 2, p["length_m"]
    body = 0.955 * r
    profile = [(0, 0.02 * h), (0.93 * body, 0.02 * h), (0.93 * body, 0), (body, 0)]
    for at in (0.33, 0.67):
        profile += [(body, (at - 0.02) * h), (r, (at - 0.008) * h), (r, (at + 0.008) * h), (body, (at + 0.02) * h)]
    profile += [(body, h), (0.93 * body, h), (0.93 * body, 0.98 * h), (0, 0.98 * h)]
    return lying(revolved(profile, 48), p, [wall("carbon_steel", p["wall_mm"], p["fill"], p["surface"])])


@thing(
    "gas_cylinder",
    "a cylinder for compressed gas with its valve",
    Number("diameter_m", 0.23, "", 0.08, 0.6),
    Number("length_m", 1.4, "without its valve", 0.3, 3),
    Number("wall_mm", 6, "of steel", 1, 30),
    Choice("fill", "air", "content", ("air", "water")),
    Switch("upright", "false", "stands instead of lying on its side"),
)
def gas_cylinder(rng, p):
    r, h = p["diameter_m"] / 2, p["length_m"]
    bend = np.linspace(0, np.pi / 2, 8)
    profile = [(0, 0.03 * h), (0.7 * r, 0), (0.9 * r, 0), (r, 0.03 * h)]
    profile += [(r * np.cos(a) if a < 1.5 else 0.2 * r, h - r + r * np.sin(a)) for a in bend]
    profile += [(0.2 * r, h + 0.25 * r), (0.3 * r, h + 0.25 * r), (0.3 * r, h + 0.7 * r), (0, h + 0.7 * r)]
    return lying(revolved(profile, 40), p, [wall("carbon_steel", p["wall_mm"], p["fill"], p["surface"])])


@thing(
    "crate",
    "a crate of wooden slats, which sound passes between",
    Number("length_m", 0.8, "", 0.2, 4),
    Number("width_m", 0.6, "", 0.2, 4),
    Number("tall_m", 0.5, "", 0.15, 4),
    Number("slats", 4, "on a side", 2, 12, whole=True),
)
def crate(rng, p):
    x, y, z, board = p["length_m"], p["width_m"], p["tall_m"], 0.02 + 0.02 * p["length_m"] / 0.8
    thin = board * 0.6
    posts = [
        box((board, board, z), (sx * (x - board) / 2, sy * (y - board) / 2, z / 2)) for sx in (-1, 1) for sy in (-1, 1)
    ]
    solids = posts
    n = p["slats"]
    high = 0.72 * z / n
    for i in range(n):
        at = (i + 0.5) * z / n
        solids += [box((x, thin, high), (0, s * (y - thin) / 2, at)) for s in (-1, 1)]
        solids += [box((thin, y - thin, high), (s * (x - thin) / 2, 0, at)) for s in (-1, 1)]
        solids.append(box((x, 0.72 * y / n, thin), (0, (i + 0.5) * y / n - y / 2, thin / 2)))
    return Model([(union(solids), solid("waterlogged_wood", p["surface"]))])


@thing("pallet", "a Euro pallet of wood", Number("length_m", 1.2, "", 0.4, 3), Number("width_m", 0.8, "", 0.3, 3))
def pallet(rng, p):
    x, y = p["length_m"], p["width_m"]
    solids = [box((x, 0.12 * y, 0.022), (0, s * 0.44 * y, 0.011)) for s in (-1, 0, 1)]
    solids += [
        box((0.12 * x, 0.15 * y, 0.08), (sx * 0.44 * x, sy * 0.42 * y, 0.06)) for sx in (-1, 0, 1) for sy in (-1, 0, 1)
    ]
    solids += [box((0.12 * x, y, 0.022), (s * 0.44 * x, 0, 0.11)) for s in (-1, 0, 1)]
    solids += [box((x, 0.13 * y, 0.022), (0, s * 0.216 * y, 0.131)) for s in (-2, -1, 0, 1, 2)]
    return Model([(union(solids), solid("waterlogged_wood", p["surface"]))])


@thing("bicycle", "a bicycle, which lies on its side", Number("wheel_m", 0.66, "diameter of its wheels", 0.3, 0.8))
def bicycle(rng, p):
    r = p["wheel_m"] / 2
    rear, front, axle, seat = (
        np.array([0, 0, r]),
        np.array([1.03, 0, r]),
        np.array([0.42, 0, r - 0.06]),
        np.array([0.27, 0, r + 0.47]),
    )
    head, steer = np.array([0.82, 0, r + 0.36]), np.array([0.78, 0, r + 0.56])
    frame = [
        bar(axle, seat, 0.016),
        bar(axle, head, 0.018),
        bar(seat * 0.85 + axle * 0.15, head, 0.014),
        bar(head - (head - steer) * 0.2, steer, 0.016),
    ]
    for side in (-0.05, 0.05):
        y = np.array([0, side, 0])
        frame += [
            bar(rear + y, axle + y * 0.4, 0.009),
            bar(rear + y, seat * 0.9 + axle * 0.1 + y * 0.3, 0.008),
            bar(front + y, head + y * 0.6, 0.011),
        ]
    frame += [
        bar(steer + (0, -0.28, 0), steer + (0, 0.28, 0), 0.011),
        bar(axle + (0, -0.09, 0), axle + (0, 0.09, 0), 0.02),
        bar(axle + (0, 0.08, 0), axle + (0.12, 0.08, -0.12), 0.01),
        bar(axle + (0, -0.08, 0), axle + (-0.12, -0.08, 0.12), 0.01),
        box((0.26, 0.13, 0.06), seat + (-0.02, 0, 0.1)),
        bar(seat, seat + (0, 0, 0.1), 0.013),
    ]
    tires = []
    for hub in (rear, front):
        wheel = torus(r - 0.018, 0.018, 48, 8)
        tires.append(moved(wheel, hub, rotation(roll=90)))
        frame.append(moved(torus(r - 0.045, 0.011, 48, 6), hub, rotation(roll=90)))
        for angle in np.arange(12) * np.pi / 6:
            frame.append(bar(hub, hub + (np.cos(angle) * (r - 0.04), 0, np.sin(angle) * (r - 0.04)), 0.0015, 4))
        frame.append(cylinder(0.02, 0.1, hub, "y", 12))
    turn, drop = rotation(roll=86), (-0.5, 0, 0.1)
    return Model(
        [
            (moved(union(frame), drop, turn), solid("carbon_steel", p["surface"])),
            (moved(union(tires), drop, turn), solid("rubber", p["surface"])),
        ]
    )


@thing("traffic_cone", "a cone of PVC with its foot", Number("tall_m", 0.75, "", 0.3, 1.2))
def traffic_cone(rng, p):
    h = p["tall_m"]
    cone = revolved(
        [(0.23 * h, 0), (0.2 * h, 0.06 * h), (0.045 * h, h), (0.02 * h, h), (0.16 * h, 0.06 * h), (0.16 * h, 0)], 40
    )
    foot = box((0.52 * h, 0.52 * h, 0.05 * h), (0, 0, 0.025 * h)) - cylinder(0.16 * h, h, (0, 0, 0))
    return Model([(cone + foot, solid("pvc", p["surface"]))])


@thing("shopping_trolley", "a trolley of steel wire on its side", Number("wire_mm", 5, "diameter of its wires", 2, 12))
def shopping_trolley(rng, p):
    r = p["wire_mm"] / 2000
    # The basket: corners of its floor and of its rim.
    low = np.array([[0, -0.2, 0.5], [0, 0.2, 0.5], [0.75, 0.17, 0.55], [0.75, -0.17, 0.55]])
    high = np.array([[-0.05, -0.27, 0.98], [-0.05, 0.27, 0.98], [0.85, 0.22, 0.88], [0.85, -0.22, 0.88]])
    wires = []
    for i in range(4):
        j = (i + 1) % 4
        for share in np.linspace(0, 1, 5):
            a, b = low[i] + share * (high[i] - low[i]), low[j] + share * (high[j] - low[j])
            wires.append(bar(a, b, r if 0 < share < 1 else 1.6 * r, 5))
        for share in np.linspace(0, 1, 7 if i % 2 else 11)[:-1]:
            wires.append(bar(low[i] + share * (low[j] - low[i]), high[i] + share * (high[j] - high[i]), r, 5))
    for share in np.linspace(0.1, 0.9, 8):
        wires.append(bar(low[0] + share * (low[3] - low[0]), low[1] + share * (low[2] - low[1]), r, 5))
    frame, wheels = [], []
    for side in (-1, 1):
        y = side * 0.22
        frame += [
            tube([(-0.12, y, 1.02), (-0.03, y, 0.95), (0.02, y, 0.35), (0.1, y, 0.15), (0.8, y * 0.75, 0.15)], 0.013, 8)
        ]
        for x, yy in ((0.08, y), (0.8, y * 0.75)):
            wheels.append(cylinder(0.06, 0.03, (x, yy, 0.06), "y", 20))
            frame.append(bar((x, yy, 0.06), (x, yy, 0.15), 0.01, 6))
    frame.append(bar((-0.12, -0.24, 1.02), (-0.12, 0.24, 1.02), 0.016, 8))
    turn, drop = rotation(roll=95), (-0.4, 0.5, 0.24)
    return Model(
        [
            (moved(union(wires + frame), drop, turn), solid("steel", p["surface"])),
            (moved(union(wheels), drop, turn), solid("rubber", p["surface"])),
        ]
    )


@thing(
    "bucket",
    "a bucket of HDPE, open above",
    Number("diameter_m", 0.3, "of its rim", 0.1, 1),
    Number("tall_m", 0.3, "", 0.1, 1),
)
def bucket(rng, p):
    r, h, skin = p["diameter_m"] / 2, p["tall_m"], 0.012
    profile = [
        (0, 0),
        (0.72 * r, 0),
        (0.95 * r, 0.9 * h),
        (r, 0.9 * h),
        (r, h),
        (0.95 * r - skin, h),
        (0.72 * r - skin, skin),
        (0, skin),
    ]
    handle = np.array(
        [(0.97 * r * np.cos(a), 0.3 * r + 0.8 * r * np.sin(a), 0.93 * h) for a in np.linspace(0.05, np.pi - 0.05, 15)]
    )
    handle[:, 1] -= 0.3 * r
    body = moved(revolved(profile, 40) + tube(handle, 0.005, 6), turn=rotation(pitch=90))
    return Model([(body, solid("hdpe", p["surface"]))])


@thing(
    "log",
    "a trunk of wood with stubs of branches",
    Number("length_m", 3.0, "", 0.5, 20),
    Number("diameter_m", 0.3, "of its thick end", 0.05, 1.5),
)
def log(rng, p):
    length, r = p["length_m"], p["diameter_m"] / 2
    s = np.linspace(0, 1, 24)
    sway = 0.03 * length
    path = np.c_[
        (s - 0.5) * length,
        sway * rng.uniform(-1, 1) * np.sin(np.pi * s),
        sway * rng.uniform(-0.3, 0.3) * np.sin(2 * np.pi * s),
    ]
    radius = r * (1 - 0.45 * s) * (1 + 0.04 * rng.standard_normal(24))
    solids = [tube(path, radius, 14)]
    for at in rng.uniform(0.25, 0.95, 5):
        base, angle = path[int(at * 23)], rng.uniform(-0.7, np.pi + 0.7)
        solids.append(
            tube(
                [base, base + np.array([0.35, np.cos(angle), np.sin(angle)]) * r * rng.uniform(2, 5)],
                np.array([0.3, 0.18]) * r,
                8,
            )
        )
    return Model([(union(solids), solid("waterlogged_wood", p["surface"]))])


@thing(
    "amphora",
    "an amphora of fired clay, which counts as concrete, with two handles",
    Number("tall_m", 0.9, "", 0.3, 1.6),
    Choice("fill", "sand", "content", ("water", "sand", "mud")),
    Number("wall_mm", 15, "of fired clay", 4, 40),
    Switch("upright", "false", "stands instead of lying on its side"),
)
def amphora(rng, p):
    h = p["tall_m"]
    half = [
        (0, 0),
        (0.03, 0.01),
        (0.035, 0.06),
        (0.1, 0.16),
        (0.16, 0.3),
        (0.18, 0.45),
        (0.165, 0.58),
        (0.11, 0.68),
        (0.06, 0.74),
        (0.05, 0.8),
        (0.05, 0.93),
        (0.07, 0.95),
        (0.07, 0.985),
        (0.055, 1.0),
        (0, 1.0),
    ]
    solids = [revolved([(r * h, z * h) for r, z in half], 48)]
    for side in (-1, 1):
        path = [
            (side * x * h, 0, z * h) for x, z in ((0.04, 0.9), (0.1, 0.92), (0.135, 0.87), (0.135, 0.74), (0.12, 0.64))
        ]
        solids.append(tube(path, 0.018 * h, 10))
    body = union(solids)
    if not p["upright"]:
        body = moved(body, turn=rotation(roll=90))
    return Model([(body, wall("concrete", p["wall_mm"], p["fill"], p["surface"]))])
