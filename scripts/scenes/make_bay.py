#!/usr/bin/env python3
"""Makes deploy/scenes/bay.flt and bay.hdr: the surveyed floor of a bay, 161 x 161 posts 2.5 m apart, elevations of -24 to
-12 m: a slope with sand waves, a channel, a field of pockmarks, and the roughness of a floor. Needs numpy."""
from pathlib import Path

import numpy as np

POSTS, SPACING = 161, 2.5
EASTING, NORTHING = 451000.0, 5962000.0    # south-west post, UTM [m]

rng = np.random.default_rng(7)
north, east = np.meshgrid(np.arange(POSTS) * SPACING, np.arange(POSTS) * SPACING, indexing="ij")

# Roughness whose spectrum falls with the third power of the wave number, as on real floors.
waves = np.hypot(*np.meshgrid(np.fft.fftfreq(POSTS, SPACING), np.fft.fftfreq(POSTS, SPACING), indexing="ij"))
waves[0, 0] = np.inf
rough = np.fft.ifft2(np.fft.fft2(rng.normal(size=waves.shape)) * waves**-1.5).real
floor = -16 - 0.012 * east + 0.3 * rough / rough.std()

crest = 2 * np.pi * (north + 0.35 * east + 6 * np.sin(east / 60)) / 28
floor += 0.9 * (np.sin(crest) + 0.25 * np.sin(2 * crest)) * np.clip(1 - np.abs(east - 110) / 100, 0, 1)
floor -= 3.5 * np.exp(-(((east - 265 - 20 * np.sin(north / 90)) / 22) ** 2))
for _ in range(9):
    middle, size = (rng.uniform(150, 380), rng.uniform(20, 380)), rng.uniform(6, 12)
    floor -= 1.6 * np.exp(-((north - middle[0]) ** 2 + (east - middle[1]) ** 2) / (2 * size**2))

target = Path(__file__).resolve().parents[2] / "deploy" / "scenes" / "bay.flt"
floor[::-1].astype("<f4").tofile(target)    # rows from north to south
target.with_suffix(".hdr").write_text(
    f"ncols {POSTS}\nnrows {POSTS}\nxllcenter {EASTING}\nyllcenter {NORTHING}\ncellsize {SPACING}\nbyteorder LSBFIRST\n"
)
