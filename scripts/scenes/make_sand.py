#!/usr/bin/env python3
"""Makes deploy/scenes/sand.glb: a floor of rough sand 20 m deep, from 24 m south to 108 m north and 36 m to either side, of one
tile that is repeated. Its relief has wavelengths of 0.25 to 2 m and slopes of 3.7 degrees (rms) about each axis. And
sand_wreck.glb: the same floor with a roughly shaped wreck, an oval broken rim with timbers inside, east of the origin. Needs numpy."""
from pathlib import Path

import numpy as np

from glb import Glb, Mesh, box, loft

DEPTH, TILE, POSTS = 20.0, 6.0, 60           # [m], posts 0.1 m apart
SOUTH, EAST, ROWS, COLUMNS = -24.0, -36.0, 22, 12
SHORTEST, LONGEST, SLOPE = 0.25, 2.0, np.tan(np.radians(3.7))    # wavelengths of the relief [m]; its slope about each axis

rng = np.random.default_rng(7)
k = np.hypot(*np.meshgrid(np.fft.fftfreq(POSTS, TILE / POSTS), np.fft.fftfreq(POSTS, TILE / POSTS), indexing="ij"))
band = np.where((k > 0.99 / LONGEST) & (k < 1 / SHORTEST), np.maximum(k, 1e-9) ** -1.5, 0)
height = np.fft.ifft2(np.fft.fft2(rng.standard_normal((POSTS, POSTS))) * band).real
height *= SLOPE / np.gradient(np.pad(height, 1, mode="wrap"), TILE / POSTS)[0][1:-1, 1:-1].std()

step = np.arange(POSTS + 1)
north, west = np.meshgrid(step * TILE / POSTS, step * TILE / POSTS, indexing="ij")
points = np.stack([north, west, height[np.ix_(step % POSTS, step % POSTS)]], -1).reshape(-1, 3)
at = (step[:-1, None] * (POSTS + 1) + step[None, :-1]).ravel()
faces = np.vstack([np.stack(c, 1) for c in ((at, at + POSTS + 1, at + POSTS + 2), (at, at + POSTS + 2, at + 1))])


def floor():
    glb = Glb()
    tile = glb.mesh("tile", [Mesh(points.round(4), faces)], glb.material("sand", {"lambert_db": -16.7}, (0.76, 0.7, 0.5)))
    for row in range(ROWS):
        for column in range(COLUMNS):
            glb.node(f"floor_{row}_{column}", tile, (SOUTH + TILE * row, EAST + TILE * column, -DEPTH))
    return glb


def add_wreck(glb, rng, centre=(7.0, -7.6), axes=(9.5, 3.9), height=1.4):
    """An oval rim of uneven height about a centre (north, west), and boxes inside it [m]."""
    matter = glb.material("wreck", {"lambert_db": -10.0}, (0.4, 0.3, 0.2))
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)[:, None]
    out, up = np.array([0.5, 0.3, -0.1, -0.4]), np.array([-0.2, 1, 1, -0.2])  # section of the rim, from outside to inside
    top = np.where(up > 0, up * height * rng.uniform(0.55, 1, angle.shape), up)
    rim = np.stack([(axes[0] + out) * np.cos(angle), (axes[1] + out) * np.sin(angle), top], -1)
    glb.node("rim", glb.mesh("rim", [loft(rim, endless=True)], matter), (*centre, -DEPTH))
    for i in range(14):
        at = rng.uniform(-0.7, 0.7, 2) * axes
        timber = glb.mesh(f"timber_{i}", [box(rng.uniform((0.3, 0.2, 0.4), (2, 0.8, 1.8)))], matter)
        glb.node(f"timber_{i}", timber, (centre[0] + at[0], centre[1] + at[1], -DEPTH))


scenes = Path(__file__).resolve().parents[2] / "deploy" / "scenes"
floor().write(scenes / "sand.glb")
wrecked = floor()
add_wreck(wrecked, np.random.default_rng(3))
wrecked.write(scenes / "sand_wreck.glb")
