"""`vs.explore`: a page served from Python, what it begins with, and how it ends."""

import re
import sys
import tomllib
import urllib.error
import urllib.request

import pytest
from support import ROOT
from support.explorers import answers

import vibro_sweep as vs

pytest.importorskip("uvicorn")
from websockets.sync.client import connect

SYSTEM = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
SHORT = {"transient": 10, "record": 4}


def first_view(page):
    host, token = page.url.removeprefix("http://").split("/?token=")
    with connect(f"ws://{host}/socket?token={token}", origin=f"http://{host}") as socket:
        return answers(socket, "open", 1)[0]["view"]


def test_a_system_along_a_number(capsys):
    page = vs.explore(SYSTEM, "omega", bounds=(0.5, 0.7))
    assert capsys.readouterr().out == f"{page.url}\n" and page.url in repr(page) and page.url in page._repr_html_()
    with urllib.request.urlopen(page.url) as answer:
        assert answer.status == 200 and "localhost:*" in answer.headers["content-security-policy"]
    with pytest.raises(urllib.error.HTTPError, match="403"):
        urllib.request.urlopen(page.url[:-3] + "abc")
    view = first_view(page)
    assert (view["axis"], view["low"], view["high"]) == ("omega", 0.5, 0.7) and view["system"]["R"] == 0.8
    page.close()
    page.close()
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(page.url)


@pytest.mark.slow
def test_sweeps_begin_with_their_view(tmp_path, capsys):
    ball = vs.Oscillator.named("one_mass", F=1, omega=1, zeta=0.1, R=0.7, b=1)
    data = vs.sweep(ball, {"F": [0.5, 1.5]}, output=tmp_path / "ball.h5", **SHORT)
    (tmp_path / "ball.yaml").write_text(data.attrs["scene"])
    for one in (data, tmp_path / "ball.h5", str(tmp_path / "ball.yaml"), vs.load_scene(tmp_path / "ball.yaml")):
        page = vs.explore(one)
        view = first_view(page)
        page.close()
        assert (view["axis"], view["low"], view["high"], view["record"]) == ("F", 0.5, 1.5, 4)
    page = vs.explore(ball)
    view = first_view(page)
    page.close()
    assert (view["axis"], view["low"], view["high"]) == ("b", 0.5, 1.5)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((SYSTEM, "gravity"), "parameter: 'gravity' is not allowed; it must be one of mu_m"),
        ((SYSTEM, "b", (7, 8)), "around 6.0"),
        ((SYSTEM, "b", 3), "around 6.0"),
        ((3,), "system: 3 is not allowed"),
        ((None,), "system: None is not allowed"),
        (("nothing.yaml",), "nothing.yaml"),
        (("nothing.h5",), "nothing.h5"),
    ],
)
def test_what_is_refused(arguments, told):
    with pytest.raises((ValueError, TypeError, OSError), match=told):
        vs.explore(*arguments)


def test_other_refusals():
    scene = vs.load_scene("configs/quickstart.yaml")
    with pytest.raises(ValueError, match="is swept already"):
        vs.explore(scene, "b")
    built = vs.sweep(lambda q: SYSTEM.replace(b=q), {"q": [5, 6]}, **SHORT)
    with pytest.raises(ValueError, match="the Dataset sweeps a function"):
        vs.explore(built)


def test_without_the_extra(monkeypatch):
    """The message and the README say what is needed in the same words, and pyproject.toml has it."""
    monkeypatch.delitem(sys.modules, "vibro_sweep.live.server", raising=False)
    monkeypatch.setitem(sys.modules, "uvicorn", None)
    with pytest.raises(vs.VibroSweepError, match=r"explore needs .* \(uvicorn is not there\)$") as refused:
        vs.explore(SYSTEM)
    needs = str(refused.value).removeprefix("explore ").partition(" (")[0]
    assert needs in " ".join((ROOT / "README.md").read_text().replace("`", "").split())
    extra = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]["explore"]
    packages = re.fullmatch(r"needs the packages (.*): pip install 'vibro_sweep\[explore\]'", needs)[1]
    assert re.split(", | and ", packages) == [package.partition(">=")[0] for package in extra]
