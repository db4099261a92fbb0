#!/usr/bin/env python3
"""A fan, its objects, and the error of a ping over its time: components/python/examples/look.py DEPLOYMENT PICTURE.png

The error is relative to the finest sampling of the ping."""
import sys
import time

import insonify
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

deployment, file = sys.argv[1:]
pose = insonify.Pose([2, 0, -5.5])
# Noise would hide the error; the sonar's own pings have no noise.
rows = [16, 32, 64, 128, 256, 1024]


def noiseless(count):
    """Bins of the ping at the pose with this number of rows, and the time of the better of two steps
    [ms]."""
    quality = {"rows": count, "columns_per_beam": 4}
    simulation = insonify.Simulation(deployment, overrides={"sonar.quality": quality, "noise.speckle": None})
    simulation.step(pose)
    times = []
    for _ in range(2):
        start = time.perf_counter()
        ping = simulation.step(pose)
        times.append(1e3 * (time.perf_counter() - start))
    return ping.bins.astype(float), min(times)


simulation = insonify.Simulation(deployment, seed=1, truth=True)
ping = simulation.step(pose)
truth = ping.truth

figure, (fan, objects, errors) = plt.subplots(1, 3, figsize=(16, 5), layout="constrained")
fan.imshow(ping.fan(width=700))
fan.set_title("the ping")
fan.axis("off")

bearings = np.degrees(ping.bearings)
shown = np.ma.masked_less(truth.object, 0)
objects.pcolormesh(bearings, ping.ranges, shown.T, cmap="tab20", shading="nearest")
objects.invert_xaxis()  # port is left
objects.set(title="the object that each bin shows", xlabel="bearing [deg], port positive", ylabel="slant range [m]")

bins, times = zip(*(noiseless(count) for count in rows))
finest = bins[-1]
error = [np.linalg.norm(each - finest) / np.linalg.norm(finest) for each in bins[:-1]]
errors.loglog(times[:-1], error, "o-")
for count, ms, off in zip(rows, times, error):
    errors.annotate(f"{count} rows", (ms, off), textcoords="offset points", xytext=(6, 4))
errors.set(title=f"error against {rows[-1]} rows", xlabel="time of a step [ms]", ylabel="relative L2 error")
errors.grid(True, which="both", alpha=0.3)
figure.savefig(file, dpi=100)
