"""Fleets in one process: vehicles with a forward-looking sonar each in one scene, with and without receiving each other's pings."""
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
