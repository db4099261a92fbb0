"""A step from Python beside the same ping of the command."""
import os
import statistics
import subprocess

from benchmarks.common import ROOT, deployment_file, fail, run_pings
from benchmarks.fans import SCENES, SONARS, deployment, scene, seen

ROUNDS = 5

# Milliseconds a ping, without the first ten.
STEPS = """
import sys, time, insonify
simulation, pose, pings = insonify.Simulation(sys.argv[1]), insonify.Pose([0, 0, 0]), int(sys.argv[2])
for _ in range(10): simulation.step(pose).bins
start = time.perf_counter()
for _ in range(pings): simulation.step(pose).bins
print(1e3 * (time.perf_counter() - start) / pings)
"""

# Steps a second of so many environments of gymnasium, each in a process of its own.
AGENTS = """
import sys, time, gymnasium, insonify, insonify.gym
file, count, steps = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
def make(): return insonify.gym.SonarEnv(file, insonify.Pose([0, 0, 0]), max_steps=10**9, collision_range=0)
if __name__ == "__main__":
    agents = gymnasium.vector.AsyncVectorEnv([make] * count)
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
    """The difference of a long run and one of ten pings, so that the start of the process is not in it."""
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
    found = {}
    with deployment_file(deployment(seen(SONARS["FLS 256 x 500"], "cpu"), scene(SCENES["80 k"]))) as file:
        for count in (1, 2, 4):
            done = subprocess.run([python, "-c", AGENTS, file, str(count), str(options.pings)], stdout=subprocess.PIPE,
                                  env=environment)
            if done.returncode != 0:
                fail("environments of gymnasium", done.returncode)
            found[count] = float(done.stdout)
    return found


def show_agents(found):
    for count, rate in found.items():
        print(f"FLS 256 x 500, 80 k, {count} environments of gymnasium: {rate:.1f} steps a second in all")
