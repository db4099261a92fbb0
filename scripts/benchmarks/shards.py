"""A run in shards, by one worker and by two, each on its own processor."""
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
BEHIND = 20_000  # pings, to find the cost of a skipped ping

LOG = "  log: {type: logger::LoggerTask, properties: {file: bench.0.log}}\nconnections:"
LOGGED = "  - {from: receiver.ping, to: log.ping, policy: {type: buffer, size: 64}}\n"


def make(file, out, shard, pings, core):
    """Makes a shard on one processor. Returns its wall and processor time [s]."""
    command = ["taskset", "--cpu-list", str(core), INSONIFY, "run", file, "--out", out, "--shard", shard, "--pings",
               str(pings), "--quiet"]
    start = time.monotonic()
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        fail("insonify run --shard", process.returncode)
    return time.monotonic() - start, usage.ru_utime + usage.ru_stime


def whole(file, pings, workers):
    """Wall and processor time of these workers for all shards [s]; size of the shards [B]."""
    waiting = iter(range(SHARDS))

    def work(core):
        return sum(make(file, out, f"{i}/{SHARDS}", pings, core)[1] for i in waiting)

    with tempfile.TemporaryDirectory(dir=BENCH) as out, ThreadPoolExecutor(workers) as pool:
        start = time.monotonic()
        used = sum(pool.map(work, sorted(os.sched_getaffinity(0))[:workers]))
        took = time.monotonic() - start
        return took, used, sum(entry.stat().st_size for entry in Path(out).rglob("*") if entry.is_file())


def one(file, shard, pings):
    with tempfile.TemporaryDirectory(dir=BENCH) as out:
        return make(file, out, shard, pings, min(os.sched_getaffinity(0)))[1]


def measure_shards(options):
    text = deployment(seen(SONARS["FLS 256 x 500"], "cpu"), scene(SCENES["80 k"]))
    pings = SHARDS * options.pings
    with deployment_file(text.replace("connections:", LOG, 1) + LOGGED) as file:
        rounds = [(whole(file, pings, 1), whole(file, pings, 2)) for _ in range(ROUNDS)]  # they take turns
        start = statistics.median(one(file, "0/1", 1) for _ in range(ROUNDS))
        last = statistics.median(one(file, f"{BEHIND - 1}/{BEHIND}", BEHIND) for _ in range(ROUNDS))

    def rates(workers):
        """Pings a second of all workers, and a second of a processor's time."""
        taken = [each[workers - 1] for each in rounds]
        return [pings / statistics.median(seconds) for seconds in list(zip(*taken))[:2]]

    return {"pings": pings, "one_worker": rates(1), "two_workers": rates(2),
            "gain": statistics.median(one[0] / two[0] for one, two in rounds), "bytes_a_ping": rounds[0][0][2] / pings,
            "start_ms": 1e3 * start, "passed_over_us": 1e6 * (last - start) / BEHIND}


def show_shards(found):
    one, two = found["one_worker"], found["two_workers"]
    print(f"FLS 256 x 500, 80 k, cpu, logged, {found['pings']} pings in {SHARDS} shards, a core a worker, medians of {ROUNDS}:")
    print(f"  one worker:  {one[0]:.1f} pings a second, {one[1]:.1f} a second of the processor")
    print(f"  two workers: {two[0]:.1f} pings a second, {two[1]:.1f} a second of the processor; {found['gain']:.2f} times the rate")
    print(f"  start of a shard with its first ping: {found['start_ms']:.0f} ms of the processor; each ping before it: "
          f"{found['passed_over_us']:.1f} us; a ping: {found['bytes_a_ping'] / 1e6:.2f} MB")
