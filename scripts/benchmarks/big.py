"""A floor of 10,000,000 triangles: its load, its memory and its pings."""
import json
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

from benchmarks.common import INSONIFY, deployment_file, fail
from benchmarks.fans import SONARS, deployment, scene, seen

CELLS = {"20 k": 100, "10 M": 2236}  # of a side of the floor; the small one is subtracted
PINGS = 60


def resident_mb(pid):
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20


def run(file, pings):
    """Summary of a run, its time from start to end and of processors [s], and its memory while it pings and at most [MB]."""
    with tempfile.TemporaryDirectory() as folder:
        summary = Path(folder, "summary.json")
        process = subprocess.Popen([INSONIFY, "run", file, "--out", Path(folder, "out"), "--pings", str(pings), "--quiet",
                                    "--summary", summary])
        sizes, start = [], time.monotonic()
        while os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
            try:
                sizes.append(resident_mb(process.pid))
            except OSError:
                break  # it is ending
            time.sleep(0.02)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            fail("insonify run", process.returncode)
        wall_s = time.monotonic() - start
        settled = sizes[sizes.index(max(sizes)):]  # most of them while it pings
        return {"summary": json.loads(summary.read_text()), "wall_s": wall_s, "processor_s": usage.ru_utime + usage.ru_stime,
                "steady_mb": statistics.median(settled), "peak_mb": usage.ru_maxrss / 1024}


def measure_big(_options):
    found = {}
    for name, cells in CELLS.items():
        with deployment_file(deployment(seen(SONARS["FLS 256 x 500"], "cpu"), scene(["--cells", str(cells)]))) as file:
            first, pings = run(file, 1), run(file, PINGS)
        found[name] = {"triangles": 2 * cells * cells, "read_s": first["wall_s"] - first["summary"]["wall_s"],
                       "first_ping_s": first["summary"]["tasks"]["sonar"]["max_ms"] / 1e3, "processor_s": first["processor_s"],
                       "ping_ms": pings["summary"]["tasks"]["sonar"]["median_ms"], "steady_mb": pings["steady_mb"],
                       "peak_mb": pings["peak_mb"]}
    small, big = found.values()
    for memory in ("steady", "peak"):
        big[memory + "_bytes_a_triangle"] = 2**20 * (big[memory + "_mb"] - small[memory + "_mb"]) / (big["triangles"] - small["triangles"])
    return found


def show_big(found):
    for name, row in found.items():
        print(f"{name} triangles: read in {row['read_s']:.1f} s, first ping after {row['first_ping_s']:.1f} s more, by "
              f"{row['processor_s']:.1f} s of processor time; a ping "
              f"{row['ping_ms']:.1f} ms; {row['steady_mb']:.0f} MB, at most {row['peak_mb']:.0f} MB")
    row = found["10 M"]
    print(f"a triangle: {row['steady_bytes_a_triangle']:.0f} bytes, at most {row['peak_bytes_a_triangle']:.0f}")
