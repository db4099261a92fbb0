"""The harbour with a hundred fish that swim, and with the same fish at rest."""
import subprocess
import sys

from benchmarks import harbour, table
from benchmarks.common import BENCH, ROOT

REST = '{"*": {play: false}}'
RUNS = 3  # runs of each in turn, so that other work on the machine affects both; the fastest counts


def school():
    """The scene, made once."""
    scene = BENCH / "harbour_fish.glb"
    if not scene.exists():
        python = ROOT / "build/venv/bin/python3"
        subprocess.run([python if python.exists() else sys.executable, ROOT / "scripts/scenes/make_fish.py", scene, "--scene",
                        ROOT / "deploy/scenes/harbour.glb"], check=True)
    return scene


def deployment(animations):
    text = harbour.unseen(harbour.demo("cpu")).replace(f"{ROOT}/deploy/scenes/harbour.glb", str(school()), 1)
    return text.replace("      mount:", f"      animations: {animations}\n      mount:", 1)


def measure_fish(options):
    pings = min(options.pings, harbour.LAST_PING)
    runs = {"at rest": [], "swimming": []}
    for _ in range(RUNS):
        runs["at rest"].append(table.measure(deployment(REST), pings, with_rays=False))
        runs["swimming"].append(table.measure(deployment("{}"), pings, with_rays=False))
    found = {name: min(all_of, key=lambda run: run["sonar"]) for name, all_of in runs.items()}
    return {"pings": found, "ratio": found["swimming"]["sonar"] / found["at rest"]["sonar"]}


def show_fish(found):
    table.show({f"fish {name}": run for name, run in found["pings"].items()})
    print(f"100 fish of 2,000 triangles: a ping of the sonar takes {found['ratio']:.2f} times as long while they swim")
