"""Fleets in one process: vehicles with a forward-looking sonar each in one scene, with and without receiving each other's pings;
and hundreds of vehicles in one process of Python."""
import json
import os
import subprocess
import tempfile
from pathlib import Path

import yaml

from benchmarks.common import INSONIFY, ROOT, fail

SIZES = [1, 2, 5, 10]
PERIOD = 0.5       # time between the pings of a sonar [s]
BUFFER = {"type": "circular_buffer", "size": 64}
HUNDREDS = [1, 10, 100, 300]
SONAR = {"range": 30, "beam_count": 256, "bin_count": 500, "field_of_view_deg": 120, "beam_height_deg": 20,
         "frequency_khz": 720, "quality": {"rows": 64, "columns_per_beam": 2}, "visibility": "cpu",
         "beam_pattern": {"transmit": {"elevation": {"width_deg": 20}},
                          "receive": {"azimuth": {"weighting": "taylor", "width_deg": 0.8, "sidelobe_db": -25}}}}


def fleet(count, crosstalk, schedule):
    """A deployment of `count` vehicles in the harbour, 3 m apart, whose pings are spread over the period."""
    tasks, connections = {}, []
    for i in range(count):
        start = [-10.0, 3.0 * i - 1.5 * count, -6.0]
        sonar = SONAR | ({"crosstalk": {}} if crosstalk else {})
        tasks |= {
            f"auv{i}": {"type": "pose::TrajectoryTask", "activity": {"period": PERIOD + i * 1e-3},
                        "properties": {"waypoints": [{"time": 0, "position": start}, {"time": 600, "position":
                                                                                     [start[0] + 30, *start[1:]]}]}},
            f"scene{i}": {"type": "scene::SceneTask",
                          "properties": {"file": str(ROOT / "deploy" / "scenes" / "harbour.glb")}},
            f"sonar{i}": {"type": "sonar::SonarTask", "properties": sonar},
            f"noise{i}": {"type": "noise::NoiseTask",
                          "properties": {"seed": i, "speckle": {"law": "rayleigh"}, "ambient": {"level_db": -138}}}}
        connections += [{"from": f"auv{i}.pose", "to": f"scene{i}.pose"},
                        {"from": f"scene{i}.snapshot", "to": f"sonar{i}.snapshot"},
                        {"from": f"sonar{i}.ping", "to": f"noise{i}.clean"}]
        connections += [{"from": f"sonar{j}.transmission", "to": f"sonar{i}.others", "policy": BUFFER}
                        for j in range(count) if crosstalk and j != i]
    return yaml.safe_dump({"schedule": schedule, "tasks": tasks, "connections": connections})


def run(count, crosstalk, schedule, limits):
    """The summary of a run, its processor time [s] and its peak memory [MB]."""
    with tempfile.TemporaryDirectory() as folder:
        file, summary = Path(folder, "fleet.yml"), Path(folder, "summary.json")
        file.write_text(fleet(count, crosstalk, schedule))
        process = subprocess.Popen([INSONIFY, "run", file, "--out", Path(folder, "out"), "--quiet", "--summary", summary,
                                    *limits])
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            fail("insonify run", process.returncode)
        return json.loads(summary.read_text()), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def measure_fleet(options):
    results = {}
    for crosstalk in [False, True]:
        for count in SIZES[1:] if crosstalk else SIZES:
            _, few, _ = run(count, crosstalk, "lockstep", ["--pings", "10"])
            summary, many, memory = run(count, crosstalk, "lockstep", ["--pings", str(10 + options.pings)])
            live, _, _ = run(count, crosstalk, "realtime", ["--duration", str(options.realtime_seconds)])
            noises = [live["tasks"][f"noise{i}"] for i in range(count)]  # a sonar also has cycles that only receive
            results[f"{count}{', hearing each other' if crosstalk else ''}"] = {
                "ms_per_ping": 1e3 * (many - few) / (options.pings * count), "mb": memory,
                "realtime_pings": sum(noise["cycles"] for noise in noises), "sent": count * options.realtime_seconds / PERIOD}
    return results


def show_fleet(results):
    print(f"{'vehicles':28}{'processor ms a ping':>20}{'MB':>8}{'realtime pings':>16}{'of':>6}")
    for name, fleet_of in results.items():
        print(f"{name:28}{fleet_of['ms_per_ping']:20.1f}{fleet_of['mb']:8.0f}{fleet_of['realtime_pings']:16.0f}"
              f"{fleet_of['sent']:6.0f}")


# One process of Python with `count` vehicles: made, then stepped in turn, or all as a batch.
VEHICLES = """
import os, sys, time, numpy as np, insonify
file, count, steps, how = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
poses = np.tile([-10, 0, -6, 1, 0, 0, 0], (count, 1)).astype(float)
poses[:, 1] += np.linspace(-8, 2, count)
given = [insonify.Pose(each[:3], each[3:]) for each in poses]
start = time.process_time()
if how == "batch":
    batch = insonify.SimulationBatch(file, count, seed=1)
    step = lambda: batch.step(poses)
else:
    vehicles = [insonify.Simulation(file, 1 + i) for i in range(count)]
    step = lambda: [vehicle.step(pose) for vehicle, pose in zip(vehicles, given)]
step()
made = time.process_time() - start
start = time.process_time()
for _ in range(steps): step()
took = time.process_time() - start
status = dict(line.split(":", 1) for line in open("/proc/self/status"))
print(1e3 * made / count, 1e3 * took / steps / count, int(status["VmRSS"].split()[0]) / 1024, int(status["Threads"]),
      len(os.listdir("/proc/self/fd")))
"""


def measure_vehicles(options):
    environment = os.environ | {"PYTHONPATH": str(ROOT / "build/python")}
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "vehicle.yml")
        file.write_text(fleet(1, False, "lockstep"))
        for how in ("apart", "batch"):
            for count in HUNDREDS:
                steps = max(2, options.pings // count)
                done = subprocess.run(["/usr/bin/python3", "-c", VEHICLES, file, str(count), str(steps), how],
                                      stdout=subprocess.PIPE, text=True, env=environment)
                if done.returncode != 0:
                    fail("vehicles in one process of Python", done.returncode)
                found[f"{count}, {how}"] = [float(number) for number in done.stdout.split()]
    return found


def show_vehicles(found):
    print(f"{'vehicles':16}{'ms to make, with a ping':>24}{'processor ms a step':>20}{'MB':>8}{'threads':>9}{'files':>7}")
    for name, (made, step, memory, threads, files) in found.items():
        print(f"{name:16}{made:24.1f}{step:20.2f}{memory:8.0f}{threads:9.0f}{files:7.0f}")
