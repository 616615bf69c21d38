"""The orbit at a click, without a page."""

import json

import numpy as np
import pytest

from vibro_sweep.live.clicked_orbit import orbit_message, settled
from vibro_sweep.live.model_words import model_words
from vibro_sweep.live.views import view_of
from vibro_sweep.scene.scene import scene_of

SCENE = {
    "system": {
        "type": "one_mass", "zeta": 0.03, "F": 1, "omega": 0.8, "b": 0.5, "tau": 0.3,
        "k_stop": 10, "c_stop": 12, "release": "force",
    },
    "sweep": {"b": {"start": 0.02, "stop": 0.2, "num": 16}},
    "orbit": {"transient": 1000, "record": 60},
}  # fmt: skip


def test_an_orbit_goes_on_where_its_stops_relax():
    """Where they are is not part of the state in which it ended."""
    view = view_of(scene_of(SCENE, "scene"))
    alone = settled(view, 0.1, 0, None)
    found = settled(view, 0.1, 0, alone.end)
    assert found.period == alone.period == 1
    np.testing.assert_allclose(found.exponents, alone.exponents, rtol=0, atol=1e-9)
    arrays, words = orbit_message(found)
    states = arrays["states"].reshape(-1, 2)
    np.testing.assert_allclose(states[-1], states[0], rtol=0, atol=1e-6)
    np.testing.assert_allclose(states[0], found.section[-1], rtol=0, atol=1e-6)
    assert (words["contacts"], words["impacts"], words["rests"]) == (2, 0, 0)
    assert np.all((arrays["contact_touch"] >= 0) & (arrays["contact_release"] > arrays["contact_touch"]))


def test_a_contact_over_the_section_counts_once():
    """Whatever the phase at which periods begin: the same two contacts, of which the section cuts one now and then."""
    drawn = set()
    for tau in (0.0, 1.5, 3.0, 4.5):
        system = SCENE["system"] | {
            "release": "displacement",
            "omega": 2.2,
            "F": 2.4,
            "k_stop": 40,
            "c_stop": 4,
            "tau": tau,
        }
        sweep = {"b": {"start": 0.9, "stop": 1.1, "num": 3}}
        found = settled(
            view_of(scene_of(SCENE | {"system": system, "sweep": sweep, "start": {"v1": 3}}, "scene")), 1.0, 0, None
        )
        arrays, words = orbit_message(found)
        assert found.period == 1 and words["contacts"] == 2
        drawn.add(len(arrays["contact_touch"]))
    assert drawn == {2, 3}


@pytest.mark.parametrize(
    ("name", "value"),
    [("k_stop", 1e308), ("c_stop", 1e308), ("F", 1e308), ("offset", -1e308), ("omega", 1e308), ("omega", 1e-308)],
)
@pytest.mark.filterwarnings("error")
def test_numbers_near_the_ends_of_the_floats_are_shown(name, value):
    """Ranges of sliders, and the period, would be infinite there, for which JSON has no word."""
    scene = scene_of(SCENE | {"system": SCENE["system"] | {name: value}, "orbit": {"transient": 1, "record": 1}}, "")
    view = view_of(scene)
    [shown] = (one for one in model_words(scene, view)["numbers"] if one["name"] == name)
    assert shown["low"] <= value <= shown["high"]
    json.dumps([shown, orbit_message(settled(view, 0.1, 0, None))[1]], allow_nan=False)
