"""Orbits that are under way after their transient go on until they have arrived; others are as without `settle`."""

import re

import numpy as np
import pytest
from support import sample, slow_cases
from support.arrivals import study_of_settle
from support.programs import main
from support.same_bits import study
from support.searching import searched

import vibro_sweep as vs

NOT_SETTLED = 6


def resonator(Q):
    """In resonance, beside a stop that it does not reach: it comes nearer to x1 = -1 by exp(-pi/Q) in a period."""
    return vs.Oscillator.named(
        "one_mass", k=1.0, zeta=0.5 / Q, F=1 / Q, omega=1.0, R=0.5, b=1.1, stops="right", tau=0.0
    )


def settled(system, axis, settle=None, transient=300, record=60, observe=("section",), **more):
    return vs.sweep(
        system, axis, settle=settle, transient=transient, record=record, observe=list(observe), workers=1, **more
    )


@pytest.mark.parametrize("start", [None, {"follow": "both"}, {"random": 9, "seed": 1}], ids=["rest", "chain", "drawn"])
@pytest.mark.parametrize("observe", [["section"], ["section", "lyapunov", "energy"]], ids=["section", "exponents"])
@pytest.mark.parametrize("Q", [400, 1e4, 1e5])
def test_a_resonator_arrives(Q, observe, start):
    """It needs log(1/3e-6) Q/pi periods from rest."""
    data = settled(resonator(Q), {"b": np.linspace(1.1, 1.3, 11)}, 10**6, observe=observe, start=start)
    assert (data.status == 0).all() and (data.period == 1).all()
    assert np.abs(data.x1[..., -1] + 1).max() < 1e-5
    if start is None:
        needed = np.log(1 / 3e-6) * Q / np.pi
        assert 0.8 * needed < data.transient_periods.max() + 60 < 1.5 * (needed + 60)
    if "energy" in observe:
        assert np.abs(data.peak_x1 - 1).max() < 1e-5 and np.abs(data.rms_x1 * np.sqrt(2) - 1).max() < 1e-5


def test_a_chain_goes_on_from_where_an_orbit_has_arrived():
    data = settled(resonator(400), {"b": np.linspace(1.1, 1.3, 5)}, 10**5, start={"follow": "up"})
    assert data.transient_periods[0] > 1000 and (data.transient_periods[1:] == 300).all()


def test_at_most_so_many_periods():
    data = settled(resonator(1e5), {"b": [1.1]}, 5000)
    assert data.status.item() == NOT_SETTLED and data.approached_period.item() == 1
    assert 4000 < data.transient_periods.item() <= 5000
    plain = settled(resonator(1e5), {"b": [1.1]}, transient=data.transient_periods.item())
    assert np.abs(plain.x1 - data.x1).max() < 1e-13  # it has gone on for as many as the file says


@pytest.mark.parametrize(
    "observe", sample(1, [["section"], ["section", "lyapunov", "impacts", "energy", "attractors"]])
)
def test_others_have_the_bits_that_they_have_without(observe):
    """Of the paper's oscillator: chaos, windows, and beside their ends orbits that are slow."""
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    axis = {"b": np.linspace(4.2, 4.5, 201)}
    plain, more = (settled(system, axis, n, transient=400, record=200, observe=observe) for n in (None, 20_000))
    went_on = (more.transient_periods > 400).values
    assert (plain.status.values[went_on] == NOT_SETTLED).all() and 0 < went_on.sum() < 100
    still = (more.status.values == NOT_SETTLED) & went_on
    assert still.sum() < went_on.sum() / 2 and (plain.status.values == NOT_SETTLED).sum() == went_on.sum()
    for name in plain.data_vars:
        assert plain[name].values[~went_on].tobytes() == more[name].values[~went_on].tobytes(), name


def test_a_section_of_impacts_has_those_of_the_last_record():
    """Of a resonator that is set free against its stop, and strikes it no more once it has arrived."""
    system = vs.Oscillator.named("one_mass", k=1.0, zeta=0.005, F=0.01, omega=1.0, R=0.9, b=1.3, stops="right", tau=0.0)
    more = {"start": {"x1": -3.0}, "section": {"kind": "impact", "stop": "right"}, "observe": ("section", "impacts")}
    first = settled(system, {"b": [1.3]}, transient=0, **more)
    assert first.status.item() == NOT_SETTLED and first.impacts_right.item() == np.isfinite(first.x1).sum() > 5
    data = settled(system, {"b": [1.3]}, 10**5, transient=0, **more)
    assert data.period.item() == 1 and data.impacts_right.item() == np.isfinite(data.x1).sum() == 0
    assert np.isnan(data.phase).all()


def test_it_is_in_the_file_only_where_it_is_asked_for():
    system = resonator(400)
    assert "transient_periods" not in settled(system, {"b": [1.1]})
    data = settled(system, {"b": [1.1]}, 1000)
    assert data.attrs["settle"] == 1000 and data.transient_periods.dtype == "i8"
    assert "settle: 1000" in data.attrs["scene"]


@pytest.mark.parametrize("seeds", [range(6), *slow_cases(range(6, 20))], ids=len)
def test_the_same_bits_of_any_machine(seeds):
    counted, wrong = searched(study, seeds)
    assert wrong == [] and counted["killed"] > counted["scenes"] / 2 and counted["went_on"] > 0


@pytest.mark.parametrize("seeds", [range(25, 45), *slow_cases(range(45, 60))], ids=len)
def test_at_most_twice_what_is_needed(seeds):
    counted, _ = searched(study_of_settle, seeds)
    assert counted["took_more_than_twice"] == counted["not_arrived"] == 0 and counted["went_on"] > len(seeds) / 10


def test_the_settle_that_info_names_is_enough(tmp_path, capsys):
    """Of a file whose transient was long already, and not long enough."""
    system = "{type: one_mass, k: 1, zeta: 5.0e-5, F: 1.0e-4, omega: 1, R: 0.5, b: 9, stops: right, tau: 0}"
    scene, file = tmp_path / "slow.yaml", str(tmp_path / "slow.h5")
    for more in ("", "settle: {}, "):
        named = more.format(*re.findall(r"orbit: settle: (\d+)`", capsys.readouterr().out))
        scene.write_text(f"system: {system}\norbit: {{transient: 9000, {named}record: 60}}\n")
        assert main(["run", str(scene), "-o", file, "--overwrite", "--quiet"]) == 0 and main(["info", file]) == 0
    assert "settle: " in scene.read_text() and "not settled" not in capsys.readouterr().out


def test_what_fails_has_no_length_of_its_transient():
    system = vs.System(mu_m=1, mu_k=1, zeta=0.05, f2=0, omega=0.6, R=0.9999, b=1e-6, tau=0)
    data = settled(system, {"omega": [1e-9, 0.6]}, 1000)
    failed = ~np.isin(data.status.values, (0, NOT_SETTLED))
    assert failed.any() and (data.transient_periods.values[failed] == -1).all()
