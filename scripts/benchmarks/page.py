"""The live page in a browser: frames a second of a large fan, and the picture of the page."""
import json
import os
import re
import statistics
import subprocess
import tempfile
from contextlib import contextmanager
from pathlib import Path

from benchmarks.common import INSONIFY, ROOT, fail

CHROMIUM = "/usr/bin/chromium"
SECONDS = 10  # of each measurement
BUSY = "data:text/html,<script>for (let x = 1;;) x = Math.sin(x) + 1;</script>"

# Resolves to the times of frames [ms], and of the page's work in each, while a ping of 512 x 1000 comes with every frame.
FRAMES = """new Promise((done) => {
  const beams = 512, bins = 1000, half = 65 * Math.PI / 180, source = insonify.fan.ping.source, pings = [], times = [], work = [];
  const edges = Array.from({length: 2 * beams}, (_, i) => -half + Math.ceil(i / 2) * 2 * half / beams);
  for (let k = 0; k < 8; ++k) pings.push(Uint8Array.from({length: beams * bins}, () => 60 + 160 * Math.random()));
  insonify.link.socket.onmessage = () => { insonify.link.heard_at = performance.now(); };
  let count = 0;
  function frame(now) {
    times.push(now);
    const json = {source, time_us: 1e5 * ++count, count, latency_s: 0, beams, bins, bin_m: 0.05, top_db: 0, step_db: 0.4, beam_width: 0.004,
                  beam_height: 0.35, bearings: [], edges}, begin = performance.now();
    if (PINGS) insonify.take({kind: 1, json, buffer: pings[count % 8].buffer, start: 0});
    work.push(performance.now() - begin);
    now - times[0] < DURATION ? requestAnimationFrame(frame) : done({times, work, size: [insonify.fan.canvas.width, insonify.fan.canvas.height]});
  }
  requestAnimationFrame(frame);
})"""


def python():
    """A python with websockets: that of scripts/setup, or Debian's."""
    for candidate in [ROOT / "build/venv/bin/python3", "/usr/bin/python3"]:
        if os.path.exists(candidate) and subprocess.run([candidate, "-c", "import websockets"],
                                                        stderr=subprocess.DEVNULL).returncode == 0:
            return candidate
    raise SystemExit("scripts/bench: no python has websockets; scripts/setup installs one in build/venv")


def processor_s(root):
    """Processor time of a process and of those that it has started, so far [s]."""
    parents, times = {}, {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:  # it has ended
            continue
        parents[int(stat.parent.name)] = int(fields[1])
        times[int(stat.parent.name)] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def is_below(pid):
        return pid == root or (pid in parents and is_below(parents[pid]))

    return sum(time for pid, time in times.items() if is_below(pid))


@contextmanager
def live_page(*settings):
    """Runs deploy/live_view.yml with these settings; yields its page as a function that answers a request of
    tests/viewer/browse.py."""
    with tempfile.TemporaryDirectory() as folder:
        command = [INSONIFY, "run", ROOT / "deploy/live_view.yml", "--out", folder]
        command += [part for setting in settings for part in ("--set", setting)]
        browse = [python(), ROOT / "tests/viewer/browse.py", CHROMIUM]
        run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        url = next((found[1] for line in run.stderr if (found := re.search(r"open (http://\S+)", line))), None)
        if url is None:
            fail("insonify run", run.wait())
        browser = subprocess.Popen([*browse, url], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

        def ask(**request):
            print(json.dumps(request), file=browser.stdin, flush=True)
            answer = json.loads(browser.stdout.readline())
            if "error" in answer:
                raise SystemExit(f"{request}: {answer['error']}")
            return answer["value"]

        ask.browser = browser.pid
        try:
            ask(size=[1280, 800, 1])
            ask(until="self.insonify && insonify.shown() > 10 && insonify.status()", seconds=120)
            yield ask
        finally:
            browser.stdin.close()
            browser.wait()
            run.terminate()
            run.wait()


def measure_page(_options):
    found = []
    for layout in ["both", "fan"] * 2:
        for busy in [False, True]:
            with live_page("sonar.beam_count=32", "sonar.bin_count=100", "sonar.quality.rows=16") as ask:
                ask(press=["1" if layout == "both" else "2"])
                if busy:
                    ask(tab=BUSY)
                script = FRAMES.replace("DURATION", str(1000 * SECONDS))
                still = ask(eval=script.replace("PINGS", "false").replace(str(1000 * SECONDS), "3000"))
                before = processor_s(ask.browser)
                seen = ask(eval=script.replace("PINGS", "true"))
                processor_ms = 1e3 * (processor_s(ask.browser) - before) / len(seen["times"])
            steps = [b - a for a, b in zip(seen["times"], seen["times"][1:])]
            found.append({"busy": busy, "layout": layout, "size": seen["size"], "frames_per_second": 1e3 / statistics.mean(steps),
                          "slowest_ms": max(steps), "still": len(still["times"]) / 3, "p99_ms": sorted(steps)[int(0.99 * len(steps))],
                          "page_ms": statistics.median(seen["work"]), "processor_ms": None if busy else processor_ms})
    return found


def show_page(rows):
    for row in rows:
        print(f"fan of 512 x 1000 on {row['size'][0]} x {row['size'][1]} pixels, "
              f"{'with' if row['layout'] == 'both' else 'without'} the scene, "
              f"{'another tab computes' if row['busy'] else 'alone':20}{row['frames_per_second']:6.1f} frames/s ({row['still']:.0f} without pings), "
              f"99 % within {row['p99_ms']:.0f} ms; {row['page_ms']:.1f} ms of the page's own work a frame"
              + ("" if row["busy"] else f", {row['processor_ms']:.0f} ms of processor time of the whole browser"))


def save_picture(file):
    """Saves the page as a picture: the pass along the quay, with a target, a line and a recording that runs."""
    with live_page() as ask:
        ask(until="insonify.attitude() && insonify.snapshot().position[0] > 12", seconds=300)
        ask(press=["t"])
        for bearing, share in [(-0.45, 0.62), (0.2, 0.72)]:
            ask(eval=f"self.at = insonify.fan.findPixel({share} * 50.8, {bearing})")
            x, y = ask(eval="(() => { const box = insonify.fan.canvas.getBoundingClientRect(); return [box.left + at[0], box.bottom - at[1]]; })()")
            for kind in ["mousePressed", "mouseReleased"]:
                ask(mouse={"type": kind, "x": x, "y": y, "button": "left", "clickCount": 1})
        ask(press=["Escape", "r"])
        ask(until="/left/.test(document.getElementById('recorded').textContent)", seconds=60)
        ask(screenshot=str(file))
        ask(press=["r"])
