#!/usr/bin/env python3
"""Makes scenes of objects that hang in open water, and sweeps to learn them from: scripts/make_hanging_objects.py FOLDER
Five classes of drawn shape and material: big and small propellers, cylinders, fishing nets, soft pipelines. FOLDER gets
scenes of one object of each class, deployment.yml, two sweeps of each scene and set.yml, which scripts/sim_to_real reads.
Needs numpy."""
import argparse
from pathlib import Path

import numpy as np

from glb import Glb, circle, icosphere, loft, merged, rotation, tube

SIDES = 24


def blade(rng, radius):
    """Of a propeller: thin, twisted, widest at two thirds of its length; along x, its axis is z."""
    width, skew, twist = rng.uniform(0.35, 0.7) * radius, rng.uniform(-0.3, 0.3), rng.uniform(15, 40)
    rings = []
    for part in np.linspace(0.1, 1, 12):
        half = width / 2 * np.sin(np.pi * (0.15 + 0.75 * part)) * (1.02 - part**6)
        thick = 0.03 * radius * (1.1 - part)
        ring = circle(12, 1) * (half, thick)
        turn = np.radians(twist + 25 * (1 - part))
        y = ring[:, 0] * np.cos(turn) - ring[:, 1] * np.sin(turn) + skew * radius * part**2
        z = ring[:, 0] * np.sin(turn) + ring[:, 1] * np.cos(turn)
        rings.append(np.c_[np.full(12, part * radius), y, z])
    return loft(rings)


def propeller(rng, radius):
    count, one = rng.integers(3, 6), blade(rng, radius)
    blades = [one.moved(turn=rotation(yaw=360 * i / count)) for i in range(count)]
    hub = [np.c_[circle(SIDES, r * radius), np.full(SIDES, z * radius)]
           for r, z in [(0.14, -0.25), (0.2, -0.2), (0.2, 0.2), (0.08, 0.4)]]
    return merged(blades + [loft(hub)])


def big_propeller(rng):
    return propeller(rng, rng.uniform(0.22, 0.38)), metal(rng)


def small_propeller(rng):
    return propeller(rng, rng.uniform(0.08, 0.18)), metal(rng)


def cylinder(rng):
    radius, half = rng.uniform(0.08, 0.2), rng.uniform(0.15, 0.45)
    rings = [np.c_[circle(48, radius), np.full(48, z)] for z in np.linspace(-half, half, 9)]
    wall = {"thickness_mm": round(rng.uniform(1.5, 6), 2), "material": str(rng.choice(["steel", "aluminium", "pvc"]))}
    if rng.random() < 0.5:
        wall["fill"] = "air"
    return loft(rings), rough(rng) | {"shell": wall}


def fishing_net(rng):
    """A sheet of twine with knots and floats, loosely folded."""
    columns, rows, step = rng.integers(6, 11), rng.integers(10, 17), rng.uniform(0.09, 0.13)
    u, v = np.meshgrid(np.arange(columns) - columns / 2, np.arange(rows) - rows / 2, indexing="ij")
    phase, waves = rng.uniform(0, 6, 2), rng.uniform(0.4, 1.2, 2)
    depth = rng.uniform(0.05, 0.25) * (np.sin(u * waves[0] + phase[0]) + np.sin(v * waves[1] + phase[1]))
    squeeze = rng.uniform(0.4, 1)
    points = np.stack([depth, u * step * squeeze, v * step], -1) + rng.normal(0, 0.012, (columns, rows, 3))
    twine = [tube(points[i], 0.003, 3) for i in range(columns)] + [tube(points[:, j], 0.003, 3) for j in range(rows)]
    floats = [icosphere(1) for _ in range(rng.integers(3, 8))]
    for each in floats:
        each.positions = each.positions * rng.uniform(0.012, 0.035) + points[rng.integers(columns), rng.integers(rows)]
    return merged(twine + floats), {"material": "hdpe", "roughness_slope": 0.3}


def soft_pipeline(rng):
    """A hose, bent at random."""
    steps, length = 40, rng.uniform(1.2, 2.4)
    bend = np.cumsum(rng.normal(0, 0.05, steps)) + np.linspace(0, rng.uniform(-1.8, 1.8), steps)
    path = np.cumsum(np.c_[np.cos(bend), np.sin(bend), rng.normal(0, 0.1, steps)], 0) * length / steps
    wall = {"thickness_mm": round(rng.uniform(2, 6), 2), "material": str(rng.choice(["neoprene", "pvc", "natural_rubber"]))}
    return tube(path - path.mean(0), rng.uniform(0.02, 0.06), 12), rough(rng) | {"shell": wall}


def rough(rng):
    return {"roughness_slope": round(rng.uniform(0.05, 0.3), 3)}


def metal(rng):
    return rough(rng) | {"material": str(rng.choice(["bronze", "steel", "aluminium", "pvc"]))}


CLASSES = {each.__name__: each for each in (big_propeller, small_propeller, cylinder, fishing_net, soft_pipeline)}

DEPLOYMENT = """\
# A part of the fan of an Oculus M750d, at either of its frequencies: scripts/sim_to_real draws range, noise and what hangs there.
schedule: lockstep
tasks:
  vehicle:
    type: pose::TrajectoryTask
    activity: {period: 0.1}                    # [s]
    properties: {waypoints: [{time: 0, position: [0, 0, 0]}, {time: 10, position: [0, 0, 0]}]}
  scene: {type: scene::SceneTask, properties: {file: objects_0.glb}}
  sonar:
    type: sonar::SonarTask
    properties:
      range: 5                                 # [m]
      range_rounding: exact
      bin_count: 500
      beam_count: %(beams)d
      field_of_view_deg: %(view)g
      beam_height_deg: 20
      frequency_khz: 750
      quality: {rows: 96, columns_per_beam: 2}
      max_walls: 4
      pulse: {bandwidth_khz: 60, window: hann}
      beam_pattern: {receive: {azimuth: {aperture_m: 0.1}}}  # 1.0 degrees at 750 kHz, 0.6 at 1200
      speckle: {coherent: true}
      water: {temperature_celsius: 12}
      absorption: {law: francois_garrison}
  noise:
    type: noise::NoiseTask
    properties: {ambient: {level_db: -90}}
  receiver:
    type: receiver::ReceiverTask
    properties: {tvg: {log_coefficient: 30, max_db: 200}}
connections:
  - {from: vehicle.pose,   to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.ping,     to: noise.clean}
  - {from: noise.noisy,    to: receiver.intensity}
"""

SWEEP = """\
# Objects at %(nearest)g to %(farthest)g m, turned in any way. The noise is drawn from a wide range: gains and seas differ.
seed: %(seed)d
scenes: [%(scene)s]
poses: {random: {count: %(count)d, z: 0}}
settings:
  sonar.frequency_khz: {choice: [750, 1200]}
  noise.ambient.level_db: {uniform: [%(quiet)g, %(loud)g]}
objects:
  - {names: ["*"], count: [1, 1], x: [%(nearest)g, %(farthest)g], y: [-%(side)g, %(side)g], z: [-0.2, 0.2], frame: vehicle, gap: 0,
     roll_deg: [-180, 180], pitch_deg: [-90, 90], yaw_deg: [-180, 180]}
classes: {%(classes)s}
picture: {shape: fan, height: %(height)d, dynamic_range_db: 100, reference_db: -10}
annotations: {min_level: 100, min_pixels: 15}
"""

SET = """\
# What scripts/sim_to_real makes, and what --ablate leaves out: by name, values of the deployment in place of its own.
deployment: deployment.yml
sweeps: ["near_*.yml", "far_*.yml"]
ablated: ["near_[0-4].yml"] # of these, to compare with and without an effect; absent: all
decibels: 100               # of white over black: crops are given back as amplitudes; absent: grey levels as they are
range_down: true            # real pictures have far ranges below; simulated ones above
margin: [0.05, 0.3]         # of a box, drawn, on each side
effects:
  speckle: {sonar.speckle.coherent: false}
  beams_and_pulse: {sonar.beam_pattern: null, sonar.pulse: null, sonar.speckle.coherent: false}
  thin_walls: {sonar.max_walls: 0}
  physics: {sonar.model: cerqueira2017, sonar.beam_pattern: null, sonar.pulse: null, sonar.speckle: null}
"""


BANDS = {  # name of the sweep, nearest and farthest [m], to either side [m], quietest and loudest noise [dB], height [px], settings
    "near": (2.2, 4.5, 0.2, -112, -80, 500, ""),
    "far": (4.5, 13, 0.5, -122, -95, 1000, "  sonar.range: [14]\n  sonar.bin_count: [1000]\n"
                                           "  sonar.beam_count: [96]\n  sonar.field_of_view_deg: [24]\n"),
}


def scene(rng, file):
    glb = Glb()
    for i, (name, make) in enumerate(CLASSES.items()):
        body, acoustics = make(rng)
        material = glb.material(name, acoustics, (0.6, 0.7, 0.8))
        glb.node(name, glb.mesh(name, [body], material), (0, 3.0 * i, -50))
    glb.write(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--scenes", type=int, default=8, help="each with one object of each class (8)")
    parser.add_argument("--samples", type=int, default=100, help="of each sweep, of which there are two for each scene (100)")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    if options.scenes < 1 or options.samples < 1:
        parser.error("--scenes and --samples are at least 1")
    options.folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(options.seed)
    for i in range(options.scenes):
        scene(rng, options.folder / f"objects_{i}.glb")
        for j, (band, (nearest, farthest, side, quiet, loud, height, settings)) in enumerate(BANDS.items()):
            values = {"nearest": nearest, "farthest": farthest, "side": side, "quiet": quiet, "loud": loud, "height": height,
                      "seed": 1000 * options.seed + 2 * i + j, "count": options.samples, "scene": f"objects_{i}.glb",
                      "classes": ", ".join(f"{name}: {name}" for name in CLASSES)}
            text = (SWEEP % values).replace("settings:\n", "settings:\n" + settings)
            (options.folder / f"{band}_{i}.yml").write_text(text)
    (options.folder / "deployment.yml").write_text(DEPLOYMENT % {"beams": 128, "view": 32})
    (options.folder / "set.yml").write_text(SET)


if __name__ == "__main__":
    main()
