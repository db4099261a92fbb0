"""The site of the project's pages, built like a user would."""

import json
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from conftest import ROOT

pytest.importorskip("material", reason="mkdocs-material is not installed; scripts/setup installs it")

PAGES = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"] + [
    str(page.relative_to(ROOT)) for folder in ("components", "types", "deploy", "ros2") for page in (ROOT / folder).rglob("*.md")
]


def build(script, out):
    return subprocess.run([sys.executable, script, "--out", out], capture_output=True, text=True)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    out = tmp_path_factory.mktemp("site")
    done = build(ROOT / "scripts/site", out)
    assert done.returncode == 0 and done.stdout == f"{out}/index.html\n", done.stderr
    return out


class Links(HTMLParser):
    """The links and pictures of a page, and the anchors that it has."""

    def __init__(self, page):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(page.read_text())

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.anchors.add(attrs.get("id"))
        link = attrs.get("href") if tag == "a" else attrs.get("src") if tag == "img" else None
        if link and not urlsplit(link).scheme:
            self.links.append(urlsplit(link))


def html_of(page):
    return Path(page).with_suffix(".html") if Path(page).name != "README.md" else Path(page).parent / "index.html"


def test_every_page_exists_and_no_link_is_broken(site):
    pages = {path: Links(path) for path in site.rglob("*.html") if path.name != "404.html"}
    assert set(pages) == {site / html_of(page) for page in PAGES}
    links = 0
    for path, page in pages.items():
        for link in page.links:
            target = (path.parent / unquote(link.path)).resolve() if link.path else path
            target = target / "index.html" if target.is_dir() else target
            assert target.is_file(), (path, link)
            if link.fragment and target in pages:
                assert unquote(link.fragment) in pages[target].anchors, (path, link)
            links += 1
    assert links > 1000


def test_the_search_finds_a_section(site):
    found = json.loads((site / "search/search_index.json").read_text())["docs"]
    assert any(entry["location"] == "components/sonar/EFFECTS.html#thin-walls" for entry in found)


@pytest.mark.parametrize("page, fault", [("[a](nowhere)", "nowhere"), ("[a](#nowhere)", "#nowhere")])
def test_a_broken_link_is_an_error(tmp_path, page, fault):
    for name in PAGES + ["scripts/site"]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(f"# {name}\n\nText.\n")
    shutil.copy(ROOT / "scripts/site", tmp_path / "scripts/site")
    assert build(tmp_path / "scripts/site", tmp_path / "out").returncode == 0
    (tmp_path / "types/README.md").write_text("# Types\n\n" + page + "\n")
    done = build(tmp_path / "scripts/site", tmp_path / "out")
    assert done.returncode == 1 and fault in done.stderr
