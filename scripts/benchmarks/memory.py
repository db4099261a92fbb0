"""Memory of long runs: a million pings in lockstep, with a log and without, and realtime with page, log and ROS 2."""
import socket
import subprocess
import tempfile
import threading
import time
from pathlib import Path

from benchmarks.common import INSONIFY, fail, free_port, loopback
from benchmarks.fans import SCENES, deployment, scene

SMALL = ("{type: sonar::SonarTask, properties: {range: 20, beam_count: 4, bin_count: 50, field_of_view_deg: 30, "
         "beam_height_deg: 20, quality: {rows: 8, columns_per_beam: 1}}}")
FAN = ("{type: sonar::SonarTask, properties: {range: 51, beam_count: 128, bin_count: 250, field_of_view_deg: 120, "
       "beam_height_deg: 20, quality: {rows: 64, columns_per_beam: 2}}}")
LOG = """  log: {type: logger::LoggerTask, properties: {file: long.0.log}}
connections:
  - {from: receiver.ping, to: log.ping, policy: {type: buffer, size: 64}}
"""
OUTSIDE = """  ros: {{type: dds::PublisherTask, properties: {{topics: [{{port: ping, topic: /bench/long}}]}}}}
  view: {{type: viewer::ViewerTask, properties: {{port: {port}}}}}
connections:
  - {{from: receiver.ping, to: ros.ping, policy: {{type: circular_buffer, size: 4}}}}
  - {{from: receiver.ping, to: view.ping}}
"""
HANDSHAKE = ("GET / HTTP/1.1\r\nHost: localhost:{}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13"
             "\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\nSec-WebSocket-Protocol: insonify.view.v1\r\n\r\n")
SETTLED = 10  # time after which all buffers have been allocated [s]


def resident(process):
    """Memory of a process [MB]; none if it has ended."""
    try:
        lines = Path(f"/proc/{process.pid}/status").read_text().splitlines()
    except FileNotFoundError:
        return None
    found = [line.split()[1] for line in lines if line.startswith("VmRSS")]
    return int(found[0]) / 1024 if found else None


def keep_reading(port, process):
    """A page that reads all that it is sent, and reconnects when disconnected."""
    while process.poll() is None:
        try:
            with socket.create_connection(("127.0.0.1", port), timeout=5) as page:
                page.send(HANDSHAKE.format(port).encode())
                while page.recv(1 << 16):
                    pass
        except OSError:
            time.sleep(0.2)


def watch(text, limits, port=None):
    """Memory [MB] of a run when it has settled, at its end and at most, and its duration [s]."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "long.yml")
        file.write_text(text)
        command = [INSONIFY, "run", file, "--out", Path(folder, "out"), "--quiet", *limits]
        start = time.monotonic()
        process = subprocess.Popen(command, env=loopback())
        if port:
            threading.Thread(target=keep_reading, args=(port, process), daemon=True).start()
        sizes = []
        while process.poll() is None:
            time.sleep(0.5)
            if time.monotonic() - start > SETTLED and (size := resident(process)):
                sizes.append(size)
        if process.returncode != 0:
            fail("insonify run", process.returncode)
        return {"settled_mb": sizes[0], "end_mb": sizes[-1], "max_mb": max(sizes), "seconds": time.monotonic() - start}


def measure_memory(options):
    pings, seconds, file = str(options.memory_pings), str(options.memory_seconds), scene(SCENES["80 k"])
    small, port = deployment(SMALL, file, period=0.003), free_port()
    outside = deployment(FAN, file, "realtime").replace("connections:\n", OUTSIDE.format(port=port))
    return {f"{pings} pings": watch(small, ["--pings", pings]),
            f"{pings} pings, logged": watch(small.replace("connections:\n", LOG), ["--pings", pings]),
            f"{seconds} s of realtime with page, log and ROS 2":
                watch(outside.replace("connections:\n", LOG), ["--duration", seconds], port)}


def show_memory(found):
    for name, run in found.items():
        print(f"{name}: {run['settled_mb']:.1f} MB after {SETTLED} s, {run['end_mb']:.1f} MB at the end, "
              f"{run['max_mb']:.1f} MB at most; {run['seconds']:.0f} s")
