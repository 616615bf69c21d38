"""Random scenes, those of fuzz_scenes.py: a result or one message each; and what every result must be."""

import functools
import json
import random
import re
import tempfile
from collections import Counter
from pathlib import Path

import jsonschema
import numpy as np

import vibro_sweep as vs
from support.contents import assert_same_bits
from support.fuzz_scenes import broken, scene, to_yaml
from support.programs import ended
from support.scene_texts import parsed
from support.searching import Report, new_report
from support.yaml_core import read
from vibro_sweep.types import Scene

EPS = 2.0**-52
VALID = (0, 6)  # ok and not_settled

# Reasons that JSON Schema does not say: relations between values, and between keys.
BEYOND_THE_SCHEMA = re.compile(
    "must be finite|must be a finite number|range of the floats|is behind a stop|unless it is swept|rise or fall|"
    "makes .* values; at most|wrong sign|must differ from start|of memory at once|numbers; at most|points; at most|"
    "no finite steady motion|in resonance|must be .*proportional|P1 . P2 > 0|has no such stop|belongs to|"
    "nothing would be computed|no sweep to follow|says where orbits start|is swept, and|not observed|no motion between|"
    "must be given; or k_stop|rigid or compliant|both stops are rigid|the map's section|resolution of double|"
    "is farther than"
)
UNREADABLE = re.compile(r"line \d+, column \d+: |unacceptable character |longer than ")


def contents(folder: Path) -> dict:
    return {path.name: (path.read_bytes(), path.stat().st_mtime_ns) for path in folder.iterdir()}


def study(n: int) -> Report:
    """What became of scene n, valid or broken, before `check`: a result, or one message."""
    report = new_report(scenes=1)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.yaml"
        path.write_bytes(broken(n))
        before = contents(path.parent)
        status, out, err = ended("check", path)
        changed = contents(path.parent) != before
    one_message = (out == "") == (status == 2) and err.count("error: ") == (status == 2) and "Traceback" not in err
    if changed or status not in (0, 2) or not one_message:
        report.wrong.append(f"scene {n}: status {status}, {err}" + ", files are changed" * changed)
        return report
    outcome, wrong = agreement(n, status)
    report.counted[outcome] += 1
    report.wrong.extend(f"scene {n}: {words}" for words in wrong)
    return report


@functools.cache
def validator() -> jsonschema.Draft7Validator:
    return jsonschema.Draft7Validator(json.loads(ended("schema").out))


def agreement(n: int, status: int) -> tuple[str, list[str]]:
    """What became of scene n, and where program and schema are not of one mind although the schema can have one."""
    problems: tuple[str, ...] = ()
    try:
        text = broken(n).decode("utf-8-sig")
        parsed(text)
    except UnicodeDecodeError:
        return "refused: no YAML", ["it is accepted"] * (status != 2)
    except vs.SceneError as error:
        problems = error.problems
    if any(map(UNREADABLE.match, problems)):
        return "refused: no YAML", ["it is accepted"] * (status != 2)
    beyond = [error.message for error in validator().iter_errors(read(text))]
    if status == 0:
        return "accepted", beyond
    if beyond:
        return "refused: form", []
    wrong = [problem for problem in problems if not BEYOND_THE_SCHEMA.search(problem)]
    return "refused: relations and sizes", wrong if problems else ["load_scene accepts it"]


def study_of_runs(n: int) -> Report:
    """The run of valid scene n, by several ways. Raises AssertionError where a result is not what it must be."""
    try:
        valid = parsed(to_yaml(scene(n)))
    except vs.SceneError as error:  # a sweep may lead behind a stop, or into resonance
        assert BEYOND_THE_SCHEMA.search(str(error)), str(error)
        return new_report(refused=1)
    with tempfile.TemporaryDirectory() as folder:
        whole = computed(valid, folder, block=10**6)
        _hold(valid, whole, n)
        assert_same_bits(computed(valid, folder, workers=1 + n % 3, block=1 + n % 2), whole)
    well = int(np.count_nonzero(np.isin(whole["status"], VALID)))
    return new_report(runs=1, orbits=whole["status"].size, well=well)


def computed(valid: Scene, folder: str, workers: int = 1, block: int = 1) -> dict[str, np.ndarray]:
    """The arrays of a scene's file; its report counts what they hold."""
    path = Path(folder) / "out.h5"
    report = vs.run(valid, path, workers=workers, block=block, mode="overwrite")
    with vs.open(path) as data:
        arrays = {str(name): values.values for name, values in data.data_vars.items()}
    assert report.points == valid.n_points and report.bad == np.count_nonzero(~np.isin(arrays["status"], VALID))
    return arrays


def study_of_extremes(seed: int) -> Report:
    """Numbers of any size that a float may have: refused by name, or a status; numbers that are ok are numbers."""
    choose = random.Random(f"ends {seed}")
    sizes = [10.0**exponent for exponent in (-300, -200, -100, -30, -10, -3, 3, 10, 30, 100, 200, 300)]
    numbers = {"mu_m": 10, "mu_k": 5, "zeta": 0.05, "f2": 0, "omega": 0.63, "R": 0.8, "b": 6.6}
    numbers |= {name: choose.choice(sizes) for name in choose.sample(list(numbers), 3) if name not in ("f2", "R")}
    orbit, observe = {"transient": 3, "record": 5}, ["section", "lyapunov", "impacts"]
    try:
        valid = parsed(to_yaml({"system": numbers, "orbit": orbit, "observe": observe}))
    except vs.SceneError as error:
        return Report(Counter(refused=1), [] if BEYOND_THE_SCHEMA.search(str(error)) else [f"seed {seed}: {error}"])
    with tempfile.TemporaryDirectory() as folder:
        arrays = computed(valid, folder)
    status = int(arrays["status"])
    well = not np.isnan(arrays["lyapunov"]).any() and np.isfinite(arrays["x1"]).all()
    bad = status in VALID and not well
    return Report(Counter({f"status {status}": 1}), [f"seed {seed}: {numbers}: status {status}, no numbers"] * bad)


def _hold(one, arrays, n):
    """What holds of every result."""
    numbers, ok = one.parameters(), np.isin(arrays["status"], VALID)
    b = np.broadcast_to(numbers["b"][..., None] if one.n_starts > 1 else numbers["b"], one.shape)
    assert arrays["status"].shape == one.shape and (arrays["status"] >= 0).all(), n
    for name, values in arrays.items():
        assert values.shape[: len(one.shape)] == one.shape, (n, name)
    if "x1" in arrays:
        assert arrays["x1"].shape == (*one.shape, one.record)
        for name in ("x1", "v1", "x2", "v2"):
            missing = np.isnan(arrays[name][ok])
            assert one.section.kind == "impact" or not missing.any(), (n, name)
            assert (np.diff(missing.astype(int), axis=-1) >= 0).all(), (n, name)  # and nothing after the last impact
        if one.dynamics == "flow":
            inside = _inside(arrays["x1"][ok], b[ok][:, None], one.system.stops)
            assert inside.all(), n
        if one.section.kind == "impact":
            side = 1 if one.section.stop == "right" else -1
            known = ~np.isnan(arrays["x1"])
            assert (arrays["x1"][known] == side * np.broadcast_to(b[..., None], known.shape)[known]).all(), n
            assert (side * arrays["v1"][known] > 0).all() and (arrays["phase"][known] >= 0).all(), n
    if "trajectory_x1" in arrays:
        assert np.isfinite(arrays["trajectory_x1"][ok]).all(), n
        assert _inside(arrays["trajectory_x1"][ok], b[ok][:, None], one.system.stops).all(), n
    if "period" in arrays:
        assert ((arrays["period"][ok] >= 0) & (arrays["period"][ok] <= one.record // 2)).all(), n
    if "impacts_right" in arrays:
        hits = arrays["impacts_right"] + arrays["impacts_left"]
        assert (hits[ok] >= 0).all() and (arrays["sticking_time"][ok] >= 0).all(), n
        if one.dynamics == "flow":
            slowest, rested = arrays["min_impact_speed"], arrays["sticking_time"] > 0  # chatter ends in a rest
            assert ((slowest > 0) | ((slowest == 0) & rested))[ok & (hits > 0)].all(), n
    if "lyapunov" in arrays:
        spectrum, residual = arrays["lyapunov"][ok], arrays["lyapunov_residual"][ok]
        assert not np.isnan(spectrum).any() and (spectrum < np.inf).all(), n
        finite = np.isfinite(spectrum).all(-1)
        assert (np.diff(spectrum[finite], axis=-1) <= 0).all(), n
        assert (np.isfinite(residual) <= finite).all(), n
        scale = 1 + np.abs(spectrum[finite]).max(-1, initial=0)
        known = np.isfinite(residual[finite])
        assert (np.abs(residual[finite][known]) <= 1e-6 * scale[known]).all(), (n, np.abs(residual[finite]).max())


def _inside(x1, b, stops):
    slack = b * (1 + 4 * EPS)
    return ((x1 <= slack) | (stops == "left") | np.isnan(x1)) & ((x1 >= -slack) | (stops == "right") | np.isnan(x1))
