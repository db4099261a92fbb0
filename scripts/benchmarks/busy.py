"""The same fan alone on the machine and next to busy processes."""
import subprocess
from contextlib import contextmanager

from benchmarks.fans import SCENES, SONARS, deployment, scene, seen
from benchmarks.table import measure, show

NEIGHBOURS = 2


@contextmanager
def neighbours(count=NEIGHBOURS):
    """Processes that keep one core busy each, on any core."""
    processes = [subprocess.Popen(["/usr/bin/python3", "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.wait()


def measure_busy(options):
    found = {}
    for visibility in options.visibility:
        text = deployment(seen(SONARS["FLS 256 x 500"], visibility), scene(SCENES["80 k"]))
        quiet = measure(text, options.pings)
        with neighbours():
            busy = measure(text, options.pings)
        found[visibility] = {"quiet": quiet, "busy": busy}
    return found


def show_busy(found):
    show({f"FLS 256 x 500, 80 k, {name}, {how}": runs[how] for name, runs in found.items() for how in ["quiet", "busy"]})
    for name, runs in found.items():
        quiet, busy = runs["quiet"], runs["busy"]
        rays = busy["embree"]["alone_median_ms"] / quiet["embree"]["alone_median_ms"]
        print(f"next to {NEIGHBOURS} busy processes, {name}: {busy['ping'] / quiet['ping']:.2f} times as long, "
              f"p99 {busy['ping_p99'] / quiet['ping_p99']:.2f}, rays {rays:.2f}")
