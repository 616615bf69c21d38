"""Datasets that users have joined, cut or renamed: what is computed from them is right, or refused with the reason."""

import numpy as np
import pytest
import xarray
from support.oscillators import PAPER

import vibro_sweep as vs


@pytest.fixture(scope="module")
def sweeps():
    """The same sweep with two coefficients of restitution."""
    values = np.linspace(3, 4.4, 8)
    return [vs.sweep(PAPER.replace(b=4, R=R), {"b": values}, transient=500, record=100) for R in (0.2, 0.8)]


def test_a_part_of_a_joined_dataset(sweeps):
    """The attributes of a joined Dataset are those of its first part."""
    joined = xarray.concat(sweeps, dim="R")
    with pytest.raises(ValueError, match="has the dimension R, which its sweep has not; take one part by `isel`"):
        vs.windows(joined)
    with pytest.raises(ValueError, match="is not one of the oscillator that the attributes and the scene describe"):
        vs.windows(joined.isel(R=1))
    first, same = vs.windows(joined.isel(R=0)), vs.windows(sweeps[0])
    assert [(one.lo, one.hi) for one in first] == [(one.lo, one.hi) for one in same] != []


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_what_belongs_to_another_oscillator_is_seen_in_any_unit_of_length(unit):
    numbers = {"M": [[1]], "K": [[1]], "C": [[0.1]], "force": [unit], "contact_normal": [1]}
    machine = vs.Oscillator(**numbers, omega=0.8, b=unit, R=0.2, tau=0)
    values = unit * np.linspace(0.8, 1, 4)
    both = [vs.sweep(machine.replace(R=R), {"b": values}, transient=500, record=50) for R in (0.2, 0.8)]
    joined = xarray.concat(both, dim="R")
    assert len(vs.windows(joined.isel(R=0)))
    with pytest.raises(ValueError, match="is not one of the oscillator that the attributes and the scene describe"):
        vs.windows(joined.isel(R=1))


def test_a_coordinate_that_contradicts_an_attribute(sweeps):
    joined = xarray.concat(sweeps, dim="R").assign_coords(R=[0.2, 0.8])
    with pytest.raises(ValueError, match=r"R: the coordinate says 0\.8 and the attribute 0\.2; they must agree"):
        vs.windows(joined.isel(R=1))
    assert len(vs.windows(joined.isel(R=0))) == len(vs.windows(sweeps[0]))


def test_what_is_missing_is_named(sweeps):
    data = sweeps[1]
    with pytest.raises(ValueError, match="data: has no `status`"):
        vs.windows(data.drop_vars("status"))
    with pytest.raises(ValueError, match="data: observe: has no 'section'"):
        vs.windows(data.drop_vars("x1"))
    with pytest.raises(vs.PlotError, match="this dataset is not from"):
        vs.plot(data.drop_vars("status"))
