"""Sea floors: a grid of heights with relief by a power law, ripples, pockmarks, and rocks and pebbles on it.

The water surface is z = 0; the mean floor is at -depth_m.
"""

import math
from dataclasses import dataclass

import numpy as np

from . import materials, shapes
from .glb import unit
from .parameters import Choice, Number, Point, generator, read_parameters

MAX_CELLS = 2_000_000
TILE_WAVES, TILE_STEPS = 16, 16  # a tile of ripples: wavelengths on a side, points to a wavelength
STRIP = 60_000  # vertices of a part of the grid, so that its indices are short

FLOOR = [
    Point("size_m", (60, 40), "extent north and west", 1, 5000),
    Point("centre_m", (0, 0), "its middle, north and west of the world's zero", -1e5, 1e5),
    Number("depth_m", 10.0, "mean depth of water", 0.5, 11000),
    Number("cell_m", 0.2, "between two points of the grid", 0.005, 50),
    Number("slope_deg", 0.0, "of the whole floor", 0, 45),
    Number("slope_heading_deg", 0.0, "direction in which the floor rises, from north to west", -360, 360),
    Choice("material", "sand", "a sediment", (*materials.COMMON_NAMES, *materials.SEDIMENTS)),
]
FRACTAL = [
    Number("slope", 3.2, "power per area of the wave-number plane falls as the wave number to this power", 1, 5),
    Number("rms_m", 0.2, "root mean square of the relief", 0, 50),
    Number("longest_m", 0.0, "longest wave; 0: as long as the floor", 0, 10000),
]
RIPPLES = [
    Number("height_m", 0.04, "trough to crest", 0.001, 5),
    Number("length_m", 0.3, "crest to crest", 0.02, 200),
    Number("heading_deg", 0.0, "direction across the crests, from north to west; the steep side is there", -360, 360),
    Number("asymmetry", 0.0, "0: both sides alike; 0.9: steep on one side", 0, 0.9),
    Number("wander", 0.3, "how far crests leave straight lines, in wavelengths", 0, 1),
]
POCKMARKS = [
    Number("count", 3, "pockmarks", 0, 500, whole=True),
    Number("diameter_m", 4.0, "from edge to edge", 0.1, 500),
    Number("depth_m", 0.5, "below the floor around", 0.01, 50),
]
ROCKS = [
    Number("per_m2", 0.02, "number density", 0, 50),
    Number("min_m", 0.2, "smallest diameter", 0.01, 20),
    Number("max_m", 1.0, "largest diameter", 0.01, 20),
    Number("exponent", 2.5, "the number of rocks larger than d falls as d to this power", 0.1, 6),
    Number("buried", 0.3, "share of the height below the floor", 0, 0.9),
    Choice("material", "rock", "matter", ("rock", "granite", "limestone", "concrete")),
]
PEBBLES = [
    Number("per_m2", 1.0, "number density", 0, 500),
    Number("min_m", 0.02, "smallest diameter", 0.005, 0.5),
    Number("max_m", 0.08, "largest diameter", 0.005, 0.5),
    Number("exponent", 2.5, "the number of pebbles larger than d falls as d to this power", 0.1, 6),
    Number("buried", 0.4, "share of the height below the floor", 0, 0.9),
    Choice("material", "rock", "matter", ("rock", "granite", "limestone")),
]
BLOCKS = {"fractal": FRACTAL, "ripples": RIPPLES, "pockmarks": POCKMARKS, "rocks": ROCKS, "pebbles": PEBBLES}
MAX_ROCKS, MAX_PEBBLES = 5000, 50_000


@dataclass
class Surface:
    """Triangles with normals, and the coordinates of a normal map."""

    positions: np.ndarray
    faces: np.ndarray
    normals: np.ndarray
    uvs: np.ndarray = None


def power_law_relief(rng, shape, cell, slope, rms, longest):
    """A Gaussian relief [m] whose power spectrum falls as |k|^-slope: a part of a relief that is periodic over twice
    the extent."""
    size = [2 * n for n in shape]
    k = np.hypot(*np.meshgrid(*(np.fft.fftfreq(n, cell) for n in size), indexing="ij"))
    lowest = 1 / longest
    amplitude = np.where(k >= lowest * 0.999, np.maximum(k, lowest), np.inf) ** (-slope / 2)
    relief = np.fft.ifft2(np.fft.fft2(rng.standard_normal(size)) * amplitude).real[: shape[0], : shape[1]]
    relief = relief - relief.mean()
    deviation = relief.std()
    return relief * (rms / deviation) if deviation > 0 else relief


class Ripples:
    """A periodic tile of ripples: u is across the crests, v along them."""

    def __init__(self, rng, values):
        self.height, self.length = values["height_m"], values["length_m"]
        self.heading, self.asymmetry = math.radians(values["heading_deg"]), values["asymmetry"]
        self.tile = TILE_WAVES * self.length
        n = TILE_WAVES * TILE_STEPS
        k = np.fft.fftfreq(n) * n
        near = np.exp(-(np.hypot(k[:, None], k[None]) ** 2) / (2 * (TILE_WAVES / 8) ** 2))
        wander = np.fft.ifft2(np.fft.fft2(rng.standard_normal((n, n))) * near).real
        wander *= values["wander"] * 0.5 / max(wander.std(), 1e-12)
        phase = 2 * np.pi * (np.arange(n)[:, None] / TILE_STEPS + wander)
        self.grid = self.height / 2 * np.sin(phase + self.asymmetry * 0.9 * np.sin(phase))

    def is_geometry(self, cell):
        return self.length >= 6 * cell

    def places(self, x, y):
        """Coordinates in tiles."""
        c, s = math.cos(self.heading), math.sin(self.heading)
        return (c * x + s * y) / self.tile, (-s * x + c * y) / self.tile

    def at(self, x, y):
        n = len(self.grid)
        (u, v) = self.places(x, y)
        u, v = u % 1 * n, v % 1 * n
        i, j = np.floor(u).astype(int), np.floor(v).astype(int)
        a, b = u - i, v - j
        i, j, k, m = i % n, j % n, (i + 1) % n, (j + 1) % n
        g = self.grid
        return (1 - a) * ((1 - b) * g[i, j] + b * g[i, m]) + a * ((1 - b) * g[k, j] + b * g[k, m])

    def normal_map(self):
        """8-bit RGB: columns along u, rows against v."""
        pixel = self.tile / len(self.grid)
        rows = self.grid.T[::-1]
        along_u = (np.roll(rows, -1, 1) - np.roll(rows, 1, 1)) / (2 * pixel)
        along_v = (np.roll(rows, 1, 0) - np.roll(rows, -1, 0)) / (2 * pixel)
        normals = unit(np.stack([-along_u, -along_v, np.ones_like(rows)], -1))
        return np.round((normals + 1) * 127.5).astype(np.uint8)


def sizes_by_power(rng, count, low, high, exponent):
    """Diameters in ascending order; the number above d falls as d^-exponent."""
    share = rng.uniform(0, 1, count)
    a, b = low**-exponent, high**-exponent
    return (a - share * (a - b)) ** (-1 / exponent)


class Floor:
    """Heights on a grid, and the parameters drawn for them."""

    def __init__(self, item, seed):
        self.item = item
        known = [each.name for each in FLOOR] + list(BLOCKS)
        block = item.block(known)
        values = read_parameters(block, FLOOR).draw(generator(seed, 1))
        self.size, self.centre, self.depth = values["size_m"], values["centre_m"], values["depth_m"]
        self.material = values["material"]
        self.shape = tuple(int(round(side / values["cell_m"])) + 1 for side in self.size)
        if min(self.shape) < 3 or (self.shape[0] - 1) * (self.shape[1] - 1) > MAX_CELLS:
            cells = (self.shape[0] - 1) * (self.shape[1] - 1)
            min_cell = math.sqrt(self.size[0] * self.size[1] / MAX_CELLS)
            block.get("cell_m", item).fail(
                f"makes {cells} cells of a floor of {self.size[0]:g} x {self.size[1]:g} m; must make 3 points on a side and at "
                f"most {MAX_CELLS} cells: from {min_cell:.2g} m to {min(self.size) / 2:g} m"
            )
        self.steps = tuple(side / (n - 1) for side, n in zip(self.size, self.shape))
        self.low = tuple(middle - side / 2 for middle, side in zip(self.centre, self.size))
        self.x = self.low[0] + self.steps[0] * np.arange(self.shape[0])[:, None] + np.zeros(self.shape)
        self.y = self.low[1] + self.steps[1] * np.arange(self.shape[1])[None] + np.zeros(self.shape)
        self.z = self.base(values)
        self.small_ripples = None
        self.laws = {name: self.laws_of(block, name) for name in BLOCKS}
        self.add_fractal(seed, block)
        self.add_pockmarks(seed, block)
        self.add_ripples(seed, block)
        if self.z.max() > -0.1:
            item.fail(
                f"rises to z = {self.z.max():.2f} m; must stay 0.1 m below the water surface: give a larger depth_m"
            )

    def laws_of(self, block, name):
        """Reads one block, or for ripples a list of blocks."""
        if name not in block:
            return []
        items = [block[name]]
        if name == "ripples" and isinstance(block[name].value, list):
            items = block[name].value
        parameters = BLOCKS[name]
        return [(each, read_parameters(each.block([p.name for p in parameters]), parameters)) for each in items]

    def base(self, values):
        heading, rise = math.radians(values["slope_heading_deg"]), math.tan(math.radians(values["slope_deg"]))
        along = (self.x - self.centre[0]) * math.cos(heading) + (self.y - self.centre[1]) * math.sin(heading)
        return -self.depth + rise * along

    def add_fractal(self, seed, block):
        for _, laws in self.laws["fractal"]:
            rng = generator(seed, 2)
            values = laws.draw(rng)
            longest = values["longest_m"] or max(self.size)
            if longest < 4 * max(self.steps):
                block["fractal"].value["longest_m"].fail(
                    f"is {longest:g}; must be 0 or at least four cells, {4 * max(self.steps):g} m"
                )
            self.z += power_law_relief(rng, self.shape, sum(self.steps) / 2, values["slope"], values["rms_m"], longest)

    def add_pockmarks(self, seed, block):
        for item, laws in self.laws["pockmarks"]:
            rng = generator(seed, 3)
            places = []
            for number in range(laws.draw(rng)["count"]):
                values = laws.draw(rng)
                radius = values["diameter_m"] / 2
                if radius < 2 * max(self.steps):
                    item.value.get("diameter_m", item).fail(
                        f"is {2 * radius:.3g} m; must be at least four cells of the floor, {4 * max(self.steps):.3g} m"
                    )
                for _ in range(1000):
                    x, y = (
                        rng.uniform(low + radius, low + side - radius) if side > 2 * radius else math.nan
                        for low, side in zip(self.low, self.size)
                    )
                    if all(math.hypot(x - a, y - b) > radius + r for a, b, r in places) and not math.isnan(x + y):
                        break
                else:
                    item.fail(
                        f"{number} pockmarks found room, the next did not in 1000 tries; ask for fewer or smaller"
                    )
                places.append((x, y, radius))
                share = np.clip(1 - ((self.x - x) ** 2 + (self.y - y) ** 2) / radius**2, 0, None)
                self.z -= values["depth_m"] * share**2

    def add_ripples(self, seed, block):
        for number, (item, laws) in enumerate(self.laws["ripples"]):
            rng = generator(seed, 4, number)
            ripples = Ripples(rng, laws.draw(rng))
            if ripples.is_geometry(max(self.steps)):
                self.z += ripples.at(self.x, self.y)
            elif self.small_ripples is None:
                self.small_ripples = ripples
            else:
                item.fail(
                    f"are the second with a wavelength below six cells ({6 * max(self.steps):.3g} m), which are a normal map; "
                    "only one may be"
                )

    def height(self, x, y):
        """Normals of the triangles at these places [m]."""
        u = np.clip((np.asarray(x, float) - self.low[0]) / self.steps[0], 0, self.shape[0] - 1)
        v = np.clip((np.asarray(y, float) - self.low[1]) / self.steps[1], 0, self.shape[1] - 1)
        i, j = np.minimum(u.astype(int), self.shape[0] - 2), np.minimum(v.astype(int), self.shape[1] - 2)
        u, v, z = u - i, v - j, self.z
        a, b, c, d = z[i, j], z[i + 1, j], z[i + 1, j + 1], z[i, j + 1]
        return np.where(u >= v, a + u * (b - a) + v * (c - b), a + v * (d - a) + u * (c - d))

    def surfaces(self):
        """Strips of the grid."""
        dx, dy = np.gradient(self.z, *self.steps)
        normals = unit(np.stack([-dx, -dy, np.ones_like(dx)], -1))
        points = np.stack([self.x, self.y, self.z], -1)
        uvs = None
        if self.small_ripples:
            u, v = self.small_ripples.places(self.x, self.y)
            uvs = np.stack([u - math.floor(u.min()), math.ceil(v.max()) - v], -1)
        rows, columns = self.shape
        a = np.arange(columns - 1)
        for first in range(0, rows - 1, each := max(1, STRIP // columns - 1)):
            count = min(each, rows - 1 - first)
            corner = (np.arange(count)[:, None] * columns + a).ravel()
            b, c, d = corner + columns, corner + columns + 1, corner + 1
            faces = np.vstack([np.stack([corner, b, c], 1), np.stack([corner, c, d], 1)])
            keep = slice(first, first + count + 1)
            yield Surface(
                points[keep].reshape(-1, 3),
                faces,
                normals[keep].reshape(-1, 3),
                None if uvs is None else uvs[keep].reshape(-1, 2),
            )

    def stones(self, seed, name, word, max_count):
        """Diameters and values of rocks or pebbles, the largest first; none if the recipe has none."""
        for item, laws in self.laws[name]:
            rng = generator(seed, word)
            values = laws.draw(rng)
            count = int(round(values["per_m2"] * self.size[0] * self.size[1]))
            if count > max_count:
                item.fail(
                    f"are {count} on {self.size[0] * self.size[1]:g} m2; at most {max_count}: give per_m2 up to "
                    f"{max_count / (self.size[0] * self.size[1]):.3g}"
                )
            if values["min_m"] > values["max_m"]:
                item.fail(f"have min_m {values['min_m']:g} above max_m {values['max_m']:g}")
            sizes = sizes_by_power(rng, count, values["min_m"], values["max_m"], values["exponent"])
            return item, values, np.sort(sizes)[::-1], rng
        return None


def boulder(rng, segments=16):
    """A stone of about 1 m diameter: a ball cut by planes and roughened."""
    planes = unit(rng.standard_normal((14, 3)))
    reach = rng.uniform(0.32, 0.52, 14)
    waves, phase = rng.normal(0, 5, (6, 3)), rng.uniform(0, 2 * np.pi, 6)

    def shaped(points):
        points = unit(np.asarray(points))
        radius = np.minimum((reach / np.clip(points @ planes.T, 0.05, None)).min(1), 0.55)
        radius = radius * (1 + 0.02 * np.sin(points @ waves.T + phase).sum(1))
        return points * radius[:, None]

    return shapes.ball(1.0, sides=segments).warp_batch(shaped)
