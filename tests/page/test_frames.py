"""Frames of a diagram: a preview of shorter orbits, then pieces; together these are what `vibro_sweep.sweep` computes,
bit for bit."""

import numpy as np
import pytest
from support import ROOT, sample
from support.explorers import answers, explorer, heights
from support.scene_texts import parsed

import vibro_sweep as vs

pytest.importorskip("uvicorn")

SYSTEM = vs.load_scene(ROOT / "configs" / "quickstart.yaml").system
ONE_MASS = {"type": "one_mass", "zeta": 0.02, "F": 0.35, "omega": 0.8, "R": 0.9, "b": 1, "stops": "right"}


@pytest.fixture
def page():
    """Of a program that has no pace yet: nothing that it computed before says how long a piece takes."""
    with explorer() as program, program.socket() as socket:
        yield socket


@pytest.fixture
def view(page):
    return answers(page, "open", 1)[0]["view"] | {"transient": 60, "record": 10, "low": 6.2, "high": 6.8}


def put_together(pieces, name, like):
    """Numbers of all columns and starts, of the shape of `like`."""
    result = np.full_like(like, -99)
    for words, arrays in pieces:
        columns = words["first"] + words["step"] * np.arange(words["length"])
        here = len(arrays["count"]) // words["length"]
        part = arrays[name].reshape(len(columns), here, *like.shape[2:])
        result[columns, words["first_start"] : words["first_start"] + here] = part
    return result


@pytest.mark.parametrize("changes", sample(3, [
    {},
    {"start": {"follow": "up"}},
    {"start": {"random": 2, "seed": 7}},
    {"start": {"follow": "down"}},
    {"start": {"follow": "both"}},
    {"axis": "R", "low": 0.5, "high": 0.9},
    {"system": ONE_MASS, "axis": "F", "low": 0.3, "high": 0.6, "start": {"random": 2}},
]), ids=["rest", "up", "random", "down", "both", "R", "one_mass"])  # fmt: skip
def test_the_final_picture_has_the_bits_of_the_sweep(page, view, changes):
    view |= {"columns": 64, "transient": 100, "record": 20, "low": 5.3, "high": 5.9} | changes
    scene = parsed(answers(page, "save", 2, view=view)[0]["text"])
    options = {"start": view["start"] or None, "transient": 100, "record": 20}
    data = vs.sweep(scene.system, scene.sweep, observe=["section", "lyapunov"], **options)
    whole = data["x1"].values.reshape(64, -1, 20)
    period = data["period"].values.reshape(64, -1)
    assert {*np.unique(period)} > {0} or "axis" in changes  # both kinds of orbits
    expected, shown = (whole - 1.25).astype("f4"), np.arange(20) >= 20 - np.where(period > 0, period, 20)[..., None]
    for seq in (3, 4):  # the second time in other pieces
        preview, *pieces = frames = answers(page, "sweep", seq, view=view, middle=1.25)
        assert preview[0]["kind"] == "preview" and preview[0]["exact"] is False
        assert np.array_equal(preview[1]["axis"], scene.sweep[view["axis"]])
        found = heights(frames, *expected.shape)
        assert np.array_equal(found[shown], expected[shown]) and np.isnan(found[~shown]).all()
        for name in ("status", "period"):
            values = data[name].values.reshape(64, -1)
            assert np.array_equal(put_together(pieces, name, values), values), name
        for name in ("lyapunov", "lyapunov_error"):
            values = data[name].values.reshape(*period.shape, -1).astype("f4")
            assert np.array_equal(put_together(pieces, name, values), values, equal_nan=True), name


@pytest.mark.parametrize(
    "columns, order",
    [(33, [0, 1]), (96, [0, 2, 1, 3]), (1000, [0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15])],
)
def test_pieces_are_interlaced_and_complete(page, view, columns, order):
    """Each makes the picture finer everywhere."""
    preview, *pieces = (words for words, _ in answers(page, "sweep", 2, view=view | {"columns": columns}))
    assert preview["kind"] == "preview" and not preview["last"] and {words["kind"] for words in pieces} == {"piece"}
    assert [words["first"] for words in pieces] == order and {words["step"] for words in pieces} == {len(order)}
    assert [words["last"] for words in pieces] == [False] * (len(order) - 1) + [True]
    every = np.concatenate([words["first"] + words["step"] * np.arange(words["length"]) for words in pieces])
    assert np.array_equal(np.sort(every), np.arange(columns))


@pytest.mark.parametrize("transient, record", [(60, 10), (1000, 200)])
def test_a_preview_has_values_of_the_sweep_and_shorter_orbits(page, view, transient, record):
    view |= {"columns": 1000, "transient": transient, "record": record, "y": "v1"}
    words, arrays = answers(page, "sweep", 2, view=view)[0]
    place = {name: words[name] for name in ("kind", "exact", "first", "step", "length")}
    assert place == {"kind": "preview", "exact": False, "first": 0, "step": 4, "length": 250}
    assert arrays.keys() == {"axis", "status", "count", "y"}
    shorter = {"transient": min(transient, 300), "record": min(record, 50)}
    alone = vs.sweep(SYSTEM, {"b": arrays["axis"][::4]}, observe=["section"], **shorter)
    assert np.array_equal(arrays["y"], alone["v1"].values.ravel().astype("f4"))


def test_a_preview_is_reduced_to_its_time(page, view):
    """By how long the last of this kind took; never to fewer than 64 columns, or 63 of a step that is whole."""
    view |= {"columns": 1000, "transient": 300, "record": 50, "start": {"random": 16}}
    first, second = (answers(page, "sweep", seq, view=view) for seq in (2, 3))
    assert first[0][0]["step"] == 4 < second[0][0]["step"] <= 16 and second[0][0]["length"] >= 63
    assert len(first) - 1 == 16 and len(second) - 1 in (1, 2, 4, 8, 16, 32, 64)
    other = answers(page, "sweep", 4, view=view | {"transient": 299})
    assert other[0][0]["step"] == 4 and len(other) - 1 == 16
