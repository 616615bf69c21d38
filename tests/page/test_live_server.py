"""What `vibro-sweep explore` answers a page."""

import json

import numpy as np
import pytest
from support import ROOT
from support.explorers import answers, ask, decoded, explorer, heights
from support.scene_texts import parsed

import vibro_sweep as vs

pytest.importorskip("uvicorn")
pytest.importorskip("websockets.sync.client")


def test_only_the_newest_request_is_finished(page, view):
    view |= {"columns": 1000, "transient": 1000, "record": 200}
    for seq in range(10, 40):
        ask(page, "sweep", seq, view=view | {"numbers": {"R": 0.8 - 0.001 * seq}})
    finished = []
    while 39 not in finished:
        words, _ = decoded(page.recv(timeout=60))
        finished += [words["seq"]] if words.get("last") else []
    assert len(finished) <= 3  # the first may have been complete before the next one came


def test_what_cannot_be_computed_is_said_in_words(page, view):
    words, _ = answers(page, "sweep", 5, view=view | {"numbers": {"R": 2.0}})
    assert words["type"] == "error" and "R" in words["text"] and "from 0 to 1" in words["text"]
    words, _ = answers(page, "sweep", 6, view=view | {"low": 5.0, "high": 5.0 + 1e-15})
    assert words["type"] == "error" and "double precision" in words["text"]
    words, _ = answers(page, "sweep", 7, view=view | {"y": "x9"})
    assert words["type"] == "error" and "x1" in words["text"]
    words, _ = answers(page, "sweep", 8, view=view | {"system": {"type": "build", "build": "os.system"}})
    assert words["type"] == "error"
    assert answers(page, "sweep", 9, view=view)[-1][0]["last"]


def test_an_orbit_is_that_of_simulate(page, view):
    words, arrays = answers(page, "orbit", 2, view=view | {"transient": 1000, "record": 200}, value=4.9)
    assert (words["period"], words["itinerary"], words["went_on"]) == (13, "LLLLRRRR", False)
    system = vs.load_scene(ROOT / "configs" / "quickstart.yaml").system.replace(b=4.9)
    whole = vs.simulate(system, [0, 0, 0, 0], 1214)
    states = whole.sample(1200 * system.period + arrays["t"].astype(float))  # it is shown from the end of its record
    assert np.allclose(arrays["states"].reshape(-1, 4)[:, 0::2], states[:, 0::2], atol=1e-4)
    exponents = vs.lyapunov(system, [0, 0, 0, 0], 1000, 200)
    assert np.allclose(arrays["exponents"], exponents, rtol=1e-12)


def test_an_orbit_goes_on_from_the_end_of_its_column(page, view):
    view |= {"start": {"follow": "up"}, "low": 6.66, "high": 6.8}
    answers(page, "sweep", 2, view=view)
    words, arrays = answers(page, "orbit", 3, view=view, value=6.8, column=63)
    assert words["went_on"] and not words["alone"]
    words, alone = answers(page, "orbit", 4, view=view, value=6.8)
    assert words["alone"] and not np.array_equal(arrays["states"], alone["states"])


def test_the_ends_of_a_window_are_where_its_orbit_ends(page, view):
    view |= {"transient": 4000, "record": 200}
    words, arrays = answers(page, "window", 2, view=view, value=4.9)
    assert words["period"] == 13 and words["low"]["type"] == words["high"]["type"] == "graze"
    system = vs.load_scene(ROOT / "configs" / "quickstart.yaml").system
    for end, inwards, direction in ((words["low"]["value"], 1, "down"), (words["high"]["value"], -1, "up")):
        values = np.sort(end + inwards * np.append(np.geomspace(0.1, 1e-5, 60), -1e-5))
        start = {"follow": direction}  # across the end, with ever smaller steps
        data = vs.sweep(system, {"b": values}, start=start, transient=2600, record=260, observe=["section", "impacts"])
        strikes = (data["impacts_right"] + data["impacts_left"]).values[::-inwards]
        assert (strikes[:-1] == 160).all() and strikes[-1] != 160  # 8 in 13 periods, until its end is passed
    (points, lines), *others = words["branches"]  # the window's own, and those that it meets at its grazes
    assert lines == 13 and others and len(arrays["value"]) == points + sum(n for n, _ in others)
    assert arrays["y"].size == sum(n * m for n, m in words["branches"]) and not arrays["unstable"][:points].any()
    assert arrays["value"][:points].min() == pytest.approx(words["low"]["value"], abs=1e-6)
    words, _ = answers(page, "window", 3, view=view, value=4.45)
    assert "Lyapunov exponent is positive" in words["reason"]


def test_a_newer_diagram_ends_the_following_of_a_window(page, view):
    """Nobody waits for what is no longer shown: of a window that is followed there comes nothing then."""
    ask(page, "window", 2, view=view, value=4.9)
    words, _ = answers(page, "sweep", 3, view=view)[-1]
    assert words["last"] and words["seq"] == 3
    words, _ = answers(page, "window", 4, view=view | {"transient": 4000, "record": 200}, value=4.9)
    assert words["seq"] == 4 and words["period"] == 13


def test_a_mapping_is_swept_and_saved_as_one(page, tmp_path):
    view = answers(page, "open", 1, name="figure_06")[0]["view"] | {"columns": 16, "transient": 100, "record": 20}
    assert view["dynamics"] == "map"
    frames = answers(page, "sweep", 2, view=view)
    words, arrays = answers(page, "orbit", 3, view=view, value=6.55)
    assert words["mapping"] and words["periods"] == 0
    scene = parsed(answers(page, "save", 4, view=view)[0]["text"])
    assert scene.dynamics == "map"
    vs.run(scene, tmp_path / "explored.h5")
    with vs.open(tmp_path / "explored.h5") as data:
        expected = data["x1"].values
    drawn = heights(frames, 16, 1, 20)[:, 0]
    assert np.array_equal(drawn[np.isfinite(drawn)], expected.astype("f4")[np.isfinite(drawn)])
    assert np.isfinite(drawn[:, -1]).all() and np.isfinite(drawn).sum() > 160
    one = vs.discontinuity_map(vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.55))
    points = arrays["section"].reshape(-1, 4).astype(float)
    assert np.allclose([one(state) for state in points[:-1]], points[1:], atol=1e-4)
    assert "mapping" in answers(page, "window", 5, view=view, value=6.8)[0]["reason"]


@pytest.mark.slow
def test_contacts_with_a_compliant_stop_and_the_ends_of_its_windows(page):
    words, _ = answers(page, "open", 1, name="one_sided_elastic")
    view = words["view"]
    assert {one["name"]: one["value"] for one in words["numbers"]}["c_stop"] == 0
    assert [name for name, _ in words["heights"]] == ["x1", "v1", "contact_force_max", "penetration_max"]
    words, arrays = answers(page, "orbit", 2, view=view, value=1.2)
    touch, release = arrays["contact_touch"], arrays["contact_release"]
    assert (words["period"], words["contacts"], len(touch)) == (1, 1, 2) and words["pressed"][1]
    x1, t = arrays["states"].reshape(-1, 2)[:, 0], arrays["t"]
    pressed = (t < release[0]) | (t > touch[1])  # the period that is shown begins and ends within a contact
    beside = abs(x1 - 1) > 1e-4
    assert np.array_equal(x1[beside] > 1, pressed[beside]) and beside.sum() > 0.9 * len(t)
    words, _ = answers(page, "window", 3, view=view, value=0.6)
    assert words["event"] == "contact" and "contact more" in words["high"]["text"]
    # the free motion has the amplitude F omega^2 / sqrt((1 - omega^2)^2 + (2 zeta omega)^2), which is b at its graze
    squares = np.roots([1 - (0.9 / 1.26) ** 2, 4 * 0.01**2 - 2, 1])
    assert words["high"]["value"] == pytest.approx(np.sqrt(squares.min()), abs=1e-12)


def test_a_number_that_follows_another_one(page, view):
    words, _ = answers(page, "open", 2, view=view)
    numbers = {one["name"]: one for one in words["numbers"]}
    assert (numbers["R_left"]["value"], numbers["R_left"]["leader"], numbers["R_left"]["follows"]) == (0.8, "R", True)
    words, _ = answers(page, "open", 3, view=view | {"numbers": {"R_left": 0.5}})
    numbers = {one["name"]: one for one in words["numbers"]}
    assert [numbers["R_left"][key] for key in ("value", "follows", "symbol")] == [0.5, False, "R left"]


def test_a_saved_view_is_computed_again(page, view, tmp_path):
    view |= {"numbers": {"R": 0.75}}
    frames = answers(page, "sweep", 2, view=view)
    scene = parsed(answers(page, "save", 3, view=view)[0]["text"])
    assert scene.system.R == 0.75 and len(scene.sweep["b"]) == 64 and scene.transient == 100
    vs.run(scene, tmp_path / "explored.h5")
    with vs.open(tmp_path / "explored.h5") as data:
        expected = data["x1"].values.astype("f4")
    drawn = heights(frames, 64, 1, 20)[:, 0]
    assert np.array_equal(drawn[np.isfinite(drawn)], expected[np.isfinite(drawn)]) and np.isfinite(drawn[:, -1]).all()


def test_every_example_is_drawn(program):
    with program.socket() as page:
        words, _ = answers(page, "open", 1)
        assert {"quickstart", "chain", "bouncing_ball"} <= {*words["presets"]}
        for seq, name in enumerate(["bouncing_ball", "physical_units"], 10):
            words, _ = answers(page, "open", seq, name=name)
            assert words["name"] == name and all(one["low"] < one["high"] for one in words["numbers"])
            view = words["view"] | {"columns": 16, "transient": 20, "record": 10}
            assert answers(page, "sweep", 100 + seq, view=view)[-1][0]["last"]
            again, _ = answers(page, "open", 200 + seq, view=view)
            assert again["view"] == view


def test_the_scene_of_a_file_comes_first(tmp_path):
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0.25, omega=0.63, R=0.6, b=6.6)
    vs.sweep(system, {"omega": [0.6, 0.61, 0.62]}, transient=3, record=2, output=tmp_path / "mine.h5")
    with explorer(tmp_path / "mine.h5") as running:
        with running.socket() as page:
            words, _ = answers(page, "open", 1)
        assert words["name"] == "mine" and words["view"]["axis"] == "omega" and words["view"]["system"]["R"] == 0.6
        assert json.loads(json.dumps(words["view"])) == words["view"]
        assert running.end()[0] == 0
