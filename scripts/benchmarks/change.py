"""A change in one file, to a passed test of it; and the quick tests after it: in a copy of the clone, with a warm compiler cache."""
import shutil
import subprocess
import time

from benchmarks.common import BENCH, ROOT, fail

COPY = BENCH / "change"
CHANGES = {  # what is changed, and the tests of it
    "components/sonar/beams/Directivity.cpp": "LineArrayTest.*:PatternedPingTest.*",
    "components/sonar/rays/TilePatches.cpp": "FootprintTest.*",
    "tests/sonar/BinGridTest.cpp": "BinGridTest.*",
}


def run(*command):
    subprocess.run(command, cwd=COPY, stdout=subprocess.DEVNULL, check=True)


def timed(*commands):
    begin = time.monotonic()
    for command in commands:
        run(*command)
    return time.monotonic() - begin


def copy_clone():
    shutil.rmtree(COPY, ignore_errors=True)
    names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout
    for name in filter(None, names.split("\0")):
        (COPY / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, COPY / name, follow_symlinks=False)


def measure_changes(unity):
    run("scripts/build", "build", "-DINSONIFY_TESTS=ON", f"-DINSONIFY_UNITY={unity}", "--", "sonar_test")
    times = {}
    for name, tests in CHANGES.items():
        listed = subprocess.run(["build/bin/sonar_test", "--gtest_list_tests", f"--gtest_filter={tests}"], cwd=COPY, stdout=subprocess.PIPE, text=True, check=True)
        if "\n  " not in listed.stdout:
            fail(f"sonar_test, which has no {tests},", 1)
        with open(COPY / name, "a") as source:  # code, since the cache knows the file without a comment too
            source.write(f"namespace {{ [[maybe_unused]] constexpr int changed_{time.time_ns()} = 0; }}\n")
        times[name] = timed(("scripts/build", "build", "--", "sonar_test"), ("build/bin/sonar_test", f"--gtest_filter={tests}", "--gtest_brief=1"))
    return times


def measure_change(_options):
    copy_clone()
    result = {"together": measure_changes("ON"), "file by file": measure_changes("OFF")}
    run("scripts/build", "build", "-DINSONIFY_UNITY=ON", "--", "all")
    quick = timed(("scripts/test", "--quick"))
    shutil.rmtree(COPY)
    return {"changes_s": result, "quick_s": quick}


def show_change(measured):
    print("a change in one file, to its passed tests [s]")
    for how, times in measured["changes_s"].items():
        for name, seconds in times.items():
            print(f"  {f'{name}, {how}':70}{seconds:6.1f}")
    print(f"scripts/test --quick after that, with nothing to build [s] {measured['quick_s']:.0f}")
