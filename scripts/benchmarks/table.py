"""Pings of a sonar, timed, as lines of a table."""
from benchmarks.common import deployment_file, run_pings, time_rays

STAGES = ["cull", "draw", "read", "deposit", "beams"]
CHAIN = ["sonar", "noise", "receiver"]


def measure(text, pings, with_rays=True):
    """Result of a deployment's run. Medians [ms] per stage of the sonar, per task of the chain, and of all three
    tasks in a ping; of the ping also the 99th percentile, as the sum of the tasks'; the sonar's time of the first
    ping; peak memory [MB]; quality and device. For comparison, right after the run, the same number of primary rays
    by Embree."""
    with deployment_file(text) as file:
        summary, _, resident_mb = run_pings(file, pings)
        rays = time_rays(file, pings) if with_rays else None
    tasks = {name: summary["tasks"][name] for name in CHAIN}
    result = {stage: times["median_ms"] for stage, times in tasks["sonar"]["stages"].items()}
    result |= {name: task["median_ms"] for name, task in tasks.items()}
    result["ping"] = sum(task["median_ms"] for task in tasks.values())
    result["ping_p99"] = sum(task["p99_ms"] for task in tasks.values())
    result["slowest_ms"] = tasks["sonar"]["max_ms"]
    result["pings_per_s"] = 1000 / result["ping"]
    result["resident_mb"] = resident_mb
    result["quality"] = summary["quality"]["sonar"]
    result["device"] = summary["devices"]["sonar"]
    return result | ({"embree": rays} if rays else {})


def cells(result):
    yield from (result.get(name) for name in STAGES + CHAIN + ["ping", "ping_p99"])
    rays = result.get("embree", {})
    yield from (rays.get(name) for name in ["alone_median_ms", "alone_p99_ms"])


def quality_of(result):
    quality = result["quality"]
    error = quality["predicted_error"]
    return f"{quality['rows']} x {quality['columns_per_beam']}" + ("" if error is None else f", predicted {error:.3f}")


def show(results):
    """A line for each result, by name."""
    width = max(map(len, results))
    heads = STAGES + CHAIN + ["ping", "p99", "rays", "p99", "slowest", "pings/s", "MB"]
    print(f"{'medians [ms]':{width}}" + "".join(f"{head:>9}" for head in heads) + "  quality")
    for name, result in results.items():
        times = "".join(" " * 9 if cell is None else f"{cell:9.3f}" for cell in cells(result))
        print(f"{name:{width}}{times}{result['slowest_ms']:9.1f}{result['pings_per_s']:9.1f}{result['resident_mb']:9.0f}"
              f"  {quality_of(result)}")
    for device in dict.fromkeys(result["device"] for result in results.values()):
        print(f"by {device}")
