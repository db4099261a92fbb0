"""Reports of studies and of beams, plotted by scripts/plot."""

import subprocess
import sys

import pytest
from conftest import INSONIFY, ROOT

pytest.importorskip("matplotlib")


def plot(*arguments):
    return subprocess.run([sys.executable, ROOT / "scripts/plot", *arguments], capture_output=True, text=True, timeout=300)


def study(tmp_path, *arguments):
    out = tmp_path / "report"
    subprocess.run([INSONIFY, "study", *arguments, "--out", out], check=True, capture_output=True, timeout=600)
    return out


def test_an_error_is_plotted_for_each_scene_and_printed(tmp_path):
    out = study(tmp_path, "error", "--scene", "flat_bottom", "--levels", "2", "--pings", "1")
    done = plot(out)
    assert done.returncode == 0, done.stderr
    assert "<svg" in (out / "error_time_flat_bottom.svg").read_text()
    assert "| flat_bottom | published (Cerqueira 2017) |" in done.stdout


@pytest.mark.parametrize("name", ["multipath", "speckle"])
def test_other_studies_are_plotted_into_a_folder(tmp_path, name):
    drawn = tmp_path / "drawn"
    done = plot(study(tmp_path, name), "--to", drawn)
    assert done.returncode == 0, done.stderr
    assert "<svg" in (drawn / f"{name}.svg").read_text()


def test_a_beam_is_plotted(tmp_path):
    file = tmp_path / "beam.json"
    command = [INSONIFY, "beam", ROOT / "deploy/harbour_recording.yml", "--json"]
    file.write_bytes(subprocess.run(command, check=True, capture_output=True, timeout=300).stdout)
    done = plot(file)
    assert done.returncode == 0, done.stderr
    assert "<svg" in (tmp_path / "beam.svg").read_text()


def test_the_stages_of_a_run_are_plotted(tmp_path):
    file = tmp_path / "summary.json"
    command = [INSONIFY, "run", ROOT / "deploy/minimal.yml", "--pings", "3", "--summary", file, "--out", tmp_path / "out", "--quiet"]
    subprocess.run(command, check=True, capture_output=True, timeout=300)
    done = plot(file)
    assert done.returncode == 0, done.stderr
    drawn = (tmp_path / "summary.svg").read_text()
    assert all(f"<!-- {name} -->" in drawn for name in ("sonar", "fan")), drawn[:2000]


def test_a_folder_without_a_report_is_refused(tmp_path):
    done = plot(tmp_path)
    assert done.returncode == 2
    assert "has no report of a study" in done.stderr
