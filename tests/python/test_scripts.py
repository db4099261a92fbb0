"""Scripts in Python, most of which people run by hand: each compiles with Debian's Python."""

import pytest
from conftest import ROOT

SCRIPTS = [
    file
    for file in sorted((ROOT / "scripts").rglob("*"))
    if file.is_file() and (file.suffix == ".py" or file.read_bytes().startswith(b"#!/usr/bin/env python3"))
]


@pytest.mark.parametrize("file", SCRIPTS, ids=lambda file: str(file.relative_to(ROOT)))
def test_script_compiles(file):
    compile(file.read_text(), str(file), "exec")


def test_the_benchmarks_are_among_the_scripts():
    assert {"bench", "build.py", "wheel.py"} <= {file.name for file in SCRIPTS}
