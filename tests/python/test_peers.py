"""The figures of scripts/research/peers on synthetic arrays with known answers, and Insonify's own adapter in a short form."""

import os
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT

PEERS = ROOT / "scripts/research/peers"
sys.path.insert(0, str(PEERS))

import case  # noqa: E402
import metrics  # noqa: E402
import sheet  # noqa: E402

rng = np.random.default_rng(5)


def test_the_peak_of_a_gaussian_pulse_is_found_between_its_bins():
    ranges = np.arange(9, 11, 0.01)
    truth = np.array([9.5, 9.7034, 10.2081])
    echoes = np.exp(-(((ranges - truth[:, None]) / 0.03) ** 2))
    assert metrics.range_error(ranges, echoes, truth) < 1e-9
    assert metrics.range_error(ranges, echoes, truth + 0.004) == pytest.approx(0.004)
    assert np.isfinite(metrics.peak(ranges, np.zeros(len(ranges))))


@pytest.mark.parametrize("elements, sidelobe", [(200, -13.26), (8, -12.80)])
def test_a_uniform_array_has_its_width_and_sidelobe(elements, sidelobe):
    sine = np.linspace(-0.2, 0.2, 8001)
    phase = np.pi * 0.1 * sine * 200 / elements
    with np.errstate(invalid="ignore"):
        pattern = np.where(phase == 0, 1, (np.sin(elements * phase) / (elements * np.sin(phase)))) ** 2
    assert metrics.beam_width(sine, pattern) == pytest.approx(0.886 / 20, rel=0.01)
    assert metrics.first_sidelobe(pattern) == pytest.approx(sidelobe, abs=0.05)


def test_a_beam_without_sidelobes_has_none():
    angle = np.linspace(-1, 1, 401)
    assert metrics.first_sidelobe(np.exp(-((angle / 0.2) ** 2))) == -np.inf


@pytest.mark.parametrize("exponent", [0, 1, 2])
def test_the_slope_of_a_floor_is_its_exponent(exponent):
    ranges = np.arange(6, 18, 0.01)
    energy = ranges**-3 * (5 / ranges) ** exponent
    slope, error = metrics.floor_slope(ranges, energy[None], 5.0, case.FLOOR_RANGES)
    assert slope == pytest.approx(exponent, abs=0.003) and error < 0.003
    speckled = energy * rng.exponential(size=(16, len(ranges)))
    slope, error = metrics.floor_slope(ranges, speckled, 5.0, case.FLOOR_RANGES)
    assert abs(slope - exponent) < 4 * error < 0.2


def test_target_strength_is_relative_to_the_reference():
    assert metrics.target_strength(np.array([0, 1, 3.0]), np.array([40.0])) == pytest.approx(-10)


def test_speckle_of_rayleigh_amplitudes_differs_from_other_laws():
    mean = 1 + np.arange(160) / 50                                # which normalised() takes out
    exponential = mean * rng.exponential(size=(60, 3, 160))
    assert metrics.contrast(exponential) == pytest.approx(1, abs=0.03)
    assert metrics.distance_to_exponential(exponential) < 0.02
    heavy = exponential * rng.gamma(1.0, size=exponential.shape)   # K-distributed with the shape 1
    assert metrics.contrast(heavy) == pytest.approx(np.sqrt(3), abs=0.2)
    assert metrics.distance_to_exponential(heavy) > 0.1
    assert metrics.contrast(mean * np.ones((60, 3, 160))) < 0.05


def test_correlations_of_an_array_that_moves_follow_the_closed_form():
    """Fields of beams over scatterers whose phases turn with twice the way of the array."""
    wavelength, elements, cells, pings = 0.005, 32, 100, 60
    sine = rng.uniform(-0.5, 0.5, (cells, 500))
    place = (np.arange(elements) - 15.5) * wavelength / 2
    pattern = np.exp(2j * np.pi / wavelength * place[:, None, None] * sine).mean(0)
    shift = case.APERTURE * np.array([0, 0.1, 0.1464, 0.3])
    assert case.APERTURE == pytest.approx(elements * wavelength / 2)

    turned = [pattern * np.exp(4j * np.pi / wavelength * x * sine) for x in shift]
    strengths = rng.normal(size=(pings, *sine.shape)) + 1j * rng.normal(size=(pings, *sine.shape))
    intensity = np.abs([[(strength * each).sum(-1) for each in turned] for strength in strengths])[:, :, None] ** 2
    found = metrics.correlations(intensity)
    assert found == pytest.approx(metrics.aperture_correlation(shift, case.APERTURE), abs=0.03)
    assert found[0] == pytest.approx(1)


def test_the_closed_form_is_a_half_at_0_146_of_the_aperture():
    assert metrics.aperture_correlation(0.1464, 1.0) == pytest.approx(0.5, abs=1e-3)
    assert metrics.aperture_correlation(0.6, 1.0) == 0


def test_insonify_is_measured_and_the_sheet_is_written(tmp_path):
    command = [sys.executable, PEERS / "run", "--short", "--out", tmp_path, "insonify"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, env=os.environ)
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "sheet.md").read_text()
    assert text in done.stdout
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    assert rows[0][2].startswith("Insonify ") and {len(row) for row in rows} == {3}
    assert len(rows) == 2 + sum(len(row[2]) for row in sheet.ROWS)
    peer = sheet.Peer(tmp_path / "insonify")
    assert set(peer.cells) == set(case.EXPERIMENTS)
    assert float(peer.cells["points"][0]) < 0.1
    assert float(peer.cells["beam"][0]) == pytest.approx(3.17, abs=0.02)
    assert float(peer.cells["beam"][1]) == pytest.approx(-13.26, abs=0.1)
    assert float(peer.cells["floor"][0].split()[0]) == pytest.approx(2, abs=0.01)
    assert float(peer.cells["sphere"][0]) == pytest.approx(-18.06, abs=0.5)
    assert float(peer.cells["motion"][0]) == pytest.approx(0.5, abs=0.15)


def test_a_python_without_numpy_uses_that_of_the_build_from_the_first_scene_to_the_sheet(tmp_path):
    """The run of a venv that has no packages; the Python of its build is this one."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "bare"], check=True)
    (tmp_path / "venv/bin").mkdir(parents=True)
    python = tmp_path / "venv/bin/python"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    command = [tmp_path / "bare/bin/python", PEERS / "run", "--short", "--out", tmp_path / "out", "insonify"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, env={**os.environ, "INSONIFY_BUILD": str(tmp_path)})
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out/sheet.md").read_text().startswith("| figure | closed form | Insonify ")


def test_an_unknown_simulator_is_refused():
    done = subprocess.run([sys.executable, PEERS / "run", "nobody"], capture_output=True, text=True)
    assert done.returncode == 2 and "nobody: is none of insonify, openstb" in done.stderr
