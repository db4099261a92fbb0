"""The command `insonify scene make`: bad recipes and options, pings of its scenes, and sweeps of recipes."""

import json
import os
import random
import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import INSONIFY, ROOT
from made_scenes import answer, insonify, make

pytestmark = pytest.mark.slow

pytest.importorskip("manifold3d")

PACKAGE = ROOT / "components/worlds/insonify_worlds"


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
    ("things:\n  - {thing: tire, diameter_m: 9}", "2:31: things[0].diameter_m: is 9; must be a number from 0.06 to 4"),
    ("things:\n  - {thing: tire, diameter_m: [1, 9]}", "2:35: things[0].diameter_m[1]: is 9; must be a number from 0.06 to 4"),
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
    ("[" * 5000, "has blocks that are nested too deep"),
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
        (["--thing", "tire", "--set", "diameter_m=9", "--out", "a.glb"], "diameter_m: is 9; must be a number from 0.06 to 4"),
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


def test_missing_packages_are_reported_with_the_command_that_installs_them(tmp_path):
    python = tmp_path / "python3"
    python.write_text("#!/bin/sh\nexit 97\n")  # as the package exits if an import fails
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


def test_a_cache_among_the_files_of_all_users_must_be_ones_own(tmp_path):
    (tmp_path / "bay.yml").write_text("things: [{thing: tire}]")
    (tmp_path / "sweep.yml").write_text("scenes: [{make: bay.yml, seeds: [1]}]\nposes: {grid: {z: -6}}\n")
    folder = tmp_path / f"insonify-{os.geteuid()}"

    def dataset():
        words = ("dataset", ROOT / "deploy/truth.yml", "--sweep", tmp_path / "sweep.yml", "--out", tmp_path / "out")
        return insonify(*words, HOME="", XDG_CACHE_HOME="", TMPDIR=str(tmp_path))

    elsewhere = tmp_path / "of_another"
    elsewhere.mkdir()
    for prepare in (lambda: folder.symlink_to(elsewhere), lambda: (folder.mkdir(), folder.chmod(0o777))):
        prepare()
        done = dataset()
        assert done.returncode == 2 and f"{folder}: is not a folder that only this user may write to" in done.stderr
        folder.unlink() if folder.is_symlink() else folder.rmdir()
    done = dataset()
    assert done.returncode == 0, done.stderr
    assert folder.stat().st_mode & 0o777 == 0o700 and len(list(folder.rglob("*.glb"))) == 1


@pytest.mark.parametrize(
    "scene, expected",
    [
        ("{make: bay.yml}", "must have one of seeds and count with make"),
        ("{make: bay.yml, seeds: [1], count: 2}", "must have one of seeds and count with make"),
        ("{file: bay.yml, count: 2}", "has seeds or count without make"),
        ("{file: bay.yml, make: bay.yml, count: 2}", "is given with file; give one of them"),
        ("{make: none.yml, count: 2}", "is none.yml; there is no such file, which is relative to the sweep"),
    ],
)
def test_a_wrong_scene_of_a_sweep_gets_one_line(tmp_path, scene, expected):
    (tmp_path / "bay.yml").write_text("things: [{thing: tire}]")
    (tmp_path / "sweep.yml").write_text(f"scenes: [{scene}]\nposes: {{grid: {{z: -6}}}}\n")
    done = insonify("dataset", ROOT / "deploy/truth.yml", "--sweep", tmp_path / "sweep.yml", "--out", tmp_path / "out")
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1 and "sweep.yml:1:" in done.stderr and "scenes[0]" in done.stderr and expected in done.stderr
