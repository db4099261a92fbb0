"""Random sonars of every kind: Python's pings are the command's, bit for bit, and echoes are at their ranges everywhere."""

import csv
import json
import os
import subprocess

import insonify
import numpy as np
import pytest
from conftest import INSONIFY

FIRST = int(os.environ.get("INSONIFY_DRAWS_FROM", 1))
SEEDS = range(FIRST, FIRST + int(os.environ.get("INSONIFY_DRAWS", 12)))
KINDS = ["Sonar", "ScanningSonar", "Profiler", "SideScan", "Sonar3d", "Altimeter"]


def write_wall(folder, distance):
    """A wall square to x, at x = distance, in two triangles of a node of its own; y up."""
    points = np.array([[distance, y, z] for y in (-90, 90) for z in (-90, 90)], "<f4")
    indices = np.array([0, 1, 3, 0, 3, 2], "<u4")
    (folder / "s.bin").write_bytes(points.tobytes() + indices.tobytes())
    made = {
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "wall"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"uri": "s.bin", "byteLength": 48 + 24}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4, "min": points.min(0).tolist(), "max": points.max(0).tolist()},
            {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": 6},
        ],
    }  # fmt: skip
    (folder / "s.gltf").write_text(json.dumps(made))


def drawn(folder, seed, noisy):
    """Writes a deployment in front of a wall; returns its path and the wall's distance [m]."""
    random = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    reach = 10 ** random.uniform(0.3, 1.8)
    bins = int(min(10 ** random.uniform(1.7, 3.3), reach / 2e-4))
    wall = reach * random.uniform(0.3, 0.8)
    sonar = {
        "range": reach, "bin_count": bins, "range_min": 0.02 * reach, "speed_of_sound": random.uniform(1400, 1600), "visibility": "cpu",
        "frequency_khz": 400, "range_rounding": "exact" if random.random() < 0.5 or reach / bins < 0.03 else "sample",
        "quality": {"rows": 16, "columns_per_beam": 16},
    }  # fmt: skip
    mount = {}
    if kind in ("Sonar", "Profiler"):
        sonar |= {"beam_height_deg": 2}
        if random.random() < 0.5:
            sonar |= {"bearings_deg": sorted(random.uniform(-50, 50, 4).tolist() + [0.0]), "beam_width_deg": 2}
        else:
            sonar |= {"beam_count": 5, "field_of_view_deg": 20}
    if kind in ("ScanningSonar", "Altimeter"):
        sonar |= {"beam_width_deg": 2, "beam_height_deg": 2}
    if kind == "ScanningSonar":
        sonar["head"] = {"left_deg": 2, "right_deg": -2, "step_deg": 1}
    if kind == "Sonar3d":
        sonar |= {"horizontal": {"beam_count": 3, "field_of_view_deg": 6}, "vertical": {"beam_count": 3, "field_of_view_deg": 6}}
        sonar |= {"beam_height_deg": 2}
    if kind == "SideScan":
        sonar |= {"beam_width_deg": 2, "beam_height_deg": 60, "depression_deg": 30, "quality": {"rows": 8, "columns_per_beam": 256}}
        mount = {"yaw_deg": -90}  # its port side looks ahead
    tasks = {
        "vehicle": {"type": "pose::TrajectoryTask", "activity": {"period": 0.25}, "properties": {"waypoints": [{"position": [0, 0, 0]}]}},
        "scene": {"type": "scene::SceneTask", "properties": {"file": "s.gltf", "mount": mount}},
        "sonar": {"type": f"sonar::{kind}Task", "properties": sonar},
        "log": {"type": "logger::LoggerTask", "properties": {"file": random.choice(["o.0.log", "o.0.mcap"])}},
    }
    links = [("vehicle.pose", "scene.pose"), ("scene.snapshot", "sonar.snapshot")]
    last = "sonar.ping"
    if noisy:
        tasks["noise"] = {"type": "noise::NoiseTask", "properties": {"speckle": {}, "ambient": {"level_db": -110}}}
        gains = [
            {"tvg": {"log_coefficient": random.uniform(0, 40)}, "output": "level_db"},
            {"brightness": {"gain": random.uniform(0, 1)}},
            {
                "automatic_gain": {
                    "target_db": random.uniform(-60, 0),
                    "attack_ms": random.uniform(0, 5),
                    "release_ms": random.uniform(0, 20),
                    "max_db": random.uniform(0, 80),
                },
                "output": str(random.choice(["intensity", "amplitude", "level_db"])),
            },
        ]
        tasks["receiver"] = {"type": "receiver::ReceiverTask", "properties": gains[seed // 2 % 3]}
        links += [("sonar.ping", "noise.clean"), ("noise.noisy", "receiver.intensity")]
        last = "receiver.ping"
    if kind == "Altimeter":
        links.append(("sonar.range", "log.range"))
    if kind == "Profiler":
        links.append(("sonar.soundings", "log.soundings"))
    links.append((last, "log.ping"))
    policy = {"type": "buffer", "size": 64}
    write_wall(folder, wall)
    made = {
        "schedule": "lockstep",
        "seed": int(seed),
        "tasks": tasks,
        "connections": [{"from": a, "to": b, "policy": policy} for a, b in links],
    }
    (folder / "d.yml").write_text(json.dumps(made))
    return folder / "d.yml", wall, last


def logged(folder, file, stream):
    """Runs three pings; returns the log and a stream of it as npz."""
    subprocess.run([INSONIFY, "run", file, "--pings", "3", "--quiet", "--out", folder / "out"], check=True, timeout=300)
    path = next((folder / "out").glob("o.0.*[gp]"))
    log = insonify.read_log(path)
    name = next(name for name in log if name.endswith(stream) or name.endswith(stream.replace(".", "/")))
    subprocess.run([INSONIFY, "log", "export", path, "--stream", name, "--to", folder / "x.npz"], check=True, timeout=300)
    return log, log[name], np.load(folder / "x.npz")


@pytest.mark.parametrize("seed", SEEDS)
def test_steps_are_the_commands_pings(tmp_path, seed):
    file, _, stream = drawn(tmp_path, seed, noisy=True)
    log, pings, npz = logged(tmp_path, file, stream)
    simulation = insonify.Simulation(file)
    assert len(pings) == len(npz["bins"]) == 3
    for ping, bins in zip(pings, npz["bins"]):
        stepped = simulation.step(insonify.Pose([0, 0, 0]), time=ping.time)
        assert stepped.time == ping.time
        np.testing.assert_array_equal(stepped.bins, ping.bins)
        np.testing.assert_array_equal(stepped.bins, bins)
        np.testing.assert_array_equal(stepped.ranges, ping.ranges)
        np.testing.assert_allclose(stepped.bearings, ping.bearings, rtol=1e-15)  # MCAP has directions


@pytest.mark.parametrize("seed", SEEDS)
def test_a_wall_is_at_its_range_in_arrays_and_files(tmp_path, seed):
    file, wall, stream = drawn(tmp_path, seed, noisy=False)
    log, pings, npz = logged(tmp_path, file, stream)
    simulation = insonify.Simulation(file)
    for ping in [pings[1], simulation.step(insonify.Pose([0, 0, 0]))]:
        ahead = int(np.argmin(np.abs(ping.bearings)) if len(ping.bins) > 2 else np.argmax(ping.bins.sum(1)))
        first = int(np.argmax(ping.bins[ahead] > 0))
        assert ping.bins[ahead, first] > 0
        assert ping.ranges[first] == pytest.approx(wall, abs=1.01 * ping.bin_length)
        assert npz["range_m"][0][first] == pytest.approx(wall, abs=1.01 * ping.bin_length)
        np.testing.assert_allclose(npz["range_m"][0], ping.ranges, rtol=1e-6)
    for name in log:
        if name.endswith(("range", "soundings")):
            command = [INSONIFY, "log", "export", next((tmp_path / "out").glob("o.0.*[gp]")), "--stream", name, "--to", tmp_path / "x.csv"]
            subprocess.run(command, check=True, timeout=300)
            with open(tmp_path / "x.csv") as lines:
                rows = list(csv.DictReader(lines))
            values = [float(row["range" if name.endswith("range") else "x"]) for row in rows]
            assert len(values) >= 3
            np.testing.assert_allclose(values, wall, atol=3 * ping.bin_length + 0.002 * wall)
