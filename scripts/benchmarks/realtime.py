"""Realtime runs on two cores, also with readers that hang and next to busy processes."""
import json
import os
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path

from benchmarks.busy import neighbours
from benchmarks.common import INSONIFY, ROOT, fail, free_port, loopback
from benchmarks.fans import SCENES, SONARS, deployment, scene

# Sonar, period [s] and range [m] of fans whose last echoes arrive within the period, on two cores.
REALTIME = {"FLS 512 x 1000, 10 Hz": ("FLS 512 x 1000", 0.1, 50), "FLS 256 x 500, 40 Hz": ("FLS 256 x 500", 0.025, 15)}
SLOW_READERS = """  ros: {{type: dds::PublisherTask, properties: {{topics: [{{port: ping, topic: /bench/slow, dtype: float32}}]}}}}
  view: {{type: viewer::ViewerTask, properties: {{port: {port}}}}}
connections:
  - {{from: receiver.ping, to: ros.ping, policy: {{type: circular_buffer, size: 4}}}}
  - {{from: receiver.ping, to: view.ping}}
"""
PAGES = []  # connections that are kept open


def run_realtime(sonar, period, reach, seconds, port=None):
    """The summary of a realtime run; a ping has its period as the deadline. With a port: with readers that hang."""
    text = SONARS[sonar].replace("range: 30", f"range: {reach}")
    text = text.replace("properties:", f"activity: {{deadline: {period}}}, properties:", 1)
    with tempfile.TemporaryDirectory() as folder:
        yml, summary = Path(folder, "bench.yml"), Path(folder, "summary.json")
        whole = deployment(text, scene(SCENES["80 k"]), "realtime", period)
        yml.write_text(whole.replace("connections:\n", SLOW_READERS.format(port=port)) if port else whole)
        command = [INSONIFY, "run", yml, "--out", Path(folder, "out"), "--duration", str(seconds),
                   "--quiet", "--summary", summary]
        two_cores = sorted(os.sched_getaffinity(0))[:2]
        run = subprocess.Popen(command, preexec_fn=lambda: os.sched_setaffinity(0, two_cores), env=loopback())
        hanging = hang_on(port) if port else []
        run.wait()
        for process in hanging:
            process.kill()
        if run.returncode != 0:
            fail("insonify run", run.returncode)
        return json.loads(summary.read_text())


def hang_on(port):
    """A page that never reads, and a ROS 2 reader that is stopped after it has received a
    message."""
    end = time.time() + 10
    while time.time() < end:
        try:
            page = socket.create_connection(("127.0.0.1", port))
            break
        except ConnectionRefusedError:
            time.sleep(0.1)
    page.send(f"GET / HTTP/1.1\r\nHost: localhost:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
              "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n"
              "Sec-WebSocket-Protocol: insonify.view.v1\r\n\r\n".encode())
    PAGES.append(page)
    reader = subprocess.Popen([ROOT / "build/venv/bin/python3", ROOT / "tests/dds/peer.py", "listen",
                               "ProjectedSonarImage", "/bench/slow", "600"], stdout=subprocess.PIPE, env=loopback())
    reader.stdout.readline()
    time.sleep(1)
    reader.send_signal(signal.SIGSTOP)
    return [reader]


def measure_realtime(options):
    """Per fan: pings, those written after the next was due, those not rendered, and latency and jitter [ms]."""
    results = {}
    runs = [(name, setting, None, 0) for name, setting in REALTIME.items()]
    fast = REALTIME["FLS 256 x 500, 40 Hz"]
    runs += [(f"the same, {busy} busy processes", fast, None, busy) for busy in [1, 2]]
    if (ROOT / "build/venv/bin/python3").exists():
        runs.append(("the same, readers hang", fast, free_port(), 0))
    for name, (sonar, period, reach), port, busy in runs:
        with neighbours(busy):
            summary = run_realtime(sonar, period, reach, options.realtime_seconds, port)
        vehicle, fan = summary["tasks"]["vehicle"], summary["tasks"]["sonar"]
        own = [lost for path, lost in summary["losses"].items() if not path.split(">")[1].startswith(("ros.", "view."))]
        skipped = vehicle["overruns"] + sum(own)
        results[name] = {"pings": summary["pings"], "late": fan["late"], "skipped": skipped,
                         "misses": fan["late"] + skipped, "echoes_ms": 2 * reach / 1500 * 1e3, "latency": fan["latency"],
                         "jitter": vehicle["jitter"], "render": {key: fan[key] for key in ["median_ms", "p99_ms", "max_ms"]}}
    return results


def show_realtime(results):
    print(f"{'realtime, 2 cores, [ms]':26}{'pings':>7}{'misses':>8}{'echoes':>8}  "
          + "".join(f"{name + ' median':>16}{'p99':>8}{'max':>8}" for name in ["latency", "jitter", "render"]))
    for name, fan in results.items():
        times = "".join(f"{fan[of]['median_ms']:16.3f}{fan[of]['p99_ms']:8.3f}{fan[of]['max_ms']:8.3f}"
                        for of in ["latency", "jitter", "render"])
        print(f"{name:26}{fan['pings']:7}{fan['misses']:8}{fan['echoes_ms']:8.1f}  {times}")
