#!/usr/bin/env python3
"""Makes a benchmark scene: make_bench_scene.py FILE.glb [--cells N] [--in-view]. A sea floor of N x N cells (200: 80,000
triangles) with 20 objects. Needs numpy. The floor is 60 x 60 m, 3 m below z = 0, centred 20 m north of the origin; with
--in-view only the part remains that is wholly in view of a fan of 120 x 20 degrees and 30 m, pitched by 10 degrees."""
import argparse
from pathlib import Path

import numpy as np

from glb import Glb, Mesh, box, icosphere, tube

SIDE, DEPTH = 60.0, 3.0


def height(x, y):
    return -DEPTH + 0.15 * np.sin(0.7 * x + 0.3 * y) + 0.1 * np.sin(0.4 * x - 1.1 * y)


def in_view(points):
    """Whether a point is inside the fan with a margin, seen from the origin."""
    x, y, z = points.T
    pitch = np.radians(10)
    ahead, up = x * np.cos(pitch) - z * np.sin(pitch), x * np.sin(pitch) + z * np.cos(pitch)
    return ((np.abs(np.arctan2(y, ahead)) < np.radians(59.5)) & (np.linalg.norm(points, axis=1) < 29.8) &
            (np.abs(np.arctan2(up, np.hypot(ahead, y))) < np.radians(9.8)))


def floor(cells, only_in_view):
    i, j = np.mgrid[:cells + 1, :cells + 1]
    x, y = 20 + SIDE * (i / cells - 0.5), SIDE * (j / cells - 0.5)
    points = np.stack([x, y, height(x, y)], -1).reshape(-1, 3)
    a = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    b, c, d = a + cells + 1, a + cells + 2, a + 1
    faces = np.vstack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return Mesh(points, faces[in_view(points)[faces].all(1)] if only_in_view else faces)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--cells", type=int, default=200)
    parser.add_argument("--in-view", action="store_true")
    options = parser.parse_args()
    glb = Glb()
    sand = glb.material("sand", {"sediment": "medium_sand"}, (0.76, 0.7, 0.5))
    steel = glb.material("steel", {"material": "carbon_steel"}, (0.35, 0.22, 0.15))
    glb.node("sea_floor", glb.mesh("sea_floor", [floor(options.cells, options.in_view)], sand))
    kinds = [glb.mesh("ball", [icosphere(2)], steel), glb.mesh("box", [box((1, 1, 1))], steel),
             glb.mesh("post", [tube([(0, 0, -1), (0, 0, 2)], 0.3, 16)], steel)]
    for n in range(20):
        bearing = np.radians(-57 + 6 * n)
        distance = 6 + 20 * (n * 7 % 20) / 20
        x, y = distance * np.cos(bearing), distance * np.sin(bearing)
        glb.node(f"object_{n:02d}", kinds[n % 3], (x, y, height(x, y) + 0.3))
    glb.write(options.file)


if __name__ == "__main__":
    main()
