#!/usr/bin/env python3
"""Makes deploy/scenes/vessels.glb: thin-walled vessels on a floor of sand. From port to starboard: a pipe of PVC and one of
the same shape of solid steel, bottles of acrylic, glass and glass with air, and a can with air. Needs numpy."""
from pathlib import Path

import numpy as np

from glb import Glb, Mesh, box, circle, loft

SCENES = Path(__file__).resolve().parents[2] / "deploy" / "scenes"
SIDES = 96
ROUGH = {"roughness_slope": 0.05}


def shell(thickness_mm, material, **more):
    return ROUGH | {"shell": {"thickness_mm": thickness_mm, "material": material} | more}


def revolved(profile):
    """A closed body round z, from (radius, height) [m]."""
    return loft([np.c_[circle(SIDES, radius), np.full(SIDES, height)] for radius, height in profile])


def bottle(radius, height):
    neck = 0.35 * radius
    profile = [(0.9 * radius, 0), (radius, 0.03 * height), (radius, 0.6 * height), (0.95 * radius, 0.66 * height),
               (0.75 * radius, 0.73 * height), (neck, 0.8 * height), (neck, height)]
    return revolved(profile)


VESSELS = [  # name, body, acoustics, east of the middle [m], turned about z; upright unless lying
    ("pvc pipe", revolved([(0.08, -0.5), (0.08, 0.5)]), shell(3, "pvc"), -1.25, 75),
    ("steel pipe", revolved([(0.08, -0.5), (0.08, 0.5)]), ROUGH | {"material": "steel"}, -0.9, 75),
    ("acrylic bottle", bottle(0.12, 0.5), shell(2, "acrylic"), -0.1, None),
    ("glass bottle", bottle(0.12, 0.5), shell(2.3, "glass"), 0.35, None),
    ("glass bottle with air", bottle(0.12, 0.5), shell(2.3, "glass", fill="air"), 0.8, None),
    ("can with air", revolved([(0.12, 0), (0.12, 0.4)]), shell(0.3, "aluminium", fill="air"), 1.25, None),
]

glb = Glb()
sand = glb.material("sand", {"sediment": "sandy_silt"}, (0.8, 0.75, 0.6))
glb.node("floor", glb.mesh("floor", [box((12, 8, 0.2), (4, 0, -0.1))], sand), (0, 0, 0))
for name, body, acoustics, east, yaw in VESSELS:
    material = glb.material(name, acoustics, (0.6, 0.7, 0.8))
    if yaw is not None:  # on the floor, on its side
        turn = np.radians(yaw)
        x, y, z = body.positions.T
        body = Mesh(np.c_[x * np.sin(turn) + z * np.cos(turn),
                                             -x * np.cos(turn) + z * np.sin(turn), y + 0.08], body.faces)
    glb.node(name, glb.mesh(name, [body], material), (3.5 if yaw is None or east < -1 else 4.3, -east, 0))
glb.write(SCENES / "vessels.glb")
