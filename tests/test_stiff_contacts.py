"""Contacts between stiffly and softly held masses, and far stops: as exact as rounding the data allows.

`python tests/test_stiff_contacts.py FIRST LAST` compares the oscillators FIRST ... LAST - 1, a line for each.
"""

import sys
from collections import Counter

import numpy as np
import pytest
from support.stiff_contacts import compared

import vibro_sweep as vs

COUNT = 500
LEAST = 10.0  # errors allowed, in units of what rounding the data does


def line(report):
    begin = (
        f"{report['seed']:5d} {report['masses']} {report['ratio']:8.1e} {report['offset/b']:8.1f} {report['damper']:8s}"
    )
    if "refused" in report:
        return f"{begin} refused: {report['refused']}"
    errors = " ".join(f"{error:8.2f}" for error in report["errors"].values())
    return f"{begin} {report.get('compared', 0):2d} {errors} {report.get('defect', '')}".rstrip()


def hold(reports):
    assert not [line(one) for one in reports if "defect" in one]
    assert not [line(one) for one in reports if max(one["errors"].values(), default=0.0) > LEAST]
    refused = sum("refused" in one for one in reports)
    assert refused <= len(reports) / 10 and sum(one.get("compared", 0) for one in reports) > 3 * (
        len(reports) - refused
    )


@pytest.mark.parametrize(
    ("k", "c", "omega", "time"),
    [(1e8, 0, 1.0, 1.12171239257454783), (1e12, 2e6, 2.0, 0.912735041695172359)],
)
def test_between_a_stiffly_and_a_softly_held_mass(k, c, omega, time):
    """Times by 40 digits."""
    system = vs.Oscillator(
        [[1, 0], [0, 2]], [[k, -1], [-1, 3]], [[c, 0], [0, 0.01]], force=[0, 1], along=[1, -1], omega=omega, R=0.8,
        b=0.1, tau=0.0,
    )  # fmt: skip
    assert abs(vs.simulate(system, [0] * 4, 1).impacts["t"][0] - time) <= 2 * np.spacing(time)


@pytest.mark.parametrize("offset", [3e1, 3e2, -3e3])
def test_far_stops_are_like_near_ones(offset):
    """Shifted with all that holds it, an oscillator strikes when it did, to the rounding of a gap of the size of b."""
    K = np.array([[1, -0.5], [-0.5, 2.0]])
    numbers = dict(M=np.diag([1.0, 4.0]), K=K, C=0.0625 * K, along=[1, 0], force=[1, 0.5], omega=0.63, R=0.8, tau=0.1)
    place = np.array([offset, offset / 2])
    near = vs.Oscillator(b=1.0, **numbers, constant=[1e-300, 0])
    far = vs.Oscillator(b=1.0, offset=offset, constant=K @ place, **numbers)
    times = [vs.simulate(one, np.kron(x, [1, 0]), 6).impacts["t"][:10] for one, x in ((near, 0 * place), (far, place))]
    np.testing.assert_allclose(times[1], times[0], rtol=0, atol=1e-13)


def test_a_few_oscillators():
    """Among them those whose stiff masses carry most of the force, and those with far stops."""
    hold([compared(seed) for seed in (4, 54, 99)])


@pytest.mark.slow
def test_thirty_oscillators():
    hold([compared(seed) for seed in range(30)])


@pytest.mark.soak
def test_five_hundred_oscillators(capsys):
    reports = [compared(seed) for seed in range(COUNT)]
    with capsys.disabled():
        print("\n" + "\n".join(table(reports)))
    hold(reports)


def table(reports):
    counts = Counter(one.get("refused", "compared") for one in reports)
    yield f"{len(reports)} drawn: " + ", ".join(f"{name} {count}" for name, count in counts.items())
    for name in ("t", "v", "x", "xdot"):
        found = [one["errors"][name] for one in reports if one["errors"]]
        half, most, all_of_them = np.quantile(found, [0.5, 0.9, 1.0])
        yield f"  {name:4s} 50 % {half:.2f}, 90 % {most:.2f}, largest {all_of_them:.2f}"


if __name__ == "__main__":
    print(" seed N    ratio offset/b damper    n        t        v        x     xdot: in units of what rounding does")
    reports = []
    for seed in range(*map(int, sys.argv[1:])):
        reports.append(compared(seed))
        print(line(reports[-1]), flush=True)
    print("\n".join(table(reports)))
