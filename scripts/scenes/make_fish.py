#!/usr/bin/env python3
"""Adds swimming fish to a scene: a skin of 2,000 triangles about a spine of six joints, one mesh for all. Each fish has two
animations, `swim_NNN`, a wave from head to tail, and `path_NNN`, a circle in the water.

scripts/scenes/make_fish.py OUT.glb [--scene deploy/scenes/harbour.glb] [--count 100] [--box 5 -6 -8 40 6 -3] [--seed 1]
scripts/scenes/make_fish.py deploy/scenes/fish.glb --count 12 --box 3 -2 -7.5 8 2 -6.5 --seed 4

The box has the middles of the circles: north, west, up of one corner and of the other [m]. Without a scene there is a level floor of
sand, 1.5 m below the box. Needs numpy."""
import argparse
import json
import struct
from pathlib import Path

import numpy as np
from glb import FLOAT, USHORT, Glb, Mesh, y_up

LENGTH = 0.7  # [m]
JOINTS = 6
RINGS, SIDES = 50, 20  # 2 * RINGS * SIDES triangles
BEAT = 0.8  # period of the tail [s]
BEAT_KEYS, PATH_KEYS = 24, 48


def body():
    """A fish along x, its nose at LENGTH / 2: rings about the spine, which end in an upright tail."""
    s = (np.arange(RINGS) + 0.5) / RINGS  # from nose to tail
    height = 0.13 * np.sin(np.pi * s**0.6) ** 0.8 + 0.1 * np.exp(-(((s - 1) / 0.07) ** 2))
    width = 0.055 * np.sin(np.pi * s**0.6) ** 0.8 * (1 - 0.5 * s) + 0.004
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    x = LENGTH * (0.5 - s)
    rings = np.stack([np.broadcast_to(x[:, None], (RINGS, SIDES)), width[:, None] * np.cos(angle), height[:, None] * np.sin(angle)], -1)
    positions = np.concatenate([rings.reshape(-1, 3), [[LENGTH / 2, 0, 0], [-LENGTH / 2, 0, 0]]])
    nose, tail = len(positions) - 2, len(positions) - 1
    faces = []
    for ring in range(RINGS - 1):
        for side in range(SIDES):
            a, b = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
            faces += [[a, a + SIDES, b], [b, a + SIDES, b + SIDES]]
    last = (RINGS - 1) * SIDES
    for side in range(SIDES):
        faces += [[nose, side, (side + 1) % SIDES], [tail, last + (side + 1) % SIDES, last + side]]
    mesh = Mesh(positions, faces)
    return mesh if mesh.volume() > 0 else Mesh(positions, mesh.faces[:, ::-1])


def spine():
    """x of each joint, from nose to tail [m]."""
    return LENGTH * (0.5 - np.arange(JOINTS) / JOINTS)


def shares(x):
    """Joints and weights of vertices: those before and behind a place, linear between."""
    at = np.clip((0.5 - x / LENGTH) * JOINTS, 0, JOINTS - 1)
    before = np.minimum(at.astype(int), JOINTS - 2)
    share = at - before
    zero = np.zeros_like(before)
    return np.stack([before, before + 1, zero, zero], -1), np.stack([1 - share, share, 0 * share, 0 * share], -1)


def turns(yaw):
    """Quaternions x, y, z, w of turns about the vertical, y in the file."""
    zero = 0 * yaw
    return np.stack([zero, np.sin(yaw / 2), zero, np.cos(yaw / 2)], -1)


class School:
    """Fish in a Glb."""

    def __init__(self, glb, material):
        self.glb = glb
        mesh = body()
        joints, weights = shares(mesh.positions[:, 0])
        primitive = glb.primitive(mesh, material)
        view = glb.view(joints.astype("<u2").tobytes())
        primitive["attributes"]["JOINTS_0"] = glb.add(
            "accessors", {"bufferView": view, "componentType": USHORT, "count": len(joints), "type": "VEC4"})
        primitive["attributes"]["WEIGHTS_0"] = glb.vectors(weights)
        self.mesh = glb.add("meshes", {"name": "fish", "primitives": [primitive]})
        matrices = np.tile(np.eye(4), (JOINTS, 1, 1))
        matrices[:, 3, 0] = -spine()  # column by column
        view = glb.view(matrices.astype("<f4").tobytes())
        self.matrices = glb.add("accessors", {"bufferView": view, "componentType": FLOAT, "count": JOINTS, "type": "MAT4"})
        self.beat = self.times(BEAT, BEAT_KEYS)

    def times(self, duration, keys):
        times = np.linspace(0, duration, keys + 1).astype("<f4")
        return self.glb.add("accessors", {"bufferView": self.glb.view(times.tobytes()), "componentType": FLOAT, "count": len(times),
                                          "type": "SCALAR", "min": [0], "max": [float(times[-1])]})

    def animate(self, name, input_accessor, channels):
        """Channels are triples of node, path and values."""
        samplers = [{"input": input_accessor, "output": self.glb.vectors(values)} for _, _, values in channels]
        targets = [{"sampler": i, "target": {"node": node, "path": path}} for i, (node, path, _) in enumerate(channels)]
        self.glb.add("animations", {"name": name, "samplers": samplers, "channels": targets})

    def add(self, number, middle, radius, period, phase):
        first = len(self.glb.gltf.get("nodes", []))
        x = spine()
        for i in range(JOINTS):
            node = {"name": f"fish_{number:03}_joint_{i}", "translation": [float(x[i] - (x[i - 1] if i else 0)), 0, 0]}
            if i + 1 < JOINTS:
                node["children"] = [first + i + 1]
            self.glb.add("nodes", node)
        skin = self.glb.add("skins", {"joints": list(range(first, first + JOINTS)), "inverseBindMatrices": self.matrices})
        body_node = self.glb.add("nodes", {"name": f"fish_{number:03}_body", "mesh": self.mesh, "skin": skin})
        around = np.linspace(0, 2 * np.pi, PATH_KEYS + 1) + 3 * phase
        places = y_up(middle + radius * np.stack([np.cos(around), np.sin(around), 0 * around], -1))
        ahead = turns(around + np.pi / 2)
        root = self.glb.add("nodes", {"name": f"fish_{number:03}", "children": [body_node, first],
                                      "translation": places[0].tolist(), "rotation": ahead[0].tolist()})
        self.glb.gltf["scenes"][0]["nodes"].append(root)
        t = np.linspace(0, 2 * np.pi, BEAT_KEYS + 1)
        wave = [(first + i, "rotation", turns(0.06 * (1 + i) * np.sin(t + phase - 0.9 * i))) for i in range(1, JOINTS)]
        self.animate(f"swim_{number:03}", self.beat, wave)
        self.animate(f"path_{number:03}", self.times(period, PATH_KEYS),
                     [(root, "translation", places), (root, "rotation", ahead)])


def read_scene(path):
    """A Glb that continues an existing file."""
    glb = Glb()
    data = path.read_bytes()
    length, = struct.unpack_from("<I", data, 12)
    glb.gltf = json.loads(data[20:20 + length])
    size, = struct.unpack_from("<I", data, 20 + length)
    glb.data = bytearray(data[28 + length:28 + length + size])
    return glb


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("--scene", type=Path, help="to which fish are added; absent: fish alone")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--box", type=float, nargs=6, default=[5, -6, -8, 40, 6, -3])
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    if options.scene:
        glb = read_scene(options.scene)
    else:
        glb, low = Glb(), options.box[2] - 1.5
        corners = [[-5, -15, low], [25, -15, low], [25, 15, low], [-5, 15, low]]
        floor = Mesh(corners, [[0, 1, 2], [0, 2, 3]])
        glb.node("floor", glb.mesh("floor", [floor], glb.material("sand", {"sediment": "medium_sand"}, (0.8, 0.7, 0.5))))
    school = School(glb, glb.material("fish", {"lambert_db": -20}, (0.5, 0.55, 0.6)))
    random = np.random.default_rng(options.seed)
    for number in range(options.count):
        middle = random.uniform(options.box[:3], options.box[3:])
        radius = random.uniform(1, 3)
        speed = random.uniform(0.5, 1)  # [m/s]
        school.add(number, middle, radius, 2 * np.pi * radius / speed, random.uniform(0, 2 * np.pi))
    glb.write(options.out)


if __name__ == "__main__":
    main()
