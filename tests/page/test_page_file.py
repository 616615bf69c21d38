"""The one HTML file of `vs.page`: in a browser it shows what a sweep computes, and it is refused in one sentence."""

import functools
import json
from pathlib import Path
from urllib.parse import quote

import numpy as np
import pytest
from support import browsers
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


def matrices(M, K):
    return vs.Oscillator(
        M, K, rayleigh=[0.1, 0.001], contact_normal=[1.0, 0.5], force=[1.0, 0.3], omega=0.9, b=0.6, R=0.7,
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
    "gears": (
        vs.Oscillator.named("one_mass", k=0, zeta=0.02, constant=0.5, F=1, omega=1, R=0.7, b=1, tau=0),
        along("F", 0.9, 3),
        RIGHT,
    ),
    "a ball on a table": (
        vs.Oscillator.named(
            "one_mass", k=0, zeta=0, constant=-1, base=True, F=1, omega=1, R=0.8, b=0, tau=0, stops="left"
        ),
        along("F", 0.7, 1.25),
        {"start": {"follow": "up", "x1": 0.5, "v1": 3}} | LEFT,
    ),
    "a ball in a cavity": (
        vs.Oscillator.named("ball_in_cavity", mass_ratio=0.05, zeta=0.01, F=0.1, omega=1, R=0.7, b=1),
        along("b", 0.5, 4),
        {"start": {"x1": 0, "v1": 0.1}},
    ),
    "two masses, coupled by dampers": (
        vs.Oscillator.named("chain", m=[1, 1], k=[1, 1, 1], c=[0.3, 0.05, 0.0], force=[1, 0], omega=0.9, b=0.6, R=0.7),
        along("b", 0.3, 1.5),
        {},
    ),
    "two masses, stops on one side of 0": (PAPER.replace(offset=4.5), along("b", 3, 4.4), {}),
    "two masses, inertia in common": (matrices([[2, 0.5], [0.5, 1]], [[3, -1], [-1, 2]]), along("b", 0.2, 1), {}),
    "two masses, rates apart": (matrices([[1, 0], [0, 1]], [[901, -900], [-900, 901]]), along("b", 0.2, 1), {}),
    "one mass, slow force": (one(R=0.7), along("omega", 0.02, 0.3), {"transient": 60}),
    "three masses": (three(R=0.6), along("b", 0.3, 1.5), {}),
    "three masses, one stop": (three(R=0.6, stops="right"), along("omega", 0.5, 0.9), {}),
    "three masses, compliant": (three(**SOFT), along("b", 0.3, 1.5), {}),
}
FINAL = "document.documentElement.dataset.state === 'final'"


def choose(name, value, event="change"):
    """What a hand does at a control of the page."""
    place = f"document.getElementById('{name}')"
    return f"({place}.value = '{value}', {place}.dispatchEvent(new Event('{event}', {{bubbles: true}})))"


SLIDER = choose("slider-R", "700", "input")
KEPT = """
window.kept = [];
const Own = window.Worker;
window.Worker = class extends Own {
  constructor(address) {
    super(address);
    this.tasks = new Map();
    window.countOf = (each, plan, states) => new Promise((answer) => { // of impacts, of a click there
      const number = -Math.random(), orbit = { kind: "orbit", each: [each], starts: [states], chain: false };
      const task = { ...orbit, plan: { ...plan, side: 0 }, begun: null };
      this.addEventListener("message", ({ data }) => data.number === number && answer(data.found.words));
      super.postMessage({ number, task });
    });
    this.addEventListener("message", ({ data }) => {
      const task = this.tasks.get(data.number);
      if (task?.kind !== "diagram" || !task.plan.lyapunov || !data.found) return;
      const { status, period, sections, lyapunov, lyapunov_error } = data.found;
      const { each, plan, starts } = task;
      window.kept.push({ each, plan, starts, status: [...status], period: [...period], sections: [...sections],
        lyapunov: [...lyapunov], errors: [...lyapunov_error] });
    });
  }
  postMessage(message) {
    if (message.task) this.tasks.set(message.number, message.task);
    super.postMessage(message);
  }
};
"""
LATE = """
Object.defineProperty(navigator, "hardwareConcurrency", { value: 2 });
const Own = window.Worker, root = document.documentElement;
let kept = false;
window.Worker = class extends Own {
  set onmessage(heard) {
    super.onmessage = (event) => {
      if (kept) return heard(event);
      kept = true;
      const clock = setInterval(() => {
        if (root.dataset.state !== "final") return;
        clearInterval(clock);
        heard(event);
        window.late = true;
      }, 20);
    };
  }
};
"""


def scene_of(name, **changes):
    system, sweep, more = SCENES[name]
    observed = ["section", "lyapunov", "impacts"] + ["contacts"] * system.linear.compliant
    orbit = {"transient": 600, "record": 60} | more
    data = vs.sweep(system.replace(**changes), sweep, observe=observed, workers=1, **orbit)
    return data, next(iter(sweep))


@functools.cache  # of both browsers
def computed(name):
    """A scene's data, what it sweeps, and how rounding moves its cycles."""
    data, axis = scene_of(name)
    return data, axis, roundings(name, data)


def last_cycle(x, period):
    """The points (p, 2) of the last cycle of an orbit of this least period, by the record of its sections."""
    return x[np.flatnonzero(np.isfinite(x[:, 0]))[-period:]]


def roundings(name, data):
    """(points,): by how much a cycle moves where numbers of the machine move in their last digits."""
    system, (axis, *_) = SCENES[name][0], SCENES[name][1]
    numbers = {key: value for key, value in system.arguments.items() if key != axis and is_numeric(value)}
    moved = np.zeros(data.period.size)
    for i in range(4):
        changes = {key: shifted(value, (-1) ** (i + j // 2)) for j, (key, value) in enumerate(numbers.items())}
        other, _ = scene_of(name, **changes)
        for k in np.flatnonzero((data.period.values > 0) & (data.period.values == other.period.values)):
            cycles = (last_cycle(sections(one)[k], int(data.period.values[k])) for one in (data, other))
            moved[k] = max(moved[k], np.abs(np.subtract(*cycles)).max(initial=0.0))
    return moved


def is_numeric(value):
    """Whether a number, or all of a list, can move in their last digits."""
    return isinstance(value, float | tuple) and np.asarray(value).dtype.kind in "fi"


def shifted(value, sign):
    """The same in the next floats; of a matrix those of its diagonal, so that it stays symmetric."""
    factor = sign * 2.0**-52 * (np.eye(len(value)) if np.ndim(value) == 2 else 1.0)
    return (np.asarray(value) * (1.0 + factor)).tolist()


def sections(data):
    return np.stack([data.x1.values, data.v1.values], -1)


@pytest.fixture(scope="module", params=["chromium", "firefox"])
def browser(request):
    with getattr(browsers, request.param)() as opening:
        yield opening


def with_script(path, script):
    """The same page with a script before its own."""
    page = path.read_text()
    assert page.count("<head>") == 1
    result = path.with_stem(f"{path.stem}_{len(script)}")
    result.write_text(page.replace("<head>", f"<head><script>{script}</script>"))
    return result


def opened(browser, address):
    tab = browser(address)
    tab.wait_for(FINAL)
    return tab


def text_of(tab, name):
    return tab.evaluate(f"document.getElementById('{name}').innerText")


@pytest.fixture
def where(browser, tmp_path):
    """The address of a page of this folder: of every other scene from the disk in one browser, and by http in the
    other."""
    with browsers.served(tmp_path) as http:
        yield lambda path, by_http: f"{http}/{path.name}" if by_http else path.as_uri()


def check_counts(tab, name, data, kept):
    """A click finds as many impacts and contacts in a cycle as the sweep has, where nothing rests; of 12 orbits. It
    sees contacts in samples, so those are compared that last for two of them on average."""
    system, (axis, *_), more = SCENES[name]
    if "follow" in more.get("start", {}):
        return  # chains do not start where a click does
    period, counts = data.period.values, {"impacts": (data.impacts_right + data.impacts_left).values}
    plain = (period > 0) & (60 % np.maximum(period, 1) == 0) & (data.min_impact_speed.values != 0)
    if system.linear.compliant:
        counts["contacts"] = (data.contacts_right + data.contacts_left).values
        plain &= 60 * 200 * data.contact_time.values > 2 * counts["contacts"]
    orbits = {one[axis]: (one, part["plan"], part["starts"][i]) for part in kept for i, one in enumerate(part["each"])}
    compared = 0
    for i in np.flatnonzero(plain)[:: max(1, np.count_nonzero(plain) // 12)]:
        value = min(orbits, key=lambda one: abs(one - data[axis].values[i]))
        words = tab.evaluate(f"window.countOf(...{json.dumps(orbits[value])})")
        if words["period"] == period[i]:
            assert {what: words[what] for what in counts} == {
                what: count[i] * period[i] // 60 for what, count in counts.items()
            }, (axis, value)
            compared += 1
    assert compared > 3 or "section" in more  # the period of an impact section is another one than that of a click


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_it_shows_what_a_sweep_computes(browser, where, request, tmp_path, name):
    """Periodic orbits to ten times what rounding of the data does, in chaos the exponents within their errors."""
    data, axis, unit = computed(name)
    path = vs.page(data, tmp_path / "diagram.html")
    assert path.stat().st_size < 290_000
    by_http = ([*SCENES].index(name) + ("firefox" in request.node.callspec.id)) % 2 == 1
    tab = opened(browser, where(with_script(path, KEPT), by_http))
    kept = tab.evaluate("window.kept")
    assert not tab.errors and text_of(tab, "status").startswith("1000 values")
    check_counts(tab, name, data, kept)
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
    found, native = all_of("sections", (60, -1))[..., :2], sections(data)
    away = []
    for i in np.flatnonzero(same):
        ours, theirs = (
            last_cycle(np.where(np.isfinite(native[i]), one[i], np.nan), int(wanted[i])) for one in (found, native)
        )
        away.append(np.abs(ours - theirs).max(initial=0.0) / (unit[i] + 1e-15))
    assert same.sum() > 10 and np.quantile(away, 0.95) < 10
    lyapunov, errors = all_of("lyapunov", (-1,)), all_of("errors", (-1,))
    known = np.isfinite(lyapunov[:, 0]) & np.isfinite(data.lyapunov.values[:, 0])  # -infinity where an orbit rests
    others = (wanted == 0) & (period == 0) & known
    if others.sum() > 5:
        apart = np.abs(lyapunov - data.lyapunov.values)[others, 0]
        assert np.median(apart / np.hypot(errors, data.lyapunov_error.values)[others, 0]) < 2


@pytest.mark.slow
def test_a_preview_that_comes_last_changes_nothing(browser, tmp_path):
    """A worker keeps its first answer until the diagram is there."""
    path = vs.page(PAPER, tmp_path / "paper.html", bounds=(4.2, 7))
    tab = opened(browser, with_script(path, LATE).as_uri())
    drawn = tab.evaluate("document.documentElement.dataset.frame")
    tab.wait_for("window.late")
    tab.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")
    assert tab.evaluate(FINAL) and text_of(tab, "status").startswith("1000 values")
    assert tab.evaluate("document.documentElement.dataset.frame") == drawn
    tab.close()


@pytest.mark.slow
def test_a_slider_a_start_and_a_click(browser, tmp_path):
    """The diagram follows a slider, other starts are computed, an orbit is shown; a wrong number is refused."""
    tab = opened(browser, vs.page(PAPER, tmp_path / "paper.html", bounds=(4.2, 7)).as_uri())
    for act in (
        SLIDER,
        choose("start", "both"),
        choose("start", "random"),
        choose("start", "state"),
        choose("height", "speed_left"),
    ):
        tab.evaluate(act)
        tab.wait_for(FINAL.replace("===", "!=="))
        tab.wait_for(FINAL)
        assert "1000 values of b" in text_of(tab, "status")
    tab.evaluate("document.getElementById('diagram').dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter'}))")
    tab.wait_for("!document.getElementById('orbit').hidden && document.getElementById('facts').textContent")
    assert "λ" in text_of(tab, "facts") and tab.evaluate("document.getElementById('why').hidden")
    tab.evaluate(choose("field-R", "2"))
    tab.wait_for("document.getElementById('status').classList.contains('bad')")
    assert "R" in text_of(tab, "status") and not tab.errors
    tab.close()


PULLED = vs.Oscillator.named(
    "chain", m=[1, 1], k=[0, 1, 0], c=[0.1, 0.1, 0.1], force=[1, 0], constant=[1, -1], omega=0.7, b=5, R=0.8
)


STIFF = vs.Oscillator.named("chain", m=[1, 1], k=[1, 1e9, 1], c=[0.1] * 3, force=[1, 0], omega=0.7, b=5, R=0.8)


@pytest.mark.slow
@pytest.mark.parametrize("system", [STIFF, PULLED], ids=["rates too far apart", "several states of balance"])
def test_what_a_page_cannot_set_up_is_said(browser, tmp_path, system):
    """Where free masses are pulled together the phase of the steady gap is not known to the page."""
    path = with_script(vs.page(system, tmp_path / "aside.html", bounds=(4, 6)), KEPT)
    tab = opened(browser, path.as_uri())
    kept = tab.evaluate("window.kept")
    assert all(status == 100 for part in kept for status in part["status"]) and not tab.errors
    assert "1000 orbits: such an oscillator cannot be set up" in text_of(tab, "status")
    tab.close()


ADDRESSES = {
    "columns": (lambda view: view.update(columns=10**9), "columns: 2 to 4000"),
    "no columns": (lambda view: view.update(columns=-1), "columns: 2 to 4000"),
    "record": (lambda view: view.update(record=10**9), "record: 1 to"),
    "transient": (lambda view: view.update(transient=1e7), "transient: 0 to"),
    "dots": (lambda view: view.update(columns=4000, record=9000), "at most 4e+6 section points"),
    "periods": (lambda view: view.update(columns=4000, transient=10**6), "at most 1e+9 periods"),
    "range": (lambda view: view.update(low=7, high=4), "from a number to a larger one"),
    "no number": (lambda view: view.update(low=None), "from a number to a larger one"),
    "axis": (lambda view: view.update(axis="colour"), "sweep: one of"),
    "restitution": (lambda view: view.update(numbers={"R": 2}), "R = 2: must be"),
    "negative": (lambda view: view.update(low=-4, high=4), "b = -4: must be"),
    "frequency": (lambda view: view.update(numbers={"omega": 0}), "omega = 0: must be"),
    "another name": (lambda view: view.update(numbers={"colour": 2}), "colour: no number of this page's oscillator"),
    "another stop": (lambda view: view["system"].update(stops="left"), "stops: this page is of"),
    "another machine": (lambda view: view["system"].update(type="one_mass"), "type: "),
    "a matrix": (lambda view: view["system"].update(contact_normal=[1, 1]), "contact_normal: no number of this"),
    "height": (lambda view: view.update(y="x9"), "y: one of x1, v1"),
    "follow": (lambda view: view.update(start={"follow": "sideways"}), "start: follow = "),
    "starts": (lambda view: view.update(start={"random": -3}), "start: random = -3"),
    "mapping": (lambda view: view.update(map={"dynamics": "map"}), "dynamics: this page computes the oscillator"),
    "a text": (lambda view: view.update(system="paper"), "this page is of"),
    "nothing": (lambda view: view.clear(), "not a view of this page"),
}  # fmt: skip


@pytest.mark.slow
def test_whatever_the_address_holds(browser, tmp_path):
    """The picture that it asks for, or a sentence; never an error that nobody sees."""
    path = vs.page(PAPER, tmp_path / "paper.html", bounds=(4.2, 7))
    tab = opened(browser, path.as_uri())
    tab.evaluate(SLIDER)
    tab.wait_for("location.hash.length > 1")
    address = tab.evaluate("decodeURIComponent(location.hash.slice(1))")
    tab.close()
    for what, (change, words) in ADDRESSES.items():
        found = json.loads(address)
        change(found["view"])
        tab = opened(browser, f"{path.as_uri()}#{quote(json.dumps(found))}")
        said = text_of(tab, "status")
        assert not tab.errors, (what, tab.errors)
        assert words in said and ("behind #" in said) != ("must be" in said), (what, said)  # or its sliders mend it
        tab.close()
    garbage = json.dumps(json.loads(address) | {"range": "abc", "home": 5, "line": "x", "start": -3})
    for other in ("{", "[]", "null", "3", garbage):
        tab = opened(browser, f"{path.as_uri()}#{quote(other)}")
        assert not tab.errors and text_of(tab, "status").startswith("1000 values of b"), other
        tab.close()


SMALL = """
const Memory = WebAssembly.Memory;
WebAssembly.Memory = function () { return new Memory({ initial: 24, maximum: 24 }); };
"""
BROWSERS = {
    "no WebAssembly": ("delete window.WebAssembly", "needs a browser of 2023 or later"),
    "no unpacking": ("delete window.DecompressionStream", "needs a browser of 2023 or later"),
    "no search from the end": ("delete Array.prototype.findLastIndex", "needs a browser of 2023 or later"),
    "no vectors": ("WebAssembly.compile = async () => { throw Error('no SIMD'); }", "the page's code: no SIMD"),
    "no memory": (f"in worker: {SMALL}", "not enough memory"),
    "no worker": ("in worker: throw Error('no worker');", "cannot run the page's code"),
}  # fmt: skip
IN_WORKER = """
const Plain = Blob;
window.Blob = class extends Plain {{
  constructor(parts, options) {{ super(options?.type ? [{0!r}, ...parts] : parts, options); }}
}};
"""


@pytest.mark.slow
@pytest.mark.parametrize("what", BROWSERS)
def test_what_a_browser_cannot_do_is_said(browser, tmp_path, what):
    script, words = BROWSERS[what]
    if script.startswith("in worker: "):
        script = IN_WORKER.format(script.removeprefix("in worker: "))
    path = vs.page(PAPER, tmp_path / "paper.html", bounds=(4.2, 7))
    tab = opened(browser, with_script(path, script).as_uri())
    assert words in text_of(tab, "status")
    tab.close()


@pytest.mark.slow
@pytest.mark.parametrize("part", ["page", "main", "worker", "module"])
def test_a_damaged_file_says_so(browser, tmp_path, part):
    path = vs.page(PAPER, tmp_path / "paper.html", bounds=(4.2, 7))
    text, begin = path.read_text(), f'id="{part}">'
    at = text.index(begin) + len(begin) + 2000
    path.write_text(text[:at] + ("A" if text[at] != "A" else "B") + text[at + 1 :])
    tab = opened(browser, path.as_uri())
    assert "damaged" in text_of(tab, "status") or "cannot run" in text_of(tab, "status")
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
