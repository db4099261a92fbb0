"""scripts/make_headers: the page for developers is current, and sentences are those of the headers."""

import importlib.machinery
import importlib.util
import subprocess
import sys

import pytest
from conftest import ROOT


@pytest.fixture(scope="module")
def headers():
    loader = importlib.machinery.SourceFileLoader("make_headers", str(ROOT / "scripts/make_headers"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("make_headers", loader))
    loader.exec_module(module)
    return module


def test_the_page_is_current():
    done = subprocess.run([sys.executable, ROOT / "scripts/make_headers", "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("text, found", [
    ("#pragma once\n// What is here. More.\n#include <a>\n/** A thing. */\nclass One {};\n", "What is here"),
    ("#pragma once\n/** Another. */\nstruct Two {};\n/** A thing\n *  of two lines. Then more. */\nclass One {};\n", "A thing of two lines"),
    ("#pragma once\n/** Returns it, e.g. x. */\nint make();\n", "Returns it, e.g. x"),
    ("#pragma once\n/** First. */\nint make();\n/** B. */\nstruct Two final : Base {};\n/** C. */\nstd::vector<int> list(int x);\n", "First; also `Two`, `list`"),
    ("#pragma once\n/** A | b < c. */\ntemplate <class T>\nstruct One {};\n", "A \\| b &lt; c"),
])
def test_a_header_is_described_by_its_comment(headers, tmp_path, text, found):
    header = tmp_path / "One.hpp"
    header.write_text(text)
    assert headers.sentence(*headers.comment(header)) == found


@pytest.mark.parametrize("page, fault", [("# A\n\n## a\n", "has no section types, a_folder"), ("# A\n\n## types\n\n## a_folder\n", "is not up to date")])
def test_a_page_of_another_tree_is_refused(headers, monkeypatch, tmp_path, page, fault):
    for folder in ("types", "components/a_folder"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "One.hpp").write_text("#pragma once\n/** One. */\nclass One {};\n")
    at = tmp_path / "components/DEVELOP.md"
    at.write_text(page)
    monkeypatch.setattr(headers, "ROOT", tmp_path)
    monkeypatch.setattr(headers, "PAGE", at)
    monkeypatch.setattr(sys, "argv", ["make_headers", "--check"])
    with pytest.raises(SystemExit, match=fault):
        headers.main()
    assert at.read_text() == page
    if "types" in page:
        monkeypatch.setattr(sys, "argv", ["make_headers"])
        headers.main()
        assert at.read_text().count("| `One.hpp` | One |") == 2
        monkeypatch.setattr(sys, "argv", ["make_headers", "--check"])
        headers.main()
