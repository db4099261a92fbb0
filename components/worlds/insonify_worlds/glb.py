"""A writer for binary glTF 2.0. Needs numpy.

Input is in world axes (x north, y west, z up) and metres; the writer converts it to glTF's y-up axes."""
import json
import struct
import zlib

import numpy as np

FLOAT, USHORT, UINT = 5126, 5123, 5125
VERTICES, INDICES = 34962, 34963


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def png(rgb):
    """An 8-bit RGB picture [rows, columns, 3], rows from the top, as a PNG file's bytes."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows, columns = rgb.shape[:2]
    lines = b"".join(b"\0" + row.tobytes() for row in rgb)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))


def quaternion(turn):
    """(w, x, y, z) of a rotation matrix."""
    m = np.asarray(turn)
    # The eigenvector of the largest eigenvalue of Bar-Itzhack's matrix: no special cases.
    k = np.array([[m[0, 0] - m[1, 1] - m[2, 2], 0, 0, 0],
                  [m[0, 1] + m[1, 0], m[1, 1] - m[0, 0] - m[2, 2], 0, 0],
                  [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], m[2, 2] - m[0, 0] - m[1, 1], 0],
                  [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], np.trace(m)]])
    x, y, z, w = np.linalg.eigh(k)[1][:, -1]
    return np.array([w, x, y, z]) * (1 if w >= 0 else -1)


def rotation(roll=0.0, pitch=0.0, yaw=0.0):
    """Rz(yaw) Ry(pitch) Rx(roll), angles in degrees."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(np.radians([roll, pitch, yaw])), np.sin(np.radians([roll, pitch, yaw]))
    return (np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]) @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
            @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]]))


def y_up(vectors):
    x, y, z = np.moveaxis(np.asarray(vectors, float), -1, 0)
    return np.stack([x, z, -y], -1)


class Glb:
    """Collects materials, meshes and nodes and writes them as one .glb file."""

    def __init__(self):
        self.data = bytearray()
        self.gltf = {"asset": {"version": "2.0", "generator": "Insonify"}, "scene": 0, "scenes": [{"nodes": []}]}

    def add(self, kind, item):
        self.gltf.setdefault(kind, []).append(item)
        return len(self.gltf[kind]) - 1

    def view(self, data, **fields):
        self.data += b"\0" * (-len(self.data) % 4)
        self.data += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.data) - len(data), "byteLength": len(data), **fields})

    def vectors(self, values, **fields):
        values = np.asarray(values, "<f4")
        view = self.view(values.tobytes(), target=VERTICES)
        return self.add("accessors", {"bufferView": view, "componentType": FLOAT, "count": len(values),
                                      "type": f"VEC{values.shape[1]}", **fields})

    def indices(self, faces, vertex_count):
        kind, code = ("<u2", USHORT) if vertex_count < 65536 else ("<u4", UINT)
        view = self.view(np.asarray(faces, kind).tobytes(), target=INDICES)
        return self.add("accessors", {"bufferView": view, "componentType": code, "count": faces.size, "type": "SCALAR"})

    def normal_map(self, rgb):
        source = self.add("images", {"bufferView": self.view(png(rgb)), "mimeType": "image/png"})
        return self.add("textures", {"source": source})

    def material(self, name, acoustics, colour, normal_map=None, normal_scale=1.0):
        look = {"baseColorFactor": [*colour, 1], "metallicFactor": 0, "roughnessFactor": 1}
        item = {"name": name, "pbrMetallicRoughness": look}
        if acoustics is not None:
            item["extras"] = {"acoustics": acoustics}
        if normal_map is not None:
            item["normalTexture"] = {"index": normal_map, "scale": normal_scale}
        return self.add("materials", item)

    def mesh(self, name, parts, material):
        """Adds one part, or several that share the material."""
        return self.mesh_of(name, [(part, material) for part in parts])

    def mesh_of(self, name, pairs):
        """Adds parts, each with its material."""
        return self.add("meshes", {"name": name, "primitives": [self.primitive(*pair) for pair in pairs]})

    def primitive(self, part, material):
        positions = y_up(part.positions).astype("<f4")
        attributes = {"POSITION": self.vectors(positions, min=positions.min(0).tolist(), max=positions.max(0).tolist())}
        if part.normals is not None:
            attributes |= {"NORMAL": self.vectors(y_up(part.normals))}
        if part.uvs is not None:
            attributes |= {"TEXCOORD_0": self.vectors(part.uvs)}
        return {"attributes": attributes, "indices": self.indices(part.faces, len(positions)), "material": material}

    def node(self, name, mesh, position=(0, 0, 0), turn=np.eye(3), scale=(1, 1, 1)):
        item = {"name": name, "mesh": mesh, "translation": y_up(position).round(6).tolist()}
        w, *axis = quaternion(turn)
        item["rotation"] = [*y_up(axis).round(7).tolist(), round(float(w), 7)]
        item["scale"] = [scale[0], scale[2], scale[1]]
        self.gltf["scenes"][0]["nodes"].append(self.add("nodes", item))

    def write(self, path):
        self.data += b"\0" * (-len(self.data) % 4)
        self.gltf["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.gltf, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + len(self.data)
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON") + text
                         + struct.pack("<I4s", len(self.data), b"BIN\0") + self.data)
