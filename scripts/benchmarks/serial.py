"""The share of a ping that is not divided among threads, by the times of one thread."""
import json
import os
import subprocess
import tempfile
from pathlib import Path

from benchmarks.common import INSONIFY, ROOT, deployment_file, fail
from benchmarks.fans import COHERENT, SCENES, SONARS, deployment, scene, seen
from benchmarks.harbour import demo, unseen

CORES = [2, 4, 8, 16]
PINGS = 40  # that the 3-D sonar of the harbour makes
STAGES = ["cull", "draw", "deposit", "beams"]


def fan(blocks=""):
    sonar = seen(SONARS["FLS 256 x 500"], "cpu").replace("properties: {", f"properties: {{{blocks}", 1)
    return deployment(sonar, scene(SCENES["80 k"]))


def sonar3d():
    return (ROOT / "deploy/harbour_sonar3d.yml").read_text().replace("scenes/", f"{ROOT}/deploy/scenes/")


def measure_one(text, pings):
    with deployment_file(text) as file, tempfile.TemporaryDirectory() as folder:
        summary = Path(folder, "summary.json")
        core = str(min(os.sched_getaffinity(0)))  # a sonar has a thread for each core that it may use
        command = ["taskset", "-c", core, INSONIFY, "run", file, "--out", Path(folder, "out"), "--pings", str(pings), "--quiet",
                   "--summary", summary]
        status = subprocess.run(command).returncode
        if status != 0:
            fail("insonify run", status)
        sonar = json.loads(summary.read_text())["tasks"]["sonar"]
    share = sonar["counts"]["undivided_share"]
    return {"ping_ms": sonar["median_ms"], "undivided_share": share,
            "stages": {name: sonar["stages"][name]["median_ms"] for name in STAGES},
            "gain": {cores: 1 / (share + (1 - share) / cores) for cores in CORES}}


def measure_serial(options):
    texts = {"fan 256 x 500": fan(), "harbour 512 x 1000": unseen(demo("cpu")), "coherent fan": fan(COHERENT), "3-D sonar": sonar3d()}
    return {name: measure_one(text, min(options.pings, PINGS)) for name, text in texts.items()}


def show_serial(found):
    print(f"{'one thread':22}{'ping ms':>9}{'undivided':>11}" + "".join(f"{stage:>9}" for stage in STAGES) +
          "".join(f"{f'{cores} cores':>10}" for cores in CORES))
    for name, row in found.items():
        print(f"{name:22}{row['ping_ms']:9.2f}{100 * row['undivided_share']:9.1f} %" +
              "".join(f"{row['stages'][stage]:9.2f}" for stage in STAGES) +
              "".join(f"{row['gain'][cores]:9.1f}x" for cores in CORES))
