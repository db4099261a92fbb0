"""Scripts in Python, most of which people run by hand: each compiles with Debian's Python; and what scripts/card compares."""

import importlib.machinery
import importlib.util
import time

import pytest
from conftest import ROOT

SCRIPTS = [
    file
    for file in sorted((ROOT / "scripts").rglob("*"))
    if file.is_file() and (file.suffix == ".py" or file.read_bytes().startswith((b"#!/usr/bin/env python3", b"#!/usr/bin/python3")))
]


@pytest.mark.parametrize("file", SCRIPTS, ids=lambda file: str(file.relative_to(ROOT)))
def test_script_compiles(file):
    compile(file.read_text(), str(file), "exec")


def test_the_benchmarks_are_among_the_scripts():
    assert {"bench", "build.py", "wheel.py", "card", "plot"} <= {file.name for file in SCRIPTS}


@pytest.fixture
def card(monkeypatch, tmp_path):
    pytest.importorskip("numpy")
    monkeypatch.syspath_prepend(str(ROOT / "scripts"))
    loader = importlib.machinery.SourceFileLoader("card", str(ROOT / "scripts/card"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("card", loader))
    loader.exec_module(module)
    monkeypatch.setattr(module.fans, "BENCH", tmp_path)
    monkeypatch.setattr(module, "PINGS", 2)
    return module


def test_rasterised_pings_of_a_card_are_as_good_as_rays(card):
    row, agrees, device = card.compare((32, 100, 64, 2, 40), "software", time.monotonic() + 300)
    assert agrees and "llvmpipe" in device, row
    assert 0 < float(row[0]) < 50 and float(row[2]) > 0, row


def test_a_step_for_which_no_time_is_left_says_so(card):
    with pytest.raises(card.Undone, match="no time is left"):
        card.compare((32, 100, 64, 2, 40), "software", time.monotonic())


def test_a_device_that_is_not_there_is_the_reason(card):
    with pytest.raises(card.Undone, match="device"):
        card.compare((32, 100, 64, 2, 40), "77", time.monotonic() + 300)
