"""The Python code of the README and of the module's page runs as it is, and so does the example."""

import re
import subprocess
import sys

import pytest
from conftest import INSONIFY, ROOT

pytestmark = pytest.mark.slow

BLOCKS = {
    page: re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)
    for page in ("README.md", "components/python/README.md")
}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "deploy").symlink_to(ROOT / "deploy")
    command = [INSONIFY, "run", "deploy/harbour_fls.yml", "--pings", "2", "--quiet"]
    subprocess.run(command, cwd=tmp_path, check=True, timeout=600)
    return tmp_path


def test_every_block_runs(folder):
    assert [len(blocks) for blocks in BLOCKS.values()] == [1, 5]
    for block in sum(BLOCKS.values(), []):
        if "gym" in block:
            pytest.importorskip("gymnasium")
        done = subprocess.run([sys.executable, "-c", block], cwd=folder, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, block + done.stderr


def test_the_example_plots(tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "look.png"
    example = ROOT / "components/python/examples/look.py"
    subprocess.run([sys.executable, example, ROOT / "deploy/harbour_fls.yml", picture], check=True, timeout=900)
    assert picture.read_bytes().startswith(b"\x89PNG") and picture.stat().st_size > 50_000
