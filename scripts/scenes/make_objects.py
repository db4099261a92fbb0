#!/usr/bin/env python3
"""Makes deploy/pictures/objects.png: thirty objects of `insonify scene make` on clay, each as the presets of three sonars
record it at 3 MHz (aris_3000), 1.2 MHz (oculus_m1200d) and 750 kHz (oculus_m750d). Only the range is set, as a user does:
to 8 m for the two Oculus. The range is up, port is left; grey levels are the codes. Needs Pillow, numpy and insonify in the path.

    scripts/scenes/make_objects.py [--out FILE] [THING...]
"""
import argparse
import json
import math
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

PICTURES = Path(__file__).resolve().parents[2] / "deploy" / "pictures"
SONARS = {"aris_3000": [], "oculus_m1200d": ["--set", "sonar.range=8"], "oculus_m750d": ["--set", "sonar.range=8"]}
THINGS = {  # settings of each thing, all below 1.5 m
    "bottle": {}, "bottle standing": {"upright": "true"}, "plastic_bottle": {}, "can": {}, "can standing": {"upright": "true"}, "carton": {},
    "tire": {"diameter_m": 0.5}, "tire standing": {"diameter_m": 0.5, "upright": "true"}, "propeller": {"diameter_m": 0.4}, "valve": {}, "hook": {},
    "chain": {"length_m": 0.8, "bar_m": 0.015}, "cable": {"length_m": 1.2}, "rope": {"length_m": 0.9, "meander_m": 0.2}, "anchor": {}, "bucket": {},
    "barrel": {}, "gas_cylinder": {}, "crate": {}, "pallet": {}, "bicycle": {}, "traffic_cone": {}, "shopping_trolley": {}, "lobster_pot": {},
    "amphora": {}, "concrete_block": {}, "stone": {}, "ball": {}, "artillery_shell": {}, "reef_ball": {},
}
DEPTH, TILE, LABEL, COLUMNS = 8.0, 100, 25, 10


def run(*words, folder):
    return subprocess.run(["insonify", *map(str, words)], cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout


def make_scene(folder, name, values, heading):
    """Makes the thing on clay, and returns its largest extent and its distance [m]."""
    thing = name.split()[0]
    words = [word for key, value in values.items() for word in ("--set", f"{key}={value}")]
    run("scene", "make", "--thing", thing, *words, "--out", "thing.glb", "--quiet", folder=folder)
    size = min(1.6, max(json.loads(run("scene", "thing.glb", "--json", folder=folder))["bounds"]["size"]))
    far = min(max(1.2, 2.2 * size), 3.6)
    entry = {"thing": thing, "x_m": far, "y_m": 0, "heading_deg": heading} | {key: True if value == "true" else value for key, value in values.items()}
    floor = {"size_m": [6, 4], "centre_m": [far, 0], "depth_m": DEPTH, "cell_m": 0.015, "fractal": {"slope": 3.2, "rms_m": 0.004}, "material": "clay"}
    (folder / "scene.yml").write_text(json.dumps({"floor": floor, "things": [entry]}))
    run("scene", "make", "scene.yml", "--out", "scene.glb", "--quiet", folder=folder)
    return size, far


def record(folder, sonar, size, far):
    """Returns the part of one ping about the thing, as levels of 8 bits [row, column]."""
    height = 0.45 * far
    pitch = math.degrees(math.atan2(height - 0.15 * size, far))
    place = f"[{{time: 0, position: [0, 0, {height - DEPTH:.3f}]}}]"
    words = ["--set", "scene.file=../scene.glb", "--set", f"scene.mount={{position: [0, 0, 0], pitch_deg: {pitch:.2f}}}",
             "--set", "vehicle.file=null", "--set", f"vehicle.waypoints={place}", *SONARS[sonar]]
    run("init", sonar, "--sonar", sonar, folder=folder)
    run("run", sonar, "--pings", 1, "--out", f"{sonar}/out", "--quiet", *words, folder=folder)
    run("log", "export", f"{sonar}/out/{sonar}.0.log", "--stream", "receiver.ping", "--to", "ping.npz", folder=folder)
    ping = np.load(folder / "ping.npz")
    bins, bearings, ranges = ping["bins"][0], ping["bearings"][0], ping["range_m"][0]
    order = np.argsort(bearings)
    side, middle = 2.0 * max(size, 0.25), math.hypot(far, height) + 0.15 * size
    across, ahead = np.meshgrid(np.linspace(0.5, -0.5, TILE) * side, np.linspace(0.5, -0.5, TILE) * side + middle)
    beam = np.interp(np.arctan2(across, ahead), bearings[order], np.arange(len(order)))
    bin_ = np.interp(np.hypot(across, ahead), ranges, np.arange(len(ranges)))
    b, k = np.minimum(beam.astype(int), len(order) - 2), np.minimum(bin_.astype(int), len(ranges) - 2)
    u, v, codes = beam - b, bin_ - k, bins[order]
    levels = (1 - u) * ((1 - v) * codes[b, k] + v * codes[b, k + 1]) + u * ((1 - v) * codes[b + 1, k] + v * codes[b + 1, k + 1])
    return np.clip(levels, 0, 255).astype(np.uint8)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=PICTURES / "objects.png")
    parser.add_argument("--heading-deg", type=float, default=60)
    parser.add_argument("things", nargs="*", default=list(THINGS), metavar="THING")
    options = parser.parse_args()
    band = LABEL + len(SONARS) * TILE
    sheet = Image.new("L", (min(COLUMNS, len(options.things)) * TILE, math.ceil(len(options.things) / COLUMNS) * band), 255)
    draw = ImageDraw.Draw(sheet)
    for i, name in enumerate(options.things):
        left, top = i % COLUMNS * TILE, i // COLUMNS * band
        with tempfile.TemporaryDirectory() as text:
            folder = Path(text)
            size, far = make_scene(folder, name, THINGS.get(name, {}), options.heading_deg)
            draw.multiline_text((left + 2, top + 1), f"{name}\n{2 * max(size, 0.25):.2g} m", fill=0, spacing=1)
            for row, sonar in enumerate(SONARS):
                sheet.paste(Image.fromarray(record(folder, sonar, size, far)), (left, top + LABEL + row * TILE))
    for x in range(TILE, sheet.width, TILE):
        draw.line((x, 0, x, sheet.height), fill=255)
    sheet.point(lambda level: round(level / 17) * 17).quantize(16).save(options.out, optimize=True)  # speckle packs badly


if __name__ == "__main__":
    main()
