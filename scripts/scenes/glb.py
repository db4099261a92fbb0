"""Shapes for the scripts that make scenes, in world axes (x north, y west, z up) and metres. Needs numpy."""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "components" / "worlds"))
from insonify_worlds.glb import FLOAT, USHORT, Glb, png, quaternion, rotation, unit, y_up  # noqa: E402, F401: for the scripts
from insonify_worlds.rings import circle, skin  # noqa: E402


class Mesh:
    """Triangles, counter-clockwise seen from outside: positions [n, 3], faces [m, 3], optionally normals and uvs."""

    def __init__(self, positions, faces, normals=None, uvs=None):
        self.positions = np.asarray(positions, float)
        self.faces = np.asarray(faces, int)
        self.normals, self.uvs = normals, uvs

    def corners(self):
        return self.positions[self.faces]

    def areas(self):
        a, b, c = np.moveaxis(self.corners(), 1, 0)
        return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2

    def volume(self):
        """Volume; positive if a closed mesh is wound outward [m^3]."""
        a, b, c = np.moveaxis(self.corners(), 1, 0)
        return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6

    def moved(self, offset=(0, 0, 0), turn=np.eye(3)):
        return Mesh(self.positions @ np.asarray(turn).T + offset, self.faces)

    def textured(self, tile, smooth):
        """The mesh with normals, either of the faces or smooth, and uvs projected along each face's
        dominant axis, `tile` metres to a repeat."""
        a, b, c = np.moveaxis(self.corners(), 1, 0)
        face_normals = np.cross(b - a, c - a)
        vertex_normals = np.zeros_like(self.positions)
        for corner in range(3):
            np.add.at(vertex_normals, self.faces[:, corner], face_normals)
        axis = np.repeat(np.abs(face_normals).argmax(axis=1), 3)
        flat = np.repeat(face_normals, 3, axis=0)
        normals = vertex_normals[self.faces.ravel()] if smooth else flat
        points = self.positions[self.faces.ravel()]
        # Axes of the uv plane, chosen so that u x v follows the outward normal on either side.
        side = np.sign(flat[np.arange(len(axis)), axis])
        u = np.choose(axis, [points[:, 1], -points[:, 0], points[:, 0]]) * side
        v = -np.choose(axis, [points[:, 2], points[:, 2], points[:, 1]])
        rows = np.hstack([points, unit(normals), np.stack([u, v], 1) / tile]).round(6)
        unique, inverse = np.unique(rows, axis=0, return_inverse=True)
        return Mesh(unique[:, :3], inverse.reshape(-1, 3), unique[:, 3:6], unique[:, 6:])


def merged(meshes):
    starts = np.cumsum([0] + [len(mesh.positions) for mesh in meshes])
    return Mesh(np.vstack([mesh.positions for mesh in meshes]),
                np.vstack([mesh.faces + start for mesh, start in zip(meshes, starts)]))


def loft(rings, endless=False):
    """A skin over rings (insonify_worlds.rings.skin)."""
    return Mesh(*skin(rings, endless))


def tube(path, radius, sides=12, endless=False):
    """A round bar along a path [m, 3]."""
    path = np.asarray(path, float)
    ahead = np.roll(path, -1, 0) - np.roll(path, 1, 0) if endless else np.gradient(path, axis=0)
    ahead = unit(ahead)
    helper = np.where(np.abs(ahead[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    left = unit(np.cross(helper, ahead))
    up = np.cross(ahead, left)
    ring = circle(sides, radius)
    return loft(path[:, None] + ring[None, :, :1] * left[:, None] + ring[None, :, 1:] * up[:, None], endless)


def box(size, centre=(0, 0, 0)):
    square = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) / 2
    ends = [np.c_[square, np.full(4, z)] for z in (-0.5, 0.5)]
    return loft(np.array(ends) * size + centre)


def icosphere(subdivisions):
    """A unit sphere of 20 * 4^subdivisions triangles."""
    g = (1 + 5**0.5) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
              (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
             (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11),
             (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    points, faces = unit(np.array(points, float)), np.array(faces)
    for _ in range(subdivisions):
        a, b, c = np.moveaxis(points[faces], 1, 0)
        corners = np.stack([a, b, c, unit(a + b), unit(b + c), unit(c + a)], 1).reshape(-1, 3)
        points, index = np.unique(corners.round(9), axis=0, return_inverse=True)
        a, b, c, ab, bc, ca = index.reshape(-1, 6).T
        faces = np.vstack([np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return Mesh(unit(points), faces)
