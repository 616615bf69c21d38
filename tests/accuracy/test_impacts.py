"""The first 30 impacts of orbits from far to near grazing, against the slow simulator.

The bound is ten times what one part in 2^53 on every input does to the same impact there.
"""

import json
import math

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive

import vibro_sweep as vs

REFERENCES = json.loads(naive.REFERENCE.read_text())


def name(reference):
    return f"b={reference['params']['b']}-x1={reference['state'][0]:.3g}"


def agrees(new, old):
    """Impacts to 20 digits, the effects of rounding to the 3 that are stored."""
    assert {key: new[key] for key in ("params", "state", "side")} == {
        key: old[key] for key in ("params", "state", "side")
    }
    for field in naive.FIELDS:
        with mp.workdps(25):
            for p, q in zip(new["impacts"][field], old["impacts"][field], strict=True):
                assert abs(mpf(p) - mpf(q)) < mpf("1e-20")
        np.testing.assert_allclose(new["effect"][field], old["effect"][field], rtol=0.01)


@pytest.mark.parametrize("reference", REFERENCES, ids=name)
def test_first_impacts(reference):
    system = vs.System(**reference["params"])
    last = float(reference["impacts"]["t"][-1])
    periods = math.floor(last * system.omega / (2 * math.pi)) + 1
    impacts = vs.simulate(system, state=tuple(reference["state"]), periods=periods).impacts[: naive.COUNT]
    assert impacts["side"].tolist() == reference["side"]
    with mp.workdps(25):
        for field in naive.FIELDS:
            error = [
                abs(mpf(x) - mpf(y)) for x, y in zip(impacts[field].tolist(), reference["impacts"][field], strict=True)
            ]
            worst = max(e / effect for e, effect in zip(error, reference["effect"][field], strict=True))
            assert worst <= 10, f"{field}: {mp.nstr(worst, 3)} times the effect of rounding the inputs"


def test_grazing_phase_to_the_rounding_of_the_inputs():
    params = REFERENCES[0]["params"]
    phase = vs.System(**{**params, "tau": "grazing"}).phase
    with mp.workdps(40):
        exact = naive.grazing(params)[1]
        moved = [naive.grazing(other)[1] for other, _ in naive.perturbed_inputs(params, [0] * 4)]
        assert abs(phase - exact) <= sum(abs(tau - exact) for tau in moved)


def test_references_cover_the_clearances():
    assert [(r["params"]["b"], tuple(r["state"])) for r in REFERENCES] == naive.ORBITS
    assert all(len(r["side"]) == naive.COUNT for r in REFERENCES)


def test_a_few_references_anew():
    for old in REFERENCES[2::6]:
        new = naive.reference(old["params"]["b"], tuple(old["state"]), count=2)
        for key in ("impacts", "effect"):
            old = {**old, key: {field: values[:2] for field, values in old[key].items()}}
        agrees(new, {**old, "side": old["side"][:2]})


@pytest.mark.slow
@pytest.mark.parametrize("old", REFERENCES, ids=name)
def test_references_anew(old):
    agrees(naive.reference(old["params"]["b"], tuple(old["state"])), old)
