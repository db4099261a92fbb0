"""Scenes by recipe, as `insonify scene make` writes them: read back from the files by code of its own."""

import itertools
import json
import os
import random
import re
import struct
import subprocess
import sys

import numpy as np
import pytest
from conftest import INSONIFY, ROOT

pytest.importorskip("manifold3d")

PACKAGE = ROOT / "components/worlds/insonify_worlds"


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
    """Edges that are not run along as often one way as the other: none on a closed surface of one sense of turning."""
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


THINGS = {each["thing"]: each for each in json.loads(answer("scene", "make", "--list", "--json"))}


def make(tmp_path, text, *words, seed=1, name="scene"):
    recipe, out = tmp_path / f"{name}.yml", tmp_path / f"{name}.glb"
    recipe.write_text(text)
    answer("scene", "make", recipe, "--seed", seed, "--out", out, *words)
    return out


def bounds_of(parameter):
    low, _, high = parameter["may_be"].partition(" to ")
    return float(low), float(high)


def is_number(parameter):
    return " to " in parameter["may_be"] and "[" not in parameter["may_be"]


# What a random value of these would make of no use here: too many triangles, or too large for a floor of 60 m.
KEPT = {"line_m", "height_m", "count", "heading_deg", "length_m", "tilt_deg", "freeboard_m"}


def random_values(rng, thing):
    """Values near the defaults, within the bounds, by name."""
    values = {}
    for each in thing["parameters"]:
        if each["name"] in KEPT or each["default"] is None:
            continue
        if not is_number(each):
            values[each["name"]] = str(rng.choice(each["may_be"].split(", ")))
            continue
        low, high = bounds_of(each)
        value = float(np.clip(each["default"] * rng.uniform(0.75, 1.3), low, high))
        values[each["name"]] = int(round(value)) if each["default"] == int(each["default"]) and high < 200 and low >= 2 else round(value, 4)
    return values


@pytest.fixture(scope="module")
def one_of_each(tmp_path_factory):
    """Every thing as it is, and with random values."""
    rng, scenes = np.random.default_rng(5), []
    for number in range(3):
        entries = [{"thing": name} | (random_values(rng, thing) if number else {}) for name, thing in THINGS.items()]
        scenes.append(Glb(make(tmp_path_factory.mktemp("each"), json.dumps({"things": entries}), seed=number)).nodes)
    return scenes


@pytest.mark.parametrize("name", THINGS)
def test_things_are_closed_and_face_outwards(one_of_each, name):
    for nodes in one_of_each:
        node = nodes[f"{name}_1"]
        for points, faces in node.parts:
            assert unbalanced_edges(points, faces) == 0
            assert volume(points, faces) > 0
        a, b, c = np.moveaxis(node.positions[node.faces], 1, 0)
        facing = np.einsum("ij,ij->i", np.cross(b - a, c - a), node.normals[node.faces].mean(1))
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        assert areas[facing <= 0].sum() < 1e-3 * areas.sum(), "normals are on the side that triangles face"


@pytest.mark.parametrize(
    "words, size",
    [
        (["tire", "diameter_m=0.7", "width_m=0.22"], (0.7, 0.7, 0.22)),
        (["can"], (0.115, 0.066, 0.066)),
        (["barrel", "upright=true"], (0.585, 0.585, 0.88)),
        (["ball", "diameter_m=1"], (1, 1, 1)),
        (["container"], (6.06, 2.44, 2.59)),
        (["artillery_shell", "diameter_m=0.155"], (0.7, 0.16, 0.16)),
        (["moored_mine", "diameter_m=1", "line_m=5", "lean_deg=0"], (1.04, 1.04, 6.77)),
    ],
)
def test_things_have_the_size_that_is_asked_for(tmp_path, words, size):
    name, *settings = words
    out = tmp_path / "thing.glb"
    answer("scene", "make", "--thing", name, *itertools.chain.from_iterable(("--set", each) for each in settings), "--out", out)
    (node,) = Glb(out).nodes.values()
    assert np.ptp(node.positions, axis=0) == pytest.approx(size, rel=0.03)
    assert node.positions[:, 2].min() == pytest.approx(0, abs=1e-4)


BODIES = [name for name, each in THINGS.items() if each["placed_as"] == "body" and name not in ("wreck", "net", "container", "fish_cage_ring")]


def random_recipe(rng):
    floor = {
        "size_m": [24, 18],
        "depth_m": 9,
        "cell_m": round(float(rng.uniform(0.15, 0.4)), 3),
        "slope_deg": round(float(rng.uniform(0, 4)), 2),
        "fractal": {"slope": round(float(rng.uniform(2.5, 4)), 2), "rms_m": round(float(rng.uniform(0, 0.2)), 3)},
        "rocks": {"per_m2": 0.08},
        "material": "mud",
    }
    things = [
        {"thing": str(name), "count": int(rng.integers(1, 4)), "buried": [0, 0.3], "gap_m": 0.15, "tilt_deg": [0, 20]}
        for name in rng.choice(BODIES, 7, replace=False)
    ]
    things.append({"thing": str(rng.choice(["pipeline", "cable", "chain", "rope"])), "length_m": 6, "gap_m": 0.15})
    things.append({"thing": "quay", "length_m": 16, "y_m": 6.5, "gap_m": 0.15, "x_m": 0})
    return {"floor": floor, "things": things}


@pytest.mark.parametrize("number", range(6))
def test_things_of_random_recipes_stand_on_the_floor_and_keep_clear(tmp_path, number):
    rng = np.random.default_rng(number)
    recipe = random_recipe(rng)
    recipe["things"][-1], recipe["things"][0] = recipe["things"][0], recipe["things"][-1]  # what is largest first
    glb = Glb(make(tmp_path, json.dumps(recipe), seed=number))
    ground = FloorGrid(glb.nodes.pop("sea_floor"))
    counted = {}
    for node in glb.nodes.values():
        counted[node.name.rsplit("_", 1)[0]] = counted.get(node.name.rsplit("_", 1)[0], 0) + 1
        assert node.positions[:, 0].min() >= -12 and node.positions[:, 0].max() <= 12
        assert node.positions[:, 1].min() >= -9 and node.positions[:, 1].max() <= 9
    for entry in recipe["things"]:
        assert counted[entry["thing"]] == entry.get("count", 1)
    for node in glb.nodes.values():
        if node.name.startswith(("quay", "pipeline", "cable", "chain", "rope")):
            continue
        above = node.positions[:, 2] - ground.height(node.positions[:, 0], node.positions[:, 1])
        tall = np.ptp(node.positions[:, 2])
        share = 0.3 if node.name.startswith("rock") else 0.31 / np.cos(np.radians(25))
        assert -share * tall - 0.02 <= above.min() <= 0.01, node.name
    clouds = {node.name: node.samples(rng, 400)[:, :2] for node in glb.nodes.values()}
    for (one, a), (other, b) in itertools.combinations(clouds.items(), 2):
        if (a.min(0) > b.max(0) + 0.2).any() or (b.min(0) > a.max(0) + 0.2).any():
            continue
        gap = np.linalg.norm(a[:, None] - b[None], axis=-1).min()
        asked = 0.0 if one.startswith("rock") and other.startswith("rock") else 0.15
        assert gap >= asked - 1e-3, (one, other, gap)


def test_the_same_seed_makes_the_same_bytes_and_another_one_other_places(tmp_path):
    text = "floor: {size_m: [20, 20], fractal: {rms_m: 0.1}}\nthings: [{thing: tire, count: 3}, {thing: can, count: [2, 5]}]"
    first, again = make(tmp_path, text, seed=4, name="a").read_bytes(), make(tmp_path, text, seed=4, name="b").read_bytes()
    assert first == again
    places = []
    for seed in (4, 5, 6):
        glb = Glb(make(tmp_path, text, seed=seed))
        names = [name for name in glb.nodes if name != "sea_floor"]
        assert sorted(name for name in names if "tire" in name) == ["tire_1", "tire_2", "tire_3"]
        assert 2 <= len([name for name in names if "can" in name]) <= 5
        places.append([glb.nodes[f"tire_{i}"].positions.mean(0) for i in (1, 2, 3)])
    assert all(np.abs(np.array(a) - np.array(b)).max() > 0.5 for a, b in itertools.combinations(places, 2))


def test_places_are_within_what_is_asked_for(tmp_path):
    text = "floor: {size_m: [40, 40]}\nthings: [{thing: ball, count: 20, x_m: [5, 15], y_m: {choice: [-3, 3]}, buried: 0, gap_m: 0.3}]"
    middles = np.array([node.positions.mean(0) for name, node in Glb(make(tmp_path, text)).nodes.items() if name != "sea_floor"])
    assert len(middles) == 20
    assert 4.99 < middles[:, 0].min() < 8 and 12 < middles[:, 0].max() < 15.01
    assert np.allclose(np.abs(middles[:, 1]), 3, atol=0.01)
    assert np.allclose(middles[:, 2], -10 + 0.15, atol=0.01)


def test_another_thing_leaves_the_others_where_they_are(tmp_path):
    head = "floor: {size_m: [30, 30]}\nthings:\n  - {thing: tire, count: 3}\n"
    before = Glb(make(tmp_path, head, name="a"))
    after = Glb(make(tmp_path, head + "  - {thing: can, count: 2}\n", name="b"))
    for number in (1, 2, 3):
        assert np.array_equal(before.nodes[f"tire_{number}"].positions, after.nodes[f"tire_{number}"].positions)


def radial_spectrum(z, cell):
    """Wave numbers [1/m] and power, averaged over rings."""
    power = np.abs(np.fft.fft2((z - z.mean()) * np.outer(*(np.hanning(n) for n in z.shape)))) ** 2
    k = np.hypot(*np.meshgrid(*(np.fft.fftfreq(n, cell) for n in z.shape), indexing="ij")).ravel()
    edges = np.geomspace(6 / (min(z.shape) * cell), 0.4 / cell, 16)
    ring = np.digitize(k, edges)
    rings = range(1, len(edges))
    return np.array([k[ring == i].mean() for i in rings]), np.array([power.ravel()[ring == i].mean() for i in rings])


@pytest.mark.parametrize("slope, rms", [(2.2, 0.05), (3.2, 0.2), (4.0, 0.5)])
def test_a_fractal_floor_has_the_slope_and_height_that_are_asked_for(tmp_path, slope, rms):
    slopes = []
    for seed in range(3):
        text = f"floor: {{size_m: [50, 40], depth_m: 12, cell_m: 0.2, fractal: {{slope: {slope}, rms_m: {rms}}}}}"
        z = FloorGrid(Glb(make(tmp_path, text, seed=seed)).nodes["sea_floor"]).z
        assert z.std() == pytest.approx(rms, rel=1e-3)
        assert z.mean() == pytest.approx(-12, abs=1e-3)
        slopes.append(-np.polyfit(*map(np.log, radial_spectrum(z, 0.2)), 1)[0])
    assert np.mean(slopes) == pytest.approx(slope, abs=0.15)


def test_ripples_have_their_length_height_and_heading(tmp_path):
    text = "floor: {size_m: [20, 20], cell_m: 0.1, ripples: {length_m: 1, height_m: 0.1, heading_deg: 30, asymmetry: %s, wander: 0.05}}"
    skews = []
    for asymmetry in (0, 0.8):
        z = FloorGrid(Glb(make(tmp_path, text % asymmetry)).nodes["sea_floor"]).z + 10
        assert np.ptp(z) == pytest.approx(0.1, rel=0.02)
        power = np.abs(np.fft.fft2(z[:200, :200])) ** 2
        i, j = np.unravel_index(power.argmax(), power.shape)
        k = np.fft.fftfreq(200, 0.1)[[i, j]]
        assert np.hypot(*k) == pytest.approx(1, abs=0.05)
        assert np.degrees(np.arctan2(k[1], k[0])) % 180 == pytest.approx(30, abs=3)
        down = np.gradient(z, 0.1, axis=0) * np.cos(np.radians(30)) + np.gradient(z, 0.1, axis=1) * np.sin(np.radians(30))
        skews.append((down**3).mean() / (down**2).mean() ** 1.5)
    assert abs(skews[0]) < 0.1 and abs(skews[1]) > 0.4, "one side is the steeper"


def test_ripples_below_six_cells_are_a_normal_map(tmp_path):
    text = "floor: {size_m: [20, 10], cell_m: 0.2, ripples: {length_m: 0.3, height_m: 0.03}}"
    glb = Glb(make(tmp_path, text))
    assert np.ptp(FloorGrid(glb.nodes["sea_floor"]).z) < 1e-4
    (material,) = glb.gltf["materials"]
    assert "normalTexture" in material
    uv = glb.array(glb.gltf["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"])
    assert np.ptp(uv[:, 0]) == pytest.approx(20 / (16 * 0.3), rel=1e-3), "a tile is 16 ripples wide"


def test_pockmarks_are_as_many_and_as_deep_as_asked_for(tmp_path):
    text = "floor: {size_m: [40, 40], cell_m: 0.2, pockmarks: {count: 4, diameter_m: 5, depth_m: 0.8}}"
    z = FloorGrid(Glb(make(tmp_path, text)).nodes["sea_floor"]).z
    assert z.min() == pytest.approx(-10.8, abs=0.02)
    below = (z < -10.001).sum() * 0.2**2
    assert below == pytest.approx(4 * np.pi * 2.5**2, rel=0.1)


def test_rocks_and_pebbles_have_their_number_and_sizes(tmp_path):
    text = ("floor: {size_m: [40, 30], rocks: {per_m2: 0.25, min_m: 0.2, max_m: 1, exponent: 2}, "
            "pebbles: {per_m2: 5, min_m: 0.02, max_m: 0.06}}")
    glb = Glb(make(tmp_path, text))
    rocks = [node for name, node in glb.nodes.items() if name.startswith("rock_")]
    assert len(rocks) == 300
    sizes = np.array([np.cbrt(np.prod(np.ptp(node.positions, axis=0))) for node in rocks])
    assert 0.15 < sizes.min() and sizes.max() < 1.1
    # Of a law d^-2 from 0.2 to 1 a fifth is above 0.42 m; boulders are a little smaller than their balls.
    assert 0.1 < (sizes > 0.42).mean() < 0.25
    pebbles = glb.nodes["pebbles"]
    ground = FloorGrid(glb.nodes["sea_floor"])
    above = pebbles.positions[:, 2] - ground.height(pebbles.positions[:, 0], pebbles.positions[:, 1])
    assert -0.05 < above.min() < 0 < above.max() < 0.06
    assert unbalanced_edges(*pebbles.parts[0]) == 0


def test_the_simulator_knows_all_that_is_made(tmp_path):
    things = "\n".join(f"  - {{thing: {name}, surface: {{choice: [clean, weathered, fouled]}}}}" for name in THINGS if name not in ("tank", "quay", "jetty"))
    text = ("floor: {size_m: [120, 100], depth_m: 15, cell_m: 0.5, ripples: {length_m: 0.3}, rocks: {per_m2: 0.01}, pebbles: {per_m2: 0.1}}\n"
            "things:\n  - {thing: quay, y_m: 46}\n  - {thing: jetty, y_m: 40}\n  - {thing: tank, y_m: -40}\n" + things)
    out = make(tmp_path, text)
    scene = json.loads(answer("scene", out, "--json"))
    assert scene["not_understood"] == [] and scene["warnings"] == []
    assert {each["source"] for each in scene["materials"]} == {"file"}
    names = [each["name"] for each in scene["objects"]]
    assert len(set(names)) == len(names)
    assert {f"{name}_1" for name in THINGS} <= set(names)
    assert scene["triangles"] < 1_000_000


def test_weathered_surfaces_reflect_as_the_simulator_has_their_matter(tmp_path):
    entries = "things:\n" + "\n".join(f"  - {{thing: {name}, surface: %s}}" for name in THINGS)
    of = {}
    for state in ("clean", "weathered"):
        scene = json.loads(answer("scene", make(tmp_path, entries.replace("%s", state)), "--json"))
        named = {each["name"].removeprefix("weathered "): each["lambert_db"] for each in scene["materials"]}
        of[state] = {name: value for name, value in named.items() if " " not in name}
    known = json.loads(answer("describe", "materials", "--json"))
    assert set(of["clean"]) <= set(known["materials"])
    assert len(of["weathered"]) >= 12
    for matter, lambert_db in of["weathered"].items():
        assert lambert_db == pytest.approx(of["clean"][matter], abs=0.02), matter


def test_floors_may_be_of_every_sediment_that_the_simulator_has(tmp_path):
    known = [name for name in json.loads(answer("describe", "materials", "--json"))["sediments"] if name != "mackenzie"]
    (tmp_path / "bad.yml").write_text("floor: {material: cheese}")
    refusal = insonify("scene", "make", tmp_path / "bad.yml", "--out", tmp_path / "bad.glb").stderr
    assert sorted(refusal.split("may be ")[1].strip().split(", ")) == sorted([*known, "sand", "gravel", "mud", "silt"])
    for name, meant in (("mud", "clay"), ("gravel", "sandy_gravel"), ("fine_silt", "fine_silt")):
        out = make(tmp_path, f"floor: {{size_m: [4, 4], material: {name}}}")
        (material,) = json.loads(answer("scene", out, "--json"))["materials"]
        assert material["sediment"] == meant


def test_the_recipe_of_the_page_makes_what_the_page_says(tmp_path):
    page = (ROOT / "components/worlds/README.md").read_text()
    recipe = page.split("```yaml\n")[1].split("```")[0]
    glb = Glb(make(tmp_path, recipe, seed=3))
    assert f"has {sum(len(node.faces) for node in glb.nodes.values()):,} with seed 3" in page
    assert {"sea_floor", "quay_1", "pipeline_1", "tire_1", "wreck_1", "moored_mine_1", "rock_1", "pebbles"} <= set(glb.nodes)


BAD = [
    ("floor: {depth: 8}", "1:9: floor.depth: is not a key here; did you mean depth_m? may be size_m"),
    ("flor: {depth_m: 8}", "1:1: flor: is not a key here; did you mean floor? may be floor, things, max_triangles"),
    ("floor: {depth_m: -1}", "1:18: floor.depth_m: is -1; must be a number from 0.5 to 11000"),
    ("floor: {depth_m: deep}", "1:18: floor.depth_m: is deep; must be a number from 0.5 to 11000"),
    ("floor: {depth_m: .nan}", "1:18: floor.depth_m: is .nan; must be a number"),
    ("floor: {size_m: 8}", "1:17: floor.size_m: is 8; must be two numbers: [x, y]"),
    ("floor: {material: cheese}", "1:19: floor.material: is cheese; may be sand, gravel"),
    ("floor: [1]", "1:8: floor: is a list; must be a block of keys: size_m"),
    ("floor: {fractal: {slope: 9}}", "1:26: floor.fractal.slope: is 9; must be a number from 1 to 5"),
    ("floor: {size_m: [1000, 1000], cell_m: 0.1}", "1:39: floor.cell_m: makes 100000000 cells"),
    ("floor: {depth_m: 1, fractal: {rms_m: 2}}", "1:8: floor: rises to z ="),
    ("floor: {depth_m: 8, depth_m: 9}", "1:21: floor.depth_m: is given twice"),
    ("floor: {depth_m: 8", "is no YAML:"),
    ("", "is empty; a recipe has a floor, things or both"),
    ("things: []", "makes nothing"),
    ("things: {}", "1:9: things: is a block; must be a list"),
    ("things: [tire]", "1:10: things[0]: must be a block with the key thing"),
    ("things: [{count: 2}]", "1:10: things[0]: has no key thing, which may be pipeline"),
    ("things: [{thing: tyre}]", "1:18: things[0].thing: is tyre; did you mean tire? may be pipeline"),
    ("things:\n  - {thing: tire, diameter: 1}", "2:19: things[0].diameter: is not a key here; did you mean diameter_m?"),
    ("things:\n  - {thing: tire, diameter_m: 9}", "2:31: things[0].diameter_m: is 9; must be a number from 0.3 to 4"),
    ("things:\n  - {thing: tire, diameter_m: [1, 9]}", "2:35: things[0].diameter_m[1]: is 9; must be a number from 0.3 to 4"),
    ("things:\n  - {thing: tire, diameter_m: [2, 1]}", "2:31: things[0].diameter_m: is [2, 1]; the lowest value is first"),
    ("things:\n  - {thing: tire, diameter_m: {norm: [1, 1]}}", "2:32: things[0].diameter_m.norm: is not a key here; did you mean normal?"),
    ("things:\n  - {thing: tire, count: 1.5}", "2:26: things[0].count: is 1.5; must be a whole number from 0 to 2000"),
    ("things:\n  - {thing: tire, upright: maybe}", "2:28: things[0].upright: is maybe; may be true, false"),
    ("things:\n  - {thing: tire, surface: rusty}", "2:28: things[0].surface: is rusty; may be clean, weathered, fouled"),
    ("things:\n  - {thing: tire, name: 3 tires}", "2:25: things[0].name: is 3 tires; must be letters, digits and _"),
    ("things:\n  - &a {thing: tire}\n  - *a", "2:5: is an anchor or alias; write the value out"),
    ("floor: {size_m: [4, 4]}\nthings:\n  - {thing: container, count: 3}", "3:5: things[0]: asks for 3, of which 0 found room in 1000 tries"),
    ("floor: {size_m: [40, 40]}\nmax_triangles: 100", "max_triangles: is 100; the recipe makes at least 80000"),
    ("floor: {depth_m: 1_0}", "1:18: floor.depth_m: is 1_0; must be a number"),
    ("floor: {size_m: [9, 9]}\nthings: [{thing: can, x_m: 20, y_m: 0}]", "2:10: things[0]: asks for 1, of which 0 found room at its place"),
    ("[" * 5000, "has blocks in blocks without end"),
]


@pytest.mark.parametrize("text, expected", BAD)
def test_a_bad_recipe_gets_one_line_with_its_place(tmp_path, text, expected):
    recipe = tmp_path / "bad.yml"
    recipe.write_text(text)
    done = insonify("scene", "make", recipe, "--out", tmp_path / "bad.glb")
    assert done.returncode == 2, done.stderr
    assert len(done.stderr.splitlines()) == 1 and done.stdout == ""
    assert done.stderr.startswith(str(recipe)) and expected in done.stderr
    assert not (tmp_path / "bad.glb").exists()


MUTATED = """floor: {size_m: [9, 8], depth_m: 3, cell_m: 0.5, fractal: {slope: 3.2, longest_m: 8}, ripples: [{length_m: 4}, {length_m: 0.3}],
  pockmarks: {count: 1, diameter_m: [3, 4]}, rocks: {per_m2: 0.05, max_m: 0.4}, pebbles: {per_m2: 1}}
things:
  - {thing: pile, x_m: 0, y_m: 3}
  - {thing: rope, from_m: [-3, -2], to_m: [3, -1], diameter_m: 0.04}
  - {thing: can, count: [1, 2], diameter_m: {uniform: [0.05, 0.08]}, buried: [0, 0.3]}
  - {thing: tire, diameter_m: {normal: [0.6, 0.05]}, upright: {choice: [true, false]}, name: wheel, height_m: 0.2}
max_triangles: 100000
"""


def test_damaged_recipes_are_refused_in_one_line_or_made():
    sys.path.insert(0, str(PACKAGE.parent))
    from insonify_worlds.parameters import RecipeError, read_yaml
    from insonify_worlds.recipe import make_world

    rng, made, refused = random.Random(3), 0, 0
    bits = ["", "{", "}", "[", ":", "null", "1e9", "-1", "0", "true", "x", "\n", ",", "1e-300", "'", "!!int", "{}", "[]", ".inf", "é", *(["0.2", "1", "2", "4"] * 4)]
    for _ in range(250):
        word = rng.choice(list(re.finditer(r"-?\d+\.?\d*|\w+|[\[\]{}:,]", MUTATED)))
        try:
            world = make_world(read_yaml(MUTATED[: word.start()] + rng.choice(bits) + MUTATED[word.end() :], "f.yml"), 1)
            assert world.triangles <= 100000
            made += 1
        except RecipeError as error:
            assert error.text().startswith("f.yml") and "\n" not in error.text()
            refused += 1
    assert made > 20 and refused > 100, (made, refused)


@pytest.mark.parametrize(
    "words, expected",
    [
        (["absent.yml", "--out", "a.glb"], "absent.yml: cannot be read: No such file or directory"),
        (["--out", "a.glb"], "scene make: give a RECIPE, or a --thing, or --list"),
        (["--thing", "tire"], "scene make: --out is missing; must be a file that ends in .glb"),
        (["--thing", "tire", "--out", "a.obj"], "scene make: --out is a.obj; must be a file that ends in .glb"),
        (["--thing", "tyre", "--out", "a.glb"], "--thing: is tyre; did you mean tire? may be pipeline"),
        (["--thing", "tire", "--set", "diameter_m=9", "--out", "a.glb"], "diameter_m: is 9; must be a number from 0.3 to 4"),
        (["--thing", "tire", "--set", "size=9", "--out", "a.glb"], "size: is not a key here; may be"),
        (["--thing", "tire", "--out", "/absent/a.glb"], "/absent/a.glb: cannot be written: No such file or directory"),
    ],
)
def test_wrong_options_get_one_line(words, expected):
    done = insonify("scene", "make", *words)
    assert done.returncode == 2, done.stderr
    assert len(done.stderr.splitlines()) == 1 and done.stderr.startswith(expected)


def test_a_list_may_be_read_in_part():
    done = subprocess.run(
        ["bash", "-c", f"{INSONIFY} scene make --list --json | head -n 1"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert (done.stdout, done.stderr) == ("[\n", "")


def test_without_the_packages_the_answer_says_what_installs_them(tmp_path):
    python = tmp_path / "python3"
    python.write_text("#!/bin/sh\nexit 97\n")  # as the package does where an import fails
    python.chmod(0o755)
    done = insonify("scene", "make", "--list", INSONIFY_PYTHON=str(python))
    assert done.returncode == 2
    assert done.stderr.splitlines() == [
        f"scene make: needs a Python 3 with numpy, PyYAML and manifold3d, which {python} is not; `scripts/setup worlds` installs them"
    ]


def test_a_ping_has_the_echo_of_a_thing_at_its_range(tmp_path):
    recipe = """
floor: {size_m: [40, 30], centre_m: [15, 0], depth_m: 8, cell_m: 0.25, material: mud}
things:
  - {thing: barrel, upright: true, x_m: 12, y_m: -2, surface: weathered, fill: air}
"""
    make(tmp_path, recipe, name="bay")
    (tmp_path / "run.yml").write_text("""
tasks:
  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {waypoints: [{time: 0, position: [0, 0, -7]}]}}
  scene: {type: scene::SceneTask, properties: {file: bay.glb}}
  sonar: {type: sonar::SonarTask, properties: {range: 20, bin_count: 1000, beam_count: 256, frequency_khz: 900}}
  log: {type: logger::LoggerTask, properties: {file: ping.log}}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.ping, to: log.ping}
""")
    answer("run", tmp_path / "run.yml", "--pings", 1, "--out", tmp_path / "out")
    answer("log", "export", tmp_path / "out/ping.log", "--stream", "sonar.ping", "--to", tmp_path / "ping.npz")
    ping = np.load(tmp_path / "ping.npz")
    bins = ping["bins"][0] * (ping["range_m"][0] > 2)  # beyond the floor below the sonar
    beam, bin_ = np.unravel_index(bins.argmax(), bins.shape)
    place = np.array([12, -2])
    assert ping["range_m"][0][bin_] == pytest.approx(np.hypot(*place) - 0.585 / 2, abs=0.05)
    assert ping["bearings"][0][beam] == pytest.approx(np.arctan2(place[1], place[0]), abs=0.02)


SWEEP = """
scenes: [{make: bay.yml, seeds: [1, 2]}, {make: bay.yml, count: 1, set: {sonar.range: 12}}]
poses: {grid: {z: -6}}
classes: {tire: tire_*, crate: crate_*}
picture: {height: 120}
"""


def test_a_sweep_makes_its_scenes_by_recipe(tmp_path):
    (tmp_path / "bay.yml").write_text(
        "floor: {size_m: [30, 20], centre_m: [12, 0], depth_m: 8, cell_m: 0.5}\n"
        "things: [{thing: tire, count: 4, upright: true, gap_m: 1}, {thing: crate, count: 3, gap_m: 1}]\n"
    )
    (tmp_path / "sweep.yml").write_text(SWEEP)
    cache = {"XDG_CACHE_HOME": str(tmp_path / "cache")}

    def dataset(out, *words):
        done = insonify("dataset", ROOT / "deploy/truth.yml", "--sweep", tmp_path / "sweep.yml", "--out", out, *words, **cache)
        assert done.returncode == 0, done.stderr
        return {file.name: file.read_bytes() for file in out.iterdir()}

    whole = dataset(tmp_path / "whole")
    scenes = [json.loads(data)["scene"] for name, data in sorted(whole.items()) if name[:6].isdigit() and name.endswith(".json")]
    assert scenes == ["bay_1.glb", "bay_2.glb", "bay_1.glb"]
    assert len(list((tmp_path / "cache").rglob("*.glb"))) == 2, "the same recipe and seed is made once"
    dataset(tmp_path / "parts", "--shard", "0/2")
    assert dataset(tmp_path / "parts", "--shard", "1/2") == whole

    recipe = (tmp_path / "bay.yml").read_text()
    (tmp_path / "bay.yml").write_text(recipe.replace("count: 3", "count: 2"))
    assert not set(dataset(tmp_path / "other")) & {name for name in whole if name[:6].isdigit()}, "another recipe, another hash"
    (tmp_path / "bay.yml").write_text(recipe.replace("tire", "tyre"))
    done = insonify("dataset", ROOT / "deploy/truth.yml", "--sweep", tmp_path / "sweep.yml", "--out", tmp_path / "bad", **cache)
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1
    assert "bay.yml:2:18: things[0].thing: is tyre; did you mean tire?" in done.stderr


@pytest.mark.parametrize(
    "scene, expected",
    [
        ("{make: bay.yml}", "must have one of seeds and count beside make"),
        ("{make: bay.yml, seeds: [1], count: 2}", "must have one of seeds and count beside make"),
        ("{file: bay.yml, count: 2}", "has seeds or count without make"),
        ("{file: bay.yml, make: bay.yml, count: 2}", "is given beside file; give one of them"),
        ("{make: none.yml, count: 2}", "is none.yml; there is no such file, which is relative to the sweep"),
    ],
)
def test_a_wrong_scene_of_a_sweep_gets_one_line(tmp_path, scene, expected):
    (tmp_path / "bay.yml").write_text("things: [{thing: tire}]")
    (tmp_path / "sweep.yml").write_text(f"scenes: [{scene}]\nposes: {{grid: {{z: -6}}}}\n")
    done = insonify("dataset", ROOT / "deploy/truth.yml", "--sweep", tmp_path / "sweep.yml", "--out", tmp_path / "out")
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1 and "sweep.yml:1:" in done.stderr and "scenes[0]" in done.stderr and expected in done.stderr
