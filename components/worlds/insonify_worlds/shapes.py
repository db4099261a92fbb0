"""Closed solids, each a manifold3d.Manifold: x ahead, y to port, z up, in metres. Booleans come from manifold3d."""

import math

import numpy as np
from manifold3d import CrossSection, Manifold, Mesh, OpType

from .glb import rotation, unit  # noqa: F401: for the things
from .rings import circle, skin

TURN = 2 * math.pi


def moved(solid, at=(0, 0, 0), turn=None):
    """The solid turned about the origin, then moved."""
    turn = np.eye(3) if turn is None else np.asarray(turn)
    return solid.transform(np.column_stack([turn, np.asarray(at, float)]))


def box(size, at=(0, 0, 0)):
    return Manifold.cube(size, True).translate(at)


def cylinder(radius, length, at=(0, 0, 0), axis="z", sides=32, top_radius=None):
    """A cylinder about its middle `at`, along an axis; a cone if the top radius differs."""
    solid = Manifold.cylinder(length, radius, radius if top_radius is None else top_radius, sides, True)
    turns = {"z": (0, 0, 0), "x": (0, 90, 0), "y": (-90, 0, 0)}
    return solid.rotate(turns[axis]).translate(at)


def ball(radius, at=(0, 0, 0), sides=32):
    return Manifold.sphere(radius, sides).translate(at)


def revolved(profile, sides=48):
    """A closed polygon of (radius, height) turned about the z axis."""
    section = CrossSection([np.asarray(profile, float)])
    if section.area() < 1e-12:  # the polygon is clockwise
        section = CrossSection([np.asarray(profile, float)[::-1]])
    return Manifold.revolve(section, sides)


def extruded(outline, height):
    """A polygon of (x, y), extruded from z = 0."""
    outline = np.asarray(outline, float)
    x, y = outline.T
    if np.dot(x, np.roll(y, -1)) < np.dot(y, np.roll(x, -1)):
        outline = outline[::-1]
    return CrossSection([outline]).extrude(height)


def from_mesh(positions, faces):
    return Manifold(Mesh(np.asarray(positions, np.float32), np.asarray(faces, np.uint32)))


def loft(rings, closed=False):
    """The solid under a skin over rings (rings.skin)."""
    return from_mesh(*skin(rings, closed))


def tube(path, radius, sides=12, closed=False):
    """A round bar along a path [m, 3]; `radius` is one for all points, or one per point."""
    path = np.asarray(path, float)
    ahead = unit(np.roll(path, -1, 0) - np.roll(path, 1, 0) if closed else np.gradient(path, axis=0))
    mean = np.abs(ahead).mean(0)
    left = unit(np.cross(np.eye(3)[mean.argmin()], ahead[0]))
    lefts = []
    for direction in ahead:  # carried along, so that the bar has no twist
        left = unit(left - direction * np.dot(left, direction))
        lefts.append(left)
    lefts = np.array(lefts)
    if closed:  # the remaining twist is distributed evenly
        first = unit(left - ahead[0] * np.dot(left, ahead[0]))
        angle = math.atan2(np.dot(np.cross(first, lefts[0]), ahead[0]), np.dot(first, lefts[0]))
        share = np.arange(len(path))[:, None] / len(path) * angle
        lefts = lefts * np.cos(share) + np.cross(ahead, lefts) * np.sin(share)
    ups = np.cross(ahead, lefts)
    ring = circle(sides)[None] * np.broadcast_to(radius, len(path))[:, None, None]
    return loft(path[:, None] + ring[..., :1] * lefts[:, None] + ring[..., 1:] * ups[:, None], closed)


def bar(start, end, radius, sides=8):
    return tube([start, end], radius, sides)


def torus(major, minor, sides=48, section_sides=16):
    """About the z axis."""
    return Manifold.revolve(CrossSection([circle(section_sides, minor) + (major, 0)]), sides)


def union(solids):
    return Manifold.batch_boolean(list(solids), OpType.Add)


def hull(points):
    return Manifold.hull_points(np.asarray(points, float))


def bounds(solids):
    """Lowest and highest corner of all."""
    boxes = np.array([solid.bounding_box() for solid in solids])
    return boxes[:, :3].min(0), boxes[:, 3:].max(0)


def vertices(solids):
    return np.vstack([solid.to_mesh().vert_properties[:, :3] for solid in solids]).astype(float)
