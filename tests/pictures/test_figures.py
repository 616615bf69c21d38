"""What a figure must show: tests/cases/figures.yaml, a call and the facts of its figure a row, and why it is there.

Labels, limits, legends and numbers of usual figures are in the golden record (tests/golden/figures.py); here are cases
of which no short run has the numbers, and those that were wrong once.
"""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure
from support import cases, figures, sample
from support.scene_texts import parsed
from xarray import Dataset

import vibro_sweep as vs

ROWS = cases.rows("figures")
SYSTEM = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
BALL = vs.Oscillator.named("one_mass", zeta=0.02, F=0.6, omega=0.9, k_stop=20, c_stop=8, b=1, tau=0, stops="right")
NAMES = {**vars(figures), "vs": vs, "np": np, "SYSTEM": SYSTEM, "BALL": BALL, "Figure": Figure, "Dataset": Dataset}


def first(fig):
    return figures.panels(fig)[0]


FACTS = {  # of a figure, and what a row says of them
    "panels": lambda fig: len(figures.panels(fig)),
    "bars": lambda fig: len(figures.bars(fig)),
    "entries": figures.entries,
    "attractors": lambda fig: sorted({entry.split(" (")[0] for entry in figures.entries(fig)}),
    "titles": lambda fig: [ax.get_title() for ax in figures.panels(fig)],
    "texts": lambda fig: [text.get_text() for text in first(fig).texts],
    "scales": lambda fig: [first(fig).get_xscale(), first(fig).get_yscale()],
    "limits": lambda fig: [*first(fig).get_xlim(), *first(fig).get_ylim()],
    "ticks": lambda fig: [text.get_text() for text in first(fig).get_yticklabels()],
    "lines": lambda fig: [line.get_label() for line in first(fig).lines],
}


def differences(fig, shows: dict) -> list[str]:
    """Facts of a figure that are not those of a row: `says`, `silent` are words that are in its texts, or are not;
    `artists` numbers of lines and areas of its panels by their group id; `begins` what a list of facts begins with."""
    fig.draw_without_rendering()
    found, written = [], "\n".join(figures.texts(fig))
    for key, wanted in shows.items():
        if key == "says":
            found += [f"no {word!r}" for word in wanted if word not in written]
        elif key == "silent":
            found += [f"{word!r}" for word in wanted if word in written]
        elif key == "artists":
            counts = {name: sum(len(figures.marked(ax, name)) for ax in figures.panels(fig)) for name in wanted}
            found += [f"artists {counts}"] if counts != wanted else []
        elif key == "begins":
            facts = {name: FACTS[name](fig)[: len(values)] for name, values in wanted.items()}
            found += [f"begins {facts}"] if facts != wanted else []
        else:
            fact = FACTS[key](fig)
            same = fact == pytest.approx(wanted, rel=1e-9) if key == "limits" else fact == wanted
            found += [] if same else [f"{key}: {fact}"]
    return found


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.filterwarnings("error", "ignore::DeprecationWarning")  # of the lowest matplotlib
def test_a_figure_shows(row, tmp_path):
    if "scene" in row:
        scene = parsed(row["scene"])
        assert row["kinds"][0] == scene.picture or row["id"] == "a plane of one point"
        assert parsed(scene.to_yaml()).picture == scene.picture and scene.replace(picture=None).picture is None
        vs.run(scene, tmp_path / "data.h5")
    given = eval(row["call"], NAMES | {"path": tmp_path / "data.h5"})
    if "kinds" in row:
        assert figures.kinds(given) == row["kinds"]
    else:
        assert row["shows"] and differences(given, row["shows"]) == []
    plt.close("all")


@pytest.mark.parametrize("axes, options", sample(1, [
    ({"b": [5, 6]}, {"observe": ["section", "lyapunov", "impacts"]}),
    ({"x1": [0, 1], "v1": [0, 1]}, {"observe": ["attractors"]}),
    ({"b": [5, 6]}, {"start": {"random": 2}, "observe": ["attractors"]}),
    ({"b": [5, 6], "R": [0.5, 0.6]}, {"observe": ["section", "lyapunov", "impacts"]}),
]))  # fmt: skip
@pytest.mark.filterwarnings("error", "ignore::DeprecationWarning")
def test_empty_panels_of_all_kinds_say_why(axes, options):
    data = vs.sweep(SYSTEM.replace(zeta=1e6), axes, transient=5, record=5, **options)
    kinds = figures.kinds(data)
    for kind in kinds:
        panels = figures.panels(vs.plot(data, kind))
        assert all(any("all points failed" in text.get_text() for text in ax.texts) for ax in panels), kind
    assert kinds and panels


def test_rows_say_why():
    assert len(ROWS) > 60 and all(row.values[0]["why"] for row in ROWS)


PLANTED = {
    "panels": lambda fig: fig.add_axes((0, 0, 0.1, 0.1)),
    "entries": lambda fig: fig.legend(["more"]),
    "attractors": lambda fig: fig.legend(["more (1 %)"]),
    "titles": lambda fig: first(fig).set_title("another"),
    "texts": lambda fig: first(fig).text(6.6, 6, "more"),
    "scales": lambda fig: first(fig).set_yscale("log"),
    "limits": lambda fig: first(fig).set_xlim(6.4, 7),
    "ticks": lambda fig: first(fig).set_yticks([6.5]),
    "lines": lambda fig: first(fig).plot([6.6], [6]),
    "artists": lambda fig: first(fig).plot([6.6], [6], gid="grazing"),
    "silent": lambda fig: fig.suptitle("chaos"),
    "says": lambda fig: fig.suptitle(""),
    "begins": lambda fig: first(fig).set_yticks([6.5]),
    "bars": lambda fig: fig.colorbar(first(fig).imshow([[1]])),
}


@pytest.mark.parametrize("key", PLANTED)
def test_the_comparison_sees(key):
    fig = vs.plot(figures.swept(), "bifurcation")
    fig.draw_without_rendering()
    shows = {name: fact(fig) for name, fact in FACTS.items()} | {"artists": {"grazing": 3}}
    shows |= {"says": ["Bifurcation diagram"], "silent": ["chaos\n"], "begins": {"ticks": shows["ticks"][:2]}}
    assert differences(fig, shows) == []
    PLANTED[key](fig)
    assert differences(fig, {key: shows[key] if key != "silent" else ["chaos"]}) != []
    assert PLANTED.keys() == {*FACTS, "artists", "says", "silent", "begins"}
