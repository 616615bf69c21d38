"""Random starts of oscillators whose stops may lie beside where they rest."""

import numpy as np
import pytest
from support import sample

import vibro_sweep as vs
from vibro_sweep.driver import blocks
from vibro_sweep.driver.drawn_starts import starts_of
from vibro_sweep.scene import scene_of as scene_from
from vibro_sweep.scene.written import changed


@pytest.mark.parametrize("stops", sample(1, ["left", "right", "both"]))
def test_they_are_between_the_stops(stops):
    """With one stop, masses that lie around the stops' middle may all have a gap beyond it: it is moved inside."""
    moved = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        n = int(rng.integers(1, 4))
        numbers = {"M": np.eye(n), "K": 2 * np.eye(n), "C": 0.1 * np.eye(n), "force": np.ones(n)}
        numbers |= {
            "contact_normal": rng.normal(size=n),
            "offset": 10 * rng.normal(),
            "omega": 0.7,
            "R": 0.8,
            "stops": stops,
        }
        system = vs.Oscillator.named("linear", b=float(rng.uniform(0.01, 1)), **numbers)
        given = {"sweep": {"b": [system.b]}, "start": {"random": 3, "seed": 1}, "transient": 0, "record": 1}
        scene = scene_from(changed({}, {"system": system, **given}), "sweep")
        (block,) = blocks.blocks(scene, lambda: 1)
        states, q = starts_of(block)[0], system.linear
        gaps = states[:, 0::2] @ q.contact.normal
        slack = 1e-12 * np.abs(states).max()
        assert np.all(np.isfinite(states)) and np.all(
            (q.contact.low - slack < gaps) & (gaps < q.contact.high + slack)
        ), seed
        moved += np.abs(states[:, 0::2] - system.offset).max() > system.b
    assert moved > 10
