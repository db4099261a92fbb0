"""A floor of 10,000,000 triangles: its load, its memory and its pings."""
import json
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

from benchmarks.common import INSONIFY, deployment_file, fail, run_pings
from benchmarks.fans import SONARS, deployment, scene, seen

CELLS = {"20 k": 100, "10 M": 2236}  # of a side of the floor; the small one is subtracted
PINGS = 60


def resident_mb(pid):
    lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("Rss:")) / 1024


def run(file, pings):
    """Summary of a run, and its memory while it pings and at most [MB]."""
    with tempfile.TemporaryDirectory() as folder:
        summary = Path(folder, "summary.json")
        process = subprocess.Popen([INSONIFY, "run", file, "--out", Path(folder, "out"), "--pings", str(pings), "--quiet",
                                    "--summary", summary])
        sizes = []
        while os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
            try:
                sizes.append(resident_mb(process.pid))
            except (OSError, StopIteration):
                break  # it is ending
            time.sleep(0.02)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            fail("insonify run", process.returncode)
        settled = sizes[sizes.index(max(sizes)):]  # most of them while it pings
        return json.loads(summary.read_text()), statistics.median(settled), usage.ru_maxrss / 1024


def measure_big(_options):
    found = {}
    for name, cells in CELLS.items():
        with deployment_file(deployment(seen(SONARS["FLS 256 x 500"], "cpu"), scene(["--cells", str(cells)]))) as file:
            first, process_ms, _ = run_pings(file, 1)
            pings, steady_mb, peak_mb = run(file, PINGS)
        sonar = first["tasks"]["sonar"]
        found[name] = {"triangles": 2 * cells * cells, "read_s": process_ms / 1e3 - first["wall_s"],
                       "first_ping_s": sonar["max_ms"] / 1e3, "ping_ms": pings["tasks"]["sonar"]["median_ms"],
                       "steady_mb": steady_mb, "peak_mb": peak_mb}
    small, big = found.values()
    for memory in ("steady", "peak"):
        big[memory + "_bytes_a_triangle"] = 2**20 * (big[memory + "_mb"] - small[memory + "_mb"]) / (big["triangles"] - small["triangles"])
    return found


def show_big(found):
    for name, row in found.items():
        print(f"{name} triangles: read in {row['read_s']:.1f} s, first ping after {row['first_ping_s']:.1f} s more, a ping "
              f"{row['ping_ms']:.1f} ms; {row['steady_mb']:.0f} MB, at most {row['peak_mb']:.0f} MB")
    row = found["10 M"]
    print(f"a triangle: {row['steady_bytes_a_triangle']:.0f} bytes, at most {row['peak_bytes_a_triangle']:.0f}")
