"""Thousands of random scenes: a result or one message each; and what every result must be, whoever computes it."""

import contextlib
import io
import random
import re
from collections import Counter

import h5py
import jsonschema
import numpy as np
import pytest
from support.fuzz_scenes import broken, scene, to_yaml
from support.programs import main
from support.scene_texts import parsed
from support.scenes import assert_same_bits, computed

import vibro_sweep as vs
from vibro_sweep.model.status import VALID
from vibro_sweep.scene import json_schema
from vibro_sweep.scene.yaml_text import YAMLTextError, read_yaml

EPS = 2.0**-52

# Reasons that JSON Schema does not say: relations between values, and between keys.
BEYOND_THE_SCHEMA = re.compile(
    "must be finite|must be a finite number|range of the floats|is behind a stop|unless it is swept|rise or fall|"
    "makes .* values; at most|wrong sign|must differ from start|of memory at once|numbers; at most|points; at most|"
    "no finite steady motion|in resonance|must be .*proportional|P1 . P2 > 0|has no such stop|belongs to|"
    "nothing would be computed|no sweep to follow|says where orbits start|is swept, and|not observed|no motion between|"
    "must be given; or k_stop|rigid or compliant|both stops are rigid|the map's section|resolution of double|"
    "is farther than"
)

counts = pytest.mark.parametrize(
    "count",
    [20, pytest.param(800, marks=pytest.mark.slow), pytest.param(10_000, marks=pytest.mark.soak)],
)
run_counts = pytest.mark.parametrize(
    "count",
    [25, pytest.param(400, marks=pytest.mark.slow), pytest.param(2000, marks=pytest.mark.soak)],
)


def contents(folder):
    return {path.name: (path.read_bytes(), path.stat().st_mtime_ns) for path in folder.iterdir()}


def checked(path):
    """Status, output and errors of `check`."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(["check", str(path)])
    return status, out.getvalue(), err.getvalue()


@counts
def test_every_scene_ends_in_a_result_or_one_message(tmp_path, count):
    path, validator, outcomes = tmp_path / "scene.yaml", jsonschema.Draft7Validator(json_schema()), Counter()
    for n in range(count):
        path.write_bytes(broken(n))
        before = contents(tmp_path)
        status, out, err = checked(path)
        assert contents(tmp_path) == before, n
        assert status in (0, 2), (n, err)
        assert (out == "") == (status == 2) and err.count("error: ") == (status == 2) and "Traceback" not in err, (
            n,
            err,
        )
        outcomes[_agreement(n, validator, status)] += 1
    print(f"\n{count} scenes: {dict(outcomes)}")
    assert outcomes["accepted"] > count / 10 and sum(outcomes.values()) - outcomes["accepted"] > count / 10


def _agreement(n, validator, status):
    """What became of scene n; the program and the schema must be of one mind, where the schema can have one."""
    try:
        data = read_yaml(broken(n).decode("utf-8-sig"))
    except (YAMLTextError, UnicodeDecodeError):
        assert status == 2, n
        return "refused: no YAML"
    valid = validator.is_valid(data)
    if status == 0:
        assert valid, (n, [error.message for error in validator.iter_errors(data)])
        return "accepted"
    if not valid:
        return "refused: form"
    with pytest.raises(vs.SceneError) as caught:
        parsed(broken(n).decode("utf-8-sig"))
    for problem in caught.value.problems:
        assert BEYOND_THE_SCHEMA.search(problem), (n, problem)
    return "refused: relations and sizes"


@run_counts
def test_every_run_keeps_what_every_run_must(tmp_path, count):
    statuses, refused = Counter(), 0
    for n in range(count):
        text = to_yaml(scene(n))
        try:
            one = parsed(text)
        except vs.SceneError as error:  # a sweep may lead behind a stop, or into resonance
            assert BEYOND_THE_SCHEMA.search(str(error)), (n, str(error))
            refused += 1
            continue
        whole, _ = computed(one, 10**6, None)
        statuses.update(whole["status"].ravel().tolist())
        _hold(one, whole, n)
        parts, _ = computed(one, 1 + n % 3, 1 + n % 11)
        assert_same_bits(parts, whole)
        if n % 10 == 0:  # through the file, by several workers
            path = tmp_path / f"{n}.h5"
            report = vs.run(one, path, workers=1 + n // 10 % 3)
            assert report.points == one.n_points and report.bad == np.count_nonzero(~np.isin(whole["status"], VALID))
            with h5py.File(path) as file:
                # attractors are numbered when all points are there
                kept = {name: values for name, values in whole.items() if name != "attractor_id"}
                assert_same_bits({name: file[name][()] for name in kept}, kept)
            path.unlink()
    print(f"\n{count} runs, {refused} refused: statuses {dict(statuses)}")
    assert refused < count / 5 and sum(statuses[code] for code in VALID) > 0.9 * statuses.total()


@pytest.mark.slow
def test_numbers_at_the_ends_of_the_floats():
    """Any that a scene may have: refused by name, or a status; numbers that are ok are numbers."""
    choose, statuses = random.Random("ends"), Counter()
    sizes = [10.0**exponent for exponent in (-300, -200, -100, -30, -10, -3, 3, 10, 30, 100, 200, 300)]
    for n in range(400):
        numbers = {"mu_m": 10, "mu_k": 5, "zeta": 0.05, "f2": 0, "omega": 0.63, "R": 0.8, "b": 6.6}
        numbers |= {name: choose.choice(sizes) for name in choose.sample(list(numbers), 3) if name not in ("f2", "R")}
        orbit, observe = {"transient": 3, "record": 5}, ["section", "lyapunov", "impacts"]
        try:
            one = parsed(to_yaml({"system": numbers, "orbit": orbit, "observe": observe}))
        except vs.SceneError as error:
            assert BEYOND_THE_SCHEMA.search(str(error)), n
            continue
        arrays, _ = computed(one, 1, None)
        statuses[int(arrays["status"])] += 1
        if arrays["status"] in VALID:
            assert not np.isnan(arrays["lyapunov"]).any() and np.isfinite(arrays["x1"]).all(), (n, numbers)
    assert len(statuses) >= 3


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
