"""Images over DDS within this machine."""
import json
import subprocess

from benchmarks.common import ROOT, loopback


def measure_dds(options):
    """Number and delay [ms] of received messages of 1 MB, between our programs and programs with PyPI's
    cyclonedds."""
    seconds = options.dds_seconds
    ours, python = ROOT / "build/bin/dds_bench", ROOT / "build/venv/bin/python3"
    env, peer = loopback(), [python, ROOT / "tests/dds/peer.py"]
    send, listen = [ours, "send", str(seconds), "3"], [ours, "listen", str(seconds + 8)]
    pairs = {"ours to ours": (send, listen)}
    if python.exists():
        pairs["ours to PyPI's, decoded in Python"] = (
            send, [*peer, "listen", "ProjectedSonarImage", "/bench/sonar", str(seconds + 8)])
        pairs["PyPI's to ours"] = (
            [*peer, "image", "/bench/sonar", str(round(40 * seconds)), "40"], listen)
    found = {}
    for name, (sender, reader) in pairs.items():
        listening = subprocess.Popen(reader, stdout=subprocess.PIPE, text=True, env=env)
        sent = subprocess.run(sender, stdout=subprocess.PIPE, text=True, check=True, env=env)
        printed = [text.removeprefix("ready\n") for text in [sent.stdout, listening.communicate()[0]]]
        sent, received = map(json.loads, printed)
        found[name] = {"sent": sent, "heard": {key: received[key] for key in received if key != "first"}}
    return found


def show_dds(found):
    print("DDS, 1 MB at 40 Hz: sent, received; latency median, p99 ms; sending median, p99, max ms")
    for name, times in found.items():
        sent, received = times["sent"], times["heard"]
        own = [f"{sent[key]:9.2f}" for key in ["median_ms", "p99_ms", "max_ms"] if key in sent]
        print(f"  {name:35}{sent['count']:6} {received['count']:6}{received['median_ms'] or 0:9.2f}{received['p99_ms'] or 0:9.2f}"
              + "".join(own))
