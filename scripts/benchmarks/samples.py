"""Samples of a data set, compared with pings of a run, by processor time."""
import os
import statistics
import subprocess
import tempfile
from pathlib import Path

from benchmarks.common import BENCH, INSONIFY, ROOT, fail

ROUNDS = 3
FEW, MANY = 10, 70  # samples; the difference of both excludes the start

SWEEP = """seed: 3
scenes: [{scene}]
poses: {{random: {{count: {count}, x: {{uniform: [0, 20]}}, y: {{uniform: [-8, 0]}}, z: -5.5, yaw_deg: {{uniform: [-60, 30]}}}}}}
objects: [{{names: [rock_00*], count: [2, 8], x: [4, 20], y: [-8, 4], frame: vehicle, ground: sea_floor, avoid: [quay_wall, hull, pile_*]}}]
classes: {{pile: pile_*, wreck: hull, rock: rock_*}}
settings: {{{drawn}}}
"""
DRAWN = "scene.materials.sand.lambert_db: {uniform: [-30, -15]}"
FAN = ["sonar.range=10", "sonar.beam_count=128", "sonar.bin_count=506", "sonar.field_of_view_deg=30", "sonar.beam_height_deg=14",
       "sonar.quality={rows: 256, columns_per_beam: 4}", "sonar.frequency_khz=1800", "sonar.pulse={bandwidth_khz: 60}",
       "sonar.beam_pattern={receive: {azimuth: {weighting: taylor, width_deg: 0.3}}}"]
COHERENT = "sonar.speckle={coherent: true}"
ERRORS = "sonar.imperfections={gain_error_db: 1, phase_error_deg: 10}"
SEEDS = f"sonar.imperfections.seed: {{choice: {list(range(1, 200))}}}"
CASES = {"energies": ([], ""), "coherent speckle": ([COHERENT], ""),
         "energies, a drawn material": ([], DRAWN), "energies, drawn errors of elements": ([ERRORS], SEEDS),
         "coherent speckle, errors of elements": ([COHERENT, ERRORS], ""),
         "coherent speckle, drawn errors of elements": ([COHERENT, ERRORS], SEEDS)}


def processor_seconds(command):
    process = subprocess.Popen([INSONIFY, *command, "--quiet"])
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        fail("insonify " + command[0], process.returncode)
    return usage.ru_utime + usage.ru_stime


def each(settings, drawn):
    """Processor time of a sample, and of a ping of a run with the same sonar [ms]."""
    assignments = [word for each in FAN + settings for word in ("--set", each)]
    with tempfile.TemporaryDirectory(dir=BENCH) as folder:
        sweep = Path(folder, "sweep.yml")

        def samples(count):
            sweep.write_text(SWEEP.format(scene=ROOT / "deploy/scenes/harbour.glb", count=count, drawn=drawn))
            with tempfile.TemporaryDirectory(dir=folder) as out:
                return processor_seconds(["dataset", ROOT / "deploy/truth.yml", "--sweep", sweep, "--out", out, *assignments])

        def pings(count):
            with tempfile.TemporaryDirectory(dir=folder) as out:
                return processor_seconds(["run", ROOT / "deploy/truth.yml", "--out", out, "--pings", str(count), *assignments])

        return [1e3 * (take(MANY) - take(FEW)) / (MANY - FEW) for take in (samples, pings)]


def measure_samples(_):
    return {name: [statistics.median(column) for column in zip(*(each(*case) for _ in range(ROUNDS)))]
            for name, case in CASES.items()}


def show_samples(found):
    print(f"COCO samples of the harbour, 128 x 506, 256 x 4 rays, processor time, medians of {ROUNDS}:")
    for name, (sample, ping) in found.items():
        print(f"  {name}: {sample:.0f} ms a sample, {1e3 / sample:.1f} a second and core; {ping:.0f} ms a ping with its picture and log")
