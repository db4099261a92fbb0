"""Runs Insonify: python insonify_peer.py FOLDER [--short]. It writes FOLDER/about.json and the arrays of case.EXPERIMENTS."""
import argparse
import json
import os
import platform
import re
import sys
import time
from pathlib import Path

import case
import insonify
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts/scenes"))
from glb import Glb, Mesh, icosphere  # noqa: E402

BIN = case.RESOLUTION / 5                 # 5 mm; bins of the ranges that are shown
MAX_RANGE = 20.0

DEPLOYMENT = """
tasks:
  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {waypoints: [{time: 0, position: [0, 0, 0]}]}}
  scene: {type: scene::SceneTask, properties: %s}
  sonar: {type: sonar::SonarTask, properties: %s}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
"""
# Bins of whole microseconds, as case.SOUND_SPEED has them, so that pings state the ranges that they have.
SONAR = {"range": MAX_RANGE, "range_rounding": "exact", "speed_of_sound": case.SOUND_SPEED, "frequency_khz": case.FREQUENCY / 1e3}
ARRAY = {"beam_geometry": "conical", "pulse": {"bandwidth_khz": case.BANDWIDTH / 1e3, "window": "none"},
         "beam_pattern": {"receive": {"azimuth": {"weighting": "uniform", "aperture_m": case.APERTURE}}}}


class Insonify:
    """Pings of deployments that are written to a folder."""

    def __init__(self, folder):
        self.folder = folder

    def simulation(self, scene, **sonar):
        file = self.folder / "deployment.yml"
        file.write_text(DEPLOYMENT % (json.dumps(scene), json.dumps({**SONAR, **sonar})))
        return insonify.Simulation(file)

    def energies(self, scene, **sonar):
        return self.simulation(scene, **sonar).step(insonify.Pose([0, 0, 0])).bins.astype(float)

    def plane(self, depth):
        """A floor of 200 x 200 m in two triangles, which scatters by Lambert's law."""
        corners = np.array([[-100, -100, -depth], [100, -100, -depth], [100, 100, -depth], [-100, 100, -depth]])
        return self.file("floor", Mesh(corners, [[0, 1, 2], [0, 2, 3]]), {"lambert_db": -20})

    def sphere(self):
        shape = icosphere(5)
        centre = case.SPHERE_RANGE + case.SPHERE_RADIUS
        return self.file("sphere", Mesh(shape.positions * case.SPHERE_RADIUS + (centre, 0, 0), shape.faces),
                         {"lambert_db": -100, "reflection": 1, "roughness_slope": 0.1})

    def file(self, name, mesh, acoustics):
        glb = Glb()
        glb.node(name, glb.mesh(name, [mesh], glb.material(f"{name}_material", acoustics, (0.5, 0.5, 0.5))), (0, 0, 0))
        glb.write(self.folder / f"{name}.glb")
        return f"{name}.glb"


def middles(count, reach=MAX_RANGE):
    return (np.arange(count) + 0.5) * reach / count


def target(x, y=0.0):
    return {"file": "floor.glb", "targets": [{"name": "target", "position": [float(x), float(y), 0], "strength_db": 0}]}


def points(peer):
    count = round(MAX_RANGE / BIN)
    found = [peer.energies(target(truth), bin_count=count, beam_count=1, field_of_view_deg=10, beam_height_deg=10, **ARRAY)[0]
             for truth in case.POINTS]
    ranges = middles(count)
    shown = (ranges > 9.5) & (ranges < 11)
    return {"range_m": ranges[shown], "truth_m": case.POINTS, "intensity": np.array(found)[:, shown]}


def beam(peer):
    """The largest bin of each of 401 beams, which look past a point target ahead."""
    found = peer.energies(target(case.BEAM_RANGE), bin_count=1600, bearings_deg=np.degrees(case.BEAM_BEARINGS).tolist(),
                          beam_count=len(case.BEAM_BEARINGS), beam_width_deg=0.1, beam_height_deg=10, **ARRAY)
    return {"bearing_rad": case.BEAM_BEARINGS, "intensity": found.max(axis=1)}


def floor(peer):
    width = np.radians(2)
    found = peer.energies({"file": peer.plane(case.FLOOR_DEPTH)}, bin_count=800, beam_count=4, beam_width_deg=2, beam_height_deg=130,
                          quality={"rows": 2048, "columns_per_beam": 8})
    return {"range_m": middles(800), "intensity": found, "azimuth_rad": width, "depth_m": case.FLOOR_DEPTH}


def sphere(peer):
    sonar = {"bin_count": 800, "beam_count": 1, "field_of_view_deg": 10, "beam_height_deg": 10,
             "quality": {"rows": 512, "columns_per_beam": 512}}
    return {"intensity": peer.energies({"file": peer.sphere()}, **sonar)[0], "reference": peer.energies(target(case.SPHERE_RANGE), **sonar)[0]}


def motion(peer, short):
    """Also the speckle: pings without a shift. Places are so far apart on the floor that they have no scatterer in common."""
    reach = case.MOTION_RANGES[1] + 0.5
    bins = round(reach / case.RESOLUTION)
    ranges = middles(bins, reach)
    shown = (ranges > case.MOTION_RANGES[0]) & (ranges < case.MOTION_RANGES[1])
    simulation = peer.simulation(
        {"file": peer.plane(case.MOTION_DEPTH)}, range=reach, bin_count=bins, bearings_deg=np.degrees(case.MOTION_BEARINGS).tolist(),
        beam_count=3, beam_width_deg=1, beam_height_deg=90, speckle={"coherent": True}, quality={"rows": 256, "columns_per_beam": 4}, **ARRAY)
    found, seconds, processor = [], [], []
    for place in range(2 if short else 6 * case.MOTION_PLACES):
        x, y, rows = 11.0 * (place // 5), 20.0 * (place % 5 - 2), []
        for shift in case.MOTION_SHIFTS:
            began = time.perf_counter(), time.process_time()
            rows.append(simulation.step(insonify.Pose([x, y + shift, 0])).bins[:, shown].astype(float))
            seconds.append(time.perf_counter() - began[0])
            processor.append(time.process_time() - began[1])
        found.append(rows)
    return {"range_m": ranges[shown], "shift_m": case.MOTION_SHIFTS, "intensity": np.array(found)}, {"seconds": seconds, "processor": processor}


def about():
    version = re.search(r'^version = "(.+)"', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)[1]
    return {"name": "Insonify", "version": version, "python": platform.python_version(),
            "notes": {"times": "the whole floor, beams formed"}}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--short", action="store_true", help="few places, to see that it runs")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    peer = Insonify(options.folder.resolve())
    arrays, times = motion(peer, options.short)
    peer.plane(1000.0)                    # the plane is out of the range of point targets
    found = {"points": points(peer), "beam": beam(peer), "sphere": sphere(peer), "floor": floor(peer), "motion": arrays,
             "speckle": {"range_m": arrays["range_m"], "intensity": arrays["intensity"][:, 0]},
             "times": {**times, "cores": len(os.sched_getaffinity(0))}}
    for name, each in found.items():
        np.savez(options.folder / f"{name}.npz", **each)
    (options.folder / "about.json").write_text(json.dumps(about(), indent=1))


if __name__ == "__main__":
    main()
