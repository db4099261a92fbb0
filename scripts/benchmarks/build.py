"""The build from nothing: its parts, the slowest files, and the cost of external headers."""
import collections
import os
import re
import shutil
import subprocess
import time

from benchmarks.common import BENCH, ROOT

FOLDER = BENCH / "build"
PARTS = {"core": ["insonify"], "component libraries": ["insonify_wheel"], "tests": ["all"]}


def run(*command):
    done = subprocess.run(command, env=os.environ | {"CCACHE_DISABLE": "1"}, stdout=subprocess.PIPE, text=True, check=True)
    return done.stdout


def slowest_files():
    """Seconds from begin to end of each object, compiled in parallel with others."""
    files = []
    for line in (FOLDER / ".ninja_log").read_text().splitlines()[1:]:
        begin, end, _, output, _ = line.split("\t")
        if output.endswith(".o"):
            name = re.sub(r"CMakeFiles/[^/]*\.dir/", "", output.removesuffix(".o"))
            files.append({"file": name, "s": (int(end) - int(begin)) / 1e3})
    return sorted(files, key=lambda each: -each["s"])


def headers():
    """The external headers that our files include: the number of files that get each, directly or not, and its
    compile time alone."""
    included = set()
    for folder in ("types", "components", "tests"):
        for source in (ROOT / folder).rglob("*.[ch]pp"):
            included |= set(re.findall(r"^#include <([^>]*[./][^>]*)>", source.read_text(), re.MULTILINE))
    users = collections.Counter()
    for line in run("ninja", "-C", FOLDER, "-t", "deps").splitlines():
        if line.startswith("    /usr/"):
            users.update(name for name in included if line.endswith("/" + name))
    flags = ["-std=c++20", "-O2", "-w", "-fsyntax-only", "-x", "c++", "-I/usr/include/opencv4", "-"]
    costs = []
    for name, count in users.items():
        begin = time.monotonic()
        if subprocess.run(["c++", *flags], input=f"#include <{name}>\n", text=True, stderr=subprocess.DEVNULL).returncode == 0:
            alone = time.monotonic() - begin
            costs.append({"header": name, "files": count, "alone_s": alone, "s": alone * count})
    return sorted(costs, key=lambda each: -each["s"])


def measure_build(_options):
    shutil.rmtree(FOLDER, ignore_errors=True)
    run("cmake", "-S", ROOT, "-B", FOLDER, "-G", "Ninja", "-DINSONIFY_TESTS=ON")
    parts = {}
    for name, targets in PARTS.items():
        begin = time.monotonic()
        run("ninja", "-C", FOLDER, *targets)
        parts[name] = time.monotonic() - begin
    return {"parts_s": parts, "files": slowest_files()[:10], "headers": headers()[:10]}


def show_build(measured):
    print("build from nothing, without a compiler cache [s]")
    for name, seconds in measured["parts_s"].items():
        print(f"  {name:58}{seconds:8.0f}")
    print("slowest files [s]")
    for each in measured["files"]:
        print(f"  {each['file']:58}{each['s']:8.1f}")
    print("external headers: files that get them, seconds of one, and of all")
    for each in measured["headers"]:
        print(f"  {each['header']:38}{each['files']:10}{each['alone_s']:10.2f}{each['s']:8.0f}")
