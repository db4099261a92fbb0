"""Tests what the training of scripts/research/sim_to_real adds to crops. Needs the packages of scripts/research/sim_to_real_requirements.txt."""
import sys
import unittest
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import torch

SCRIPTS = Path(__file__).resolve().parent.parent.parent / "scripts/research"
sys.path.insert(0, str(SCRIPTS))
import sim_real_learn as learn  # noqa: E402
import sim_real_sets as sets  # noqa: E402


class Training(unittest.TestCase):
    def test_a_background_adds_noise_over_a_range_of_rows_to_some_crops(self):
        torch.manual_seed(0)
        crops = learn.with_background(torch.zeros(2000, 1, 40, 40))
        self.assertTrue(torch.isfinite(crops).all())
        noisy = crops[crops.amax((1, 2, 3)) > 0.05]
        self.assertAlmostEqual(len(noisy) / len(crops), 0.55, delta=0.1)  # 0.6, less those with little noise or none in the crop
        rows = (noisy**4).mean((1, 3))
        self.assertGreater(float((rows[:, 30:].mean(1) > rows[:, :10].mean(1)).float().mean()), 0.9)

    def test_crops_are_at_times_without_their_size(self):
        torch.manual_seed(1)
        crops = torch.full((2000, 3, 40, 40), 0.5)
        crops[:, 2] = 2
        sizes = learn.augmented(crops)[:, 2]
        self.assertTrue((sizes == sizes[:, :1, :1]).all())
        known = sizes[:, 0, 0][sizes[:, 0, 0] != 0]
        self.assertAlmostEqual(len(known) / 2000, 0.8, delta=0.04)
        self.assertAlmostEqual(float(known.mean()), 2, delta=0.05)

    def test_without_sizes_training_and_test_have_the_same_two_channels(self):
        rng = np.random.default_rng(5)
        crops = [sets.Crop(rng.random((20, 20)), label, "", "") for label in "ab" * 12]
        x, y = learn.arrays(crops, ["a", "b"], False)
        self.assertEqual(learn.augmented(torch.from_numpy(x)).shape, (24, 2, 40, 40))
        self.assertEqual(learn.varied(x, rng).shape, (24, 2, 40, 40))
        cnn = learn.Cnn(2, steps=2, batch=8)
        cnn.learn(x, y, 0)
        self.assertEqual(cnn.evidence(x).shape, (24, 2))

    def test_hog_learns_a_class_by_its_size_alone(self):
        rng = np.random.default_rng(4)
        crops = [sets.Crop(rng.random((side, side)), label, "", "") for label, side in [("a", 16), ("b", 128)] * 60]
        for used, right in ((True, (0.95, 1)), (False, (0.2, 0.8))):
            x, y = learn.arrays(crops, ["a", "b"], used)
            x[:, 0] = rng.random(x[:, 0].shape)
            found = learn.evidence(learn.Hog, 2, (x[:60], y[:60]), x[60:], 0).argmax(1)
            self.assertTrue(right[0] <= (found == y[60:]).mean() <= right[1], (used, (found == y[60:]).mean()))

    def test_a_row_of_two_sources_adds_their_evidence(self):
        rng = np.random.default_rng(6)
        y = np.arange(120) % 4

        def crops(*known):  # the class is two bits, one in the proportions and one in the size; a source knows one of them
            x = rng.random((120, 3, 40, 40), np.float32)
            for bit in (0, 1):
                side = y >> bit & 1 if bit in known else rng.integers(0, 2, 120)
                x[:, 1 + bit] = (6 * side - 3)[:, None, None]
            return x
        sources = {"low": lambda seed, x=crops(0): (x, y), "high": lambda seed, x=crops(1): (x, y)}
        loader = SourceFileLoader("sim_to_real", str(SCRIPTS / "sim_to_real"))  # has no suffix .py
        script = module_from_spec(spec_from_loader("sim_to_real", loader))
        loader.exec_module(script)
        rows = script.trained(learn.Hog, sources, [("low", ["low"]), ("high", ["high"]), ("both", ["low", "high"])], (crops(0, 1), y),
                              SimpleNamespace(seeds=1), 4)
        low, high, both = (row["runs"][0]["accuracy"] for row in rows)
        self.assertLess(max(low, high), 0.8)
        self.assertGreater(both, 0.9)
        self.assertEqual([row["pictures"] for row in rows], [120, 120, 240])


if __name__ == "__main__":
    unittest.main()
