"""A step from Python compared with the same ping of the command."""
import os
import statistics
import subprocess

from benchmarks.common import ROOT, deployment_file, fail, run_pings
from benchmarks.fans import FAN, SCENES, SONARS, deployment, scene, seen

ROUNDS = 5
SMALL = ("{type: sonar::SonarTask, properties: {quality: {rows: 64, columns_per_beam: 1}, beam_count: 96, bin_count: 128, "
         + FAN + "}}")

# Milliseconds a ping, without the first ten.
STEPS = """
import sys, time, insonify
simulation, pose, pings = insonify.Simulation(sys.argv[1]), insonify.Pose([0, 0, 0]), int(sys.argv[2])
for _ in range(10): simulation.step(pose).bins
start = time.perf_counter()
for _ in range(pings): simulation.step(pose).bins
print(1e3 * (time.perf_counter() - start) / pings)
"""

# Steps a second of `count` environments of gymnasium: each in its own process, or all in one.
AGENTS = """
import sys, time, gymnasium, insonify, insonify.gym
file, count, steps, together = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4] == "together"
start, options = insonify.Pose([0, 0, 0]), dict(max_steps=10**9, collision_range=0)
def make(): return insonify.gym.SonarEnv(file, start, **options)
if __name__ == "__main__":
    agents = insonify.gym.SonarVectorEnv(file, start, count, **options) if together else gymnasium.vector.AsyncVectorEnv([make] * count)
    agents.reset(seed=1)
    for _ in range(10): agents.step(0 * agents.action_space.sample())
    start = time.perf_counter()
    for _ in range(steps): agents.step(0 * agents.action_space.sample())
    print(count * steps / (time.perf_counter() - start))
    agents.close()
"""


def by_python(file, pings):
    environment = os.environ | {"PYTHONPATH": str(ROOT / "build/python")}
    done = subprocess.run(["/usr/bin/python3", "-c", STEPS, file, str(pings)], stdout=subprocess.PIPE, env=environment)
    if done.returncode != 0:
        fail("a step from Python", done.returncode)
    return float(done.stdout)


def by_command(file, pings):
    """The difference of a long run and one of ten pings, which excludes the start of the process."""
    (_, few, _), (_, many, _) = run_pings(file, 10), run_pings(file, 10 + pings)
    return (many - few) / pings


def measure_steps(options):
    found = {}
    for visibility in options.visibility:
        text = deployment(seen(SONARS["FLS 256 x 500"], visibility), scene(SCENES["80 k"]))
        with deployment_file(text) as file:  # they take turns
            rounds = [(by_command(file, options.pings), by_python(file, options.pings)) for _ in range(ROUNDS)]
        found[visibility] = {"command_ms": statistics.median(command for command, _ in rounds),
                             "python_ms": statistics.median(python for _, python in rounds),
                             "ratio": statistics.median(python / command for command, python in rounds)}
    return found


def show_steps(found):
    for visibility, times in found.items():
        print(f"FLS 256 x 500, 80 k, {visibility}: command {times['command_ms']:.2f} ms a ping, a step from Python "
              f"{times['python_ms']:.2f} ms, {times['ratio']:.3f} times as long (median of {ROUNDS} rounds)")


def measure_agents(options):
    python = ROOT / "build/venv/bin/python"
    environment = os.environ | {"PYTHONPATH": str(ROOT / "build/python")}

    def rate(file, count, how):
        steps = max(10, options.pings // count)
        done = subprocess.run([python, "-c", AGENTS, file, str(count), str(steps), how], stdout=subprocess.PIPE, env=environment)
        if done.returncode != 0:
            fail("environments of gymnasium", done.returncode)
        return float(done.stdout)

    found = {}
    for name, sonar in (("FLS 256 x 500", SONARS["FLS 256 x 500"]), ("FLS 96 x 128", SMALL)):
        with deployment_file(deployment(seen(sonar, "cpu"), scene(SCENES["80 k"]))) as file:
            found[name] = [[count, how, statistics.median(rate(file, count, how) for _ in range(3))]
                           for count, how in ((1, "apart"), (4, "apart"), (4, "together"), (32, "together"))]
    return found


def show_agents(found):
    for name, rates in found.items():
        for count, how, rate in rates:
            print(f"{name}, 80 k, {count} environments of gymnasium, {how}: {rate:.1f} steps a second in all")
