"""scripts/pictures: its table is complete and right, and some pictures come out as they are in the project."""

import importlib.machinery
import importlib.util
import re
import shlex
import subprocess
import sys

import pytest
from conftest import INSONIFY, ROOT

np = pytest.importorskip("numpy")
Image = pytest.importorskip("PIL.Image")

ALIKE = 2.0  # mean difference of levels, of 255: another processor rounds otherwise


@pytest.fixture(scope="module")
def pictures():
    loader = importlib.machinery.SourceFileLoader("pictures", str(ROOT / "scripts/pictures"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("pictures", loader))
    sys.modules["pictures"] = module  # for its dataclasses
    loader.exec_module(module)
    return module


def shown_in(page, text):
    """The files of pictures that a page shows, without thumbnails (`<img>`); the page itself where it is a notebook with pictures."""
    if page.endswith(".ipynb"):
        return {page} if '"image/png"' in text else set()
    return {str(((ROOT / page).parent / each).resolve().relative_to(ROOT)) for each in re.findall(r"!\[[^\]]*\]\(([^)\s]+)\)", text)}


def commands_in(text):
    """The text of a page with each command in one line."""
    return "\n".join(" ".join(line.split()) for line in text.replace("\\\n", " ").splitlines())


def faults(table, pages, tree, help_of):
    """What is wrong in a table: by name the path, commands and whether it is drawn; pages by path; the pictures of the tree."""
    found = [f"{path} has {n} entries" for path in tree if (n := [each["path"] for each in table.values()].count(path)) != 1]
    shown = {path: {page for page, text in pages.items() if path in shown_in(page, text)} for path in {each["path"] for each in table.values()}}
    for name, each in table.items():
        if each["path"] not in tree:
            found.append(f"{name}: {each['path']} is not there")
        if not shown[each["path"]]:
            found.append(f"{name}: no page shows it")
        if not each["commands"] and not each["drawn"]:
            found.append(f"{name}: neither drawn nor made by a command")
        for page in shown[each["path"]]:
            text = commands_in(pages[page])
            refers = re.search(rf"scripts/pictures [\w ]*\b{name}\b", text)
            if not each["drawn"] and page != each["path"] and not refers and not all(command in text for command in each["commands"]):
                found.append(f"{name}: {page} shows it, and prints neither its commands nor scripts/pictures {name}")
        for command in each["commands"]:
            words = shlex.split(command)
            known = help_of(words[1]) if words[0] == "insonify" else words[0] in ("sed", "python3", "build/yolo/bin/yolo") or (ROOT / words[0]).is_file()
            if not known:
                found.append(f"{name}: there is no {' '.join(words[:2])}")
    return found


@pytest.fixture(scope="module")
def described(pictures):
    table = {name: {"path": str(pictures.path_of(name)), "commands": each.commands, "drawn": each.drawn} for name, each in pictures.PICTURES.items()}
    pages = pictures.pages()
    tree = {str(file.relative_to(ROOT)) for file in (ROOT / "deploy/pictures").iterdir()}
    for page, text in pages.items():
        tree |= shown_in(page, text)
    listed = subprocess.run([INSONIFY, "--help"], capture_output=True, text=True, check=True).stdout.partition("Subcommands:")[2]
    subcommands = set(re.findall(r"^  (\w+)", listed, re.MULTILINE))
    return table, pages, tree, subcommands.__contains__


def test_every_picture_has_its_command_and_every_command_its_picture(described):
    table, pages, tree, help_of = described
    assert faults(table, pages, tree, help_of) == []
    assert len(table) > 30 and len(pages) > 40


def with_entry(table, name, **changes):
    return table | {name: table[name] | changes}


def test_faults_are_found(described):
    table, pages, tree, help_of = described
    page = "components/sonar/EFFECTS.md"
    without = {name: each for name, each in table.items() if name != "vessels"}
    twice = table | {"again": table["vessels"]}
    unshown = pages | {page: pages[page].replace("vessels.png", "none.png")}
    other = "components/sonar/README.md"
    unprinted = pages | {other: pages[other].replace("insonify run deploy/harbour_altimeter.yml --set echoes.width=640", "insonify run deploy/harbour_altimeter.yml")}
    cases = [
        (without, pages, tree, "deploy/pictures/vessels.png has 0 entries"),
        (twice, pages, tree, "deploy/pictures/vessels.png has 2 entries"),
        (table, pages, tree - {"deploy/pictures/vessels.png"}, "vessels: deploy/pictures/vessels.png is not there"),
        (table, unshown, tree, "vessels: no page shows it"),
        (table, unprinted, tree, "harbour_altimeter: components/sonar/README.md shows it, and prints neither its commands nor scripts/pictures harbour_altimeter"),
        (with_entry(table, "vessels", commands=[]), pages, tree, "vessels: neither drawn nor made by a command"),
        (with_entry(table, "vessels", commands=["insonify rnu x.yml"]), pages, tree, "vessels: there is no insonify rnu"),
        (with_entry(table, "vessels", commands=["scripts/polt x"]), pages, tree, "vessels: there is no scripts/polt x"),
    ]
    for *given, fault in cases:
        found = faults(*given, help_of)
        assert any(fault in each for each in found), (fault, found)


def run(*arguments):
    return subprocess.run([sys.executable, ROOT / "scripts/pictures", *arguments], capture_output=True, text=True, timeout=600)


def test_the_list_names_page_and_command(pictures):
    listed = run("--list").stdout.splitlines()
    assert len(listed) == len(pictures.PICTURES)
    assert any(re.match(r"vessels +components/sonar/EFFECTS.md.* +insonify run deploy/vessels.yml", line) for line in listed)


def test_what_cannot_be_made_is_named_with_its_reason():
    done = run("one_ping", "tutorial_detector")
    assert done.returncode == 0, done.stderr
    assert re.fullmatch(r"one_ping: left out: drawn; .*\ntutorial_detector: left out: is not made by this script: .*\n", done.stdout), done.stdout
    unknown = run("nothing")
    assert unknown.returncode == 2 and "no picture nothing; there are crosstalk," in unknown.stderr


@pytest.mark.parametrize("name", ["tank_multipath", "materials", "vessels"])
def test_a_picture_comes_out_as_it_is_in_the_project(pictures, tmp_path, name):
    done = run("--to", tmp_path, name)
    assert done.returncode == 0, done.stderr
    kept = (ROOT / "deploy/pictures" / f"{name}.png").read_bytes()
    assert pictures.difference(kept, (tmp_path / f"{name}.png").read_bytes()) < ALIKE


def test_another_picture_is_seen_as_another(pictures):
    read = {name: (ROOT / "deploy/pictures" / f"{name}.png").read_bytes() for name in ("materials", "tank_multipath")}
    assert pictures.difference(read["materials"], read["tank_multipath"]) == float("inf"), "of another size"
    shifted = np.roll(np.asarray(Image.open(ROOT / "deploy/pictures/materials.png").convert("RGB")), 12, axis=1)
    assert pictures.difference(read["materials"], pictures.encoded(Image.fromarray(shifted), ".png")) > ALIKE
