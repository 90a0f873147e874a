"""The site of the documentation is whole: built strictly, links lead somewhere, equations are MathML, keys of scenes are listed."""

import re
import subprocess
import sys
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit

import pytest
from conftest import ROOT


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.ids = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ("href", "src") and value:
                self.links.append(value)
            if name in ("id", "name") and value:
                self.ids.add(value)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    for module in ("mkdocs", "material", "mkdocstrings_handlers.python", "latex2mathml"):
        pytest.importorskip(module)
    folder = tmp_path_factory.mktemp("site")
    build = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)]
    said = subprocess.run(build, cwd=ROOT, capture_output=True, text=True)
    assert said.returncode == 0, said.stderr
    return folder


def test_links_of_the_site_lead_somewhere(site):
    pages = {p: Page(p.read_text(encoding="utf-8")) for p in site.rglob("*.html") if p.name != "404.html"}
    assert len(pages) > 20
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                # nothing is loaded from elsewhere; what made the site may be named
                assert parts.scheme in ("data", "mailto") or "mkdocs" in link, f"{path}: {link}"
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            assert target.exists(), f"{path}: {link}"
            if parts.fragment and target in pages:
                assert unquote(parts.fragment) in pages[target].ids, f"{path}: {link}"


def test_the_site_shows_the_program_the_movie_equations_and_the_api(site):
    front = (site / "index.html").read_text(encoding="utf-8")
    assert "discharge.webp" in front and "topobatteries" in front
    assert "<math" in (site / "tradeoff.html").read_text(encoding="utf-8")
    assert "<math" in (site / "notebooks/how-accurate.html").read_text(encoding="utf-8")
    api = Page((site / "api.html").read_text(encoding="utf-8"))
    assert {"topobatteries.Rod", "topobatteries.Result.table", "topobatteries.RodDischarge.after_cut", "topobatteries.Rod.ropelength", "topobatteries.Colloid.charge"} <= api.ids
    assert "7_4" in (site / "search/search_index.json").read_text(encoding="utf-8")


def test_the_front_page_has_the_program_of_the_readme():
    program = re.search(r"```python\n(.*?)```", (ROOT / "crates/topo-py/README.md").read_text(encoding="utf-8"), re.S)
    assert program[0] in (ROOT / "docs/index.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("which", ["quick", "small"])
def test_the_reference_lists_every_key_of_a_scene(which, request):
    reference = (ROOT / "docs/scenes.md").read_text(encoding="utf-8")
    written = (request.getfixturevalue(which).folder / "scene.toml").read_text(encoding="utf-8")
    keys = re.findall(r"^(\w+) =", written, re.M)
    assert len(keys) > 20
    missing = [key for key in keys if not re.search(rf"\b{key}\b", reference)]
    assert not missing
