"""Installations and builds by scripts/setup and scripts/run. Stand-ins for the system's commands record their
arguments."""

import os
import shutil
import subprocess

import pytest
from conftest import ROOT

COMMANDS = {
    "dpkg-query": 'grep -qx "${@: -1}" installed && echo installed',
    "apt-cache": '! grep -qx "$2" unknown',
    "apt-get": 'echo "apt-get $*" >>asked',
    "dpkg": '[ "$1" != --audit ] && echo "dpkg $*" >>asked || cat interrupted',
    "sudo": 'exec "$@"',
}


def packages(*folders):
    return [name for folder in folders for name in (ROOT / folder / "packages").read_text().split()]


@pytest.fixture
def system(tmp_path):
    """A clone, and a system that has the packages of the core."""
    for folder in ("components", "types", "tests", "deploy"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    (tmp_path / "scripts").mkdir()
    for script in ("run", "setup", "requirements.txt"):
        shutil.copy(ROOT / "scripts" / script, tmp_path / "scripts")
    stand_in(tmp_path / "scripts/build", 'echo "build $*" >>asked; sleep "${BUILD_SECONDS:-0}"')
    for name, line in COMMANDS.items():
        stand_in(tmp_path / "commands" / name, line)
    stand_in(tmp_path / "build/bin/insonify", '[ "$1" = libraries ] && cat libraries || echo "insonify $*" >>asked')
    (tmp_path / "build/targets").touch()
    (tmp_path / "libraries").touch()
    (tmp_path / "unknown").touch()
    (tmp_path / "interrupted").touch()
    core = [folder for folder in (ROOT / "components").glob("*/packages") if not is_optional(folder.parent.name)]
    names = packages("components", "types", *(folder.parent.relative_to(ROOT) for folder in core))
    (tmp_path / "installed").write_text("\n".join(names) + "\n")
    return tmp_path


def is_optional(component):
    built = (ROOT / "components" / component / "CMakeLists.txt").read_text()
    return component in ("python", "meshes") or "insonify_component(" in built


def stand_in(file, line):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(f"#!/usr/bin/env bash\n{line}\n")
    file.chmod(0o755)


def asked(system, script, *arguments, path=None):
    """Returns the commands that the script ran, and its output."""
    (system / "asked").write_text("")
    done = subprocess.run(
        [f"scripts/{script}", *arguments],
        cwd=system,
        env=os.environ | {"PATH": path or f"{system}/commands:{os.environ['PATH']}"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    return done.returncode, (system / "asked").read_text().splitlines(), done.stderr


def installed(lines):
    return [line.split("--no-install-recommends ")[1].split() for line in lines if " install " in line]


def test_with_all_packages_only_the_core_is_built(system):
    assert asked(system, "setup", "insonify") == (0, ["build build -- insonify"], "")


def test_missing_packages_of_the_core_are_installed_first(system):
    lacks = ["libyaml-cpp-dev", "libepoxy-dev"]
    there = (system / "installed").read_text().split()
    assert set(lacks) <= set(there)
    (system / "installed").write_text("\n".join(name for name in there if name not in lacks) + "\n")
    code, lines, _ = asked(system, "setup", "insonify")
    assert code == 0
    assert [sorted(names) for names in installed(lines)] == [sorted(lacks)]
    assert lines[-1] == "build build -- insonify"
    assert not (system / "build/targets").exists(), "CMake searches again"


def test_a_component_library_installs_only_its_own_packages(system):
    code, lines, _ = asked(system, "setup", "survey")
    assert code == 0
    assert installed(lines) == [packages("components/survey")]
    assert lines[-1] == "build build -- insonify_component_survey"


def test_sdf_installs_the_library_of_its_meshes(system):
    code, lines, _ = asked(system, "setup", "sdf")
    assert code == 0
    assert sorted(installed(lines)[0]) == sorted(packages("components/sdf", "components/meshes"))
    assert lines[-1] == "build build -- insonify_component_sdf insonify_component_meshes"


def test_a_package_unknown_to_the_system_omits_its_library(system):
    (system / "unknown").write_text("\n".join(packages("components/sdf")) + "\n")
    code, lines, said = asked(system, "setup", "sdf")
    assert code == 0
    assert lines[-1] == "build build -- insonify_component_sdf insonify_component_meshes"
    assert installed(lines) == [packages("components/meshes")]
    for name in packages("components/sdf"):
        assert f"this system has no package {name}; the parts of components/sdf that need it are omitted" in said


def test_without_a_package_of_the_core_setup_fails_with_a_message(system):
    there = (system / "installed").read_text().split()
    (system / "installed").write_text("\n".join(name for name in there if name != "libyaml-cpp-dev") + "\n")
    (system / "unknown").write_text("libyaml-cpp-dev\n")
    code, lines, said = asked(system, "setup", "insonify")
    assert code == 1
    assert said == "scripts/setup: this system has no package libyaml-cpp-dev, which components/framework needs\n"
    assert not installed(lines)


def test_a_run_sets_up_the_libraries_of_its_deployment(system):
    (system / "libraries").write_text("viewer\nsurvey\n")
    code, lines, _ = asked(system, "run", "mine.yml", "--duration", "1")
    assert code == 0
    assert sorted(installed(lines)[0]) == sorted(packages("components/viewer", "components/survey"))
    assert lines[0] == "build build -- insonify"
    assert lines[-2:] == [
        "build build -- insonify_component_viewer insonify_component_survey",
        "insonify run mine.yml --duration 1",
    ]


def test_without_a_deployment_the_harbour_is_run(system):
    code, lines, _ = asked(system, "run", "--duration", "1")
    assert code == 0
    assert lines == [
        "build build -- insonify",
        f"insonify run {system}/deploy/harbour_fls.yml --duration 1",
    ]


def test_tests_are_configured_for_their_targets_alone(system):
    everything = [str(file) for folder in ("components", "types", "tests", "scripts") for file in (ROOT / folder).rglob("packages")]
    names = [name for file in everything for name in open(file).read().split()]
    (system / "installed").write_text("\n".join(names) + "\n")
    (system / "build/venv").mkdir()
    wanted = [file.read_text() for file in (ROOT / "components").glob("*/requirements.txt")]
    (system / "build/venv/installed").write_text("".join(wanted))
    assert asked(system, "setup", "sonar_test") == (0, ["build build -DINSONIFY_TESTS=ON -- sonar_test"], "")
    assert asked(system, "setup", "insonify", "sdf")[1] == [
        "build build -- insonify insonify_component_sdf insonify_component_meshes"
    ]


def test_an_interrupted_installation_is_completed_first(system):
    (system / "interrupted").write_text("libyaml-cpp-dev is half installed\n")
    assert asked(system, "setup", "insonify")[1] == ["build build -- insonify"], "there is nothing to install"
    there = (system / "installed").read_text().split()
    (system / "installed").write_text("\n".join(name for name in there if name != "libyaml-cpp-dev") + "\n")
    code, lines, said = asked(system, "setup", "insonify")
    assert code == 0
    assert lines[0] == "dpkg --configure -a"
    assert "an installation of packages was interrupted" in said


def test_two_at_once_wait_for_each_other(system):
    (system / "asked").write_text("")
    environment = os.environ | {"PATH": f"{system}/commands:{os.environ['PATH']}", "BUILD_SECONDS": "1"}
    both = [
        subprocess.Popen(["scripts/setup", "insonify"], cwd=system, env=environment, stderr=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    said = "".join(each.communicate()[1] for each in both)
    assert [each.returncode for each in both] == [0, 0]
    assert said == "scripts/setup: waits for another set-up of this clone\n"
    assert (system / "asked").read_text() == 2 * "build build -- insonify\n"


def test_a_system_without_debian_packages_is_built_with_what_it_has(system):
    for name in ("bash", "env", "sed", "cat", "basename", "dirname", "mkdir", "flock", "sleep"):
        (system / "few" / name).parent.mkdir(exist_ok=True)
        (system / "few" / name).symlink_to(shutil.which(name))
    (system / "installed").write_text("")
    code, lines, said = asked(system, "setup", "insonify", path=str(system / "few"))
    assert (code, lines) == (0, ["build build -- insonify"])
    assert said == "scripts/setup: this system has no Debian packages, so none are installed; CMake names what is missing\n"
