#!/usr/bin/env python3
"""Makes deploy/scenes/tank.glb and tank_pass.csv: a basin of four concrete walls with two pillars, and a vehicle that
moves 6 m and turns about in it within one turn of a scanning head. Needs numpy."""
from pathlib import Path

import numpy as np

from glb import Glb, box, quaternion, rotation, tube

SCENES = Path(__file__).resolve().parents[2] / "deploy" / "scenes"
NORTH, WEST = 13.2, 9.0    # faces of the walls; the others are at the negative values [m]
HEIGHT, THICK = 2.4, 0.5   # walls [m]
PILLARS = [(7.0, -4.5), (-8.0, 5.0)]  # [m]
DURATION, STEP = 21.0, 0.25           # trajectory [s]

glb = Glb()
concrete = glb.material("concrete", {"material": "concrete"}, (0.6, 0.6, 0.58))
for sign, side in ((1, "north"), (-1, "south")):
    wall = box((THICK, 2 * WEST + 2 * THICK, HEIGHT))
    glb.node(f"wall {side}", glb.mesh(side, [wall], concrete), (sign * (NORTH + THICK / 2), 0, 0))
for sign, side in ((1, "west"), (-1, "east")):
    wall = box((2 * NORTH, THICK, HEIGHT))
    glb.node(f"wall {side}", glb.mesh(side, [wall], concrete), (0, sign * (WEST + THICK / 2), 0))
pillar = glb.mesh("pillar", [tube([(0, 0, -HEIGHT / 2), (0, 0, HEIGHT / 2)], 0.3, sides=24)], concrete)
for number, (x, y) in enumerate(PILLARS):
    glb.node(f"pillar {number}", pillar, (x, y, 0))
glb.write(SCENES / "tank.glb")

rows = ["time,x,y,z,qw,qx,qy,qz"]
for time in np.arange(0, DURATION + STEP / 2, STEP):
    share = time / 20
    position = (-3 + 5 * share, -2 + 3.5 * share, 0.1 * np.sin(time))
    turn = quaternion(rotation(roll=2 * np.sin(0.7 * time), pitch=1.5 * np.sin(0.9 * time), yaw=-180 * share))
    rows.append(",".join(f"{value:.7g}" for value in (time, *position, *turn)))
(SCENES / "tank_pass.csv").write_text("\n".join(rows) + "\n")
