"""What a page is told of units and contacts, and the orbits of a click where a value has several starts."""

import json
import math

import numpy as np
import pytest
from support import ROOT
from support.explorers import answers, decoded, heights, requested
from support.scene_texts import parsed

import vibro_sweep as vs

pytest.importorskip("uvicorn")
from websockets.sync.client import connect

LEVER = (ROOT / "configs" / "lever" / "lever.yaml").read_text()


def opened(scene):
    """What a page is told of a scene, and by name the units of its numbers and of the axes."""
    page = vs.explore(scene)
    host, token = page.url.removeprefix("http://").split("/?token=")
    with connect(f"ws://{host}/socket?token={token}", origin=f"http://{host}") as socket:
        words, _ = answers(socket, "open", 1)
    page.close()
    units = {one["name"]: (one["unit"], one["scale"]) for one in words["numbers"]}
    return words, units, {name: (one["unit"], one["scale"]) for name, one in words["units"].items()}


def test_numbers_have_the_units_of_the_scene():
    words, units, axes = opened(parsed(LEVER))
    assert words["view"]["axis"] == "frequency" and "omega" not in units
    assert units["frequency"] == ("Hz", 1) and units["m1"] == ("kg", 1) and units["force1"] == ("N", 1)
    assert units["b"] == ("mm", 1000) and units["k1"] == units["k_stop"] == ("N/mm", 0.001)
    assert axes["x1"] == axes["penetration_max"] == axes["gap"] == ("mm", 1000)
    assert axes["v1"] == axes["gap_velocity"] == ("mm/s", 1000)
    assert axes["contact_force_max"] == ("N", 1) and axes["lyapunov"] == ("1/s", 1)
    assert {name for name, _ in words["heights"]} <= axes.keys()
    _, units, _ = opened(parsed(LEVER.replace("picture:", "#")))
    assert units["b"] == ("m", 1) and units["k1"] == ("N/m", 1)
    _, units, axes = opened(vs.load_scene(ROOT / "configs" / "quickstart.yaml"))
    assert {*units.values(), *axes.values()} == {("", 1)}


def test_ranges_of_sliders_have_the_size_of_the_machine():
    words, _, _ = opened(parsed(LEVER))
    sliders = {one["name"]: one for one in words["numbers"]}
    assert sliders["offset"]["value"] == 0 and 1e-4 < sliders["offset"]["high"] == -sliders["offset"]["low"] < 1e-2
    assert sliders["preload"]["value"] == 0 and 0.1 < sliders["preload"]["high"] < 1000  # N, of a force of 40 N
    for one in sliders.values():
        assert one["low"] <= one["value"] <= one["high"]
    words, _, _ = opened(vs.load_scene(ROOT / "configs" / "quickstart.yaml"))
    offset = next(one for one in words["numbers"] if one["name"] == "offset")
    assert (offset["low"], offset["high"]) == (-1, 1)


def test_hertz_in_place_of_omega():
    """Whether omega is swept or not; only the view changes, and its scene computes the same."""
    lever = parsed(LEVER)
    words, units, _ = opened(lever.replace(sweep={"omega": [31.4, 157.0]}))
    ends = [words["view"][key] for key in ("axis", "low", "high")]
    assert ends == ["frequency", 31.4 / (2 * math.pi), 157 / (2 * math.pi)] and "omega" not in units
    over_b = lever.replace(system=lever.system.replace(omega=63.0), sweep={"b": [0.001, 0.002]})
    words, units, _ = opened(over_b)
    assert words["view"]["axis"] == "b" and units["frequency"] == ("Hz", 1) and "omega" not in units
    assert 2 * math.pi * words["view"]["system"]["frequency"] == pytest.approx(63, rel=1e-15)
    _, units, _ = opened(over_b.replace(picture_units=("mm",)))
    assert units["omega"] == ("rad/s", 1) and "frequency" not in units


def test_a_saved_scene_keeps_its_units_and_the_numbers_of_its_system(page):
    view = answers(page, "open", 1, name="lever")[0]["view"]
    for seq, picture in enumerate(({"units": ["mm", "Hz"]}, None), 2):  # links that are older than units have none
        asked = requested(view)
        asked["scene"] |= {} if picture is None else {"picture": picture}
        page.send(json.dumps({"type": "save", "seq": seq, "view": asked}))
        scene = parsed(decoded(page.recv())[0]["text"])
        assert scene.picture_units == (() if picture is None else ("mm", "Hz")) and scene.system.b == 0.0015
        assert opened(scene)[0]["view"] == view | {"picture": picture}
    asked["scene"]["picture"] = {"units": ["apples"]}
    page.send(json.dumps({"type": "save", "seq": 4, "view": asked}))
    words, _ = decoded(page.recv())
    assert words["type"] == "error" and "apples is no unit here" in words["text"]


@pytest.mark.parametrize("y", ["contact_force_max", "penetration_max"])
def test_the_largest_force_and_penetration_of_contacts(page, y):
    """One dot an orbit; none where there is no contact."""
    system = parsed(LEVER).system
    view = answers(page, "open", 1, name="lever")[0]["view"]
    view |= {"transient": 100, "record": 40, "low": 18, "high": 21, "columns": 4, "y": y}
    frames = answers(page, "sweep", 2, view=view)
    assert frames[0][1]["count"].max() == 1
    options = {"start": {"follow": "both"}, "transient": 100, "record": 40}
    data = vs.sweep(system, {"frequency": [18, 19, 20, 21]}, observe=["section", "contacts", "lyapunov"], **options)
    expected = data[y].values
    assert np.isnan(expected).any() and np.isfinite(expected).any()
    assert np.array_equal(heights(frames, 4, 2, 1)[..., 0], expected.astype("f4"), equal_nan=True)
    words, arrays = answers(page, "window", 3, view=view | {"transient": 2000}, value=18)
    assert words["low"]["value"] < 18 < words["high"]["value"] and arrays["y"].size == 0


def test_rigid_stops_have_no_contacts(page):
    words, _ = answers(page, "open", 1)
    assert not {"contact_force_max", "penetration_max"} & {name for name, _ in words["heights"]}
    words, _ = answers(page, "sweep", 2, view=words["view"] | {"y": "penetration_max"})
    assert words["type"] == "error" and "rigid" in words["text"]


def last_points(data, column, start):
    """The last section point of an orbit of a sweep."""
    return [float(data[name].values[column, start, -1]) for name in ("x1", "v1", "x2", "v2")]


def test_an_orbit_is_that_of_its_start(page, view):
    """Up and down; and of random starts also before the diagram is complete."""
    view |= {"low": 6.66, "high": 6.8, "transient": 300, "record": 60, "columns": 15, "start": {"follow": "both"}}
    axis = answers(page, "sweep", 2, view=view)[0][1]["axis"]
    periods = set()
    for start in (0, 1):
        words, _ = answers(page, "orbit", 3 + start, view=view, value=axis[6], start=start, column=6)
        assert words["start"] == start and words["went_on"]
        periods.add((words["period"], words["impacts"]))
    assert len(periods) == 2 and (1, 0) in periods  # on the way down it swings freely
    view["start"] = {"random": 3, "seed": 4}
    scene = parsed(answers(page, "save", 5, view=view)[0]["text"])
    data = vs.sweep(scene.system, scene.sweep, start=view["start"], transient=300, record=60)
    found = []
    for start in range(3):
        words, arrays = answers(page, "orbit", 6 + start, view=view, value=axis[2], start=start)
        assert words["start"] == start and not words["went_on"]
        found.append(arrays["section"].reshape(-1, 4)[-1])
        assert np.array_equal(found[-1], np.array(last_points(data, 2, start), "f4"))
    assert not np.array_equal(found[0], found[1])
