"""Rings of points, and the skin over them. Needs numpy."""

import numpy as np


def circle(sides, radius=1.0):
    """Points [sides, 2] on a circle, counter-clockwise."""
    angle = np.arange(sides) * 2 * np.pi / sides
    return radius * np.stack([np.cos(angle), np.sin(angle)], 1)


def skin(rings, closed=False):
    """Positions [n, 3] and faces [m, 3] of a skin over rings [rings, points, 3], each counter-clockwise seen from
    the last; with flat ends unless it is closed."""
    rings = np.asarray(rings, float)
    m, n = rings.shape[:2]
    i, j = np.mgrid[: m if closed else m - 1, :n]
    here, right = i * n + j, i * n + (j + 1) % n
    above, diagonal = (i + 1) % m * n + j, (i + 1) % m * n + (j + 1) % n
    faces = [np.stack([here, right, diagonal], -1).reshape(-1, 3), np.stack([here, diagonal, above], -1).reshape(-1, 3)]
    positions = rings.reshape(-1, 3)
    if not closed:
        positions = np.vstack([positions, rings[0].mean(0), rings[-1].mean(0)])
        k, following, last = np.arange(n), (np.arange(n) + 1) % n, (m - 1) * n
        faces += [
            np.stack([following, k, np.full(n, m * n)], -1),
            np.stack([last + k, last + following, np.full(n, m * n + 1)], -1),
        ]
    return positions, np.vstack(faces)
