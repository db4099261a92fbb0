"""A floor and things that keep clear of each other, as the nodes of one .glb file."""

import math
from dataclasses import dataclass

import numpy as np

from . import floor as floors
from . import materials
from .floor import Floor, Surface, boulder
from .glb import Glb, rotation
from .parameters import generator, read_parameters
from .places import (
    TRIES,
    Body,
    FlatGround,
    Taken,
    convex_hull,
    is_inside,
    path_between,
    strip_outlines,
    tilt_about,
)
from .shapes import bounds
from .things import THINGS
from .things.catalogue import CREASE_DEG, ENTRY, Model, may_be_thing

STONE_SHAPES = 8
MIN_EDGE_M = 1e-5  # shorter edges, which booleans leave behind, are removed


@dataclass
class Placed:
    """One node of the scene."""

    name: str
    surfaces: list  # pairs of surface and material
    at: tuple
    turn: np.ndarray


def surface_of(solid):
    """Triangles with normals, which are smooth at blunt edges. Triangles without area in single precision are
    removed."""
    mesh = solid.simplify(MIN_EDGE_M).calculate_normals(0, CREASE_DEG).to_mesh()
    points = mesh.vert_properties[:, :3]
    a, b, c = np.moveaxis(points[mesh.tri_verts].astype(float), 1, 0)
    faces = mesh.tri_verts[np.any(np.cross(b - a, c - a) != 0, axis=1)]
    normals = mesh.vert_properties[:, 3:6].round(6) + 0.0  # drops the last bits, in which versions of numpy differ
    return Surface(points, faces, normals)


def joined(surfaces):
    starts = np.cumsum([0] + [len(each.positions) for each in surfaces])
    return Surface(
        np.vstack([each.positions for each in surfaces]),
        np.vstack([each.faces + start for each, start in zip(surfaces, starts)]),
        np.vstack([each.normals for each in surfaces]),
    )


def surfaces_of(model):
    """One surface per material."""
    by_material = {}
    for solid, material in model.parts:
        if solid.num_tri() > 0:
            by_material.setdefault(material, []).append(surface_of(solid))
    return [(joined(surfaces), material) for material, surfaces in by_material.items()]


def centred(model):
    """The model, moved so that the middle of its box is above its origin."""
    low, high = bounds([solid for solid, _ in model.parts])
    offset = [*(-(low + high)[:2] / 2), 0]
    outlines = model.outlines and [outline + offset[:2] for outline in model.outlines]
    return Model([(solid.translate(offset), material) for solid, material in model.parts], outlines)


class Spot:
    """The area of a thing: x_m and y_m of an entry, or the whole floor if these are absent."""

    def __init__(self, x=None, y=None):
        self.laws = (x, y)

    def is_fixed(self):
        return all(law and law.is_fixed() for law in self.laws)

    def draw(self, rng, ground):
        at = rng.uniform(ground.low, np.array(ground.low) + ground.size)
        for axis, law in enumerate(self.laws):
            if law and not law.is_absent():
                at[axis] = law.draw(rng)
        return at

    def tries(self):
        return 1 if self.is_fixed() else TRIES


ANYWHERE = Spot()


class World:
    """A world with a budget of `max_triangles`. Beyond it, `refuse` is called with the number of triangles."""

    def __init__(self, seed, max_triangles=math.inf, refuse=None):
        self.seed, self.max_triangles, self.refuse, self.triangles = seed, max_triangles, refuse, 0
        self.ground = FlatGround()
        self.placed, self.taken, self.numbers = [], Taken(), {}

    def add(self, name, surfaces, at=(0, 0, 0), turn=np.eye(3)):
        self.triangles += sum(len(surface.faces) for surface, _ in surfaces)
        if self.triangles > self.max_triangles:
            self.refuse(self.triangles)
        self.placed.append(Placed(name, surfaces, at, turn))

    def number(self, name):
        self.numbers[name] = self.numbers.get(name, 0) + 1
        return f"{name}_{self.numbers[name]}"

    # The floor and its parts.

    def add_floor(self, item):
        self.ground = Floor(item, self.seed)
        matter = materials.sediment(self.ground.material)
        self.add("sea_floor", [(each, matter) for each in self.ground.surfaces()])

    def add_stones(self):
        """Places the rocks after the things, which need more space."""
        self.add_rocks(self.ground.stones(self.seed, "rocks", 5, floors.MAX_ROCKS))
        self.add_pebbles(self.ground.stones(self.seed, "pebbles", 6, floors.MAX_PEBBLES))

    def add_rocks(self, stones):
        if not stones:
            return
        item, values, sizes, rng = stones
        models = [surface_of(boulder(rng)) for _ in range(STONE_SHAPES)]
        matter = materials.solid(values["material"])
        for number, size in enumerate(sizes):
            turn = rotation(*rng.uniform(-180, 180, 3)) * size
            shape = models[number % STONE_SHAPES]
            turned = shape.positions @ turn.T
            outline = convex_hull(turned[:, :2])
            for _ in range(TRIES):
                at = ANYWHERE.draw(rng, self.ground)
                if is_inside([outline + at], self.ground) and self.taken.is_clear([outline + at], 0.0):
                    break
            else:
                item.fail(f"are {len(sizes)}, of which {number} found room; ask for fewer or smaller")
            self.taken.add([outline + at], 0.0)
            tall = np.ptp(turned[:, 2])
            z = (self.ground.height(*(turned[:, :2] + at).T) - turned[:, 2]).max() - values["buried"] * tall
            surface = Surface(turned, shape.faces, shape.normals @ (turn / size).T)
            self.add(self.number("rock"), [(surface, matter)], (*at, z))

    def add_pebbles(self, stones):
        """Puts all pebbles in one node; they may touch each other."""
        if not stones:
            return
        _, values, sizes, rng = stones
        if not len(sizes):
            return
        models = [surface_of(boulder(rng, 8)) for _ in range(STONE_SHAPES)]
        low, size = np.array(self.ground.low), np.array(self.ground.size)
        reach = sizes.max() / 2
        at = low + reach + rng.uniform(0, 1, (len(sizes), 2)) * (size - 2 * reach)
        z = self.ground.height(*at.T) + (0.45 - values["buried"]) * sizes
        yaw = rng.uniform(-math.pi, math.pi, len(sizes))
        matter = materials.solid(values["material"])
        surfaces = []
        for kind, shape in enumerate(models):
            mine = np.arange(kind, len(sizes), STONE_SHAPES)
            if not len(mine):
                continue
            c, s = np.cos(yaw[mine])[:, None], np.sin(yaw[mine])[:, None]

            def turned(vectors):
                x, y, up = vectors.T
                return np.stack([c * x - s * y, s * x + c * y, np.broadcast_to(up, c.shape[:1] + up.shape)], -1)

            points = turned(shape.positions) * sizes[mine, None, None] + np.c_[at, z][mine, None]
            faces = shape.faces[None] + (np.arange(len(mine)) * len(shape.positions))[:, None, None]
            surfaces.append(
                (Surface(points.reshape(-1, 3), faces.reshape(-1, 3), turned(shape.normals).reshape(-1, 3)), matter)
            )
        self.add("pebbles", surfaces)

    # Things.

    def add_entry(self, item, index):
        name = item.value.get("thing") if isinstance(item.value, dict) else None
        if name is None:
            item.fail(
                "must be a block with the key thing"
                if not isinstance(item.value, dict)
                else f"has no key thing, which may be {', '.join(THINGS)}"
            )
        if not isinstance(name.value, str) or name.value not in THINGS:
            name.fail(f"is {name.said()}; {may_be_thing(name.value)}")
        thing = THINGS[name.value]
        parameters = thing.all_parameters() + ENTRY
        block = item.block(["thing", *(each.name for each in parameters)])
        laws = read_parameters(block, parameters)
        spot = Spot(laws.laws.pop("x_m"), laws.laws.pop("y_m"))
        count = laws.laws["count"].draw(generator(self.seed, 10, index))
        for number in range(count):
            rng = generator(self.seed, 11, index, number)
            values = laws.draw(rng)
            node = self.number(values["name"] or thing.name)
            if not self.place(thing, values, rng, node, spot):
                tries = "at its place" if spot.is_fixed() else f"in {TRIES} tries"
                item.fail(
                    f"asks for {count}, of which {number} found room {tries}: on the floor, and gap_m or more from others; "
                    "give a larger floor, fewer things, smaller things, or a smaller gap_m"
                )

    def place(self, thing, values, rng, node, spot):
        """Returns whether it found a place."""
        placed = {"body": self.place_body, "line": self.place_line, "structure": self.place_structure}[thing.kind]
        return placed(thing, values, rng, node, spot)

    def place_body(self, thing, values, rng, node, spot):
        model = centred(thing.build(rng, values))
        heading = rng.uniform(-180, 180) if values["heading_deg"] is None else values["heading_deg"]
        body = Body(model, tilt_about(rng.uniform(-180, 180), values["tilt_deg"]) @ rotation(yaw=heading))
        for _ in range(spot.tries()):
            at = spot.draw(rng, self.ground)
            if not self.is_free(body.outlines(body.turn, at), values["gap_m"]):
                continue
            turn, position = body.rest(self.ground, at, values["buried"], values["height_m"])
            outlines = body.outlines(turn, at)
            if self.is_free(outlines, values["gap_m"]):
                self.taken.add(outlines, values["gap_m"])
                self.add(node, surfaces_of(model), tuple(position), turn)
                return True
        return False

    def is_free(self, outlines, gap):
        return is_inside(outlines, self.ground) and self.taken.is_clear(outlines, gap)

    def place_structure(self, thing, values, rng, node, spot):
        turn = rotation(yaw=values["heading_deg"])
        body = None
        for _ in range(spot.tries()):
            at = spot.draw(rng, self.ground)
            depth = -float(self.ground.height(*at))
            body = body or Body(thing.build(rng, values, depth), turn)  # outlines do not depend on the depth
            outlines = body.outlines(turn, at)
            if self.is_free(outlines, values["gap_m"]):
                self.taken.add(outlines, values["gap_m"])
                self.add(node, surfaces_of(thing.build(rng, values, depth)), (*at, 0.0), turn)
                return True
        return False

    def ends_of(self, values, rng, spot):
        length = values["length_m"]
        start, end = values["from_m"], values["to_m"]
        heading = math.radians(rng.uniform(-180, 180) if values["heading_deg"] is None else values["heading_deg"])
        ahead = np.array([math.cos(heading), math.sin(heading)]) * length
        if start is None and end is None:
            middle = spot.draw(rng, self.ground)
            return middle - ahead / 2, middle + ahead / 2
        if start is None:
            return np.array(end) - ahead, np.array(end)
        return np.array(start), np.array(start) + ahead if end is None else np.array(end)

    def place_line(self, thing, values, rng, node, spot):
        for _ in range(TRIES):
            start, end = self.ends_of(values, rng, spot)
            path = path_between(rng, start, end, values["meander_m"], 0.1)
            outlines = strip_outlines(path, thing.half_width(values))
            if not self.is_free(outlines, values["gap_m"]):
                continue
            self.taken.add(outlines, values["gap_m"])
            model = thing.build(rng, values, self.ground, path)
            middle = path[len(path) // 2]
            origin = np.array([*middle, float(self.ground.height(*middle))])
            model.parts = [(solid.translate(-origin), material) for solid, material in model.parts]
            self.add(node, surfaces_of(model), tuple(origin))
            return True
        return False

    # The file.

    def write(self, path):
        glb = Glb()
        used = {}
        ripples = getattr(self.ground, "small_ripples", None)
        normal_map = glb.normal_map(ripples.normal_map()) if ripples else None
        for placed in self.placed:
            pairs = []
            for surface, material in placed.surfaces:
                if material not in used:
                    is_floor = placed.name == "sea_floor"
                    used[material] = glb.material(
                        material.name, material.acoustics(), material.colour, normal_map if is_floor else None
                    )
                pairs.append((surface, used[material]))
            mesh = glb.mesh_of(placed.name, pairs)
            glb.node(placed.name, mesh, placed.at, placed.turn)
        glb.write(path)
