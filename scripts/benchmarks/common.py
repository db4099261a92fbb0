"""Shared by all benchmarks: folders, runs of `insonify`, and an environment for DDS within this machine."""
import json
import os
import socket
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
BENCH = ROOT / "build" / "bench"
INSONIFY = ROOT / "build" / "bin" / "insonify"


def fail(program, status):
    sys.exit(f"scripts/bench: {program} failed with status {status}")


@contextmanager
def deployment_file(text, name="bench"):
    """Yields a file with this deployment, in a temporary folder."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, f"{name}.yml")
        file.write_text(text)
        yield file


def run_pings(file, pings):
    """Returns the summary of a run with this number of pings, the time from start to end of its process [ms],
    and its peak memory [MB]."""
    with tempfile.TemporaryDirectory() as folder:
        summary = Path(folder, "summary.json")
        command = [INSONIFY, "run", file, "--out", Path(folder, "out"), "--pings", str(pings), "--quiet",
                   "--summary", summary]
        start = time.monotonic()
        process = subprocess.Popen(command)
        _, status, usage = os.wait4(process.pid, 0)
        process_ms = 1e3 * (time.monotonic() - start)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            fail("insonify run", process.returncode)
        return json.loads(summary.read_text()), process_ms, usage.ru_maxrss / 1024


def time_rays(file, pings):
    """Embree's times for the number of primary rays that the sonar's quality sets."""
    done = subprocess.run([INSONIFY, "study", "rays", file, "--pings", str(pings)], stdout=subprocess.PIPE)
    if done.returncode != 0:
        fail("insonify study rays", done.returncode)
    return json.loads(done.stdout)


def loopback():
    """The environment for DDS within this machine, on a rarely used domain."""
    settings = ("<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces><AllowMulticast>"
                "false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex><Peers>"
                "<Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>")
    return os.environ | {"CYCLONEDDS_URI": settings, "ROS_DOMAIN_ID": str(20 + os.getpid() % 200)}


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]
