"""A run in shards, by one worker and by two, each on a processor of its own."""
import os
import statistics
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from benchmarks.common import BENCH, INSONIFY, deployment_file, fail
from benchmarks.fans import SCENES, SONARS, deployment, scene, seen

SHARDS = 8
ROUNDS = 3
BEHIND = 20_000  # pings, to find what one costs that is passed over


def make(file, out, shard, pings, core):
    command = ["taskset", "--cpu-list", str(core), INSONIFY, "run", file, "--out", out, "--shard", shard, "--pings",
               str(pings), "--quiet"]
    start = time.monotonic()
    if (done := subprocess.run(command)).returncode != 0:
        fail("insonify run --shard", done.returncode)
    return time.monotonic() - start


def whole(file, pings, workers):
    """How long these workers take for all shards [s]."""
    waiting = iter(range(SHARDS))

    def work(core):
        for i in waiting:
            make(file, out, f"{i}/{SHARDS}", pings, core)

    with tempfile.TemporaryDirectory(dir=BENCH) as out, ThreadPoolExecutor(workers) as pool:
        start = time.monotonic()
        list(pool.map(work, sorted(os.sched_getaffinity(0))[:workers]))
        return time.monotonic() - start


def one(file, shard, pings):
    with tempfile.TemporaryDirectory(dir=BENCH) as out:
        return make(file, out, shard, pings, min(os.sched_getaffinity(0)))


def measure_shards(options):
    text = deployment(seen(SONARS["FLS 256 x 500"], "cpu"), scene(SCENES["80 k"]))
    pings = SHARDS * options.pings
    with deployment_file(text) as file:
        rounds = [(whole(file, pings, 1), whole(file, pings, 2)) for _ in range(ROUNDS)]  # they take turns
        starts = [one(file, "0/1", 1) for _ in range(ROUNDS)]
        last = [one(file, f"{BEHIND - 1}/{BEHIND}", BEHIND) for _ in range(ROUNDS)]
    return {"pings": pings, "one_worker_s": statistics.median(one for one, _ in rounds),
            "two_workers_s": statistics.median(two for _, two in rounds),
            "gain": statistics.median(one / two for one, two in rounds), "start_s": statistics.median(starts),
            "passed_over_us": 1e6 * (statistics.median(last) - statistics.median(starts)) / BEHIND}


def show_shards(found):
    one, two = found["pings"] / found["one_worker_s"], found["pings"] / found["two_workers_s"]
    print(f"FLS 256 x 500, 80 k, {found['pings']} pings in {SHARDS} shards, a core a worker: one worker {one:.1f} pings a "
          f"second, two {two:.1f}, {two / 2:.1f} a core; {found['gain']:.2f} times as many (median of {ROUNDS} rounds)")
    print(f"start of a shard and its first ping: {1e3 * found['start_s']:.0f} ms; a ping before the shard: "
          f"{found['passed_over_us']:.1f} us")
