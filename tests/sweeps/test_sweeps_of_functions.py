"""Sweeps of oscillators that a function makes."""

import numpy as np
import pytest
from support.models import oscillator

import vibro_sweep as vs


def test_a_sweep_of_what_a_function_makes(tmp_path):
    """Any number of any model: the same orbits as of the oscillators themselves, and their matrices in the file."""

    def damper(play, share):
        return oscillator("ball_in_cavity", b=play, mass_ratio=share)

    given = dict(start=(0, 0.1, 0, 0), transient=20, record=10, observe=("section", "impacts"))
    axes = {"play": [0.5, 1.0, 1.5], "share": [0.02, 0.05]}
    data = vs.sweep(damper, axes, **given, output=tmp_path / "damper.h5")
    assert data.attrs["type"] == "build" and data.attrs["build"] == "damper"
    for i, play in enumerate(axes["play"]):
        for j, share in enumerate(axes["share"]):
            here, q = data.isel(play=i, share=j), damper(play, share).linear
            orbit = vs.simulate(damper(play, share), (0, 0.1, 0, 0), 30)
            np.testing.assert_array_equal(here["x2"], orbit.section[21:, 2])
            assert (here["M22"], here["high"], here["R_low"]) == (share, play, 0.7)
            assert [[here["K11"], here["K12"]], [here["K12"], here["K22"]]] == q.K.tolist()
    vs.plot(data.isel(share=0), kind="bifurcation")
    with pytest.raises(TypeError, match="a System or an Oscillator"):
        vs.sweep(lambda play: play, {"play": [1.0]})
    with pytest.raises(ValueError, match=r"axes\.play"):
        vs.sweep(damper, {"play": ["a"]})
    with pytest.raises(ValueError, match=r"start: \[0, 0\] is not allowed; it must be four finite numbers"):
        vs.sweep(damper, {"play": [0.5, 1.0], "share": [0.1]}, start=[0, 0])
    other = oscillator("one_mass")
    with pytest.raises(ValueError, match=r"play=2.0\): 1 masses are not allowed; there must be as many"):
        vs.sweep(lambda play: other if play == 2 else damper(play, 0.1), {"play": [1.0, 2.0]}, transient=1, record=1)


@pytest.mark.slow
def test_an_interrupted_sweep_of_a_function_is_continued_by_the_same_matrices(tmp_path):
    class StoppedError(Exception):
        pass

    def ball(F, zeta=0.1):
        return oscillator("one_mass", F=F, zeta=zeta)

    given = dict(start=(0, 0), transient=50, record=10, observe=("section",), workers=1)
    axes, output = {"F": np.linspace(0.5, 1.5, 301)}, tmp_path / "ball.h5"

    def stop(done, total):
        if 0 < done < total:
            raise StoppedError

    whole = vs.sweep(ball, axes, **given)
    with pytest.raises(StoppedError):
        vs.sweep(ball, axes, **given, output=output, progress=stop)
    with pytest.raises(vs.StoreError, match="`resume` computes that"):
        vs.sweep(ball, axes, **given, output=output)

    def other(F):
        return ball(F, zeta=0.2)

    other.__name__ = "ball"
    with pytest.raises(vs.StoreError, match="made from another scene"):
        vs.sweep(other, axes, **given, output=output, mode="resume")
    begun = []
    data = vs.sweep(ball, axes, **given, output=output, mode="resume", progress=lambda done, total: begun.append(done))
    assert begun[0] > 0
    np.testing.assert_array_equal(data["x1"], whole["x1"])
    np.testing.assert_array_equal(vs.sweep(ball, axes, **given, output=output)["x1"], whole["x1"])  # it is complete
    with pytest.raises(vs.StoreError, match="holds something else than this run makes"):
        vs.sweep(other, axes, **given, output=output)
    with pytest.raises(ValueError, match="mode: 'resume' is not allowed; it must be 'new' without a file"):
        vs.sweep(ball, axes, **given, mode="resume")
