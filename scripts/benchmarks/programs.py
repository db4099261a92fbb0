"""Programs of tests/bench: the framework's ports, the logger, and paths by mirrors."""
import json
import subprocess
import tempfile

from benchmarks.common import BENCH, ROOT, fail
from benchmarks.fans import GROWTH, scene


def measure_ports(_options):
    file = BENCH / "framework.json"
    file.unlink(missing_ok=True)
    subprocess.run([ROOT / "build/bin/framework_bench", file], stdout=subprocess.DEVNULL)  # 1: a bound is missed
    return json.loads(file.read_text())


def show_ports(rows):
    for row in rows:
        bound = "" if row["at_most"] is None else f"  at most {row['at_most']:g}"
        if row["at_most"] is not None and row["value"] > row["at_most"]:
            bound += "  MISSED"
        print(f"{row['name']:60}{row['value']:12.4g} {row['unit']}{bound}")


def measure_logger(options):
    """Results of logger_bench for pings of 512 x 1000 floats, 40 a second."""
    with tempfile.TemporaryDirectory(dir=BENCH) as folder:
        command = [ROOT / "build/bin/logger_bench", str(options.log_seconds), folder]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if not done.stdout:
        fail("logger_bench", done.returncode)
    return json.loads(done.stdout)


def show_logger(logger):
    print(f"logger, 512 x 1000 floats at 40 Hz: {logger['pings']} pings written, {logger['in_log']} in the log, "
          f"{logger['lost']} lost, {logger['megabytes_per_s']:.1f} MB/s")
    for name, unit in [("write_us", "us"), ("interval_ms", "ms")]:
        times = logger[name]
        print(f"  {name.split('_')[0]:9}{times['median']:9.3f} {unit}, p99 {times['p99']:.3f}, max {times['max']:.3f}")


def measure_oculus(options):
    """Results of oculus_bench for a driver that requests 512 x 1000 at 40 Hz from deploy/hil_oculus.yml
    over TCP, and for one that changes settings."""
    def measured(*arguments):
        done = subprocess.run([ROOT / "build/bin/oculus_bench", *arguments], stdout=subprocess.PIPE, text=True)
        if done.returncode != 0:
            fail("oculus_bench", done.returncode)
        return json.loads(done.stdout)
    changes = measured("10", scene(["--cells", GROWTH["1 M"]]))  # 100 pings of each setting
    return measured(str(options.log_seconds)) | {"changes": changes}


def show_oculus(oculus):
    print(f"Oculus, 512 x 1000 codes of 16 bits at 40 Hz over TCP: {oculus['received']} pings received of "
          f"{oculus['asked']:.0f} requested in {oculus['seconds']:.0f} s, {oculus['mb_per_s']:.1f} MB/s")
    for row in oculus["changes"]:
        print(f"  {row['changed'] + ' changed each second':36} median {row['median_ms']:7.1f} ms, after a change at most "
              f"{row['after_change_ms']:7.1f}: {row['after_change_ms'] / row['median_ms']:.2f} times")


def measure_paths(options):
    """Results of paths_bench for at most 100 pings: processor time of the paths to 50 targets."""
    done = subprocess.run([ROOT / "build/bin/paths_bench", str(min(options.pings, 100))], stdout=subprocess.PIPE)
    if done.returncode != 0:
        fail("paths_bench", done.returncode)
    return json.loads(done.stdout)


def show_paths(scenes):
    for name, found in scenes.items():
        print(f"paths to 50 targets, two bounces, {name:24}{found['median_ms']:9.3f} ms a ping, max {found['max_ms']:.3f}, "
              f"{found['paths']:.1f} paths a target")


def measure_scenes(_options):
    """Results of scene_bench for a mission over tiles of a survey, for paths over borders of cells, and for the memory of
    1 and of 16 sonars of one scene."""
    def measured(*arguments):
        done = subprocess.run([ROOT / "build/bin/scene_bench", *arguments], stdout=subprocess.PIPE, text=True)
        if done.returncode != 0:
            fail("scene_bench", done.returncode)
        return json.loads(done.stdout)
    with tempfile.TemporaryDirectory(dir=BENCH) as folder:
        mission = measured("mission", folder)
    return {"mission": mission, "borders": [measured("border", way, "708") for way in ("line", "circle")],
            "memory": [measured("memory", count, "708") for count in ("1", "16")]}


def show_scenes(scenes):
    mission = scenes["mission"]
    for clock, kind in [("", "by the clock"), ("busy_", "processor time")]:
        for name, key in [(f"{mission['pings']} pings", "ms"), (f"{mission['changes']} with new tiles", "ms_of_changes")]:
            median, p99, slowest = mission[clock + key]
            print(f"mission, {name:20} {kind:15} median {median:7.2f} ms, p99 {p99:7.2f}, max {slowest:7.2f}: "
                  f"{slowest / mission[clock + 'ms'][0]:.2f} times the median of all")
    for row in scenes["borders"]:
        median, p99, slowest = row["busy_ms"]
        print(f"{row['way']:6} over borders, processor time median {median:7.2f} ms, p99 {p99:7.2f}, max {slowest:7.2f}: "
              f"{slowest / median:.2f} times, by the clock {row['ms'][2] / row['ms'][0]:.2f} times; {row['mb_first']:.0f} MB after the first ping, at most {row['mb']:.0f}")
    for row in scenes["memory"]:
        print(f"{row['sonars']:2} sonars of {row['triangles']} triangles: {row['mb']:.1f} MB, of which the scene without "
              f"sonars is {row['mb_scene']:.1f} MB")
