"""Makes scenes with `insonify scene make`, and reads the files back with independent code."""

import json
import os
import struct
import subprocess

import numpy as np
from conftest import INSONIFY


def insonify(*words, **environment):
    return subprocess.run(
        [str(INSONIFY), *map(str, words)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | environment,
    )


def answer(*words):
    done = insonify(*words)
    assert done.returncode == 0, done.stderr
    return done.stdout


class Node:
    """World positions [n, 3] in x north, y west, z up, and faces of all its primitives."""

    def __init__(self, name, positions, faces, normals, parts):
        self.name, self.positions, self.faces, self.normals, self.parts = name, positions, faces, normals, parts

    def samples(self, rng, count):
        corners = self.positions[self.faces]
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        a, b = rng.uniform(0, 1, (2, count, 1))
        a, b = np.where(a + b > 1, (1 - a, 1 - b), (a, b))
        chosen = corners[rng.choice(len(corners), count, p=areas / areas.sum())]
        return chosen[:, 0] + a * (chosen[:, 1] - chosen[:, 0]) + b * (chosen[:, 2] - chosen[:, 0])


def z_up(vectors):
    return np.stack([vectors[:, 0], -vectors[:, 2], vectors[:, 1]], 1)


class Glb:
    def __init__(self, file):
        data = file.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        self.gltf = json.loads(data[20 : 20 + length])
        self.bytes = data[28 + length :]
        self.nodes = {}
        for node in self.gltf["nodes"]:
            assert node["name"] not in self.nodes, "names are unique"
            self.nodes[node["name"]] = self.node(node)

    def array(self, index):
        accessor = self.gltf["accessors"][index]
        view = self.gltf["bufferViews"][accessor["bufferView"]]
        kind = {5126: "<f4", 5123: "<u2", 5125: "<u4"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        return np.frombuffer(self.bytes, kind, accessor["count"] * width, view["byteOffset"]).reshape(-1, width)

    def node(self, node):
        x, y, z, w = node["rotation"]
        turn = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        positions, faces, normals, parts, first = [], [], [], [], 0
        for primitive in self.gltf["meshes"][node["mesh"]]["primitives"]:
            points = self.array(primitive["attributes"]["POSITION"]).astype(float)
            own = self.array(primitive["indices"]).reshape(-1, 3).astype(int)
            parts.append((points, own))
            positions.append(z_up(points @ turn.T + node["translation"]))
            normals.append(z_up(self.array(primitive["attributes"]["NORMAL"]).astype(float) @ turn.T))
            faces.append(own + first)
            first += len(points)
        return Node(node["name"], np.vstack(positions), np.vstack(faces), np.vstack(normals), parts)


def unbalanced_edges(points, faces):
    """Edges that do not occur equally often in both directions: none on a closed surface with consistent winding."""
    _, same = np.unique(points.round(6) + 0.0, axis=0, return_inverse=True)
    faces = same.reshape(-1)[faces]
    ends = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ways = np.sign(ends[:, 1] - ends[:, 0])
    _, edge = np.unique(np.sort(ends, 1), axis=0, return_inverse=True)
    return int(np.count_nonzero(np.bincount(edge.reshape(-1), ways)))


def volume(points, faces):
    a, b, c = np.moveaxis(points[faces] - points.mean(0), 1, 0)
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


class FloorGrid:
    """Heights of the floor from its triangles."""

    def __init__(self, node):
        points = np.unique(node.positions.round(5), axis=0)
        self.x, self.y = np.unique(points[:, 0]), np.unique(points[:, 1])
        assert len(points) == len(self.x) * len(self.y)
        self.z = points[:, 2].reshape(len(self.x), len(self.y))

    def height(self, x, y):
        i = np.clip(np.searchsorted(self.x, x) - 1, 0, len(self.x) - 2)
        j = np.clip(np.searchsorted(self.y, y) - 1, 0, len(self.y) - 2)
        u, v = (x - self.x[i]) / (self.x[i + 1] - self.x[i]), (y - self.y[j]) / (self.y[j + 1] - self.y[j])
        a, b, c, d = self.z[i, j], self.z[i + 1, j], self.z[i + 1, j + 1], self.z[i, j + 1]
        return np.where(u >= v, a + u * (b - a) + v * (c - b), a + v * (d - a) + u * (c - d))


def make(tmp_path, text, *words, seed=1, name="scene"):
    recipe, out = tmp_path / f"{name}.yml", tmp_path / f"{name}.glb"
    recipe.write_text(text)
    answer("scene", "make", recipe, "--seed", seed, "--out", out, *words)
    return out
