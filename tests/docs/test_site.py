"""The site: it builds without a warning, every link leads somewhere, and its pages are whole in a browser."""

import json
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from support import ROOT
from support.browsers import chromium_of_playwright, served

pytestmark = pytest.mark.slow
SIZES = {"desktop": (1280, 900, "light"), "phone": (360, 740, "dark")}
MINUTES = 10


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site, built from a copy: its folder."""
    for package in ("sphinx", "myst_nb", "sphinx_gallery", "pydata_sphinx_theme"):
        pytest.importorskip(package, reason="the site is built where pip install '.[docs]' was run")
    home = tmp_path_factory.mktemp("site")
    for name in ("docs", "benchmarks", "configs"):
        built = shutil.ignore_patterns("auto_gallery", "generated", "__pycache__")
        shutil.copytree(ROOT / name, home / name, ignore=built)
    for name in ("README.md", "CHANGELOG.md", "CITATION.cff"):
        shutil.copy(ROOT / name, home)
    command = [sys.executable, "-m", "sphinx", "-W", "-b", "html", "docs", "site"]
    done = subprocess.run(command, cwd=home, capture_output=True, text=True, timeout=60 * MINUTES, check=False)
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-8000:]
    seconds = json.loads((home / "site" / "sphinx-reading-durations.json").read_text())
    for page, took in sorted(seconds.items(), key=lambda row: -row[1]):
        print(f"{took:8.1f} s  {page}")
    return home / "site"


class Page(HTMLParser):
    """What a page refers to, what it loads, and its anchors."""

    def __init__(self, path: Path):
        super().__init__()
        self.path, self.links, self.loads, self.anchors = path, [], [], set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        self.anchors |= {named[key] for key in ("id", "name") if named.get(key)}
        if tag == "a" and named.get("href"):
            self.links.append(named["href"])
        if named.get("src"):
            self.loads.append(named["src"])
        if tag == "link" and named.get("rel") in ("stylesheet", "preload", "modulepreload", "icon"):
            self.loads.append(named["href"])


@pytest.fixture(scope="module")
def pages(site):
    return {path: Page(path) for path in site.rglob("*.html") if "_static" not in path.parts}


def test_every_link_leads_somewhere(pages):
    lost = []
    for page in pages.values():
        for link in [*page.links, *page.loads]:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (page.path.parent / unquote(parts.path)).resolve() if parts.path else page.path
            there = target.exists() and (
                target not in pages or not parts.fragment or unquote(parts.fragment) in pages[target].anchors
            )
            lost += [] if there else [(page.path.name, link)]
    assert len(pages) > 30 and not lost, lost[:20]


def test_each_tutorial_can_be_downloaded_as_a_notebook(site, pages):
    tutorials = sorted((ROOT / "docs" / "tutorials").glob("*.md"))
    for name in (path.stem for path in tutorials):
        assert f"{name}.ipynb" in pages[site / "tutorials" / f"{name}.html"].links
        cells = json.loads((site / "tutorials" / f"{name}.ipynb").read_text())["cells"]
        assert any(one["cell_type"] == "code" for one in cells) and not any(one.get("outputs") for one in cells)
        words = "".join(line for one in cells if one["cell_type"] == "markdown" for line in one["source"])
        assert words and not re.search(r"\]\((?!https?:|#)", words)  # a link of the page leads nowhere from elsewhere


def test_commands_look_as_one_types_them(site):
    words = (site / "start" / "ten_minutes.html").read_text()
    assert "vibro-sweep new quickstart" in re.sub("<[^>]+>", "", words) and "%%bash" not in words


def test_the_interface_links_to_its_types_and_to_the_gallery(site, pages):
    links = pages[site / "reference" / "generated" / "vibro_sweep.sweep.html"].links
    assert any(re.search("auto_gallery/.*plot_", one) for one in links)
    assert any("vibro_sweep.types.Start" in one for one in links)


def test_nothing_is_loaded_from_another_host(pages):
    assert not [(page.path.name, one) for page in pages.values() for one in page.loads if urlsplit(one).netloc]


@pytest.fixture(scope="module")
def browser():
    with chromium_of_playwright() as opened:
        yield opened


@pytest.fixture(scope="module")
def address(site):
    """The site served on the loopback interface."""
    with served(site) as there:
        yield there


@pytest.mark.parametrize("size", SIZES)
def test_pages_are_whole(site, pages, browser, address, size):
    """Nothing is wider than the page, each picture is there, each formula is drawn, and no other host is asked."""
    width, height, scheme = SIZES[size]
    context = browser.new_context(viewport={"width": width, "height": height}, color_scheme=scheme)
    tab, wrong = context.new_page(), []
    tab.on("request", lambda one: one.url.startswith((address, "data:", f"blob:{address}")) or wrong.append(one.url))
    tab.on("pageerror", lambda error: wrong.append(str(error)))
    for path in sorted(pages):
        name = path.relative_to(site).as_posix()
        tab.goto(f"{address}/{name}", wait_until="load")
        if "MathJax" in tab.content():
            tab.wait_for_function("window.MathJax?.startup?.promise?.then(() => true)")
        too_wide = "document.documentElement.scrollWidth > document.documentElement.clientWidth"
        broken = "[...document.images].filter(one => one.complete && !one.naturalWidth).map(one => one.src)"
        undrawn = "document.querySelectorAll('mjx-merror').length"
        wrong += [(name, "wide")] if tab.evaluate(too_wide) else []
        wrong += [(name, one) for one in tab.evaluate(broken)]
        wrong += [(name, "formula")] if tab.evaluate(undrawn) else []
    context.close()
    assert not wrong, wrong[:20]


def test_search_finds(browser, address):
    tab = browser.new_page()
    tab.goto(f"{address}/search.html?q=grazing")
    tab.wait_for_selector("#search-results li a")
    assert tab.locator("#search-results li").count() >= 5
    tab.close()


def test_diagrams_move_when_they_are_asked_for(browser, site, address):
    made = [*(site / "_diagrams").glob("*.html")]
    assert len(made) == 6 and all(path.stat().st_size < 250_000 for path in made)
    tab = browser.new_page()
    tab.goto(f"{address}/start/ten_minutes.html")
    assert not any("_diagrams" in frame.url for frame in tab.frames)
    tab.click("details.diagram summary")
    tab.frame_locator("details.diagram iframe").locator("html[data-state=final]").wait_for(state="attached")
    words = tab.frame_locator("details.diagram iframe").locator("#status").inner_text()
    tab.close()
    assert words.startswith("1000 values of b")
