"""Places of things: outlines that keep clear of each other, and bodies at rest on the floor."""

import math

import numpy as np

from . import shapes
from .glb import rotation, unit

TRIES = 1000


def convex_hull(points):
    """Corners of the convex hull of points in the plane, counter-clockwise (Andrew's monotone chain)."""
    points = np.unique(np.round(np.asarray(points, float), 6), axis=0)
    if len(points) < 3:
        return points

    def turns_left(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0])

    def chain(ordered):
        kept = []
        for p in ordered:
            while len(kept) > 1 and not turns_left(kept[-2], kept[-1], p):
                kept.pop()
            kept.append(p)
        return kept[:-1]

    ordered = points.tolist()
    return np.array(chain(ordered) + chain(ordered[::-1]))


def _axes(polygon):
    edges = np.roll(polygon, -1, 0) - polygon
    return np.stack([edges[:, 1], -edges[:, 0]], 1)


def _corner_distance(corners, polygon):
    """Distance from the nearest corner to an edge of the other polygon."""
    start, edge = polygon, np.roll(polygon, -1, 0) - polygon
    length = np.maximum((edge**2).sum(1), 1e-18)
    share = np.clip(((corners[:, None] - start) * edge).sum(-1) / length, 0, 1)
    return np.linalg.norm(corners[:, None] - start - share[..., None] * edge, axis=-1).min()


def distance(one, other):
    """Distance between two convex polygons; 0 if they overlap."""
    for axis in np.vstack([_axes(one), _axes(other)]):
        a, b = one @ axis, other @ axis
        if a.max() < b.min() or b.max() < a.min():
            return min(_corner_distance(one, other), _corner_distance(other, one))
    return 0.0


class Taken:
    """Occupied outlines, with the gap around each."""

    def __init__(self):
        self.polygons, self.gaps, self.boxes = [], [], np.empty((0, 4))

    def is_clear(self, polygons, gap):
        for polygon in polygons:
            low, high = polygon.min(0), polygon.max(0)
            gaps = np.maximum(self.gaps, gap)
            near = np.flatnonzero(
                (self.boxes[:, 0] - gaps <= high[0])
                & (self.boxes[:, 2] + gaps >= low[0])
                & (self.boxes[:, 1] - gaps <= high[1])
                & (self.boxes[:, 3] + gaps >= low[1])
            )
            if any(distance(polygon, self.polygons[i]) < gaps[i] + 1e-6 for i in near):
                return False
        return True

    def add(self, polygons, gap):
        self.polygons += polygons
        self.gaps = np.append(self.gaps, [gap] * len(polygons))
        self.boxes = np.vstack([self.boxes, [[*p.min(0), *p.max(0)] for p in polygons]])


class FlatGround:
    """The floor of a recipe without one."""

    def __init__(self, depth=10.0, size=(200.0, 200.0)):
        self.depth, self.size = depth, size
        self.low = (-size[0] / 2, -size[1] / 2)

    def height(self, x, y):
        return np.full(np.broadcast(x, y).shape, -self.depth)


def is_inside(polygons, ground):
    low, high = np.array(ground.low), np.array(ground.low) + ground.size
    return all((p >= low).all() and (p <= high).all() for p in polygons)


def tilt_about(axis_deg, angle_deg):
    """A rotation about a horizontal axis."""
    return rotation(yaw=axis_deg) @ rotation(roll=angle_deg) @ rotation(yaw=-axis_deg)


def floor_turn(ground, polygon):
    """The rotation that lays a horizontal plane onto the floor below an outline, by least
    squares."""
    middle = polygon.mean(0)
    points = np.vstack([polygon, middle, (polygon + middle) / 2])
    a = np.c_[points - middle, np.ones(len(points))]
    dx, dy, _ = np.linalg.lstsq(a, ground.height(points[:, 0], points[:, 1]), rcond=None)[0]
    up = unit(np.array([-dx, -dy, 1.0]))
    axis = np.cross([0, 0, 1], up)
    sine = np.linalg.norm(axis)
    if sine < 1e-9:
        return np.eye(3)
    x, y, z = axis / sine
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + sine * skew + (1 - up[2]) * skew @ skew


class Body:
    """A rigid model with the rotation that it has before it is laid onto the floor."""

    def __init__(self, model, turn):
        self.model, self.turn = model, turn
        self.points = shapes.vertices([solid for solid, _ in model.parts])
        core = shapes.hull(self.points).to_mesh().vert_properties[:, :3].astype(float)
        self.core = core if len(core) else self.points

    def outlines(self, turn, at):
        if self.model.outlines is None:
            return [convex_hull((self.core @ turn.T)[:, :2] + at)]
        return [outline @ turn[:2, :2].T + at for outline in self.model.outlines]

    def rest(self, ground, at, buried, height):
        """The rotation and the position of its origin: touching the floor in at least one point, then lowered by the
        buried share."""
        turn = (
            floor_turn(ground, convex_hull((self.core @ self.turn.T)[:, :2] + at)) @ self.turn
            if height == 0
            else self.turn
        )
        turned = self.points @ turn.T
        above = ground.height(turned[:, 0] + at[0], turned[:, 1] + at[1]) - turned[:, 2]
        tall = turned[:, 2].max() - turned[:, 2].min()
        return turn, np.array([*at, above.max() + height - (buried * tall if height == 0 else 0)])


def path_between(rng, start, end, meander, step):
    """Points about `step` apart from start to end, with two waves of random phase and at most `meander` to the side."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    length = np.linalg.norm(end - start)
    count = max(3, int(math.ceil(length / step)) + 1)
    share = np.linspace(0, 1, count)
    side = np.array([-(end - start)[1], (end - start)[0]]) / max(length, 1e-9)
    first, second = rng.uniform(-1, 1, 2)
    swing = meander * (0.6 * first * np.sin(np.pi * share) + 0.4 * second * np.sin(2 * np.pi * share))
    return start + share[:, None] * (end - start) + swing[:, None] * side


def along(path, step):
    """The path [n, d] in even steps of its own length, each at most `step`."""
    legs = np.linalg.norm(np.diff(path, axis=0), axis=1)
    at = np.concatenate([[0], np.cumsum(legs)])
    even = np.linspace(0, at[-1], max(2, int(math.ceil(at[-1] / step)) + 1))
    return np.stack([np.interp(even, at, path[:, axis]) for axis in range(path.shape[1])], 1)


def strip_outlines(path, half_width, longest=2.0):
    """Convex outlines that cover a strip about a path."""
    path = along(path[:, :2], longest)
    outlines = []
    for a, b in zip(path[:-1], path[1:]):
        ahead = unit(b - a) * half_width
        side = np.array([-ahead[1], ahead[0]])
        outlines.append(np.array([a - ahead - side, b + ahead - side, b + ahead + side, a - ahead + side]))
    return outlines
