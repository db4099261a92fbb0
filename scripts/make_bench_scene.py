#!/usr/bin/env python3
"""Makes the benchmark's scene at the path given: a sea floor of 200 x 200 cells (80,000 triangles) with 20 objects.
Needs numpy. The floor is 60 x 60 m, 3 m below z = 0, centred 20 m north of the origin."""
import sys
from pathlib import Path

import numpy as np

from glb import Glb, Mesh, box, icosphere, tube

CELLS, SIDE, DEPTH = 200, 60.0, 3.0


def height(x, y):
    return -DEPTH + 0.15 * np.sin(0.7 * x + 0.3 * y) + 0.1 * np.sin(0.4 * x - 1.1 * y)


def floor():
    i, j = np.mgrid[:CELLS + 1, :CELLS + 1]
    x, y = 20 + SIDE * (i / CELLS - 0.5), SIDE * (j / CELLS - 0.5)
    a = (np.arange(CELLS)[:, None] * (CELLS + 1) + np.arange(CELLS)).ravel()
    b, c, d = a + CELLS + 1, a + CELLS + 2, a + 1
    faces = np.vstack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return Mesh(np.stack([x, y, height(x, y)], -1).reshape(-1, 3), faces)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: make_bench_scene.py FILE.glb")
    glb = Glb()
    sand = glb.material("sand", {"sediment": "medium_sand"}, (0.76, 0.7, 0.5))
    steel = glb.material("steel", {"material": "carbon_steel"}, (0.35, 0.22, 0.15))
    glb.node("sea_floor", glb.mesh("sea_floor", [floor()], sand))
    kinds = [glb.mesh("ball", [icosphere(2)], steel), glb.mesh("box", [box((1, 1, 1))], steel),
             glb.mesh("post", [tube([(0, 0, -1), (0, 0, 2)], 0.3, 16)], steel)]
    for n in range(20):
        bearing = np.radians(-57 + 6 * n)
        distance = 6 + 20 * (n * 7 % 20) / 20
        x, y = distance * np.cos(bearing), distance * np.sin(bearing)
        glb.node(f"object_{n:02d}", kinds[n % 3], (x, y, height(x, y) + 0.3))
    glb.write(Path(sys.argv[1]))


if __name__ == "__main__":
    main()
