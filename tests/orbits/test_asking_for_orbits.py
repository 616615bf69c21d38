"""`periodic_orbit`: what may be asked for, how failures are told, files and pictures of orbits."""

import json
import math

import numpy as np
import pytest
from support.oscillators import PAPER

import vibro_sweep as vs


def test_guess_may_be_a_rotation_of_the_itinerary():
    orbit = vs.periodic_orbit(PAPER, itinerary="LR")
    guess = [(hit["t"], hit["side"], hit["v1"]) for hit in orbit.impacts[::-1]]
    guess[1] = (guess[1][0] + PAPER.period, *guess[1][1:])
    again = vs.periodic_orbit(PAPER, itinerary="LR", guess=guess)
    assert again.ok and again.impacts["t"] == pytest.approx(orbit.impacts["t"], abs=1e-13)


def test_failures_are_told_by_status():
    assert vs.periodic_orbit(PAPER.replace(b=9.0), guess=[(0.0, 1, 3.0)]).status in ("not_converged", "inadmissible")
    resonant = PAPER.replace(zeta=0.0, tau=0.0, omega=math.sqrt(PAPER.modes.omega_squared[0]))
    orbit = vs.periodic_orbit(resonant, itinerary="")
    assert orbit.status == "resonance" and not orbit.ok and len(orbit.impacts) == 0 and math.isnan(orbit.stop_distance)
    resting = PAPER.replace(b=0.03)
    state = vs.simulate(resting, (0, 0, 0, 0), 200).section[-1]
    assert vs.periodic_orbit(resting, state=state).status == "sticking"


def test_touches_that_hold_a_free_mass_are_no_impacts():
    """The ball may be at rest anywhere in its cavity, at a stop as well; with impacts it has orbits."""
    system = vs.Oscillator.named(
        "ball_in_cavity", mass_ratio=0.3828802628642237, zeta=0.02276833525040379, F=0.45934115344610726,
        omega=1.1198987551534054, R=0.8111725304055444, b=1.818778311334295, tau=3.8085778862473907,
    )  # fmt: skip
    for word, periods in (("", 1), ("RR", 3), ("R", 2)):
        assert vs.periodic_orbit(system, itinerary=word, periods=periods).status == "resonance"
    assert vs.periodic_orbit(system, itinerary="LR").ok


def test_orbit_survives_its_file(tmp_path):
    orbit = vs.periodic_orbit(PAPER.replace(b=1.0), itinerary="LLRR")
    path = orbit.save(tmp_path / "orbit.json")
    again = vs.load(path)
    assert again.status == "ok" and again.system == orbit.system
    assert again.impacts.tobytes() == orbit.impacts.tobytes()
    with pytest.raises(FileExistsError):
        orbit.save(path)
    record = json.loads(path.read_text())
    for damage in ({"format": "x"}, {"sides": [1, 5]}, {"unknowns": [1.0]}, {"system": {"b": 1}}, {"halves": 2}):
        path.write_text(json.dumps(record | damage))
        with pytest.raises(ValueError, match=path.name):
            vs.load(path)
    path.write_bytes(b"\xff\x00")
    with pytest.raises(ValueError, match=path.name):
        vs.load(path)


def test_files_of_orbits_from_before_they_had_a_checksum(tmp_path):
    orbit = vs.periodic_orbit(PAPER.replace(b=1.0), itinerary="LLRR")
    path = orbit.save(tmp_path / "orbit.json")
    new = json.loads(path.read_text())
    old = {key: value for key, value in new.items() if key != "checksum"}
    path.write_text(json.dumps(old | {"format": "vibro_sweep periodic orbit 1"}))
    assert vs.load(path).impacts.tobytes() == orbit.impacts.tobytes()
    for damaged in (old, new | {"format": "vibro_sweep periodic orbit 1"}, new | {"residual": 1e-9}):
        path.write_text(json.dumps(damaged))
        with pytest.raises(ValueError, match="checksum"):
            vs.load(path)


def test_picture(tmp_path):
    figure = vs.periodic_orbit(PAPER, itinerary="LR").plot()
    portrait, history = figure.axes
    gap = history.lines[0].get_ydata()
    assert np.nanmax(np.abs(gap)) <= PAPER.b * (1 + 1e-12)
    figure.savefig(tmp_path / "orbit.png")
    assert len(portrait.lines) >= 3
    with pytest.raises(ValueError, match="no motion"):
        vs.periodic_orbit(PAPER.replace(b=9.0), guess=[(0.0, 1, 3.0), (0.1, 1, 1e9)]).plot()


@pytest.mark.slow
def test_two_impacts_in_501_periods_pass_the_stops():
    """Thousands of solutions do, which a look at one period shows."""
    assert vs.periodic_orbit(PAPER.replace(b=3.0), itinerary="LR", periods=501).status == "inadmissible"
