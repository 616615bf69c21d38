"""How the pictures look: type, colours, the names of the axes."""

import matplotlib
import numpy as np
from matplotlib import colormaps
from matplotlib.colors import ListedColormap, to_rgba
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from vibro_sweep.oscillator.catalogue import BY_NAME, NUMBERS
from vibro_sweep.tables.bifurcations import TYPES
from vibro_sweep.tables.units import shown_unit, unit_in

TYPE = 8.0  # points: all type of a narrow page

STYLE = {
    "figure.dpi": 200,
    "savefig.dpi": "figure",
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 10,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "legend.fontsize": 8,
    "figure.titlesize": 9,
    "axes.linewidth": 0.6,
    "axes.formatter.limits": (-3, 6),  # numbers below 0.01 by a power of ten: their zeros have no room in small panels
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 0.8,
    "hatch.linewidth": 0.5,
    "legend.frameon": False,
    "mathtext.fontset": "stix",
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}

INK = "#1a1a2e"
FAINT = "#8a8a96"
# Colours that stand side by side in a legend are distinct with any colour vision (tests/pictures/test_colours.py).
EXPONENTS = ("#b2182b", "#2f8fd8", "#1a1a5e", "#e0a030")  # lambda_1 .. lambda_4
CHAOS = "#fbe3dc"  # the tint where lambda_1 > 0
NEUTRAL = "#f7f7f7"  # where it does not differ from 0
# below zero and above it, so that the palest colours still differ from the neutral one between them
DIVERGING = ListedColormap(
    [*colormaps["RdBu_r"](np.linspace(0, 0.42, 128)), to_rgba(NEUTRAL), *colormaps["RdBu_r"](np.linspace(0.58, 1, 128))]
)
SECTION = "#b2182b"  # states at t = 0 mod T
IMPACT = "#2f8fd8"
GRAZING = "#7b3294"
BRANCHES = {"up": "#1f6fb4", "down": "#e1570f"}
ARROWS = {"up": "up \N{RIGHTWARDS ARROW}", "down": "\N{LEFTWARDS ARROW} down"}
DASHES = (0, (5, 3))
PER_TIME = "per unit of $t$"
RIGHT, LEFT = "#c26a00", "#2b5c8a"
NOT_COMPUTED = "#f2f2f5"
LONGEST = 12  # periods with a colour of their own
NO_PERIOD, LONGER = "#1c1c26", "#8c8c94"
PERIODS = (
    *("#9fd0ea", "#0077ee", "#554400", "#00bb77", "#990066", "#66ffaa"),
    *("#771188", "#446644", "#eeaa44", "#9966aa", "#aa6611", "#dd99ff"),
)

# Special points: label, name, marker, colour; filled or not. Those of a graze, which are two, come first.
SPECIAL = {row.name: (row.label, row.words, row.mark, row.colour, True) for row in TYPES if row.label}
_LABEL, _WORDS, *_GRAZE, _ = SPECIAL.pop("graze")
SPECIAL = {
    "graze": (_LABEL, f"{_WORDS}, persistence", *_GRAZE, True),
    "nonsmooth_fold": (_LABEL, f"{_WORDS}, nonsmooth fold", *_GRAZE, False),
    **SPECIAL,
}


def type_size(usual: float) -> float:
    """Points of a text that is smaller or larger than others, but on narrow pages, where all are alike."""
    return TYPE if matplotlib.rcParams["font.size"] == TYPE else usual


def special_mark(kind: str, size: float = 4.0) -> dict:
    """The style in which `plot` draws a special point."""
    _, _, marker, colour, filled = SPECIAL[kind]
    return {
        "ls": "none", "marker": marker, "color": colour, "markerfacecolor": colour if filled else "white",
        "markersize": size, "markeredgewidth": 0.7,
    }  # fmt: skip


def symbol(name) -> str:
    """A number or a variable of the table as in the paper, for mathtext."""
    return f"${BY_NAME[name].symbol}$"


def exponent(i, note="") -> str:
    """The symbol of the i-th exponent, from 1, or of any; and what is to be said of it."""
    return f"${BY_NAME['lyapunov'].symbol}_{i}{note}$"


def exponents_name(i, unit: str) -> str:
    """The i-th exponent, or any, as an axis label; unit : of the file, if it has one."""
    return f"{exponent(i)}{unit or f' {PER_TIME}'}"


def axis_name(key, unit: str = "") -> str:
    """A number of the system or of the start as an axis label: its name, its symbol and its unit."""
    return f"{NUMBERS[key].label} {symbol(key)}{unit}" if key in NUMBERS else f"{key}{unit}"


def with_unit(label: str, declared: str, system) -> str:
    """The label of an axis, with the unit that a system has for what is `declared` in SI; a Family has none."""
    return label + shown_unit(unit_in(declared, getattr(system, "units", None)))


def grazing_of(name) -> str:
    """The text on a grazing clearance, for a legend."""
    of = {"b_right": " at the right stop", "b_left": " at the left stop"}.get(name, "")
    return f"grazing of the free motion{of}, {symbol(name)}"


def stop_name(result, side) -> str:
    """A stop as a line in a picture, with where it stands."""
    shifted = "offset" in result.sweep or result.settings.get("offset")
    coordinate = symbol("x1") if result.contact_normal is None else symbol("gap")
    where = f"{symbol('offset')[1:-1] if shifted else ''}{('+' if shifted else '') if side > 0 else '-'}b"
    return f"{'right' if side > 0 else 'left'} stop, ${coordinate[1:-1]} = {where}$"


def stop_names(result) -> dict[int, str]:
    """The same of each side."""
    return {side: stop_name(result, side) for side in result.sides}


def exponent_colour(i) -> str:
    """The colour of the i-th exponent, from 0; the fifth and all below share one."""
    return EXPONENTS[i] if i < len(EXPONENTS) else FAINT


def at_section(name) -> str:
    """A coordinate of section points, as an axis label."""
    return f"{symbol(name)} at $t = 0$ mod $T$"


def before_impact(name) -> str:
    """A coordinate of points of an impact section."""
    return f"{symbol(name)} before impact"


def equation(key, value) -> str:
    """The value of a number, for a title."""
    return f"${NUMBERS[key].symbol if key in NUMBERS else key} = {in_formula(value)}$"


def in_formula(value: float, digits: int = 6) -> str:
    """A number of so many digits; with a power of ten, from a million on, in place of Python's e+06."""
    mantissa, e, exponent = f"{float(f'{value:.{digits}g}'):.6g}".partition("e")
    if not e:
        return mantissa
    factor = mantissa.removesuffix("1") if mantissa in ("1", "-1") else rf"{mantissa} \cdot "
    return f"{factor}10^{{{int(exponent)}}}"


def marked(colour, marker):
    """The handle of a legend for a colour and a marker together."""
    style = {"ls": "none", "markersize": 5, "markeredgewidth": 0.6}
    dot = Line2D([], [], color=INK, marker=marker, markerfacecolor="white", **style)
    return Patch(facecolor=colour, edgecolor=FAINT, linewidth=0.4), dot


def density_colours() -> ListedColormap:
    """Perceptually even, to nearly black from a light colour that still stands out on white."""
    return ListedColormap(colormaps["magma_r"](np.linspace(0.22, 1, 256)), name="density")


def edges(values) -> np.ndarray:
    """Cell borders, shape (n + 1,), halfway between neighbouring values (n,)."""
    values = np.asarray(values, float)
    if len(values) == 1:
        half = 0.05 * abs(values[0]) or 0.5
        return np.array([values[0] - half, values[0] + half])
    inner = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - inner[0]], inner, [2 * values[-1] - inner[-1]]])


def limits(values, least=1e-9) -> tuple[float, float]:
    """An axis's range for values of any shape, NaN among them; the rounding of a constant is not blown up.

    least : the axis reaches as far to both sides of its middle
    """
    low, high = np.nanmin(values), np.nanmax(values)
    middle = (low + high) / 2
    half = max(0.53 * (high - low), 1e-3 * abs(middle), least)
    return middle - half, middle + half
