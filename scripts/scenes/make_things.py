#!/usr/bin/env python3
"""Makes deploy/pictures/things.png: the things of `insonify scene make`, each on clay as a forward-looking sonar of 1.2 MHz
records it from 2.2 of its lengths away. The range is up, port is left. Needs matplotlib and insonify in the path.

    scripts/scenes/make_things.py [--out FILE] [THING...]
"""
import argparse
import io
import json
import math
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from matplotlib import pyplot
from PIL import Image

PICTURES = Path(__file__).resolve().parents[2] / "deploy" / "pictures"
OMITTED = ("quay", "jetty", "tank", "pile", "ball")  # larger than a tile of the picture, or without detail
DEPTH = 30.0
SETTINGS = {  # by thing: settings for the picture
    "pipeline": {"length_m": 12}, "cable": {"length_m": 4}, "rope": {"length_m": 2.5, "meander_m": 0.5}, "chain": {"length_m": 2.5},
    "mooring": {"line_m": 2.5, "lean_deg": 30, "heading_deg": 90}, "moored_mine": {"line_m": 1.5, "lean_deg": 40, "heading_deg": 90}, "diver": {"height_m": 0.6}, "rov": {"height_m": 0.3},
    "auv": {"height_m": 0.3}, "net": {"length_m": 2.5, "width_m": 1.6, "mesh_m": 0.1}, "wreck": {"length_m": 12},
}
DEPLOYMENT = """
tasks:
  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {waypoints: [{time: 0, position: [0, 0, %(z)g], pitch_deg: %(pitch)g}]}}
  scene: {type: scene::SceneTask, properties: {file: scene.glb}}
  sonar:
    type: sonar::SonarTask
    properties:
      range: %(range)g
      range_rounding: sample
      bin_count: %(bins)d
      beam_count: 256
      field_of_view_deg: %(view)g
      beam_height_deg: 40
      frequency_khz: 1200
      max_walls: 4
      quality: {rows: 600, columns_per_beam: 3}
      pulse: {bandwidth_khz: %(bandwidth)g, window: hann}
      beam_pattern: {receive: {azimuth: {weighting: taylor, sidelobe_db: -35, aperture_m: 0.2}}}
      speckle: {coherent: true}
  log: {type: logger::LoggerTask, properties: {file: ping.log}}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.ping, to: log.ping}
"""


def run(*words, folder):
    return subprocess.run(["insonify", *map(str, words)], cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout


def scene_of(folder, name, heading, values, size):
    """A patch of clay with the thing in its middle, `far` from the origin."""
    far = 2.2 * size
    side = 4.5 * size
    entry = {"thing": name, "x_m": far, "y_m": 0, "heading_deg": heading} | values
    floor = {"size_m": [side, side], "centre_m": [far, 0], "depth_m": DEPTH, "cell_m": max(side / 400, 0.005),
             "fractal": {"slope": 3.2, "rms_m": 0.004 * size}, "material": "clay"}
    (folder / "scene.yml").write_text(json.dumps({"floor": floor, "things": [entry]}))
    run("scene", "make", "scene.yml", "--out", "scene.glb", "--quiet", folder=folder)


def size_of(folder, name, values):
    """The largest extent of the thing [m]."""
    settings = [word for key, value in values.items() for word in ("--set", f"{key}={value}")]
    run("scene", "make", "--thing", name, *settings, "--out", "thing.glb", "--quiet", folder=folder)
    return max(json.loads(run("scene", "thing.glb", "--json", folder=folder))["bounds"]["size"])


def ping_of(folder, name, heading):
    """Bins [beams, bins] of one ping, with bearings [rad] and ranges [m]; the size of the thing [m]."""
    values = SETTINGS.get(name, {})
    size = max(size_of(folder, name, values), 0.3)  # small things from 0.66 m
    scene_of(folder, name, heading, values, size)
    far, height = 2.2 * size, 1.1 * size
    pitch = math.atan2(height - 0.2 * size, far)
    reach = math.hypot(far, height) + 1.2 * size
    step = 1.5e-3 * max(1, round(reach / 900 / 1.5e-3))  # bins: the way of sound in whole microseconds
    bins = math.ceil(reach / step)
    (folder / "run.yml").write_text(DEPLOYMENT % {
        "z": height - DEPTH, "pitch": math.degrees(pitch), "range": bins * step, "bins": bins, "view": 56, "bandwidth": min(300, 110 / size)})  # 1/150 of the thing, or 2.5 mm
    run("run", "run.yml", "--pings", 1, "--out", "out", folder=folder)
    run("log", "export", "out/ping.log", "--stream", "sonar.ping", "--to", "ping.npz", folder=folder)
    return dict(np.load(folder / "ping.npz")), size


def draw(axis, name, ping, size):
    """The part of the fan about the thing, 45 dB of levels below its brightest 0.2 %."""
    far, height = 2.2 * size, 1.1 * size
    ranges, bearings = ping["range_m"][0], ping["bearings"][0]
    level = 10 * np.log10(np.maximum(ping["bins"][0], 1e-30)) + 40 * np.log10(np.maximum(ranges, 0.1))
    across, ahead = np.meshgrid(np.linspace(1, -1, 440) * 0.9 * size, np.linspace(1.1, -0.7, 440) * size)
    slant = math.hypot(far, height)
    r, bearing = np.hypot(slant + ahead, across), np.arctan2(across, slant + ahead)
    order = np.argsort(bearings)
    beam = np.interp(bearing, bearings[order], order)
    bin_ = np.interp(r, ranges, np.arange(len(ranges)))
    b, k = np.clip(beam.astype(int), 0, len(bearings) - 2), np.clip(bin_.astype(int), 0, len(ranges) - 2)
    u, v = beam - b, bin_ - k
    picture = (1 - u) * ((1 - v) * level[b, k] + v * level[b, k + 1]) + u * ((1 - v) * level[b + 1, k] + v * level[b + 1, k + 1])
    white = np.percentile(picture, 99.8)
    axis.imshow(picture, cmap="afmhot", vmin=white - 45, vmax=white)
    axis.set_title(f"{name}, {size:.2g} m", fontsize=8, pad=2)


def main():
    listing = json.loads(subprocess.run(["insonify", "scene", "make", "--list", "--json"], check=True, stdout=subprocess.PIPE).stdout)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=PICTURES / "things.png")
    parser.add_argument("--heading-deg", type=float, default=60)
    parser.add_argument("things", nargs="*", default=[each["thing"] for each in listing if each["thing"] not in OMITTED])
    options = parser.parse_args()
    columns = min(7, len(options.things))
    rows = math.ceil(len(options.things) / columns)
    figure, axes = pyplot.subplots(rows, columns, figsize=(2.0 * columns, 2.0 * rows), squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    for axis, name in zip(axes.flat, options.things):
        with tempfile.TemporaryDirectory() as folder:
            ping, size = ping_of(Path(folder), name, options.heading_deg)
        draw(axis, name, ping, size)
    figure.subplots_adjust(0.003, 0.003, 0.997, 0.975, 0.02, 0.1)
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=88)
    Image.open(drawn).convert("RGB").quantize(24).save(options.out, optimize=True)  # speckle packs badly


if __name__ == "__main__":
    main()
