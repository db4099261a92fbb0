"""Sea floors with things on them, made by `insonify scene make`."""

import itertools
import json
import random

import numpy as np
import pytest
from conftest import ROOT
from made_scenes import FloorGrid, Glb, answer, insonify, make, unbalanced_edges, volume

pytestmark = pytest.mark.slow

pytest.importorskip("manifold3d")

THINGS = {each["thing"]: each for each in json.loads(answer("scene", "make", "--list", "--json"))}


def bounds_of(parameter):
    low, _, high = parameter["may_be"].partition(" to ")
    return float(low), float(high)


def is_number(parameter):
    return " to " in parameter["may_be"] and "[" not in parameter["may_be"]


# Parameters without random values: they would give too many triangles, or sizes too large for a floor of 60 m.
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
    """Every thing with default and with random values."""
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
        (["tire", "diameter_m=0.08", "width_m=0.03"], (0.08, 0.08, 0.03)),
        (["can"], (0.115, 0.066, 0.066)),
        (["plastic_bottle", "upright=true"], (0.065, 0.065, 0.22)),
        (["carton", "upright=true"], (0.07, 0.07, 0.22)),
        (["valve", "bore_m=0.1"], (0.29, 0.51, 0.3)),
        (["hook", "upright=true"], (0.125, 0.027, 0.198)),
        (["barrel", "upright=true"], (0.585, 0.585, 0.88)),
        (["ball", "diameter_m=1"], (1, 1, 1)),
        (["container"], (6.06, 2.44, 2.59)),
        (["artillery_shell", "diameter_m=0.155"], (0.7, 0.16, 0.16)),
        (["moored_mine", "diameter_m=1", "line_m=5", "lean_deg=0"], (1.04, 1.04, 6.77)),
    ],
)
def test_things_have_the_requested_size(tmp_path, words, size):
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
def test_things_of_random_recipes_rest_on_the_floor_and_do_not_overlap(tmp_path, number):
    rng = np.random.default_rng(number)
    recipe = random_recipe(rng)
    recipe["things"][-1], recipe["things"][0] = recipe["things"][0], recipe["things"][-1]  # the largest thing first
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


def test_places_are_within_the_requested_bounds(tmp_path):
    text = "floor: {size_m: [40, 40]}\nthings: [{thing: ball, count: 20, x_m: [5, 15], y_m: {choice: [-3, 3]}, buried: 0, gap_m: 0.3}]"
    middles = np.array([node.positions.mean(0) for name, node in Glb(make(tmp_path, text)).nodes.items() if name != "sea_floor"])
    assert len(middles) == 20
    assert 4.99 < middles[:, 0].min() < 8 and 12 < middles[:, 0].max() < 15.01
    assert np.allclose(np.abs(middles[:, 1]), 3, atol=0.01)
    assert np.allclose(middles[:, 2], -10 + 0.15, atol=0.01)


def test_an_additional_thing_does_not_move_the_others(tmp_path):
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
def test_a_fractal_floor_has_the_requested_slope_and_height(tmp_path, slope, rms):
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


def test_pockmarks_have_the_requested_number_and_depth(tmp_path):
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
    # A law d^-2 from 0.2 to 1 has a fifth above 0.42 m; boulders are a little smaller than their balls.
    assert 0.1 < (sizes > 0.42).mean() < 0.25
    pebbles = glb.nodes["pebbles"]
    ground = FloorGrid(glb.nodes["sea_floor"])
    above = pebbles.positions[:, 2] - ground.height(pebbles.positions[:, 0], pebbles.positions[:, 1])
    assert -0.05 < above.min() < 0 < above.max() < 0.06
    assert unbalanced_edges(*pebbles.parts[0]) == 0


def test_the_simulator_knows_all_materials(tmp_path):
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


def test_the_recipe_of_the_page_makes_the_described_scene(tmp_path):
    page = (ROOT / "components/worlds/README.md").read_text()
    recipe = page.split("```yaml\n")[1].split("```")[0]
    glb = Glb(make(tmp_path, recipe, seed=3))
    assert f"has {sum(len(node.faces) for node in glb.nodes.values()):,} with seed 3" in page
    assert {"sea_floor", "quay_1", "pipeline_1", "tire_1", "wreck_1", "moored_mine_1", "rock_1", "pebbles"} <= set(glb.nodes)
