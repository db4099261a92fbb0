"""Tests scripts/research/sim_to_real: halves never share a film, windows show the visible pixels, wrong input is one error and exit 2.
A stand-in for insonify makes the sets, and writes the files of a data set."""
import random
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import yaml
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts/research"))
import sim_real_learn as learn  # noqa: E402
import sim_real_sets as sets  # noqa: E402

# Draws a bright square for each class that its first argument names, as `insonify dataset ... --out FOLDER` would.
STAND_IN = """#!{python}
import json, sys
from pathlib import Path
import numpy as np
from PIL import Image
folder = Path(sys.argv[sys.argv.index("--out") + 1])
folder.mkdir(parents=True)
classes = {classes}
images, annotations = [], []
for i in range(4 * len(classes)):
    pixels = np.random.default_rng(i).integers(0, 60, (40, 40), np.uint8)
    pixels[10:20, 10:20] = 200
    Image.fromarray(pixels).save(folder / f"{{i:06d}}_0.png")
    images.append({{"id": i, "file_name": f"{{i:06d}}_0.png"}})
    annotations.append({{"image_id": i, "category_id": i % len(classes), "bbox": [10, 10, 10, 10]}})
(folder / "instances_train.json").write_text(json.dumps({{"images": images, "annotations": annotations,
    "categories": [{{"id": i, "name": name}} for i, name in enumerate(classes)]}}))
(folder / "manifest.json").write_text("{{}}")
"""


DEVICE = """
tasks:
  sonar: {type: sonar::SonarTask, properties: {range: 30, bin_count: 750, pulse: {bandwidth_khz: 166}, beam_pattern: {receive: {}}}}
  noise: {type: noise::NoiseTask, properties: {speckle: {law: rayleigh}}}
  receiver: {type: receiver::ReceiverTask, properties: {output: code, code: {bits: 16, law: sqrt, gamma: 0.5}}}
"""

DRAWN = """
settings: {receiver.gain_db: {uniform: [-6, 6]}, receiver.code.gamma: {uniform: [0.4, 0.6]}}
picture: {shape: fan}
"""


class DeviceSet(unittest.TestCase):
    def made(self, folder, text, sweep=DRAWN):
        (folder / "device.yml").write_text(text)
        (folder / "sweep.yml").write_text(sweep)
        return subprocess.run([sys.executable, ROOT / "scripts/scenes/make_hanging_objects.py", folder / "set", "--scenes", "1", "--objects", "1",
                               "--device", folder / "device.yml"], capture_output=True, text=True)

    def test_a_device_is_used_as_it_is_and_each_of_its_effects_can_be_omitted(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            self.assertEqual(self.made(folder, DEVICE).returncode, 0)
            plan = sets.read_set(folder / "set")
            self.assertEqual(plan["deployment"].resolve(), (folder / "device.yml").resolve())
            self.assertEqual(plan["effects"], {"beam_pattern": {"sonar.beam_pattern": None}, "pulse": {"sonar.pulse": None},
                                               "speckle": {"noise.speckle": None}, "gamma": {"receiver.code.gamma": 1},
                                               "operator": {"receiver.gain_db": 0, "receiver.code.gamma": 0.5}})
            self.assertEqual([each.name for each in plan["sweeps"]], ["near_0.yml", "far_0.yml"])
            for file in plan["sweeps"]:
                sweep = yaml.safe_load(file.read_text())
                self.assertEqual(set(sweep["settings"]), {"sonar.range", "scene.mount", "receiver.gain_db", "receiver.code.gamma"})
                self.assertEqual(sweep["settings"]["receiver.gain_db"], {"uniform": [-6, 6]})
                self.assertEqual((sweep["picture"]["scale"], sweep["picture"]["code_bits"], sweep["picture"]["smooth"]), ("code", 16, False))
                bins = sweep["settings"]["sonar.range"][0] / 750 / 1497e-6  # of a microsecond; rounded up to a whole one
                self.assertLess(np.ceil(bins) - bins, 0.1)

    def test_a_file_that_is_no_deployment_of_a_device_is_one_error(self):
        with tempfile.TemporaryDirectory() as name:
            for text in ("tasks: {}", "- 1", "tasks: [", DEVICE.replace("code: {bits", "codes: {bits")):
                done = self.made(Path(name), text)
                self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
                self.assertIn("device.yml: is no deployment", done.stderr)
            done = self.made(Path(name), DEVICE, "picture: {}")
            self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
            self.assertIn("next to its sweep.yml (KeyError('settings'))", done.stderr)

    def test_what_an_effect_sets_is_not_drawn(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            self.assertEqual(self.made(folder, DEVICE).returncode, 0)
            sweep = sets.read_set(folder / "set")["sweeps"][0]
            content = yaml.safe_load(sweep.read_text())
            self.assertEqual(sets.without_settings(sweep, content, ["noise.speckle", "receiver.gain"], folder / "less.yml"), sweep)
            less = yaml.safe_load(sets.without_settings(sweep, content, ["receiver.code"], folder / "less.yml").read_text())
            self.assertEqual(set(content["settings"]) - set(less["settings"]), {"receiver.code.gamma"})
            self.assertEqual(less["scenes"], [str((sweep.parent / content["scenes"][0]).resolve())])
            self.assertEqual(less["objects"], content["objects"])


class Contrast(unittest.TestCase):
    def test_a_crop_is_the_same_for_any_gain_offset_and_gamma_and_equal_pixels_have_one_level(self):
        rng = np.random.default_rng(8)
        for _ in range(20):
            crop = rng.random(rng.integers(5, 90, 2))
            levels = learn.normalised(crop)
            gamma, gain, offset = rng.uniform(0.3, 3), rng.uniform(0.1, 5), rng.uniform(0, 0.5)
            np.testing.assert_allclose(learn.normalised(offset + gain * crop**gamma), levels, atol=1e-6)
            self.assertTrue(0 <= levels.min() and levels.max() <= 1)
        flat = learn.normalised(np.full((12, 9), 0.3))
        np.testing.assert_allclose(flat, flat[0, 0], atol=1e-6)
        saturated = learn.normalised(np.where(np.arange(1600).reshape(40, 40) < 800, np.linspace(0, 0.9, 1600).reshape(40, 40), 1))
        self.assertEqual(len(np.unique(saturated[20:])), 1)  # white is no texture
        self.assertLess(saturated[:20].max(), saturated[20:].min())


class Halves(unittest.TestCase):
    def test_no_film_and_no_picture_is_in_both_sets(self):
        rng, cut = random.Random(3), 0
        for _ in range(300):
            films = rng.choice([[""], [f"film_{i}" for i in range(rng.randint(2, 9))]])
            crops = [sets.Crop(np.zeros((4, 4)), label, rng.choice(films), f"{label}/img_{i}.png")
                     for label in "abc"[:rng.randint(2, 3)] for i in range(rng.randint(4, 40))]
            try:
                train, test = sets.halves(crops)
            except sets.Wrong:  # a class of one film alone
                continue
            cut += 1
            self.assertEqual(sorted(each.name for each in train + test), sorted(each.name for each in crops))
            self.assertFalse({each.name for each in train} & {each.name for each in test})
            self.assertFalse({each.group for each in train} & {each.group for each in test} - {""})
            self.assertEqual({each.label for each in train}, {each.label for each in test})
        self.assertGreater(cut, 200)

    def test_without_films_the_pictures_are_divided_once(self):
        with tempfile.TemporaryDirectory() as folder:
            for label in "ab":
                (Path(folder) / label).mkdir()
                for i in range(1, 13):  # by number, not alphabetically: img_10 follows img_9
                    Image.new("L", (8, 8), i).save(Path(folder) / label / f"img_{i}.png")
            train, test = sets.halves(sets.real(Path(folder))[0])
            for label in "ab":
                numbers = [[int(each.name.split("_")[1][:-4]) for each in part if each.label == label] for part in (train, test)]
                self.assertEqual(numbers, [list(range(1, 7)), list(range(7, 13))])


class Windows(unittest.TestCase):
    def setUp(self):
        self.levels = np.random.default_rng(0).rayleigh(0.02, (120, 120)).astype(np.float32)
        self.rows, self.columns = (each.ravel() for each in np.mgrid[40:44, 30:80])  # a bar across
        self.levels[40:44, 30:80] = 0.9
        self.box = [30, 40, 50, 4]

    def test_a_turned_window_holds_its_object_and_the_object_is_turned(self):
        for turn in (-40, 0, 25):
            window = sets.window(self.levels, self.box, (self.rows, self.columns), turn, 8)
            crop = sets.cut_turned(self.levels, window, 0.1)
            self.assertAlmostEqual(int((crop > 0.5).sum()), 200, delta=24)
            y, x = np.nonzero(crop > 0.5)
            self.assertAlmostEqual(np.degrees(np.arctan(np.polyfit(x, y, 1)[0])), -turn, delta=5)  # rows count downward

    def test_an_object_below_the_noise_has_no_window(self):
        faint = self.levels.copy()
        faint[40:44, 30:80] = 0.03
        self.assertIsNone(sets.window(faint, self.box, (self.rows, self.columns), 0, 8))
        self.assertIsNotNone(sets.window(faint, self.box, (self.rows, self.columns), 0, None))

    def test_the_window_is_the_box_of_bright_pixels(self):
        self.levels[40:44, 55:80] = 0.02  # half of the bar
        left, _, width, _ = sets.window(self.levels, self.box, (self.rows, self.columns), 0, 8).box
        self.assertAlmostEqual(left, 29, delta=2)
        self.assertAlmostEqual(left + width, 56, delta=3)

    def test_a_display_turns_its_share_white(self):
        pixels = np.random.default_rng(1).rayleigh(1, (100, 100))
        self.assertAlmostEqual((sets.displayed(pixels, 3) == 1).mean(), 0.03, delta=0.005)

    def test_classifiers_get_proportions_and_the_size_of_sets_that_use_it(self):
        crops = [sets.Crop(np.random.default_rng(2).random(size), "a", "", "") for size in [(64, 16), (64, 64), (32, 128)]]
        for used in (True, False):
            x, _ = learn.arrays(crops, ["a"], used)
            np.testing.assert_allclose(x[:, 1, 0, 0], [2, 0, -2])
            self.assertEqual(x.shape[1], 3 if used else 2)  # an unused size is absent, not 0
            np.testing.assert_allclose(x[:, 2:, 5, 7], [[-1], [0], [0]] if used else np.zeros((3, 0)), atol=1e-6)


class Wrong(unittest.TestCase):
    def setUp(self):
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.folder = Path(held.name)
        for label in ("ball", "box"):
            (self.folder / "real" / label).mkdir(parents=True)
            for i in range(6):
                Image.fromarray(np.random.default_rng(i).integers(0, 255, (20, 20), np.uint8)).save(
                    self.folder / "real" / label / f"{i}.png")
        plan = self.folder / "set"
        plan.mkdir()
        (plan / "deployment.yml").write_text("tasks: {}\n")
        (plan / "sweep.yml").write_text("poses: {}\n")
        (plan / "set.yml").write_text("deployment: deployment.yml\nsweeps: [sweep.yml]\neffects: {pulse: {sonar.pulse: null}}\n")
        self.stand_in(["ball", "box"])

    def stand_in(self, classes):
        command = self.folder / "insonify"
        command.write_text(STAND_IN.format(python=sys.executable, classes=classes))
        command.chmod(0o755)

    def refuses(self, said, *more):
        done = subprocess.run([sys.executable, ROOT / "scripts/research/sim_to_real", self.folder / "real", self.folder / "set", "--out",
                               self.folder / "out", "--insonify", self.folder / "insonify", *more], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(said, done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual(len([line for line in done.stderr.splitlines() if line.startswith("sim_to_real: ")]), 1, done.stderr)

    def test_empty_class(self):
        (self.folder / "real" / "net").mkdir()
        self.refuses("net: holds 0 pictures; a class has at least 4")

    def test_one_class(self):
        for file in (self.folder / "real" / "box").iterdir():
            file.unlink()
        (self.folder / "real" / "box").rmdir()
        self.refuses("has 1 classes; there must be at least two")

    def test_unreadable_picture(self):
        (self.folder / "real" / "box" / "7.jpg").write_bytes(b"no picture")
        self.refuses("box/7.jpg: cannot be read as a picture")

    def test_damaged_zip(self):
        (self.folder / "real" / "net.zip").write_bytes(b"no zip")
        self.refuses("net.zip: is no zip file")

    def test_damaged_coco(self):
        (self.folder / "real" / "frames.json").write_text("{}")
        self.refuses("frames.json: is no COCO file")

    def test_no_folder(self):
        (self.folder / "real").rename(self.folder / "elsewhere")
        self.refuses("is no folder")

    def test_class_missing_in_the_sweep(self):
        self.stand_in(["ball", "tire"])
        self.refuses("box: is a class of")

    def test_no_windows(self):
        self.stand_in([])
        self.refuses("the sweeps gave no windows")

    def test_failing_command(self):
        (self.folder / "insonify").write_text("#!/bin/sh\necho sweep.yml:1:1 is wrong >&2; exit 2\n")
        self.refuses("sweep.yml:1:1 is wrong")

    def test_unknown_effect(self):
        self.refuses("--ablate plse: is no effect of", "--ablate", "plse")

    def test_no_command(self):
        (self.folder / "insonify").unlink()
        self.refuses("there is no such command")

    def test_set_without_sweeps(self):
        (self.folder / "set" / "set.yml").write_text("deployment: deployment.yml\n")
        self.refuses("must have deployment and sweeps")

    def test_sizes_neither_true_nor_false(self):
        (self.folder / "set" / "set.yml").write_text("deployment: deployment.yml\nsweeps: [sweep.yml]\nsizes: 3\n")
        self.refuses("set.yml: sizes is 3; it is true or false")

    def test_set_names_no_file(self):
        (self.folder / "set" / "sweep.yml").unlink()
        self.refuses("no file is named as its sweeps are")


if __name__ == "__main__":
    unittest.main()
