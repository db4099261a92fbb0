"""Mines, bombs and shells."""

import math

import numpy as np

from ..materials import solid, wall
from ..parameters import Number
from ..shapes import ball, bar, box, cylinder, moved, revolved, rotation, torus, union
from .catalogue import Model, thing


@thing(
    "bottom_mine",
    "a cylindrical ground mine, full of explosive",
    Number("diameter_m", 0.53, "", 0.2, 1),
    Number("length_m", 2.0, "", 0.5, 4),
)
def bottom_mine(rng, p):
    r, n = p["diameter_m"] / 2, p["length_m"]
    body = revolved(
        [
            (0, 0),
            (0.55 * r, 0),
            (0.9 * r, 0.06 * n),
            (r, 0.14 * n),
            (r, 0.95 * n),
            (0.85 * r, 0.96 * n),
            (0.85 * r, n),
            (0, n),
        ],
        48,
    )
    bands = [torus(r, 0.018, 48, 8).translate((0, 0, at * n)) for at in (0.3, 0.7)]
    lug = box((0.05, 0.12, 0.1), (r, 0, 0.5 * n))
    lying = moved(union([body, *bands, lug]), (-n / 2, 0, 0), rotation(pitch=90))
    return Model([(lying, solid("steel", p["surface"]))])


@thing(
    "cone_mine",
    "a ground mine of the shape of a cut cone, of fibreglass (0.98 m across)",
    Number("diameter_m", 0.98, "of its foot", 0.3, 2),
    Number("tall_m", 0.44, "", 0.15, 1),
)
def cone_mine(rng, p):
    r, h = p["diameter_m"] / 2, p["tall_m"]
    body = revolved(
        [
            (0, 0),
            (0.97 * r, 0),
            (r, 0.06 * h),
            (0.56 * r, 0.9 * h),
            (0.5 * r, h),
            (0.2 * r, h),
            (0.2 * r, 0.96 * h),
            (0, 0.96 * h),
        ],
        56,
    )
    return Model([(body, solid("fibreglass", p["surface"]))])


@thing(
    "moored_mine",
    "a ball with horns on a wire above its anchor",
    Number("diameter_m", 0.9, "of the ball", 0.4, 1.6),
    Number("line_m", 3.0, "from anchor to ball", 0.2, 500),
    Number("horns", 8, "", 3, 16, whole=True),
    Number("lean_deg", 4.0, "of the wire, by current", 0, 60),
)
def moored_mine(rng, p):
    r, s = p["diameter_m"] / 2, p["surface"]
    tall = 0.55 * p["diameter_m"]
    trolley = [box((1.0 * p["diameter_m"], 0.75 * p["diameter_m"], tall), (0, 0, tall / 2 + 0.1))]
    trolley += [
        cylinder(0.12, 0.06, (x * 0.36 * p["diameter_m"], y * 0.4 * p["diameter_m"], 0.12), "y", 20)
        for x in (-1, 1)
        for y in (-1, 1)
    ]
    lean = math.radians(p["lean_deg"])
    foot = np.array([0, 0, tall + 0.1])
    middle = foot + np.array([math.sin(lean), 0, math.cos(lean)]) * (p["line_m"] + r)
    wire = bar(foot - (0, 0, 0.05), middle - (0, 0, 0.9 * r), 0.008, 8)
    shell = [ball(r, middle, 48), moved(torus(r, 0.02, 48, 8), middle)]
    horns = []
    for i in range(p["horns"]):
        ring, around = (0.75, i) if i % 2 else (0.25, i)
        up = math.radians(90 * (1 - ring))
        angle = 2 * math.pi * around / p["horns"]
        out = np.array([math.cos(angle) * math.cos(up), math.sin(angle) * math.cos(up), math.sin(up)])
        horns += [
            bar(middle + 0.97 * r * out, middle + (r + 0.13) * out, 0.025, 10),
            ball(0.032, middle + (r + 0.13) * out, 12),
        ]
    return Model(
        [
            (union(shell + horns), wall("steel", 6, "air", s)),
            (wire, solid("steel", s)),
            (union(trolley), solid("carbon_steel", s)),
        ]
    )


@thing(
    "bomb",
    "an aerial bomb of 250 kg with its fins",
    Number("diameter_m", 0.36, "", 0.1, 1),
    Number("length_m", 1.65, "", 0.4, 4),
)
def bomb(rng, p):
    r, n = p["diameter_m"] / 2, p["length_m"]
    body = revolved(
        [
            (0, 0),
            (0.35 * r, 0.02 * n),
            (0.75 * r, 0.08 * n),
            (r, 0.2 * n),
            (r, 0.52 * n),
            (0.8 * r, 0.66 * n),
            (0.42 * r, 0.8 * n),
            (0.36 * r, 0.86 * n),
            (0, 0.86 * n),
        ],
        40,
    )
    fins = [
        moved(box((0.018 * r / 0.18, 1.0 * r, 0.28 * n), (0, 0.55 * r, 0.86 * n)), turn=rotation(yaw=90 * i + 45))
        for i in range(4)
    ]
    ring = revolved([(0.98 * r, 0.82 * n), (1.02 * r, 0.82 * n), (1.02 * r, n), (0.98 * r, n)], 40)
    lug = torus(0.04, 0.01, 16, 8).rotate((90, 0, 0)).translate((r + 0.01, 0, 0.4 * n))
    return Model(
        [
            (
                moved(union([body, ring, lug, *fins]), (-n / 2, 0, 0), rotation(pitch=90)),
                solid("carbon_steel", p["surface"]),
            )
        ]
    )


@thing(
    "artillery_shell",
    "a shell of 155 mm",
    Number("diameter_m", 0.155, "", 0.03, 0.5),
    Number("length_m", 0.7, "", 0.1, 2),
)
def artillery_shell(rng, p):
    r, n = p["diameter_m"] / 2, p["length_m"]
    body = revolved(
        [
            (0, 0),
            (0.9 * r, 0),
            (0.97 * r, 0.12 * n),
            (1.03 * r, 0.13 * n),
            (1.03 * r, 0.17 * n),
            (r, 0.18 * n),
            (r, 0.5 * n),
            (0.9 * r, 0.66 * n),
            (0.7 * r, 0.8 * n),
            (0.4 * r, 0.94 * n),
            (0.25 * r, 0.97 * n),
            (0.2 * r, n),
            (0, n),
        ],
        40,
    )
    return Model([(moved(body, (-n / 2, 0, 0), rotation(pitch=90)), solid("carbon_steel", p["surface"]))])
