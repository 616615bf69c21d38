"""The paper's scenes, and what the table of the page on the paper says."""

import pytest
from support import paper

from vibro_sweep import grazing, load_scene

SCENES = sorted(paper.SCENES.glob("*.yaml"))


def test_every_scene_has_a_figure():
    assert [scene.stem for scene in SCENES] == sorted(paper.FIGURES)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_scenes_are_the_papers(path):
    scene = load_scene(path)
    system = scene.system
    numbers = (system.mu_m, system.mu_k, system.zeta, system.f2, system.omega, system.R)
    assert numbers == (10, 5, 0.05, 0, 0.63, 0.8)
    assert scene.dynamics == ("map" if path.stem in ("figure_06", "figure_07", "figure_08") else "flow")
    if scene.dynamics == "map" or path.stem < "figure_05":  # these start at the grazing point
        point = (scene.expand_at or grazing(system).b, *grazing(system).state[1:])
        assert scene.start.state == pytest.approx(point, abs=1e-14)
    if "06" in path.stem:
        b = scene.sweep["b"]
        assert (b[0], b[-1], len(b), scene.transient, scene.record) == (6.5, pytest.approx(6.9), 2001, 1300, 200)


@pytest.fixture(scope="module")
def table():
    return paper.table(paper.Runner(workers=None))


@pytest.mark.slow
def test_double_grazing(table):
    assert table.b[0] == pytest.approx(6.70571674097302, abs=1e-13)
    assert table.tau[0] == pytest.approx(2.229306509033, abs=1e-12)
    assert max(table.b[1], table.tau[1]) < 1e-13


@pytest.mark.slow
def test_states_of_the_flow(table):
    found = {b: models["exact flow"] for b, models in table.states.items()}
    (free,), (periodic,), (chaotic,), mirrored = (found[b] for b in (6.8, 6.69, 6.68, 6.6))
    assert free.kind == "period 1, no impacts"
    assert free.exponent == pytest.approx(-0.0212917, abs=1e-7)
    assert periodic.kind == "period 29, 4 + 4 impacts"
    assert chaotic.kind == "chaotic"
    assert {attractor.kind for attractor in mirrored} == {"period 13, 0 + 4 impacts", "period 13, 4 + 0 impacts"}


@pytest.mark.slow
def test_states_of_the_maps(table):
    for b in (6.6, 6.68, 6.69):
        (band,) = table.states[b]["map, order 1"]
        assert band.kind == "chaotic"
        assert band.exponent > 10 * band.error
    for b in (6.6, 6.69, 6.8):
        kinds = [{a.kind for a in table.states[b][name]} for name in ("map, order 2", "exact flow")]
        assert kinds[0] == kinds[1]


@pytest.mark.slow
def test_where_the_band_ends(table):
    for name, expected in (("map, order 1", table.b[0]), ("  expanded at the printed b", paper.PAPER["b*"])):
        end, off = table.from_graze[name]
        assert end == pytest.approx(expected, abs=2 * off)
    for end in table.from_elsewhere.values():  # hysteresis: in the maps as in the flow
        assert 6.74 < end.most <= end.last + paper.STEP < 6.77
