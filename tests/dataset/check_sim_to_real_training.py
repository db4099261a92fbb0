"""Tests what the training of scripts/sim_to_real adds to crops. Needs torch."""
import sys
import unittest
from pathlib import Path

import torch

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "scripts"))
import sim_real_learn as learn  # noqa: E402


class Training(unittest.TestCase):
    def test_a_background_adds_noise_over_a_range_of_rows_to_some_crops(self):
        torch.manual_seed(0)
        crops = learn.with_background(torch.zeros(2000, 1, 40, 40))
        self.assertTrue(torch.isfinite(crops).all())
        noisy = crops[crops.amax((1, 2, 3)) > 0.05]
        self.assertAlmostEqual(len(noisy) / len(crops), 0.55, delta=0.1)  # 0.6, less those with little noise or none in the crop
        rows = (noisy**4).mean((1, 3))
        self.assertGreater(float((rows[:, 30:].mean(1) > rows[:, :10].mean(1)).float().mean()), 0.9)


if __name__ == "__main__":
    unittest.main()
