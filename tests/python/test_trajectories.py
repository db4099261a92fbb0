"""Trajectories of other clocks and units, long ones, and those of sweeps."""

import json
import subprocess

import insonify
import numpy as np
import pytest
from conftest import INSONIFY

WEEK = 7 * 86_400
QUATERNION = ",1,0,0,0"


def deployment(folder, period, **vehicles):
    """Trajectories of lone vehicles, whose poses are logged; returns the path."""
    tasks = {"log": {"type": "logger::LoggerTask", "properties": {"file": "o.0.log"}}}
    links = []
    for name, properties in vehicles.items():
        tasks[name] = {"type": "pose::TrajectoryTask", "activity": {"period": period}, "properties": properties}
        links.append({"from": f"{name}.pose", "to": f"log.{name}", "policy": {"type": "buffer", "size": 64}})
    (folder / "d.yml").write_text(json.dumps({"schedule": "lockstep", "tasks": tasks, "connections": links}))
    return folder / "d.yml"


def run(folder, *arguments):
    command = [INSONIFY, "run", folder / "d.yml", "--out", folder / "out", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=100)


def poses(folder, name):
    return [(pose.time, *pose.position) for pose in insonify.read_log(folder / "out/o.0.log")[f"{name}.pose"]]


def path_of(times, shift=0.0):
    return [{"time": t, "position": [i + shift, -i, 0.5 * i]} for i, t in enumerate(times)]


@pytest.mark.parametrize(
    "properties, days",
    [
        ({"waypoints": path_of([0, WEEK + 1])}, 7),
        ({"waypoints": path_of([0, 30 * 86_400.0])}, 30),
        ({"waypoints": path_of([0, 1000 * (WEEK + 1)]), "time_unit": "ms"}, 7),
        ({"waypoints": path_of([-86_400, 8 * 86_400]), "start_s": -86_400}, 9),
        ({"waypoints": path_of([1.7e9, 1.7e9 + 8 * 86_400]), "start": "first_pose"}, 8),
    ],
)
def test_a_run_of_more_than_seven_days_needs_a_limit(tmp_path, properties, days):
    deployment(tmp_path, 86_400, short={"waypoints": path_of([0, 5])}, vehicle=properties)
    refused = run(tmp_path)
    assert refused.returncode == 2 and not (tmp_path / "out/o.0.log").exists()
    assert "tasks.vehicle: its trajectory ends" in refused.stderr and f"({days}" in refused.stderr and "more than 7 days" in refused.stderr
    assert run(tmp_path, "--duration", "100", "--quiet").returncode == 0
    assert len(poses(tmp_path, "vehicle")) == 1


@pytest.mark.parametrize(
    "properties",
    [
        {"waypoints": path_of([0, WEEK])},
        {"waypoints": path_of([0, 1e3 * WEEK]), "time_unit": "ms"},
        {"waypoints": path_of([0, 1e6 * WEEK]), "time_unit": "us"},
        {"waypoints": path_of([1.7e18, 1.7e18 + 1e9 * WEEK]), "start": "first_pose"},
        {"waypoints": path_of([-86_400, WEEK])},
        {"waypoints": path_of([-WEEK, 0]), "start_s": -WEEK},
    ],
)
def test_a_run_of_seven_days_ends_with_its_trajectory(tmp_path, properties):
    deployment(tmp_path, 86_400, vehicle=properties)
    assert run(tmp_path, "--quiet").returncode == 0
    recorded = poses(tmp_path, "vehicle")
    assert len(recorded) == 8 and recorded[-1][1:] == pytest.approx([1, -1, 0.5], abs=1e-9)


def test_pings_do_not_limit_a_run_that_makes_none(tmp_path):
    deployment(tmp_path, 0.1, vehicle={"waypoints": path_of([0, 5])})
    refused = run(tmp_path, "--pings", "2")
    assert refused.returncode == 2 and "--pings: is 2, and no task of the deployment makes pings; give --duration S" in refused.stderr
    assert run(tmp_path, "--duration", "1", "--quiet").returncode == 0


def test_a_loop_has_no_end_and_says_so(tmp_path):
    deployment(tmp_path, 0.5, vehicle={"waypoints": path_of([10, 11]), "loop": True})
    looped = run(tmp_path, "--duration", "13")
    assert looped.returncode == 0, looped.stderr
    first = poses(tmp_path, "vehicle")[0][1]
    assert first == 0 and "begins 10 s after the start of the run" in looped.stderr + looped.stdout


@pytest.mark.parametrize("seed", range(6))
def test_clocks_and_units_are_the_same_path(tmp_path, seed):
    """Two vehicles of one clock keep their distance in time, in every unit and with each way to start."""
    random = np.random.default_rng(seed)
    stamps = np.cumsum(random.uniform(0.2, 2, 6)).round(3)
    later = (stamps + random.uniform(0.1, 1)).round(3)
    zero = float(random.integers(1_500_000_000, 1_800_000_000))
    waypoints = lambda times, scale, epoch: path_of([float(t) for t in (times + epoch) * scale])
    start = float(stamps[0])
    of_run = {"first": {"waypoints": waypoints(stamps - start, 1, 0)}, "second": {"waypoints": waypoints(later - start, 1, 0)}}
    cases = [of_run]
    for scale, unit in ((1, "s"), (1e3, "ms"), (1e6, "us")):
        clock = {"start_s": zero + start} | ({"time_unit": unit} if seed % 2 else {})
        cases.append({name: {"waypoints": waypoints(t, scale, zero), **clock} for name, t in (("first", stamps), ("second", later))})
    cases.append({"first": {"waypoints": waypoints(stamps, 1e3, zero), "start": "first_pose"}, "second": of_run["second"]})
    expected = None
    for i, vehicles in enumerate(cases):
        (tmp_path / str(i)).mkdir()
        deployment(tmp_path / str(i), 0.1, **vehicles)
        done = run(tmp_path / str(i), "--duration", "6", "--quiet")
        assert done.returncode == 0, done.stderr
        recorded = {name: np.array(poses(tmp_path / str(i), name)) for name in vehicles}
        expected = expected or recorded
        for name, values in recorded.items():
            np.testing.assert_allclose(values, expected[name], rtol=0, atol=2e-4)
            assert np.ptp(values[:, 1]) > 0.5


def test_a_sweep_takes_the_keys_of_a_trajectorys_clock(tmp_path, deploy):
    """Samples of a file since 1970 are those of the same file from 0."""
    stamps, records = [0, 1, 2, 3], []
    for epoch, scale, keys in (
        (0, 1, ""),
        (1.6e9, 1e3, ", start: first_pose"),
        (1.6e9, 1, ", start_s: 1.6e9"),
        (0, 1e6, ", time_unit: us"),
    ):
        folder = tmp_path / str(len(records))
        folder.mkdir()
        rows = [f"{(t + epoch) * scale:.0f},{3 + t},-4,-5{QUATERNION}" for t in stamps]
        (folder / "p.csv").write_text("\n".join(["time,x,y,z,qw,qx,qy,qz", *rows]))
        (folder / "s.yml").write_text(f"poses:\n  trajectory: {{file: p.csv, count: 3{keys}}}\npicture: {{shape: fan, height: 64}}\n")
        command = [INSONIFY, "dataset", deploy / "truth.yml", "--sweep", folder / "s.yml", "--out", folder / "out", "--format", "npz"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        made = [json.loads(path.read_text()) for path in sorted((folder / "out").glob("0*.json"))]
        records.append([(record["time_s"], record["pose"]["position"]) for record in made])
    assert len(records[0]) == 3
    for other in records[1:]:
        for (time, position), (expected_time, expected_position) in zip(other, records[0]):
            assert time == pytest.approx(expected_time, abs=1e-6) and position == pytest.approx(expected_position, abs=1e-6)
