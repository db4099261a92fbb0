#!/usr/bin/env python3
"""Makes deploy/scenes/harbour.glb, harbour_pass.csv and harbour_round.csv: a quay, a wreck and a fractal sea floor.

The water surface is z = 0, the floor about z = -9; the quay runs north along y = 9 (west) and the vehicle passes it at
y = 0. The script always makes the same bytes; it needs numpy. With a survey's .npz (array `elev`, 2 m spacing) as argument the spectral slope of that
tile is printed next to the floor's.

The spectral slope is that of the radial power spectrum: power per unit area of the wave-number plane, averaged over
direction, falls as |k|^slope. The floor is a Gaussian surface whose slope is -2.7, as measured on a real survey.
"""
import math
import sys
from pathlib import Path

import numpy as np

from glb import Glb, Mesh, box, icosphere, loft, merged, quaternion, rotation, tube, unit

SCENES = Path(__file__).resolve().parents[2] / "deploy" / "scenes"
SPECTRAL_SLOPE = -2.7
SPACING = 0.32          # grid of the floor [m]
TILE = 800              # grid points on a side of the whole fractal surface: 256 m
RELIEF = 1.0            # height difference over the whole surface [m]
DEPTH = 9.0             # mean [m]
SOUTH, EAST = -30.0, -52.0   # corner of the part that is kept [m]
ROWS, COLUMNS = 352, 194     # its grid points: 112 m north, 62 m west
QUAY = 9.0              # y of the wall's face [m]
BUOY = -6.9             # z of the chain's upper end, under a buoy below the surface [m]


def fractal_surface(rng):
    """A periodic Gaussian surface [TILE, TILE] with the wanted spectral slope and relief [m]."""
    k = np.fft.fftfreq(TILE, SPACING)
    k = np.hypot(k[:, None], k[None])
    k[0, 0] = np.inf
    noise = np.fft.fft2(rng.standard_normal((TILE, TILE)))
    surface = np.fft.ifft2(noise * k ** (SPECTRAL_SLOPE / 2)).real
    return surface * RELIEF / np.ptp(surface)


def radial_spectral_slope(surface):
    """Least-squares slope of log power against log |k|: power of the windowed surface, averaged over rings of |k| one
    cycle per side wide, from two cycles per side to the Nyquist wave number."""
    n = len(surface)
    power = np.abs(np.fft.fft2((surface - surface.mean()) * np.outer(np.hanning(n), np.hanning(n)))) ** 2
    k = np.fft.fftfreq(n) * n
    ring = np.hypot(k[:, None], k[None]).round().astype(int).ravel()
    mean_power = np.bincount(ring, power.ravel()) / np.bincount(ring)
    cycles = np.arange(2, (n + 1) // 2)
    return np.polyfit(np.log(cycles), np.log(mean_power[cycles]), 1)[0]


class Floor:
    """The part of the fractal surface that the scene keeps."""

    def __init__(self, surface):
        self.height = surface[:ROWS, :COLUMNS] - surface[:ROWS, :COLUMNS].mean() - DEPTH

    def z(self, x, y):
        """Bilinear height at a place [m]."""
        row, column = (np.asarray(x) - SOUTH) / SPACING, (np.asarray(y) - EAST) / SPACING
        i = np.clip(row.astype(int), 0, ROWS - 2)
        j = np.clip(column.astype(int), 0, COLUMNS - 2)
        a, b = row - i, column - j
        h = self.height
        return ((1 - a) * ((1 - b) * h[i, j] + b * h[i, j + 1]) + a * ((1 - b) * h[i + 1, j] + b * h[i + 1, j + 1]))

    def parts(self, strips=4, ripple_tile=4.0):
        """Strips of fewer than 65,536 points, so that indices have 16 bits."""
        dx, dy = np.gradient(self.height, SPACING)
        normals = unit(np.stack([-dx, -dy, np.ones_like(dx)], -1))
        i, j = np.mgrid[:ROWS, :COLUMNS]
        x, y = SOUTH + SPACING * i, EAST + SPACING * j
        points = np.stack([x, y, self.height], -1)
        uvs = np.stack([x, -y], -1) / ripple_tile
        for rows in np.array_split(np.arange(ROWS - 1), strips):
            keep = slice(rows[0], rows[-1] + 2)
            a = (np.arange(len(rows))[:, None] * COLUMNS + np.arange(COLUMNS - 1)).ravel()
            b, c, d = a + COLUMNS, a + COLUMNS + 1, a + 1
            faces = np.vstack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
            yield Mesh(points[keep].reshape(-1, 3), faces, normals[keep].reshape(-1, 3), uvs[keep].reshape(-1, 2))


def normal_map(height, pixel):
    """Tangent-space normals of a periodic relief [m] whose rows run downwards; 8-bit RGB."""
    along_u = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) / (2 * pixel)
    along_v = (np.roll(height, 1, 0) - np.roll(height, -1, 0)) / (2 * pixel)
    normals = unit(np.stack([-along_u, -along_v, np.ones_like(height)], -1))
    return np.round((normals + 1) * 127.5).astype(np.uint8)


def relief(rng, size, tile, shape, rms_slope):
    """A periodic relief [size, size] of `tile` metres whose amplitude spectrum is shape(kx, ky) [1/m], of given slope."""
    k = np.fft.fftfreq(size, tile / size)
    height = np.fft.ifft2(np.fft.fft2(rng.standard_normal((size, size))) * shape(k[None], k[:, None])).real
    slopes = np.gradient(height, tile / size)
    return height * rms_slope / np.sqrt(sum((s**2).mean() for s in slopes))


def ripples(rng):
    """Sand ripples of 0.33 m, their crests roughly across the track, over a finer rough relief; tile 4 m."""
    def crests(kx, ky):
        return sum(np.exp(-((kx - s * 2.9) ** 2 + (ky - s * 0.8) ** 2) / (2 * 0.35**2)) for s in (-1, 1))

    waves = relief(rng, 256, 4.0, crests, 0.05)
    rough = relief(rng, 256, 4.0, lambda kx, ky: np.exp(-np.hypot(kx, ky) / 8), 0.04)
    return normal_map(waves + rough, 4.0 / 256)


def pitted_stone(rng):
    """Weathered rock or concrete with growth on it; tile 1 m."""
    return normal_map(relief(rng, 128, 1.0, lambda kx, ky: 1 / (1 + np.hypot(kx, ky) / 6) ** 2, 0.25), 1.0 / 128)


def quay(rng, length=112.0, panel=4.0):
    """Concrete panels with open joints before a back wall, and a cap above the water."""
    solids = [box((length, 1.0, 14.0), (SOUTH + length / 2, QUAY + 0.7, -5.0)),
              box((length, 2.0, 1.0), (SOUTH + length / 2, QUAY + 0.9, 2.5))]
    for x in np.arange(SOUTH, SOUTH + length, panel):
        for z in (-10.4, -7.9, -5.4, -2.9, -0.4):
            setback = rng.uniform(0, 0.05)
            solids.append(box((panel - 0.12, 0.25, 2.4), (x + panel / 2, QUAY + 0.125 + setback, z)))
    return merged(solids)


def ladder(top=1.5, bottom=-8.3):
    rails = [tube([(x, 0, bottom), (x, 0, top)], 0.04, 8) for x in (-0.25, 0.25)]
    rungs = [tube([(-0.25, 0, z), (0.25, 0, z)], 0.02, 6) for z in np.arange(bottom + 0.2, top, 0.3)]
    brackets = [tube([(x, 0, z), (x, 0.5, z)], 0.03, 6) for x in (-0.25, 0.25) for z in np.arange(bottom + 0.5, top, 2.2)]
    return merged(rails + rungs + brackets)


def wreck():
    """A 15 m steel coaster: lofted hull, coaming, deckhouse, mast; keel down, deck at z = 0."""
    station = np.linspace(-1, 1, 25)
    half_beam = 2.1 * np.clip(np.where(station > 0, 1 - np.abs(station) ** 2.6, 1 - 0.25 * station**4), 0.02, None)
    draught = 2.3 * np.where(station > 0, 1 - 0.35 * station**4, 1 - 0.3 * station**6)
    sheer = 0.5 * station**2
    angle = np.linspace(np.pi, 2 * np.pi, 17)            # starboard deck edge, keel, port deck edge
    across = np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** 0.5
    down = -np.abs(np.sin(angle)) ** 0.6
    rings = [np.stack([np.full(17, 7.5 * s), b * across, h + d * down], 1)
             for s, b, d, h in zip(station, half_beam, draught, sheer)]
    house = [box((2.8, 2.6, 1.9), (-4.6, 0, 1.1)), box((1.6, 2.2, 0.8), (-4.4, 0, 2.4)),
             tube([(-3.0, 0, 0), (-3.0, 0, 4.0)], 0.1, 8)]
    hatch = [box((4.6, 0.15, 0.6), (1.0, y, 0.3)) for y in (-1.2, 1.2)] + [box((0.15, 2.4, 0.6), (x, 0, 0.3)) for x in (-1.3, 3.3)]
    return merged([loft(rings)] + house + hatch)


def boulder(rng, subdivisions=2):
    """A sphere of about 1 m diameter cut by random planes and roughened."""
    sphere = icosphere(subdivisions)
    planes = unit(rng.standard_normal((14, 3)))
    reach = rng.uniform(0.32, 0.52, 14) / np.clip(sphere.positions @ planes.T, 0.05, None)
    radius = np.minimum(reach.min(1), 0.55) * (1 + 0.04 * rng.standard_normal(len(sphere.positions)))
    return Mesh(sphere.positions * radius[:, None], sphere.faces).textured(1.0, smooth=True)


def link():
    """A chain link in the xy plane, 0.32 m long, of 45 mm bar."""
    angle = np.arange(20) * 2 * np.pi / 20
    oval = np.stack([0.055 * np.sign(np.cos(angle)) + 0.08 * np.cos(angle), 0.08 * np.sin(angle), 0 * angle], 1)
    return tube(oval, 0.0225, 8, endless=True)


def chain_path(floor):
    """From the side of the mooring block in curves over the floor, then up as a catenary: points 0.2 m
    apart."""
    t = np.linspace(0, 1, 400)
    x, y = 20 + 7 * t, -7 + 1.6 * np.sin(2 * np.pi * t) + 2.5 * t
    lying = np.stack([x, y, floor.z(x, y) + 0.06], 1)
    t = np.linspace(0, 1, 400)[1:]
    rise = (BUOY - lying[-1, 2]) * (np.cosh(2.2 * t) - 1) / (np.cosh(2.2) - 1)
    rising = lying[-1] + np.stack([5 * t, 1.2 * t, rise], 1)
    path = np.vstack([lying, rising])
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    at = np.arange(1.0, along[-1] - 0.1, 0.2)
    return np.stack([np.interp(at, along, path[:, axis]) for axis in range(3)], 1)


def add_chain(glb, floor, steel, concrete):
    block = np.array([20.0, -7.0])
    glb.node("mooring_block", glb.mesh("mooring_block", [box((1.4, 1.4, 0.8)).textured(1.0, smooth=False)], concrete),
             (*block, floor.z(*block) + 0.2), rotation(4, -5, 30))
    mesh = glb.mesh("chain_link", [link()], steel)
    path = chain_path(floor)
    for n, (here, ahead) in enumerate(zip(path, unit(np.gradient(path, axis=0)))):
        left = unit(np.cross([0, 0, 1], ahead))
        frame = np.stack([ahead, left, np.cross(ahead, left)], 1)
        glb.node(f"chain_{n:02d}", mesh, here, frame @ rotation(roll=45 + 90 * (n % 2)))
    ball = icosphere(3)
    glb.node("buoy", glb.mesh("buoy", [Mesh(0.4 * ball.positions, ball.faces)], steel), path[-1] + (0, 0, 0.45))



def add_pipeline(glb, floor, steel, concrete):
    """The pipeline: half buried, from the quay out to the south-east, on saddles."""
    ends = np.array([[50.0, 8.6], [4.0, -30.0]])
    t = np.linspace(0, 1, 60)[:, None]
    plan = ends[0] + t * (ends[1] - ends[0])
    z = floor.z(plan[:, 0], plan[:, 1])
    z = np.convolve(np.pad(z, 4, "edge"), np.full(9, 1 / 9), "valid") + 0.12
    glb.node("pipeline", glb.mesh("pipeline", [tube(np.c_[plan, z], 0.35, 20)], steel))
    saddle = glb.mesh("saddle", [box((0.6, 1.5, 1.0)).textured(1.0, smooth=False)], concrete)
    yaw = np.degrees(np.arctan2(*(ends[1] - ends[0])[::-1]))
    for n, at in enumerate(range(4, 50, 7)):
        glb.node(f"saddle_{n:02d}", saddle, (*plan[at], z[at] - 0.05), rotation(yaw=yaw))


def rock_places(rng):
    """Riprap along the toe of the wall, a reef to starboard, and single stones ahead: (x, y, size) [m]; none
    below another."""
    toe = [(rng.uniform(9, 58), QUAY - rng.uniform(0.3, 2.2), rng.uniform(0.25, 0.7)) for _ in range(50)]
    reef = [(*(np.array([26, -24]) + rng.normal(0, (4.5, 2.0)) @ rotation(yaw=30)[:2, :2]), rng.uniform(0.5, 2.2))
            for _ in range(45)]
    distance, bearing = rng.uniform(8, 42, 55), np.radians(rng.uniform(-60, 10, 55))
    single = zip(9 + distance * np.cos(bearing), distance * np.sin(bearing), rng.uniform(0.25, 1.1, 55))
    places = []
    for place in sorted([*toe, *reef, *single], key=lambda place: -place[2]):
        if all(np.hypot(place[0] - x, place[1] - y) > 0.9 * size + 0.6 * place[2] for x, y, size in places):
            places.append(place)
    return places


def add_rocks(glb, rng, floor, stone):
    meshes = [glb.mesh(f"boulder_{n}", [boulder(rng)], stone) for n in range(6)]
    for n, (x, y, size) in enumerate(rock_places(rng)):
        scale = size * rng.uniform(0.75, 1.25, 3)
        turn = rotation(*rng.uniform(-180, 180, 3))
        glb.node(f"rock_{n:03d}", meshes[n % 6], (x, y, floor.z(x, y) + 0.12 * size), turn, scale)


def add_quay(glb, rng, floor, steel, concrete, rubber):
    glb.node("quay_wall", glb.mesh("quay_wall", [quay(rng).textured(1.0, smooth=False)], concrete))
    glb.node("ladder", glb.mesh("ladder", [ladder()], steel), (17, QUAY - 0.3, 0))
    pile = glb.mesh("pile", [tube([(0, 0, -12), (0, 0, 2)], 0.38, 20)], steel)
    for n, x in enumerate(np.arange(8.0, 64.0, 6.0)):
        glb.node(f"pile_{n:02d}", pile, (x, QUAY - 1.6, 0), rotation(roll=0.4 * np.sin(9 * n), pitch=0.5 * np.cos(7 * n)))
    fender = glb.mesh("fender", [tube([(0, 0, -7.6), (0, 0, -0.4)], 0.42, 20)], rubber)
    for n, x in enumerate(np.arange(11.0, 60.0, 12.0)):
        glb.node(f"fender_{n:02d}", fender, (x, QUAY - 0.45, 0))


def weathered(material, reflection):
    """A material long in the water, rough and overgrown: Lambert's law at every frequency, by its reflection
    (ACOUSTICS.md 3.3)."""
    return {"material": material, "lambert_db": -9.23 + 20 * math.log10(reflection)}


def make_scene(rng, floor):
    glb = Glb()
    stony = glb.normal_map(pitted_stone(rng))
    sand = glb.material("sand", {"sediment": "medium_sand"}, (0.76, 0.7, 0.5), glb.normal_map(ripples(rng)))
    stone = glb.material("stone", weathered("granite", 0.81), (0.45, 0.43, 0.4), stony)
    concrete = glb.material("concrete", weathered("concrete", 0.69), (0.6, 0.6, 0.58), stony, 0.4)
    steel = glb.material("steel", weathered("carbon_steel", 0.936), (0.35, 0.22, 0.15))
    rubber = glb.material("rubber", weathered("neoprene", 0.15), (0.08, 0.08, 0.08))
    glb.node("sea_floor", glb.mesh("sea_floor", list(floor.parts()), sand))
    add_quay(glb, rng, floor, steel, concrete, rubber)
    x, y = 39.0, -15.0
    glb.node("hull", glb.mesh("hull", [wreck()], steel), (x, y, floor.z(x, y) + 1.55), rotation(roll=-20, pitch=-3, yaw=125))
    add_pipeline(glb, floor, steel, concrete)
    add_chain(glb, floor, steel, concrete)
    add_rocks(glb, rng, floor, stone)
    return glb


def write_pass(path, duration=18.0, step=0.2):
    """A pass north at about 1 m/s, 3.5 m above the floor, swaying like a small vehicle."""
    lines = ["time,x,y,z,qw,qx,qy,qz"]
    for t in np.arange(0, duration + step / 2, step):
        w = 2 * np.pi * t
        position = (t + 0.15 * np.sin(w / 7), 0.25 * np.sin(w / 11), -5.5 + 0.1 * np.sin(w / 6))
        turn = rotation(roll=1.5 * np.sin(w / 4.1), pitch=1.0 * np.sin(w / 5.3), yaw=-2 + 4 * np.sin(w / 13))
        lines.append(",".join(f"{v:.6f}" for v in (t, *position, *quaternion(turn))))
    path.write_text("\n".join(lines) + "\n")


def write_round(path, length=24.0, radius=6.0, step=0.2):
    """A round: north along the quay, round to starboard, back south over the open floor and round again, at 1 m/s
    and swaying. It ends where it begins, so that it can be repeated without end."""
    turn, lines = np.pi * radius, ["time,x,y,z,qw,qx,qy,qz"]
    duration = round((2 * (length + turn)) / step) * step
    for t in np.linspace(0, duration, round(duration / step) + 1):
        w = 2 * np.pi * t / duration
        along = min(t, duration) / duration * 2 * (length + turn)
        back, along = divmod(along, length + turn) if t < duration else (2, 0.0)
        bend = max(0.0, along - length) / radius  # 0 to pi
        x, y = min(along, length) + radius * np.sin(bend), -radius * (1 - np.cos(bend))
        if back == 1:
            x, y = length - x, -2 * radius - y
        yaw = -np.degrees(bend) - 180 * back
        turned = rotation(roll=1.5 * np.sin(18 * w), pitch=1.0 * np.sin(14 * w), yaw=yaw + 3 * np.sin(6 * w))
        position = (x, y + 0.25 * np.sin(7 * w), -5.5 + 0.1 * np.sin(13 * w))
        lines.append(",".join(f"{v:.6f}" for v in (t, *position, *quaternion(turned))))
    path.write_text("\n".join(lines) + "\n")


def main():
    rng = np.random.default_rng(2017)
    surface = fractal_surface(rng)
    print(f"spectral slope of the floor: {radial_spectral_slope(surface):.2f} (wanted {SPECTRAL_SLOPE})")
    if len(sys.argv) > 1:
        survey = np.load(sys.argv[1])["elev"].astype(float)
        print(f"spectral slope of the survey: {radial_spectral_slope(survey):.2f}")
    SCENES.mkdir(parents=True, exist_ok=True)
    make_scene(rng, Floor(surface)).write(SCENES / "harbour.glb")
    write_pass(SCENES / "harbour_pass.csv")
    write_round(SCENES / "harbour_round.csv")
    print(f"harbour.glb: {(SCENES / 'harbour.glb').stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
