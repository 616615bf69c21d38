"""The one HTML file of `vs.page`: in a browser it shows what a sweep computes, and it is refused in one sentence."""

from pathlib import Path

import numpy as np
import pytest
from support.cli import scene
from support.programs import main

import vibro_sweep as vs

PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
SOFT_PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, k_stop=200.0, c_stop=1.0, b=5)


def one(**numbers):
    return vs.Oscillator.named("one_mass", zeta=0.05, F=1.0, omega=0.8, b=0.5, **numbers)


def three(**numbers):
    return vs.Oscillator.named(
        "chain", m=[1, 2, 1], k=[1] * 4, c=[0.1] * 4, force=[1, 0, 0], omega=0.7, b=0.6, **numbers,
    )  # fmt: skip


def along(name, low, high):
    return {name: {"start": low, "stop": high, "num": 1000}}


UP, DOWN = {"start": {"follow": "up"}}, {"start": {"follow": "down"}}
RIGHT, LEFT = ({"section": {"kind": "impact", "stop": stop}} for stop in ("right", "left"))
SOFT = {"k_stop": 50.0, "c_stop": 0.2}
SCENES = {
    "two masses": (PAPER, along("b", 4.2, 7), {}),
    "two masses, frequency": (PAPER, along("omega", 0.55, 0.7), {}),
    "two masses, up": (PAPER, along("b", 4.2, 7), UP),
    "two masses, down": (PAPER, along("omega", 0.55, 0.7), DOWN),
    "two masses, impacts": (PAPER, along("b", 4.2, 6.5), RIGHT),
    "two masses, impacts on the left": (PAPER, along("R", 0.5, 0.9), LEFT),
    "two masses, one stop": (PAPER.replace(stops="right"), along("b", 4.2, 7), {}),
    "two masses, one stop, impacts": (PAPER.replace(stops="right"), along("b", 4.2, 6.5), RIGHT),
    "two masses, asymmetric": (PAPER.replace(R_left=0.6, offset=0.2), along("mu_k", 4, 6), {}),
    "one mass": (one(R=0.7), along("omega", 0.6, 1.4), {}),
    "one mass, one stop": (one(R=0.7, stops="right"), along("omega", 0.6, 1.4), {}),
    "one mass, constant force": (one(R=0.7, stops="left", constant=-0.2), along("b", 0.2, 1), {}),
    "one mass, down": (one(R=0.7), along("b", 0.2, 1), DOWN),
    "one mass, compliant": (one(**SOFT), along("b", 0.3, 1.2), {}),
    "one mass, compliant, up": (one(**SOFT), along("omega", 0.6, 1.4), UP),
    "one mass, compliant, one stop": (one(**SOFT, stops="right"), along("k_stop", 10, 200), {}),
    "two masses, compliant": (SOFT_PAPER, along("b", 4.2, 7), {}),
    "three masses": (three(R=0.6), along("b", 0.3, 1.5), {}),
    "three masses, one stop": (three(R=0.6, stops="right"), along("omega", 0.5, 0.9), {}),
    "three masses, compliant": (three(**SOFT), along("b", 0.3, 1.5), {}),
}
SLIDER = """(slider => {
  slider.value = 700;
  slider.dispatchEvent(new Event("input"));
})(document.getElementById("slider-R"))"""
KEPT = """
window.kept = [];
const Own = window.Worker;
window.Worker = class extends Own {
  constructor(address) {
    super(address);
    this.tasks = new Map();
    this.addEventListener("message", ({ data }) => {
      const task = this.tasks.get(data.number);
      if (task?.kind !== "diagram" || !task.plan.lyapunov || !data.found) return;
      const { status, period, sections, lyapunov, lyapunov_error } = data.found;
      window.kept.push({ each: task.each, status: [...status], period: [...period], sections: [...sections],
        lyapunov: [...lyapunov], errors: [...lyapunov_error] });
    });
  }
  postMessage(message) {
    if (message.task) this.tasks.set(message.number, message.task);
    super.postMessage(message);
  }
};
"""


def scene_of(name, tmp_path):
    system, sweep, more = SCENES[name]
    data = vs.sweep(
        system, sweep, transient=600, record=60, observe=["section", "lyapunov"], workers=1, **more,
        output=tmp_path / f"{name}.h5",
    )  # fmt: skip
    return data, next(iter(sweep))


def opened(browser, path, script=KEPT):
    tab = browser.new_page()
    errors = []
    tab.on("pageerror", lambda error: errors.append(str(error)))
    tab.add_init_script(script)
    tab.goto(f"file://{path}")
    tab.wait_for_function("document.documentElement.dataset.state === 'final'", timeout=60_000)
    return tab, errors


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_it_shows_what_a_sweep_computes(browser, tmp_path, name):
    """Periodic orbits to what rounding of the data does, in chaos the exponents within their errors."""
    data, axis = scene_of(name, tmp_path)
    path = vs.page(data, tmp_path / "diagram.html")
    assert path.stat().st_size < 360_000
    tab, errors = opened(browser, path)
    kept = tab.evaluate("window.kept")
    assert not errors and tab.inner_text("#status").startswith("1000 values")
    tab.close()
    values = np.array([one[axis] for part in kept for one in part["each"]])
    order = np.argsort(values)
    np.testing.assert_allclose(values[order], data[axis].values, rtol=1e-15)

    def all_of(field, width):
        parts = [np.array(part[field], float).reshape(len(part["each"]), -1) for part in kept]
        return np.concatenate(parts)[order].reshape(len(values), *width)

    status, period = all_of("status", ()), all_of("period", ())
    wanted = data.period.values
    assert (status == data.status.values).mean() > 0.95 and (period == wanted).mean() > 0.9
    same = (period == wanted) & (wanted > 0)
    if name.endswith(("up", "down")):  # behind a chaotic column a chain may go on on another of two mirrored orbits
        turn = 1 if name.endswith("up") else -1
        same &= (np.cumsum((wanted == 0)[::turn]) == 0)[::turn]
    sections = all_of("sections", (60, -1))
    x1, v1 = data.x1.values, data.v1.values
    away = []
    for i in np.flatnonzero(same):
        last = np.flatnonzero(np.isfinite(x1[i]))[-int(wanted[i]) :]
        apart = sections[i, last, :2] - np.stack([x1[i, last], v1[i, last]], -1)
        away.append(np.abs(apart).max(initial=0.0))
    assert same.sum() > 10 and np.quantile(away, 0.9) < 1e-9
    lyapunov, errors = all_of("lyapunov", (-1,)), all_of("errors", (-1,))
    others = (wanted == 0) & (period == 0)
    if others.sum() > 5:
        apart = np.abs(lyapunov - data.lyapunov.values)[others, 0]
        assert np.median(apart / np.hypot(errors, data.lyapunov_error.values)[others, 0]) < 2


@pytest.mark.slow
def test_a_slider_a_start_and_a_click(browser, tmp_path):
    """The diagram follows a slider, other starts are computed, an orbit is shown; a wrong number is refused."""
    path = vs.page(PAPER, tmp_path / "paper.html", bounds=(4.2, 7))
    tab, errors = opened(browser, path)
    final = "document.documentElement.dataset.state === 'final'"
    for act in (
        lambda: tab.evaluate(SLIDER),
        lambda: tab.select_option("#start", "both"),
        lambda: tab.select_option("#start", "random"),
        lambda: tab.select_option("#start", "state"),
        lambda: tab.select_option("#height", "speed_left"),
    ):  # fmt: skip
        act()
        tab.wait_for_function(final.replace("===", "!=="))
        tab.wait_for_function(final, timeout=60_000)
        assert "1000 values of b" in tab.inner_text("#status")
    tab.evaluate("document.getElementById('diagram').focus()")
    tab.keyboard.press("Enter")
    tab.wait_for_function("!document.getElementById('orbit').hidden && document.getElementById('facts').textContent")
    assert "λ" in tab.inner_text("#facts") and tab.is_hidden("#why")
    tab.fill("#field-R", "2")
    tab.keyboard.press("Tab")
    tab.wait_for_function("document.getElementById('status').classList.contains('bad')")
    assert "R" in tab.inner_text("#status") and not errors
    tab.close()


@pytest.mark.slow
def test_what_a_page_cannot_set_up_is_said(browser, tmp_path):
    """With both stops on one side of 0 a mass at rest is held by one of them: no orbit is shown in its place."""
    path = vs.page(PAPER.replace(offset=8.0), tmp_path / "aside.html", bounds=(4, 6))
    tab, errors = opened(browser, path)
    kept = tab.evaluate("window.kept")
    assert all(status == 100 for part in kept for status in part["status"]) and not errors
    assert "1000 orbits: such an oscillator cannot be set up" in tab.inner_text("#status")
    tab.close()


def test_what_is_no_page_is_refused_in_a_sentence(tmp_path):
    with pytest.raises(ValueError, match="ends with"):
        vs.page(PAPER, tmp_path / "page.pdf")
    there = tmp_path / "there.html"
    there.write_text("mine")
    with pytest.raises(FileExistsError, match="already"):
        vs.page(PAPER, there)
    assert there.read_text() == "mine"
    with pytest.raises(ValueError, match="no number of an oscillator"):
        vs.page(vs.sweep(PAPER, {"x1": [0.0, 1.0]}, transient=10, record=5), tmp_path / "states.html")


def test_the_command_says_what_is_in_the_way(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("there.html").write_text("mine")
    Path("scene.yaml").write_text(scene("sweep: {b: {values: [3, 4]}}"))
    assert main(["page", "scene.yaml", "-o", "there.html"]) == 2
    assert "there.html: there is a file already" in capsys.readouterr().err
    assert Path("there.html").read_text() == "mine"
