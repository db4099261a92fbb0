"""Tests what the training of scripts/sim_to_real adds to crops. Needs the packages of scripts/sim_to_real_requirements.txt."""
import sys
import unittest
from pathlib import Path

import numpy as np
import torch

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "scripts"))
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
        cnn.learn([(x, y)], 0)
        self.assertEqual(len(cnn.find(x)), 24)

    def test_hog_learns_a_class_by_its_size_alone(self):
        rng = np.random.default_rng(4)
        crops = [sets.Crop(rng.random((side, side)), label, "", "") for label, side in [("a", 16), ("b", 128)] * 60]
        for used, right in ((True, (0.95, 1)), (False, (0.2, 0.8))):
            x, y = learn.arrays(crops, ["a", "b"], used)
            x[:, 0] = rng.random(x[:, 0].shape)
            found = learn.answers(learn.Hog, 2, [(x[:60], y[:60])], x[60:], 0)
            self.assertTrue(right[0] <= (found == y[60:]).mean() <= right[1], (used, (found == y[60:]).mean()))


if __name__ == "__main__":
    unittest.main()
