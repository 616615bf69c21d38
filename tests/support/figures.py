"""Datasets made up for pictures, which take numbers that no short run has, and what their figures show."""

import itertools
import re
from functools import cache

import numpy as np
import xarray as xr
from golden.figures import Data
from matplotlib.text import Text

import vibro_sweep as vs

golden = cache(Data)  # golden()["sweep"]: the Datasets whose figures the record has

SETTINGS = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8, b=6.6, tau=2.2293, stops="both")
SETTINGS |= dict(b_star=6.70571674097302, model="flow", section="phase", transient=300, record=20)
OWN = {"lyapunov": ("exponent",), "x1": ("sample",), "v1": ("sample",), "phase": ("sample",)}
OWN |= {"lyapunov_running": ("elapsed", "exponent"), "lyapunov_error": ("exponent",)}
OWN |= {f"trajectory_{name}": ("t_over_T",) for name in ("x1", "v1", "x2", "v2")}
OWN |= {f"trajectory_section_{name}": ("trajectory_section",) for name in ("x1", "v1", "x2")}
OWN |= {f"trajectory_impact_{name}": ("trajectory_impact",) for name in ("t_over_T", "side", "v1", "v1_after", "x2")}


def made(axes, quantities, done=None, along=None, time=(), **settings):
    """A Dataset as that of a sweep: axes in order, then each quantity's own dimensions (OWN).

    along: numbers that follow from swept ones, name -> (key, values).
    """
    shape, along = tuple(len(values) for values in axes.values()), along or {}
    status = np.where(np.ones(shape, bool) if done is None else done, 0, -1)
    variables = {
        name: ((*axes, *OWN.get(name, ())), np.asarray(values))
        for name, values in {"status": status, **quantities}.items()
    }
    coordinates = {name: np.asarray(values) for name, values in axes.items()} | along
    coordinates |= {"t_over_T": np.asarray(time)} if len(time) else {}
    known = {name: value for name, value in (SETTINGS | settings).items() if name not in coordinates}
    data = xr.Dataset(variables, coordinates, known | {"sweep_dimensions": [key for key in axes if key != "start"]})
    if "lyapunov_error" in data:
        data["lyapunov_error"].attrs["significant"] = 2.0
    return data


def exponents(*shape):
    """A spectrum that is chaotic in the last quarter of the first dimension."""
    spectrum = np.tile([-0.01, -0.02, -0.05, -0.1], (*shape, 1))
    spectrum[3 * shape[0] // 4 :, ..., 0] = 0.004
    return spectrum


def swept():
    """A sweep of b whose last quarter is chaotic, with section points, exponents and impacts."""
    b = np.linspace(6.5, 6.9, 40)
    x1 = b[:, None] - np.random.default_rng(0).uniform(0, 1, (40, 20))
    counts = {"impacts_right": np.full(40, 10), "impacts_left": np.full(40, 5)}
    return made({"b": b}, {"x1": x1, "lyapunov": exponents(40), **counts})


def bouncing():
    """The motion between walls at +-2 with speed 1, impacts at t = 2, 6, 10, 14; the forcing period is 8 too."""
    time = np.linspace(0, 16, 41)  # no sample meets an impact
    x1, v1 = np.abs((time - 2) % 8 - 4) - 2, np.where((time - 2) % 8 < 4, -1.0, 1.0)
    side = np.array([1, -1, 1, -1, 0])
    before = np.where(side == 0, np.nan, side)
    quantities = {
        **{"trajectory_x1": x1, "trajectory_v1": v1, "trajectory_x2": x1 / 2, "x1": np.zeros(2)},
        **{"trajectory_section_x1": np.zeros(3), "trajectory_section_v1": np.ones(3)},
        **{"trajectory_section_x2": np.zeros(3), "trajectory_impacts": 4, "trajectory_impact_side": side},
        "trajectory_impact_t_over_T": np.array([2, 6, 10, 14, np.nan]) / 8,
        **{"trajectory_impact_v1": before, "trajectory_impact_v1_after": -before, "trajectory_impact_x2": before},
    }
    return made({}, quantities, time=time / 8, b=2.0, omega=2 * np.pi / 8, R=1.0)


def plane():
    """Four values of b, three of omega, two starts; some numbers at chosen places, and one point that is missing."""
    spectrum = np.full((4, 3, 2, 4), -0.1)
    spectrum[1, 2, 0, 0], spectrum[1, 2, 1, 0] = -0.05, 0.02
    period = np.ones((4, 3, 2), int)
    period[1, 2] = 5, 0
    period[3, 0] = 40
    done = np.ones((4, 3, 2), bool)
    done[0, 0] = False
    axes = {"b": np.linspace(6, 7, 4), "omega": np.array([0.5, 0.6, 0.8]), "start": np.arange(2)}
    return made(axes, {"lyapunov": spectrum, "period": period}, done)


def ragged(like: str, sizes: dict[str, int], **values):
    """A file of branches or curves as one of the record, with these variables and zeros in all others."""
    data = golden()[like]
    variables = {
        name: (held.dims, np.zeros([sizes.get(dim, data.sizes[dim]) for dim in held.dims], held.dtype), held.attrs)
        for name, held in data.variables.items()
    }
    for name, given in values.items():
        dims, zeros, attributes = variables[name]
        variables[name] = dims, np.asarray(given).astype(zeros.dtype).reshape(zeros.shape), attributes
    return xr.Dataset(variables, attrs=data.attrs)


def codes(variable, names):
    """The numbers that stand for words in a variable of a file."""
    words = variable.attrs["flag_meanings"].split()
    return [int(np.asarray(variable.attrs["flag_values"])[words.index(name)]) for name in names]


def chart(*curves, parameters=("b", "omega")):
    """A file of curves, each from a boundary to another one.

    curves : of each its type, the places (2, points), its period, and points of codimension two, (type, index)
    """
    like, lengths = golden()["file curves"], [np.shape(places)[1] for _, places, *_ in curves]
    first, special = np.cumsum([0, *lengths]), []
    for i, (_, _, _, *points) in enumerate(curves):
        special += [(kind, i, first[i] + at) for kind, at in (("boundary", 0), *points, ("boundary", lengths[i] - 1))]
    names, branch, at = zip(*special, strict=True)
    places = np.concatenate([np.asarray(places) for _, places, *_ in curves], axis=1)
    counts = np.bincount(branch)
    sizes = {"point": sum(lengths), "branch": len(curves), "special": len(special), "impact": 0}
    data = ragged(
        "file curves", sizes, b=places[0], omega=places[1], special_value=places.T[[*at]], special_point=at,
        branch_row_size=lengths, branch_type=codes(like.branch_type, [kind for kind, *_ in curves]),
        branch_period=[period for _, _, period, *_ in curves], special_type=codes(like.special_type, names),
        special_branch=branch, branch_special=counts, branch_begins=np.cumsum(counts) - counts,
        branch_ends=np.cumsum(counts) - 1,
    )  # fmt: skip
    data.attrs["parameters"] = list(parameters)
    return data.rename(dict(zip(("b", "omega"), parameters, strict=True)))


def kinds(data) -> list[str]:
    """The kinds of picture that data can show, the default one first; they are named where another one is asked for."""
    try:
        vs.plot(data, "no kind")
    except vs.PlotError as error:
        named = re.search(r"can show (.*) \(or all\)", str(error))
        return named[1].split(", ") if named else []
    raise AssertionError("a kind that does not exist is drawn")


def dots(ax):
    """All points drawn as single dots."""
    return np.concatenate([line.get_xydata() for line in ax.lines if line.get_linestyle() == "None"])


def image(ax):
    (only,) = ax.images
    return only


def marked(ax, name: str) -> list:
    """Lines and areas with this group id."""
    return [artist for artist in (*ax.lines, *ax.collections) if artist.get_gid() == name]


def panels(fig) -> list:
    return [ax for ax in fig.axes if ax.get_label() != "<colorbar>"]


def bars(fig) -> list:
    return [ax for ax in fig.axes if ax.get_label() == "<colorbar>"]


def entries(fig) -> list[str]:
    """The texts of all legends, those of the figure first."""
    legends = [*fig.legends, *filter(None, (ax.get_legend() for ax in fig.axes))]
    return [text.get_text() for legend in legends for text in legend.get_texts()]


def texts(fig) -> list[str]:
    """All that is written."""
    return [text.get_text() for text in fig.findobj(Text)]


def overlaps(written) -> list[tuple[str, str]]:
    """Texts that cover each other; the figure must have been drawn."""
    boxes = [(text.get_text(), text.get_window_extent()) for text in written if text.get_visible() and text.get_text()]
    return [(a, b) for (a, box), (b, other) in itertools.combinations(boxes, 2) if box.overlaps(other)]


def many():
    """700 values of 200 points: 140 000, of which every second value is periodic, of period 4."""
    x1 = np.random.default_rng(0).uniform(0, 1, (700, 200))
    x1[::2] = np.tile(x1[::2, :4], 50)
    period = np.where(np.arange(700) % 2, 0, 4)
    return made({"b": np.linspace(1, 8, 700)}, {"x1": x1, "period": period})


def circle(kind, radius, period=1, *special):
    """A closed curve of a chart."""
    t = np.linspace(0, 6, 50)
    return kind, radius * np.array([np.cos(t), np.sin(t)]), period, *special


def one_mass(**law):
    numbers = dict(zeta=0.02, F=0.8, omega=1.6, b=1, tau=0)
    return vs.Oscillator.named("one_mass", **numbers | law)


def basins(**law):
    axes = {"x1": {"start": -0.9, "stop": 0.9, "num": 9}, "v1": {"start": -2, "stop": 2, "num": 9}}
    return vs.sweep(one_mass(**law), axes, transient=600, record=60, observe=["attractors"])
