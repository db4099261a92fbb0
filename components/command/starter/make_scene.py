#!/usr/bin/env python3
"""Makes scene.glb and two trajectories, pass.csv and hover.csv, in this script's folder. Needs Python alone.

Change it, run it, and run the deployment again. Everything here is in world axes, x north, y west, z up, and in metres;
the writer turns it into glTF's y-up axes. The water surface is z = 0, the sea floor is at about z = -8. The acoustics
of a material are in its `extras.acoustics`: {"sediment": NAME} or {"material": NAME}, by the names of
`insonify describe materials`, or numbers. Same script, same bytes.
"""
import json
import math
import random
import struct
import zlib
from pathlib import Path

HERE = Path(__file__).resolve().parent
DEPTH = 8.0                       # mean depth of the floor [m]
SOUTH, NORTH, EAST, WEST = -32.0, 44.0, -36.0, 20.0   # edges of the floor [m]
SPACING = 0.8                     # grid of the floor [m]
WALL = 11.0                       # y of the face of the quay wall, to the west [m]
rng = random.Random(7)

# The floor is a sum of waves of random direction and phase, the longer the higher, 0.6 m from trough to crest.
WAVES = []
for octave in range(40):
    length = 30.0 * 0.92 ** octave
    heading = rng.uniform(0, 2 * math.pi)
    WAVES.append((2 * math.pi / length * math.cos(heading), 2 * math.pi / length * math.sin(heading),
                  rng.uniform(0, 2 * math.pi), 0.0028 * length))


def floor_height(x, y):
    return -DEPTH + sum(a * math.sin(kx * x + ky * y + phase) for kx, ky, phase, a in WAVES)


def floor_normal(x, y):
    dx = sum(a * kx * math.cos(kx * x + ky * y + phase) for kx, ky, phase, a in WAVES)
    dy = sum(a * ky * math.cos(kx * x + ky * y + phase) for kx, ky, phase, a in WAVES)
    length = math.sqrt(dx * dx + dy * dy + 1)
    return (-dx / length, -dy / length, 1 / length)


# -- shapes: (positions, faces), faces counter-clockwise seen from outside ----------------------------------------------

def box(size, centre=(0, 0, 0)):
    signs = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    points = [tuple(c + s * half / 2 for c, s, half in zip(centre, sign, size)) for sign in signs]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]


def tube(path, radius, sides=14, closed=False):
    """A round bar along a path; `closed` joins its ends to a ring."""
    points, faces, count = [], [], len(path)
    for i, here in enumerate(path):
        before = path[i - 1] if i > 0 or closed else here
        after = path[(i + 1) % count] if i + 1 < count or closed else here
        ahead = unit(tuple(b - a for a, b in zip(before, after)))
        left = unit(cross((0, 0, 1) if abs(ahead[2]) < 0.9 else (1, 0, 0), ahead))
        up = cross(ahead, left)
        for k in range(sides):
            c, s = math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides)
            points.append(tuple(h + radius * (c * l + s * u) for h, l, u in zip(here, left, up)))
    for i in range(count if closed else count - 1):
        for k in range(sides):
            a, b = i * sides + k, i * sides + (k + 1) % sides
            c, d = (b + sides) % (count * sides), (a + sides) % (count * sides)
            faces += [(a, b, c), (a, c, d)]
    for end, ring in () if closed else ((path[0], range(sides)), (path[-1], range((count - 1) * sides, count * sides))):
        ring, middle = list(ring), len(points)
        points.append(tuple(end))
        for a, b in zip(ring, ring[1:] + ring[:1]):
            faces.append((b, a, middle) if ring[0] == 0 else (a, b, middle))
    return points, faces


def stone(size):
    """A sphere of triangles, squashed and roughened."""
    golden = (1 + 5 ** 0.5) / 2
    points = [unit(p) for a in (-1, 1) for b in (-golden, golden) for p in ((a, b, 0), (0, a, b), (b, 0, a))]
    side = min(math.dist(points[0], p) for p in points[1:]) * 1.01
    faces = [outward(points, (a, b, c)) for a in range(12) for b in range(a) for c in range(b)
             if max(math.dist(points[a], points[b]), math.dist(points[b], points[c]), math.dist(points[c], points[a])) < side]
    for _ in range(1 if size < 1 else 2):
        middle, finer = {}, []
        for face in faces:
            mids = []
            for a, b in zip(face, face[1:] + face[:1]):
                key = (min(a, b), max(a, b))
                if key not in middle:
                    middle[key] = len(points)
                    points.append(unit(tuple(p + q for p, q in zip(points[a], points[b]))))
                mids.append(middle[key])
            (a, b, c), (ab, bc, ca) = face, mids
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    stretch = [size * rng.uniform(0.7, 1.2) / 2 for _ in range(3)]
    rough = [1 + rng.gauss(0, 0.06) for _ in points]
    return [tuple(s * r * p for s, p in zip(stretch, point)) for point, r in zip(points, rough)], faces


def merged(shapes):
    points, faces = [], []
    for more, triangles in shapes:
        faces += [tuple(i + len(points) for i in face) for face in triangles]
        points += more
    return points, faces


def moved(shape, offset, turn_deg=0.0):
    c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    return [(c * x - s * y + offset[0], s * x + c * y + offset[1], z + offset[2]) for x, y, z in shape[0]], shape[1]


def outward(points, face):
    a, b, c = (points[i] for i in face)
    normal = cross(tuple(q - p for p, q in zip(a, b)), tuple(q - p for p, q in zip(a, c)))
    return face if sum(n * p for n, p in zip(normal, a)) > 0 else (face[0], face[2], face[1])


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


# -- glTF ---------------------------------------------------------------------------------------------------------------

class Glb:
    """Collects materials and objects and writes them as one .glb file."""

    def __init__(self):
        self.data = bytearray()
        self.gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}

    def add(self, kind, item):
        self.gltf.setdefault(kind, []).append(item)
        return len(self.gltf[kind]) - 1

    def view(self, data):
        self.data += b"\0" * (-len(self.data) % 4) + data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.data) - len(data), "byteLength": len(data)})

    def numbers(self, rows, **fields):
        flat = [value for row in rows for value in row]
        return self.add("accessors", {"bufferView": self.view(struct.pack(f"<{len(flat)}f", *flat)), "componentType": 5126,
                                      "count": len(rows), "type": f"VEC{len(rows[0])}", **fields})

    def material(self, name, acoustics, colour, normal_map=None):
        item = {"name": name, "extras": {"acoustics": acoustics},
                "pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": 0}}
        if normal_map:
            image = self.add("images", {"bufferView": self.view(normal_map), "mimeType": "image/png"})
            item["normalTexture"] = {"index": self.add("textures", {"source": image})}
        return self.add("materials", item)

    def object(self, name, shape, material, normals=None, uvs=None):
        """One node of this name with its origin in the middle of its box, so that a data set can place and turn it;
        `insonify describe scene::SceneTask` explains how a connection moves it."""
        middle = [(min(c) + max(c)) / 2 for c in zip(*shape[0])]
        shape = [tuple(value - m for value, m in zip(point, middle)) for point in shape[0]], shape[1]
        points = [struct.unpack("<3f", struct.pack("<3f", x, z, -y)) for x, y, z in shape[0]]   # y-up, as stored
        attributes = {"POSITION": self.numbers(points, min=[min(c) for c in zip(*points)], max=[max(c) for c in zip(*points)])}
        if normals:
            attributes["NORMAL"] = self.numbers([(x, z, -y) for x, y, z in normals])
            attributes["TEXCOORD_0"] = self.numbers(uvs)
        flat = [index for face in shape[1] for index in face]
        indices = self.add("accessors", {"bufferView": self.view(struct.pack(f"<{len(flat)}H", *flat)),
                                         "componentType": 5123, "count": len(flat), "type": "SCALAR"})
        mesh = self.add("meshes", {"primitives": [{"attributes": attributes, "indices": indices, "material": material}]})
        self.gltf["scenes"][0]["nodes"].append(self.add("nodes", {"name": name, "mesh": mesh, "translation": [middle[0], middle[2], -middle[1]]}))

    def write(self, path):
        self.data += b"\0" * (-len(self.data) % 4)
        self.gltf["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.gltf, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        path.write_bytes(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(self.data), len(text), 0x4E4F534A) + text
                         + struct.pack("<II", len(self.data), 0x004E4942) + self.data)


def ripples(size=64, tile=4.0):
    """Sand ripples 0.33 m apart as a normal map of 4 x 4 m, an 8-bit PNG: it modulates the echoes of the floor
    without adding triangles."""
    waves = [(12, 3, 0.3, 0.0035), (11, 4, 1.9, 0.0025), (13, 2, 4.0, 0.0025)]
    waves += [(rng.randint(-20, 20), rng.randint(-20, 20), rng.uniform(0, 6.28), 0.0006) for _ in range(24)]
    rows = b""
    for row in range(size):
        rows += b"\0"
        for column in range(size):
            u = v = 0.0
            for m, n, phase, height in waves:
                slope = height * math.cos(2 * math.pi * (m * column + n * row) / size + phase) * 2 * math.pi / tile
                u, v = u + m * slope, v - n * slope
            normal = unit((-u, -v, 1))
            rows += bytes(round((c + 1) * 127.5) for c in normal)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    # Stored, not deflated: the bytes are the same with any version of zlib.
    stored = zlib.compress(rows, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", stored) + chunk(b"IEND", b""))


# -- the scene ----------------------------------------------------------------------------------------------------------

def add_floor(glb, sand):
    rows, columns = round((NORTH - SOUTH) / SPACING) + 1, round((WEST - EAST) / SPACING) + 1
    places = [(SOUTH + SPACING * i, EAST + SPACING * j) for i in range(rows) for j in range(columns)]
    faces = []
    for a in (i * columns + j for i in range(rows - 1) for j in range(columns - 1)):
        faces += [(a, a + columns, a + columns + 1), (a, a + columns + 1, a + 1)]
    glb.object("sea_floor", ([(x, y, floor_height(x, y)) for x, y in places], faces), sand,
               [floor_normal(x, y) for x, y in places], [(x / 4, -y / 4) for x, y in places])


def add_wall(glb, concrete, steel):
    panels = [box((3.85, 0.4, 11), (x + 2, WALL + 0.2 + rng.uniform(0, 0.06), -4)) for x in range(-32, 44, 4)]
    glb.object("quay_wall", merged([box((76, 1, 11), (6, WALL + 0.9, -4)), *panels]), concrete)
    for number, x in enumerate(range(-14, 40, 6)):
        glb.object(f"pile_{number}", tube([(x, WALL - 1.5, -11), (x, WALL - 1.5, 1)], 0.3, 20), steel)


def add_wares(glb, steel, concrete, rubber):
    x, y = 17.0, -6.0
    ribs = [box((0.12, 2.5, 2.6), (-2.9 + 0.58 * k, 0, 0)) for k in range(11)]
    container = merged([box((6.0, 2.4, 2.5)), *ribs])
    glb.object("container", moved(container, (x, y, floor_height(x, y) + 0.4), 35), steel)
    ends = (24.0, 10.5), (9.0, -30.0)
    path = [tuple(a + t / 40 * (b - a) for a, b in zip(*ends)) for t in range(41)]
    glb.object("pipeline", tube([(x, y, floor_height(x, y) + 0.2) for x, y in path], 0.3, 18), steel)
    x, y = 11.0, 4.0
    z = floor_height(x, y)
    glb.object("mooring_block", moved(box((1.2, 1.2, 0.9)), (x, y, z + 0.3), 20), concrete)
    glb.object("mooring_line", tube([(x + 0.5 * t * t, y - 0.1 * t, z + 0.7 + 4.5 * t) for t in (k / 12 for k in range(13))], 0.04, 8), steel)
    glb.object("buoy", moved(stone(0.9), (x + 0.5, y - 0.1, z + 5.6)), rubber)
    for number, (x, y, tilt) in enumerate(((3.8, 0.4, 0.0), (10.4, -0.3, 0.5), (13.0, -14.0, 0.3))):
        ring = [(0.38 * math.cos(a), 0.38 * math.sin(a), 0.38 * tilt * math.sin(a)) for a in (k * math.pi / 16 for k in range(32))]
        glb.object(f"tire_{number}", moved(tube(ring, 0.12, 10, closed=True), (x, y, floor_height(x, y) + 0.12 + 0.3 * tilt)), rubber)


def add_stones(glb, granite):
    places = [(rng.uniform(-25, 38), WALL - rng.uniform(0.5, 2.5), rng.uniform(0.3, 0.9)) for _ in range(24)]
    places += [(rng.gauss(21, 3.5), rng.gauss(-20, 2.5), rng.uniform(0.5, 1.9)) for _ in range(22)]
    places += [(rng.uniform(6, 36), rng.uniform(-28, 8), rng.uniform(0.2, 0.8)) for _ in range(26)]
    places += [(7.0, -0.3, 0.5)]   # below pass.csv, for sonars of short range
    for number, (x, y, size) in enumerate(places):
        glb.object(f"stone_{number:02d}", moved(stone(size), (x, y, floor_height(x, y) + 0.15 * size), rng.uniform(0, 360)), granite)


def write_trajectory(name, duration, speed, height):
    """Where the vehicle is: time [s], position [m], orientation (w, x, y, z). North, swaying a little."""
    lines = ["time,x,y,z,qw,qx,qy,qz"]
    for step in range(round(duration / 0.2) + 1):
        t = 0.2 * step
        yaw = math.radians(2.0 * math.sin(t / 2.1) * min(speed, 1))
        pitch = math.radians(0.8 * math.sin(t / 0.9) * min(speed, 1))
        cy, sy, cp, sp = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
        row = (t, speed * t, 0.1 * math.sin(t / 1.7), height + 0.03 * math.sin(t / 1.1), cy * cp, -sy * sp, cy * sp, sy * cp)
        lines.append(",".join(f"{value + 0.0:.6f}" for value in row))
    (HERE / name).write_text("\n".join(lines) + "\n")


def main():
    glb = Glb()
    sand = glb.material("sand", {"sediment": "medium_sand"}, (0.76, 0.7, 0.5), ripples())
    granite = glb.material("granite", {"material": "granite"}, (0.45, 0.43, 0.4))
    concrete = glb.material("concrete", {"material": "concrete"}, (0.6, 0.6, 0.58))
    steel = glb.material("steel", {"material": "carbon_steel"}, (0.35, 0.22, 0.15))
    rubber = glb.material("rubber", {"material": "neoprene"}, (0.08, 0.08, 0.08))
    add_floor(glb, sand)
    add_wall(glb, concrete, steel)
    add_wares(glb, steel, concrete, rubber)
    add_stones(glb, granite)
    glb.write(HERE / "scene.glb")
    write_trajectory("pass.csv", 12, 0.6, -4.4)
    write_trajectory("hover.csv", 20, 0.0, -5.5)
    print(f"{HERE}: scene.glb with {len(glb.gltf['nodes'])} objects, pass.csv, hover.csv")


if __name__ == "__main__":
    main()
