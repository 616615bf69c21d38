"""Objects and errors that users hold survive pickle and copy, also on their way through a pool of processes."""

import copy
import importlib
import multiprocessing
import pickle
import pkgutil
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from support import ROOT
from support.oscillators import PAPER

import vibro_sweep as vs

pytest.importorskip("distributed")  # whose tblib changes how every error is pickled

SYSTEM = PAPER.replace(b=0.4)


def errors() -> list[type[Exception]]:
    """Every class of errors that the package declares."""
    found = set()
    for module in pkgutil.walk_packages(vs.__path__, "vibro_sweep."):
        if module.name.endswith("__main__") or module.name == "vibro_sweep.driver.cluster":
            continue
        for one in vars(importlib.import_module(module.name)).values():
            if isinstance(one, type) and issubclass(one, Exception) and one.__module__ == module.name:
                found.add(one)
    return sorted(found, key=lambda one: one.__name__)


ARGUMENTS = {
    "ParameterError": ("R", 2, "between 0 and 1"),
    "SceneError": ("scene", ["R: too large"]),
    "MissingError": (Path("x"),),
    "ForeignError": (Path("x"), "h5netcdf=1.8.2"),
    "FileError": (Path("x"), "cannot be read"),
}


@pytest.mark.parametrize("kind", errors(), ids=lambda kind: kind.__name__)
def test_every_error_of_the_package(kind):
    error = kind(*ARGUMENTS.get(kind.__name__, ("what is wrong",)))
    for again in (pickle.loads(pickle.dumps(error)), copy.copy(error), copy.deepcopy(error)):
        assert type(again) is kind and str(again) == str(error) and vars(again) == vars(error)


def raised(call, *arguments):
    with pytest.raises(Exception) as found:
        call(*arguments)
    return found.value


def test_errors_as_they_are_raised(tmp_path):
    (tmp_path / "x.yaml").write_text("system: 3\n")
    for error in (
        raised(vs.open, tmp_path / "none.h5"),
        raised(vs.plot, tmp_path / "none.h5"),
        raised(vs.load_scene, tmp_path / "x.yaml"),
        raised(SYSTEM.replace, 1),
        raised(lambda: SYSTEM.replace(R=2)),
    ):
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error) and str(again) == str(error)


@pytest.fixture(scope="module")
def objects():
    orbit = vs.periodic_orbit(SYSTEM, itinerary="LLLRRR")
    branch = vs.continue_orbit(orbit, "b", (0.37, 0.42))
    lost = vs.simulate(SYSTEM.replace(R=0.2), np.zeros(4), 20)  # with chatter
    return {
        "system": SYSTEM,
        "model": vs.Oscillator.named("one_mass", zeta=0.1, F=1, omega=1, R=0.5, b=0.3),
        "orbit": lost,
        "status": lost.status,
        "exponents": vs.lyapunov(SYSTEM, np.zeros(4), 20, 20),
        "grazing": vs.grazing(SYSTEM),
        "periodic orbit": orbit,
        "branch": branch,
        "special point": next(one for one in branch.special if one.type == "pitchfork"),
        "mapping": vs.discontinuity_map(SYSTEM),
        "born": vs.born_at_grazing(SYSTEM)[0],
        "scene": vs.load_scene(ROOT / "configs" / "quickstart.yaml"),
        "dataset": vs.sweep(SYSTEM, {"b": [0.4]}, observe=["section"], transient=10, record=10),
    }


def test_objects(objects):
    assert objects["status"].note
    for name, one in objects.items():
        for again in (pickle.loads(pickle.dumps(one)), copy.copy(one), copy.deepcopy(one)):
            assert type(again) is type(one), name
            assert repr(again) == repr(one), name
    orbit, again = objects["orbit"], copy.deepcopy(objects["orbit"])
    assert np.array_equal(orbit.sample([1.0]), again.sample([1.0]))
    assert (orbit.status.code, orbit.status.note) == (again.status.code, again.status.note)
    mapping, again = objects["mapping"], pickle.loads(pickle.dumps(objects["mapping"]))
    assert np.array_equal(mapping(mapping.graze), again(again.graze))
    point, again = objects["special point"], copy.deepcopy(objects["special point"])
    assert np.array_equal(point.orbit.sample([1.0]), again.orbit.sample([1.0]))
    assert len(vs.switch(point)) == len(vs.switch(again))
    branch, again = objects["branch"], pickle.loads(pickle.dumps(objects["branch"]))
    assert [one.parameters for one in branch.special] == [one.parameters for one in again.special]


def impacts(system, state):
    return vs.simulate(system, state, 5)


@pytest.mark.slow
def test_through_a_pool_of_processes():
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        orbit = pool.submit(impacts, SYSTEM, np.zeros(4)).result()
        assert np.array_equal(orbit.impacts, impacts(SYSTEM, np.zeros(4)).impacts)
        with pytest.raises(ValueError, match="state"):
            pool.submit(impacts, SYSTEM, np.zeros(3)).result()
        with pytest.raises(vs.ParameterError, match=r"R: 2 is not allowed"):
            pool.submit(replaced, SYSTEM).result()
        assert pool.submit(len, "it lives").result() == 8


def replaced(system):
    return system.replace(R=2)
