#!/usr/bin/env python3
"""Makes scenes of objects that hang in open water, and sweeps to train on them: scripts/scenes/make_hanging_objects.py FOLDER
Five classes of random shape and material: big and small propellers, cylinders, fishing nets, soft pipelines. Each hangs on a line.
FOLDER gets scenes of several objects of each class, deployment.yml, sweeps of each scene and set.yml, which scripts/research/sim_to_real
reads. With --device the deployment is one of `insonify init`, as it is: sweeps set its range and level the sonar, draw what the sweep.yml next to
it draws, and have its pictures, with up to five objects. Needs numpy, and PyYAML for --device."""
import argparse
import json
import os
from pathlib import Path

import numpy as np

from glb import Glb, circle, icosphere, loft, merged, rotation, tube

SIDES = 24


def any_turn(rng):
    return rotation(rng.uniform(-180, 180), np.degrees(np.arcsin(rng.uniform(-1, 1))), rng.uniform(-180, 180))


def blade(rng, radius):
    """Blade of a propeller: thin, twisted, widest at two thirds of its length; along x, its axis is z."""
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
    return merged(blades + [loft(hub)]).moved(turn=any_turn(rng))


def big_propeller(rng):
    return propeller(rng, rng.uniform(0.22, 0.38)), metal(rng)


def small_propeller(rng):
    return propeller(rng, rng.uniform(0.07, 0.16)), metal(rng)


def cylinder(rng):
    radius, half = rng.uniform(0.05, 0.22), rng.uniform(0.08, 0.32)
    rings = [np.c_[circle(48, radius), np.full(48, z)] for z in np.linspace(-half, half, 9)]
    wall = {"thickness_mm": round(rng.uniform(1.5, 12), 2), "material": str(rng.choice(["steel", "aluminium", "pvc"]))}
    if rng.random() < 0.3:
        wall["fill"] = "air"
    return loft(rings).moved(turn=any_turn(rng)), rough(rng) | {"shell": wall}


def fishing_net(rng):
    """A sheet of twine with knots and floats, hanging more or less gathered."""
    height, width = rng.uniform(1.5, 4.5), rng.uniform(0.6, 1.2)
    columns, rows = rng.integers(5, 9), int(height / rng.uniform(0.1, 0.16))
    u, v = np.meshgrid(np.linspace(-0.5, 0.5, columns), np.linspace(-0.5, 0.5, rows), indexing="ij")
    phase, waves = rng.uniform(0, 6, 2), rng.uniform(3, 9, 2)
    depth = rng.uniform(0.05, 0.25) * (np.sin(u * waves[0] + phase[0]) + np.sin(v * waves[1] + phase[1]))
    gathered = width * rng.uniform(0.05, 0.5) * (1 + 0.4 * np.sin(v * 5 + phase[1]))
    points = np.stack([depth, u * gathered, v * height], -1) + rng.normal(0, 0.015, (columns, rows, 3))
    twine = [tube(points[i], 0.003, 3) for i in range(columns)] + [tube(points[:, j], 0.003, 3) for j in range(rows)]
    line = rng.integers(columns)  # the line with floats
    floats = [icosphere(1) for _ in range(rng.integers(8, 24))]
    for each in floats:
        each.positions = each.positions * rng.uniform(0.012, 0.045) + points[line, rng.integers(rows)]
    turn = rotation(yaw=rng.uniform(-180, 180))
    return merged(twine).moved(turn=turn), {"lambert_db": round(rng.uniform(-28, -4), 2)}, merged(floats).moved(turn=turn)


def soft_pipeline(rng):
    """A hose, bent at random."""
    steps, length = 64, rng.uniform(1.2, 3.2)
    bend = np.cumsum(rng.normal(0, 0.05, steps)) + np.linspace(0, rng.uniform(-8, 8), steps)
    path = np.cumsum(np.c_[np.cos(bend), np.sin(bend), rng.normal(0, 0.1, steps)], 0) * length / steps
    wall = {"thickness_mm": round(rng.uniform(2, 6), 2), "material": str(rng.choice(["neoprene", "pvc", "natural_rubber"]))}
    hose = tube(path - path.mean(0), rng.uniform(0.015, 0.05), 12)
    return hose.moved(turn=any_turn(rng)), rough(rng, softer=6) | {"shell": wall}


def mooring(rng):
    """A rope or a chain, which holds an object from above and moors it below."""
    above, below = rng.uniform(0, 0.4), rng.uniform(0.1, 0.8)
    z = np.linspace(-below, above, 24)
    sway = np.cumsum(rng.normal(0, 0.006, (24, 2)), 0)
    path = np.c_[sway - sway[np.abs(z).argmin()], z]
    parts = [tube(path, rng.uniform(0.006, 0.02), 6)]
    if rng.random() < 0.6:  # links, knots or weights
        size = rng.uniform(0.012, 0.035)
        for height in np.arange(-below, above, rng.uniform(0.05, 0.25)):
            bead = icosphere(1)
            at = [np.interp(height, z, path[:, 0]), np.interp(height, z, path[:, 1]), height]
            bead.positions = bead.positions * size * rng.uniform(0.6, 1.4) + at
            parts.append(bead)
    return merged(parts)


def rough(rng, softer=0):
    """A surface from clean and smooth to fouled: a lobe about the normal, and diffuse scattering."""
    return {"roughness_slope": round(rng.uniform(0.2, 1), 3), "lambert_db": round(rng.uniform(-16, 2) - softer, 2)}


def metal(rng):
    return rough(rng) | {"material": str(rng.choice(["bronze", "steel", "aluminium", "pvc"]))}


CLASSES = {each.__name__: each for each in (big_propeller, small_propeller, cylinder, fishing_net, soft_pipeline)}
MOORED = {"big_propeller": 0.9, "small_propeller": 0.9, "cylinder": 0.9, "soft_pipeline": 0.3}  # probability

DEPLOYMENT = """\
# A part of the fan of an Oculus M750d, at either of its frequencies: scripts/research/sim_to_real draws range, noise and objects.
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
      bin_count: 700
      beam_count: 144
      field_of_view_deg: 40
      beam_height_deg: 20
      frequency_khz: 750
      quality: {rows: 96, columns_per_beam: 2}
      max_walls: 4
      pulse: {bandwidth_khz: 150, window: hann}
      beam_pattern: {receive: {azimuth: {weighting: taylor, sidelobe_db: -25, aperture_m: 0.12}}}  # 1.0 degrees at 750 kHz, 0.6 at 1200
      speckle: {coherent: true}
      water: {temperature_celsius: 12}
      absorption: {law: francois_garrison}
  noise:
    type: noise::NoiseTask
    properties: {ambient: {level_db: -90}, filter: {looks: 2, correlation_beams: 2}}
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
# Objects at %(nearest)g to %(farthest)g m. The sonar is level, and the line on which they hang is tilted, as a sonar that looks up or down
# sees it. The noise is drawn from a wide range: gains and seas differ.
seed: %(seed)d
scenes: [%(scene)s]
poses: {random: {count: %(count)d, z: 0}}
settings:
  sonar.frequency_khz: [%(frequency)g]
  sonar.beam_height_deg: [%(opening)g]
  sonar.range: [%(range)g]
  noise.ambient.level_db: {uniform: [%(quiet)g, %(loud)g]}
objects:
  - {names: [%(names)s], count: [1, 1], x: [%(nearest)g, %(farthest)g], y: [-%(side)g, %(side)g], z: [-0.1, 0.1], frame: vehicle, gap: 0,
     roll_deg: [-15, 15], pitch_deg: [-50, 50]}
classes: {%(classes)s}
picture: {shape: fan, height: %(height)d, dynamic_range_db: 100, reference_db: -10}
annotations: {min_level: 70, min_pixels: 15}
"""

SET = """\
# The sets of scripts/research/sim_to_real, and the effects that --ablate omits: by name, values that replace the deployment's.
deployment: deployment.yml
sweeps: ["near_*.yml", "far_*.yml"]
ablated: ["near_[0-4].yml", "far_[0-4].yml"] # of these, to compare with and without an effect; absent: all
decibels: 100               # of white over black: crops are converted to amplitudes; absent: grey levels as they are
range_down: true            # far ranges are at the bottom of real pictures and at the top of simulated pictures
margin: [0.0, 0.25]         # of a box, random, on each side
sizes: true                 # pictures have the scale of real pictures: the size of a crop in pixels is an input
turn_deg: [-35, 35]         # pictures are turned about the object, which is then as far off the sonar's axis
white_share: [0, 4]         # displays are set so that this random share of a window is white [%]
visible_db: 8               # a window is the box of the object's pixels that exceed the median level by this
effects:
  speckle: {sonar.speckle.coherent: false}
  beams_and_pulse: {sonar.beam_pattern: null, sonar.pulse: null, sonar.speckle.coherent: false}
  thin_walls: {sonar.max_walls: 0}
  receiver_filter: {noise.filter: null}
  moorings: {scene.materials: {mooring: {lambert_db: -100}}}
  physics: {sonar.model: cerqueira2017, sonar.beam_pattern: null, sonar.pulse: null, sonar.speckle: null}
"""

DEVICE_SWEEP = """\
# Objects at %(nearest)g to %(farthest)g m ahead, seen by a device as `insonify init` makes it; the line on which they hang is tilted.
seed: %(seed)d
scenes: [%(scene)s]
poses: {random: {count: %(count)d, z: -8}}  # 8 m deep
settings:
  sonar.range: [%(range)g]
  scene.mount: [{position: [0, 0, 0], pitch_deg: 0}]
%(settings)sobjects:
  - {names: [%(names)s], count: [1, %(most)d], x: [%(nearest)g, %(farthest)g], y: [-%(side)g, %(side)g], z: [-8.1, -7.9], frame: vehicle, gap: 0,
     roll_deg: [-15, 15], pitch_deg: [-50, 50]}
classes: {%(classes)s}
picture: {shape: fan, height: %(height)d, scale: code, code_bits: %(bits)d, smooth: %(smooth)s}
annotations: {min_level: 8, min_pixels: 5}
"""

DEVICE_SET = """\
# The set of a device as `insonify init` makes it, and what --ablate switches off: each effect that the deployment has.
deployment: %(deployment)s
sweeps: ["near_*.yml", "far_*.yml"]
ablated: ["near_[0-2].yml", "far_[0-3].yml"]
range_down: true            # far ranges are at the bottom of real pictures and at the top of simulated pictures
margin: [0.0, 0.25]         # of a box, random, on each side
sizes: true                 # pictures have the scale of real pictures: the size of a crop in pixels is an input
visible_db: 4               # of codes; those of an Oculus are roots of amplitudes, so this is 8 dB
effects:
%(effects)s
"""

EFFECTS = {  # of a device: its name, and the properties without which it is absent
    "errors_of_elements": ["sonar.imperfections"], "beam_pattern": ["sonar.beam_pattern", "sonar.imperfections"], "pulse": ["sonar.pulse"],
    "absorption": ["sonar.absorption"], "scatterers": ["sonar.speckle"], "speckle": ["noise.speckle"], "shared_noise": ["noise.filter"],
    "sea": ["noise.ambient"], "tvg": ["receiver.tvg"]}

RANGES = {"near": (3, 6), "far": (6, 12)}  # of a sweep, drawn [m]
FREQUENCIES = {750: 20, 1200: 12}  # [kHz], with the vertical opening [deg]


def scene(rng, file, count):
    glb = Glb()
    line = glb.material("mooring", {"lambert_db": round(rng.uniform(-10, 3), 2)}, (0.5, 0.5, 0.4))
    buoyant = glb.material("float", {"lambert_db": round(rng.uniform(-6, 3), 2)}, (0.9, 0.5, 0.2))
    for i, (name, make) in enumerate(CLASSES.items()):
        for j in range(count):
            body, acoustics, *floats = make(rng)
            material = glb.material(f"{name}_{j}", acoustics, (0.6, 0.7, 0.8))
            mesh = glb.mesh(f"{name}_{j}", [body], material)
            if rng.random() < MOORED.get(name, 0):
                glb.gltf["meshes"][mesh]["primitives"].append(glb.primitive(mooring(rng), line))
            for each in floats:
                glb.gltf["meshes"][mesh]["primitives"].append(glb.primitive(each, buoyant))
            glb.node(f"{name}_{j}", mesh, (6.0 * j, 6.0 * i, -50))
    glb.write(file)


def sweep(rng, options, i, band):
    farthest, frequency = rng.uniform(*RANGES[band]), int(rng.choice(list(FREQUENCIES)))
    quiet = {"near": -92, "far": -104}[band]
    return SWEEP % {"nearest": max(1.5, 0.35 * farthest), "farthest": 0.9 * farthest, "side": 0.02 * farthest, "range": farthest,
                    "frequency": frequency, "opening": FREQUENCIES[frequency], "quiet": quiet, "loud": quiet + 26,
                    "height": int(rng.integers(700, 1200)), "seed": int(rng.integers(1 << 30)), "count": options.samples,
                    "scene": f"objects_{i}.glb", "names": ", ".join(f"{name}_*" for name in CLASSES),
                    "classes": ", ".join(f"{name}: {name}_*" for name in CLASSES)}


def value_in(tasks, name):
    """Returns a property of tasks by its dotted name; 0 where it is absent, as a gain."""
    value = tasks
    for key in name.split("."):
        value = value.get(key, 0)
    return value


def read_device(deployment, folder):
    """Returns set.yml of a deployment that `insonify init` has written, and of it and the sweep next to it what sweeps need."""
    import yaml
    try:
        tasks = {name: task.get("properties") or {} for name, task in yaml.safe_load(deployment.read_text())["tasks"].items()}
        drawn = yaml.safe_load((deployment.parent / "sweep.yml").read_text())
        device = {"bits": tasks["receiver"]["code"]["bits"], "bins": tasks["sonar"]["bin_count"],
                  "smooth": json.dumps(drawn["picture"].get("smooth", False)),
                  "settings": "".join(f"  {name}: {json.dumps(law)}\n" for name, law in drawn["settings"].items())}
    except (OSError, yaml.YAMLError, KeyError, TypeError, AttributeError) as error:
        raise SystemExit(f"make_hanging_objects: --device {deployment}: is no deployment of a fan with codes by `insonify init`, next to its sweep.yml "
                         f"({error!r})") from None
    has = lambda name: name.split(".")[1] in tasks.get(name.split(".")[0], {})  # noqa: E731
    effects = {name: {each: None for each in properties if has(each)} for name, properties in EFFECTS.items() if has(properties[0])}
    if "gamma" in tasks["receiver"]["code"]:
        effects["gamma"] = {"receiver.code.gamma": 1}
    effects["operator"] = {name: value_in(tasks, name) for name in drawn["settings"]}
    lines = "\n".join(f"  {name}: {json.dumps(values)}" for name, values in effects.items())
    return DEVICE_SET % {"deployment": os.path.relpath(deployment, folder), "effects": lines}, device


def device_sweep(rng, options, i, band, device):
    bins, bin_metre = device["bins"], 1500e-6  # or a little less: a bin is of whole microseconds
    farthest = 0.99 * bins * bin_metre * max(1, round(rng.uniform(*RANGES[band]) / bins / bin_metre))
    most, count = {"near": (2, options.samples), "far": (5, max(1, options.samples * 2 // 5))}[band]  # objects in a picture; pictures
    return DEVICE_SWEEP % ({"nearest": max(1.2, 0.3 * farthest), "farthest": 0.8 * farthest, "side": 0.6 * farthest, "range": farthest,
                           "most": most, "height": int(rng.integers(700, 1200)), "seed": int(rng.integers(1 << 30)), "count": count,
                           "scene": f"objects_{i}.glb", "names": ", ".join(f"{name}_*" for name in CLASSES),
                           "classes": ", ".join(f"{name}: {name}_*" for name in CLASSES)} | device)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--scenes", type=int, default=60, help="each with some objects of each class (60)")
    parser.add_argument("--objects", type=int, default=5, help="of each class in a scene (5)")
    parser.add_argument("--samples", type=int, default=40, help="of each sweep, of which there are two for each scene (40)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--device", type=Path, metavar="FILE", help="a deployment of `insonify init`, used as it is; absent: one of this script")
    options = parser.parse_args()
    if min(options.scenes, options.objects, options.samples) < 1:
        parser.error("--scenes, --objects and --samples are at least 1")
    options.folder.mkdir(parents=True, exist_ok=True)
    written, device = read_device(options.device, options.folder) if options.device else (SET, None)
    rng = np.random.default_rng(options.seed)
    for i in range(options.scenes):
        scene(rng, options.folder / f"objects_{i}.glb", options.objects)
        for band in RANGES:
            made = device_sweep(rng, options, i, band, device) if options.device else sweep(rng, options, i, band)
            (options.folder / f"{band}_{i}.yml").write_text(made)
    if not options.device:
        (options.folder / "deployment.yml").write_text(DEPLOYMENT)
    (options.folder / "set.yml").write_text(written)


if __name__ == "__main__":
    main()
