"""The Python code of the README and of the module's page runs as it is, prints what they show, and so does the example."""

import importlib.util
import os
import re
import subprocess
import sys

import pytest
from conftest import INSONIFY, ROOT

pytestmark = pytest.mark.slow

DATA_SETS = "components/dataset/README.md"
BLOCKS = {  # code, and the text right below it, which is what it prints
    page: re.findall(r"```python\n(.*?)```(?:\n\n```text\n(.*?)```)?", (ROOT / page).read_text(), re.DOTALL)
    for page in ("README.md", "components/python/README.md", DATA_SETS)
}


def is_like(printed, shown):
    """Whether all lines that are shown are printed, with any text in place of dots."""
    return re.fullmatch(re.escape(shown).replace(r"\.\.\.", "[^\n]*"), printed) is not None


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "deploy").symlink_to(ROOT / "deploy")
    command = [INSONIFY, "run", "deploy/harbour_fls.yml", "--pings", "2", "--quiet"]
    subprocess.run(command, cwd=tmp_path, check=True, timeout=600)
    return tmp_path


def test_every_block_runs(folder):
    assert [len(blocks) for blocks in BLOCKS.values()] == [1, 5, 2]
    for block, shown in sum((blocks for page, blocks in BLOCKS.items() if page != DATA_SETS), []):
        if "gym" in block:
            pytest.importorskip("gymnasium")
        done = subprocess.run([sys.executable, "-c", block], cwd=folder, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, block + done.stderr
        assert not shown or is_like(done.stdout, shown), block + done.stdout


def test_the_loader_of_data_sets_reads_one(tmp_path):
    pytest.importorskip("PIL")
    (reading, shown), (training, _) = BLOCKS[DATA_SETS]
    made = "insonify init views\n" + re.search(r"```sh\n(insonify dataset \S+ [^\n]*--out masks[^\n]*)", (ROOT / DATA_SETS).read_text())[1]
    path = {"PATH": f"{INSONIFY.parent}:{os.environ['PATH']}"}
    subprocess.run(["bash", "-euc", made], cwd=tmp_path, check=True, capture_output=True, timeout=600, env=os.environ | path)
    has_torch = importlib.util.find_spec("torch") is not None
    compile(training, DATA_SETS, "exec")
    code = reading + (training if has_torch else "")
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert is_like("".join(done.stdout.splitlines(keepends=True)[:1]), shown), done.stdout


def test_what_a_page_shows_is_compared():
    assert [sum(bool(shown) for _, shown in blocks) for blocks in BLOCKS.values()] == [1, 1, 1]
    assert is_like("(2, 3) 1.25\nb\n", "(2, 3) 1...\nb\n")
    assert not is_like("(2, 3) 1.25\nb\n", "(2, 4) 1...\nb\n")
    assert not is_like("(2, 3) 1.25\nb\n", "(2, 3) 1...\n")


def test_the_example_plots(tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "look.png"
    example = ROOT / "components/python/examples/look.py"
    subprocess.run([sys.executable, example, ROOT / "deploy/harbour_fls.yml", picture], check=True, timeout=900)
    assert picture.read_bytes().startswith(b"\x89PNG") and picture.stat().st_size > 50_000
