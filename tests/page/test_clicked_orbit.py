"""The orbit at a click into a diagram of compliant stops, and sliders of numbers near the ends of the floats."""

import json

import numpy as np
import pytest
from support.explorers import answers

pytest.importorskip("uvicorn")

SYSTEM = {
    "type": "one_mass", "zeta": 0.03, "F": 1, "omega": 0.8, "b": 0.5, "tau": 0.3,
    "k_stop": 10, "c_stop": 12, "release": "force",
}  # fmt: skip
VIEW = {"system": SYSTEM, "axis": "b", "low": 0.1, "high": 0.2, "columns": 16, "transient": 1000, "record": 60}


def test_an_orbit_goes_on_where_its_stops_relax(page):
    """Where they are is not part of the state in which it ended."""
    alone, first = answers(page, "orbit", 1, view=VIEW, value=0.1)
    answers(page, "sweep", 2, view=VIEW)
    words, arrays = answers(page, "orbit", 3, view=VIEW, value=0.1, column=0)
    assert words["went_on"] and not alone["went_on"] and words["period"] == alone["period"] == 1
    np.testing.assert_allclose(arrays["exponents"], first["exponents"], rtol=0, atol=1e-9)
    states, section = arrays["states"].reshape(-1, 2), arrays["section"].reshape(-1, 2)
    np.testing.assert_allclose(states[-1], states[0], rtol=0, atol=1e-6)
    np.testing.assert_allclose(states[0], section[-1], rtol=0, atol=1e-6)
    assert (words["contacts"], words["impacts"], words["rests"]) == (2, 0, 0)
    assert np.all((arrays["contact_touch"] >= 0) & (arrays["contact_release"] > arrays["contact_touch"]))


def test_a_contact_over_the_section_counts_once(page):
    """Whatever the phase at which periods begin: the same two contacts, of which the section cuts one now and then."""
    drawn = set()
    for tau in (0.0, 1.5, 3.0, 4.5):
        law = {"release": "displacement", "omega": 2.2, "F": 2.4, "k_stop": 40, "c_stop": 4, "tau": tau}
        view = VIEW | {"system": SYSTEM | law, "start": {"v1": 3}, "low": 0.9, "high": 1.1, "columns": 3}
        words, arrays = answers(page, "orbit", 4, view=view, value=1.0)
        assert words["period"] == 1 and words["contacts"] == 2
        drawn.add(len(arrays["contact_touch"]))
    assert drawn == {2, 3}


@pytest.mark.parametrize(
    ("name", "value"),
    [("k_stop", 1e308), ("c_stop", 1e308), ("F", 1e308), ("offset", -1e308), ("omega", 1e308), ("omega", 1e-308)],
)
def test_numbers_near_the_ends_of_the_floats_are_shown(page, name, value):
    """Ranges of sliders, and the period, would be infinite there, for which JSON has no word."""
    view = VIEW | {"system": SYSTEM | {name: value}, "transient": 1, "record": 1}
    model, _ = answers(page, "open", 5, view=view)
    orbit, _ = answers(page, "orbit", 6, view=view, value=0.1)
    assert (model["type"], orbit["type"]) == ("model", "orbit")
    (shown,) = (number for number in model["numbers"] if number["name"] == name)
    assert shown["low"] <= value <= shown["high"]
    json.dumps([model, orbit], allow_nan=False)
