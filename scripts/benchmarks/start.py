"""The start of the command: its time, its memory, and the libraries that it loads."""
import os
import statistics
import subprocess
import tempfile
import time

from benchmarks.common import INSONIFY, ROOT, fail

RUNS = 15


def measure(arguments):
    times, peak = [], 0
    for _ in range(RUNS):
        begin = time.monotonic()
        process = subprocess.Popen([INSONIFY, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        times.append(1e3 * (time.monotonic() - begin))
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            fail("insonify " + arguments[0], process.returncode)
        peak = max(peak, usage.ru_maxrss / 1024)
    loaded = subprocess.run([INSONIFY, *arguments], env=os.environ | {"LD_DEBUG": "libs"}, stderr=subprocess.PIPE,
                          stdout=subprocess.DEVNULL, text=True)
    return {"median_ms": statistics.median(times), "peak_mb": peak, "libraries": loaded.stderr.count("calling init: ")}


def measure_start(_options):
    with tempfile.TemporaryDirectory() as folder:
        ping = ["run", str(ROOT / "deploy/minimal.yml"), "--pings", "1", "--quiet", "--out", folder]
        return {"--version": measure(["--version"]), "run deploy/minimal.yml --pings 1": measure(ping)}


def show_start(rows):
    for name, row in rows.items():
        print(f"insonify {name:36}{row['median_ms']:8.0f} ms {row['peak_mb']:8.0f} MB {row['libraries']:5} libraries")
