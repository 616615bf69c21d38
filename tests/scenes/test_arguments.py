"""What Python functions take: numbers, arrays and data of any kind that are what they should be.

What they refuse: tests/cases/messages.yaml.
"""

import math

import numpy as np
import pytest
import xarray as xr
from support.oscillators import PAPER

import vibro_sweep as vs

SYSTEM = PAPER.replace(b=6.6)
REST = (0.0, 0.0, 0.0, 0.0)


def test_numbers_of_any_kind_are_numbers():
    for number in (1, 1.0, np.int8(1), np.float32(1), np.longdouble(1), np.array(1)):
        assert len(vs.simulate(SYSTEM, np.zeros(4, np.int8), periods=number, start_time=number).section) == 2


def test_an_orbit_is_sampled_at_a_time_at_some_or_at_none():
    for orbit in (vs.periodic_orbit(SYSTEM.replace(b=3.0), itinerary="LR"), vs.simulate(SYSTEM, REST, periods=1)):
        assert orbit.sample([]).shape == (0, 4) and orbit.sample(0).shape == (1, 4)


def test_values_of_xarray_and_what_is_not_masked():
    wanted = vs.sweep(SYSTEM, {"b": [6.5, 6.6]}, transient=0, record=3)
    for axis in (xr.DataArray([6.5, 6.6], dims="b"), {"values": xr.DataArray([6.5, 6.6])}, np.ma.array([6.5, 6.6])):
        assert vs.sweep(SYSTEM, {"b": axis}, transient=0, record=3).equals(wanted)
    assert SYSTEM.replace(b=wanted.b[1]) == SYSTEM
    assert np.array_equal(
        vs.simulate(SYSTEM, xr.DataArray(np.zeros(4)), 2).section, vs.simulate(SYSTEM, REST, 2).section
    )


@pytest.mark.parametrize("value", [math.nan, -1, None, "1", True, [1.0]])
def test_the_error_of_a_number_has_its_key_the_value_and_what_is_allowed(value):
    with pytest.raises(vs.ParameterError) as caught:
        SYSTEM.replace(mu_m=value)
    error = caught.value
    assert (error.key, repr(error.value)) == ("mu_m", repr(value)) and "number" in error.allowed
