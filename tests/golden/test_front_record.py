"""What users see is what it was in an earlier version: sweeps, files, figures and the live page (tests/data/golden)."""

import copy

import pytest

from golden import answers, checking, figures, files, records, shown, sweeps
from golden.drawn import described
from golden.scenes import computed

CASES = {"sweeps": 25, "files": 18, "figures": 94, "answers": 19}
FAST = {  # those that the fast tests compare
    "sweeps": ("section alone, from a state", "followed up and down", "attractors of random starts"),
    "files": ("sweep", "unfinished", "frequency"),
    "figures": (
        'vs.plot(data["sweep"])',
        'vs.plot(data["attractors"])',
        'vs.plot(data["basins"])',
        'vs.plot(data["plane"])',
        'vs.plot(data["orbits"], "history")',
        'vs.plot(data["contacts"], "contact-force", at=dict(b=0.6))',
        'vs.plot(data["units"])',
        'vs.plot(data["units"], units="mm, Hz")',
        'vs.plot(data["file sweep"], windows=data["file windows"])',
    ),
    "answers": ("a page", "a diagram", "a saved scene", "what cannot be computed"),
}


def wrong(kind: str, chosen: dict) -> dict[str, list[str]]:
    """What differs, by the names of records."""
    differences = {name: checking.compared(kind, record) for name, record in chosen.items()}
    return {name: lines for name, lines in differences.items() if lines}


@pytest.mark.parametrize("kind", [kind for kind in FAST if FAST[kind]])
def test_some(kind):
    stored = records.read(kind)
    assert len(stored) == CASES[kind]
    assert wrong(kind, {name: stored[name] for name in FAST[kind]}) == {}


@pytest.mark.parametrize("kind", list(CASES))
@pytest.mark.slow
def test_all(kind):
    stored = records.read(kind)
    assert len(stored) == CASES[kind]
    assert wrong(kind, stored) == {}


CHANGED_SWEEPS = {
    "a number": lambda data: data.assign(x1=data.x1 * (1 + 1e-9)),
    "a count": lambda data: data.assign(impacts_right=data.impacts_right + 1),
    "a type": lambda data: data.assign(period=data.period.astype("int32")),
    "a dimension": lambda data: data.rename(sample="point"),
    "a name": lambda data: data.rename(x1="x3"),
    "no variable": lambda data: data.drop_vars("status"),
    "a unit": lambda data: data.assign(x1=data.x1.assign_attrs(units="m")),
    "a text of the file": lambda data: data.assign_attrs(stops="right"),
    "a number of the file": lambda data: data.assign_attrs(R=0.81),
    "less of the file": lambda data: data.drop_attrs(deep=False),
}


def test_the_comparison_of_sweeps_sees():
    record = records.read("sweeps")["followed up and down"]
    data = computed(record["scene"])
    assert sweeps.compared(record["result"], data) == []
    unseen = [name for name, change in CHANGED_SWEEPS.items() if not sweeps.compared(record["result"], change(data))]
    assert unseen == []


def test_the_comparison_of_what_is_shown_sees():
    stored = {"text": "b = 1.25 +- 1e-13", "numbers": [1.0, 2.0, None], "count": 3, "names": ["x1", None, True]}
    stored |= {"colour": "#0e0011ff"}
    same = {"text": "b = 1.2500001  +- 3e-14", "numbers": [1.0, 2.000001, None]}
    assert shown.different(stored, stored | same) == []
    for change in (
        {"text": "b = 1.26 +- 1e-13"}, {"text": "c = 1.25 +- 1e-13"}, {"text": "b = 1.25"}, {"count": 4}, {"more": 1},
        {"numbers": [1.0, 2.0, 2.0]}, {"numbers": [1.0, 2.0]}, {"numbers": [1.00001, 2.0, None]},
        {"names": ["x1", None, False]}, {"names": ["x1", None, 1]}, {"colour": "#0e0012ff"},
    ):  # fmt: skip
        assert len(shown.different(stored, stored | change)) == 1, change


def test_the_comparison_of_files_sees():
    record = records.read("files")["sweep"]
    kept = files.kept(record)
    for part, change in (
        ("layout", lambda layout: layout.pop("x1")), ("attrs", lambda attrs: attrs.update(R=0.7)),
        ("opened", lambda opened: opened["x1"]["dims"].reverse()), ("attributes", lambda attrs: attrs.pop("stops")),
    ):  # fmt: skip
        changed = copy.deepcopy(kept)
        change(changed[part])
        assert shown.different(record["result"], changed), part
    for part in ("info", "yaml"):
        assert shown.different(record["result"], kept | {part: kept[part].replace("b", "c", 1)}), part


CHANGED_FIGURES = {
    "a label": lambda ax: ax.set_xlabel("x"),
    "a limit": lambda ax: ax.set_xlim(4.9, 7),
    "a scale": lambda ax: ax.set_yscale("symlog"),
    "ticks": lambda ax: ax.set_xticks([5, 6]),
    "a text": lambda ax: ax.text(5, 5, "text"),
    "a line more": lambda ax: ax.plot([5, 6], [1, 2]),
    "a line less": lambda ax: ax.lines[0].remove(),
    "a colour": lambda ax: ax.lines[0].set_color("red"),
    "numbers": lambda ax: ax.lines[0].set_ydata(ax.lines[0].get_ydata() * 1.0001),
    "a legend": lambda ax: ax.legend(["a line"]),
    "a title": lambda ax: ax.figure.suptitle("title"),
}


def test_the_comparison_of_figures_sees():
    record = records.read("figures")['vs.plot(data["sweep"])']
    for name, change in CHANGED_FIGURES.items():
        figure = figures.figure_of(record)
        change(figure.axes[0])
        assert shown.different(record["result"], [described(figure)]), name


def test_the_comparison_of_answers_sees():
    record = records.read("answers")["a diagram"]
    for change in ({"columns": 11}, {"transient": 9}, {"y": "v1"}, {"numbers": {"R": 0.80001}}):
        (request,) = record["requests"]
        case = record | {"requests": [request | {"view": request["view"] | change}]}
        assert shown.different(record["result"], answers.result_of(case)), change
