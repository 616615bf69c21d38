"""Where there is a motion without contact: `vs.quiet`, and what `check`, `run`, `info` and `grazing` say of it."""

import numpy as np
import pytest
from support.programs import ended

import vibro_sweep as vs


def lever(**more):
    numbers = dict(
        m=[2.4], k=[9500, 0], c=[3, 0], force=[40], k_stop=180000, c_stop=45, stop_right=1.5e-3, frequency=10
    )
    return vs.Oscillator.named("chain", units="SI", **numbers | more)


def amplitude(omega):
    return 40 / np.abs(9500 - 2.4 * omega**2 + 3j * omega)


def test_a_mass_on_a_spring_is_quiet_outside_of_its_resonance():
    """|40/(k - m omega^2 + i c omega)| = b, a quadratic equation in omega^2."""
    m, k, c, force, b = 2.4, 9500, 3, 40, 6e-3
    squares = np.roots([m * m, c * c - 2 * m * k, k * k - (force / b) ** 2])
    ends = np.sort(np.sqrt(squares.real)) / (2 * np.pi)
    found = vs.quiet(lever(stop_right=b), "frequency", (1, 40))
    assert np.allclose(found.ranges, [(1, ends[0]), (ends[1], 40)], rtol=1e-12) and found.attracts
    inside = vs.quiet(lever(stop_right=b), "frequency", (ends[0] * 1.01, ends[1] * 0.99))
    assert inside.ranges == [] and np.allclose((inside.below, inside.above), ends, rtol=1e-12)


@pytest.mark.parametrize("width", [1e-2, 1e-4])
def test_a_narrow_resonance_between_the_values_is_seen(width):
    """Its peak is far narrower than the distance of the values at which the room is computed first."""
    system = lever(c=[2 * width * np.sqrt(2.4 * 9500), 0], stop_right=0.9 * 40 / (2 * width * 9500))
    (low, first), (second, high) = vs.quiet(system, "frequency", (2, 60)).ranges
    peak = np.sqrt(9500 / 2.4) / (2 * np.pi)
    assert (low, high) == (2, 60) and first < peak < second and second - first < 3 * width * peak
    for end in (first, second):
        size = abs(40 / (9500 - 2.4 * (2 * np.pi * end) ** 2 + 1j * system.c1 * 2 * np.pi * end))
        assert abs(size / system.b - 1) < 1e-9


def test_a_constant_force_moves_the_middle():
    """Of a ball pressed against a stop there is none; a mass that hangs has less room on one side."""
    pressed = lever(constant=[20], stop_right=1e-3)  # it would rest at 2.1 mm
    assert vs.quiet(pressed, "frequency", (1, 1000)).ranges == []
    shifted = lever(constant=[4.75], stop_right=2e-3)  # it rests at 0.5 mm
    (found,) = vs.quiet(shifted, "frequency", (12, 40)).ranges
    assert abs(amplitude(2 * np.pi * found[0]) - 1.5e-3) < 1e-12 and found[1] == 40


def test_without_damping_nothing_fades_to_it():
    assert not vs.quiet(lever(c=[0, 0]), "frequency", (20, 30)).attracts
    assert not vs.quiet(vs.Oscillator(1, 0, force=1, contact_normal=1, omega=1, R=0.5, b=1), "b", (1, 9)).attracts


def test_simulated_orbits_agree():
    """On both sides of the end of the range an orbit from rest meets the stop, or does not."""
    system = lever(c=[60, 0])
    (low, _), = vs.quiet(system, "frequency", (15, 30)).ranges  # fmt: skip
    for times, met in ((0.999, True), (1.001, False)):
        there = system.replace(frequency=low * times)
        late = vs.simulate(there, vs.simulate(there, None, 600).section[-1], 20)
        assert bool(len(late.contacts)) == met


SCENE = """
system: {type: chain, m: [2.4], k: [9500, 0], c: [3, 0], force: [40], k_stop: 180000, c_stop: 45, stop_right: 0.0015,
  units: SI}
sweep: {frequency: {start: 5, stop: 15, num: 5}}
orbit: {transient: 20, record: 10}
observe: [section, contacts]
"""


def test_what_the_program_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "low.yaml").write_text(SCENE)
    high = SCENE.replace("stop: 15", "stop: 25").replace("transient: 20", "transient: 900")
    (tmp_path / "high.yaml").write_text(high)
    lines = ended("check", "low.yaml", "--quick").out.splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("  machine"))
    assert [line[12:] for line in lines[first:]] == [
        "natural frequency 10.01 Hz; damping ratio 0.00993",
        "force at 5 to 15 Hz, omega = 31.42 to 94.25 rad/s",
        "free motion 3.384 to 210.3 mm, gap 1.5 mm: always touched",
        "without contact: nowhere in 5 to 15 Hz; from 19.54 Hz on",
        "the slowest mode settles in 310 forcing periods; transient 20",
    ]
    for name in ("low", "high"):
        assert lines[first] in ended("run", f"{name}.yaml").out
    assert "quiet        without contact: nowhere in 5 to 15 Hz; from 19.54 Hz on\n" in ended("info", "low.h5").out
    assert "without contact: frequency = 19.54 to 25 Hz; there 2 of 2 orbits move so\n" in ended("info", "high.h5").out
    again = ended("run", "low.yaml").out
    assert "machine" not in again and "complete already" in again


def test_units_that_are_wrong_are_seen():
    """A gap in mm, a frequency in Hz in place of rad/s, a damping ratio in place of a damper."""
    texts = {
        "stop_right: 0.0015": ("stop_right: 1.5", "gap 1.5 m: never touched"),
        "frequency: {start: 5": ("omega: {start: 5", "force at 0.7958 to 2.387 Hz"),
        "c: [3, 0]": ("c: [0.01, 0]", "damping ratio 3.31e-05"),
    }
    for old, (new, seen) in texts.items():
        with open("wrong.yaml", "w") as file:
            file.write(SCENE.replace(old, new))
        assert seen in ended("check", "wrong.yaml", "--quick").out


@pytest.fixture(autouse=True)
def _folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def said(text):
    """The machine lines of `check`."""
    with open("scene.yaml", "w") as file:
        file.write(text)
    out = ended("check", "scene.yaml", "--quick").out
    return out[out.index("machine") :]


def test_what_is_said_of_branches_is_that_of_all_values_between_their_ends():
    """A resonance lies within the range, and the free motion at both of its ends is small."""
    text = SCENE[: SCENE.index("sweep:")].replace("0.0015", "0.02")
    text += "continue: {from: free, parameter: {frequency: [2, 40]}}\n"
    lines = said(text.replace("units: SI}", "units: SI, frequency: 3}"))
    peak = np.sqrt(9500 / 2.4 - (3 / 2.4) ** 2 / 2)
    assert f"to {1e3 * amplitude(peak):.4g} mm, gap 20 mm: touched at some" in lines


@pytest.mark.parametrize("ends", ["start: 5000, stop: 20000", "start: 20000, stop: 5000"])
def test_modes_of_a_machine_whose_stiffness_is_swept(ends):
    text = SCENE.replace("frequency: {start: 5, stop: 15", f"k1: {{{ends}").replace(
        "units: SI", "frequency: 9, units: SI"
    )
    lines = said(text)
    low, high = (np.sqrt(k / 2.4) / (2 * np.pi) for k in (5000, 20000))
    ratios = [3 / (2 * np.sqrt(2.4 * k)) for k in (20000, 5000)]
    assert f"natural frequency {low:.4g} to {high:.4g} Hz; damping ratio {ratios[0]:.3g} to {ratios[1]:.3g}" in lines
