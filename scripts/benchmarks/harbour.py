"""The harbour of deploy/harbour_fls.yml: its pings, its first ping, and how long an error takes."""
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

from benchmarks import table
from benchmarks.common import INSONIFY, ROOT, deployment_file, fail, run_pings

LAST_PING = 181  # last ping of the pass along the quay
STARTS = 7


def demo(visibility):
    """The unchanged deployment, picture and log included, with a visibility and absolute paths of files."""
    text = (ROOT / "deploy/harbour_fls.yml").read_text().replace("scenes/", f"{ROOT}/deploy/scenes/")
    return text.replace("      beam_count:", f"      visibility: {visibility}\n      beam_count:", 1)


def unseen(text):
    """The deployment without a picture per ping, which would take a core."""
    return text.replace("file: fan_%06d.png,", "file: fan_%06d.png, every: 1000,", 1)


def first_ping(visibility):
    """Medians of some starts [ms]: the whole process, its part before the run, and the first cycles."""
    starts = []
    with deployment_file(demo(visibility)) as file:
        for _ in range(STARTS):
            summary, process_ms, _ = run_pings(file, 1)
            cycles = {name: task["max_ms"] for name, task in summary["tasks"].items()}
            starts.append({"process": process_ms, "loading": process_ms - 1e3 * summary["wall_s"], **cycles})
    found = {name: statistics.median(start[name] for start in starts) for name in starts[0]}
    return found | {"slowest": max(start["process"] for start in starts)}


def measure_harbour(options):
    pings = min(options.pings, LAST_PING)
    return {"pings": {f"harbour, {name}": table.measure(unseen(demo(name)), pings) for name in options.visibility},
            "first_ping": {name: first_ping(name) for name in options.visibility}}


def show_harbour(found):
    table.show(found["pings"])
    for name, start in found["first_ping"].items():
        parts = ", ".join(f"{part} {start[part]:.1f}" for part in ["loading", "sonar", "noise", "receiver", "fan", "log"])
        print(f"first ping after start, {name}: {start['process']:.0f} ms, slowest {start['slowest']:.0f} ms of {STARTS}; "
              f"of that {parts} ms")


def study_error(visibility, options):
    """Results of `insonify study error` per method: times to 1 and 0.1 % [ms], and how they were found."""
    with deployment_file(demo(visibility), "harbour") as file, tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "out")
        command = [INSONIFY, "study", "error", file, "--ping", str(options.error_ping), "--out", out, "--quiet"]
        for name in ["levels", "reference_rays"]:
            if getattr(options, name) is not None:
                command += ["--" + name.replace("_", "-"), str(getattr(options, name))]
        status = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
        if not (out / "error_time.json").exists():  # 1 with a report: a claim of the study fails
            fail("insonify study error", status)
        return json.loads((out / "error_time.json").read_text())


def measure_error(options):
    return {name: study_error(name, options) for name in options.visibility}


def time_text(method, percent):
    time, kind = method[f"ms_to_{percent}_percent"], method[f"ms_to_{percent}_percent_is"]
    return "never" if time is None else f"{time:.1f} ({kind.replace('_', ' ')})"


def show_error(found):
    print("harbour, time to an error of 1 % and 0.3 % after a gain of 50 log10(range) [ms]")
    for visibility, study in found.items():
        for method in study["methods"]:
            print(f"  {visibility:5}{method['method']:20}{time_text(method, '1'):>28}{time_text(method, '0.3'):>28}")
        for verdict in study["verdicts"]:
            if verdict["verdict"] != "pass":
                print(f"  {visibility:5}{verdict['verdict']}: {verdict['claim']}")
