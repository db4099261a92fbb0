#!/usr/bin/env python3
"""Makes deploy/scenes/materials.glb: a sphere, a box and a cylinder of each of five materials on a floor of sand. The
materials have modellers' names and no acoustic values. Needs numpy."""
from pathlib import Path

import numpy as np

from glb import Glb, Mesh, box, circle, icosphere, loft

SCENES = Path(__file__).resolve().parents[2] / "deploy" / "scenes"
SIDES = 128
MATERIALS = [("Steel.001", (0.5, 0.5, 0.55)), ("Material_PVC", (0.8, 0.8, 0.8)), ("rubber-02", (0.1, 0.1, 0.1)),
             ("Concrete", (0.6, 0.6, 0.58)), ("RockMoss", (0.4, 0.38, 0.35))]  # from port to starboard
NEAR, BETWEEN, APART = 4.0, 1.4, 9.0  # range of the spheres [m], from row to row [m], from column to column [deg]
RADIUS = 0.2                          # each sphere [m]


def cylinder(radius, length):
    return loft([np.c_[circle(SIDES, radius), np.full(SIDES, height)] for height in (-length / 2, length / 2)])


def lying(body):
    """A body with its z axis across the line of sight."""
    x, y, z = body.positions.T
    return Mesh(np.c_[x, z, -y], body.faces)


sphere = icosphere(4)
BODIES = [("sphere", Mesh(RADIUS * sphere.positions, sphere.faces)), ("box", box((0.35, 0.35, 0.35))),
          ("cylinder", lying(cylinder(0.15, 0.5)))]

glb = Glb()
sand = glb.material("Sand", None, (0.8, 0.75, 0.6))
glb.node("floor", glb.mesh("floor", [box((14, 10, 0.2), (5, 0, -0.1))], sand), (0, 0, 0))
for column, (name, colour) in enumerate(MATERIALS):
    material = glb.material(name, None, colour)
    bearing = np.radians((2 - column) * APART)
    for row, (shape, body) in enumerate(BODIES):
        turn = np.array([[np.cos(bearing), -np.sin(bearing), 0], [np.sin(bearing), np.cos(bearing), 0], [0, 0, 1]])
        across = NEAR + BETWEEN * row
        place = (across * np.cos(bearing), across * np.sin(bearing), -body.positions[:, 2].min())
        glb.node(f"{shape} {name}", glb.mesh(f"{shape} {name}", [body.moved(turn=turn)], material), place)
glb.write(SCENES / "materials.glb")
