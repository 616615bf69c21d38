"""Types of bifurcations, of codimension one and two, declared once: what follows from a type looks it up here."""

from typing import NamedTuple


class Bifurcation(NamedTuple):
    """A type of special point of branches.

    label, words, mark, colour : in pictures; without a label it is not marked. curve_colour : of its curve in charts
    test : of engine/continuation/branch_tests.py, that changes its sign there; "": impacts and flights tell
    condition : the equation that holds along its curve in two parameters; "": it has no curve
    sigma : of the orbits that have it; 0: all
    crosses : how many multipliers cross the circle there: one above 1, one below -1, a pair; all 0: the test is another
    beyond : what branches off, a key of `BEYOND` in analysis/branches/branch_switching.py; "": nothing
    advice : what a user can do where a branch, or a window, ends there
    """

    name: str
    text: str
    label: str = ""
    words: str = ""
    mark: str = ""
    colour: str = ""
    curve_colour: str = ""
    test: str = ""
    condition: str = ""
    sigma: int = 0
    crosses: tuple[int, int, int] = (0, 0, 0)
    beyond: str = ""
    advice: str = ""


TYPES = (
    Bifurcation("fold", "two orbits meet and vanish", "LP", "fold", "s", "#b2182b", "#2f8fd8",
                test="rate", condition="fold", crosses=(1, 0, 0),
                advice="The branch turns back there and goes on. Beyond the end of a window the motion jumps to "
                       "another attractor, often with hysteresis: sweep with `follow: both` to see both ways."),
    Bifurcation("flip", "period doubling, multiplier -1", "PD", "flip", "D", "#2f8fd8", "#e0a030",
                test="minus", condition="flip", sigma=1, crosses=(0, 1, 0), beyond="doubled",
                advice="The orbit goes on, unstable. `switch`, or `follow: [flip]`, gives that of twice the period."),
    Bifurcation("pitchfork", "a symmetric orbit loses its symmetry",
                "BP", "pitchfork", "^", "#e0a030", "#b2182b",
                test="minus", condition="flip", sigma=-1, crosses=(0, 1, 0), beyond="mirror images",
                advice="The symmetric orbit goes on, unstable. `switch`, or `follow: [pitchfork]`, gives the two that "
                       "are mirror images of each other."),
    Bifurcation("neimark_sacker", "a torus is born, a pair of multipliers of modulus 1",
                "NS", "Neimark-Sacker", "p", "#7b3294", "#1a1a5e", test="pair", condition="torus", crosses=(0, 0, 1),
                advice="The orbit goes on, unstable. Where the point is supercritical, a sweep beyond it "
                       "shows the torus."),
    Bifurcation("graze", "an impact or a contact appears or vanishes", "GR", "graze", "o", "#1a1a2e", "#8a8a96",
                condition="graze", beyond="graze",
                advice="Orbits with an impact more, or less, exist on one of the two sides: `switch`, or "
                       "`follow: [graze]`, gives them. Of the kind `nonsmooth_fold` both lie on one side, "
                       "and the motion jumps."),
    Bifurcation("sticking", "a rest on a stop begins, ends or is interrupted",
                "ST", "sticking", "X", "#446644", "#9600fa", condition="stick",
                advice="Orbits that rest have no finite list of impacts: `simulate` and `sweep` compute them."),
    Bifurcation("closed", "the branch comes back to itself"),
    Bifurcation("boundary", "end of the bounds within which it was followed",
                advice="Widen `bounds`, of a window the range of the sweep, where the parameter allows it."),
    Bifurcation("failed", "the branch could not be followed any further",
                advice="What was computed is valid. Begin from an orbit beyond that place, or go round it in "
                       "another parameter."),
    Bifurcation("split", "within a contact the mass comes back to its stop: two contacts become one",
                "SC", "split contact", "v", "#8c6d31", beyond="split",
                advice="Orbits with one contact more, or less, begin there: `switch` or `follow: [split]` finds them."),
    Bifurcation("unrelaxed", "with `release: force` a stop is touched before it has relaxed: no bifurcation",
                advice="The motion goes on: `simulate` and `sweep` compute it. Branches need stops that are at rest "
                       "again at their next touch."),
    Bifurcation("permanent_contact", "the contact never ends: the mass no longer leaves its stop",
                "PC", "permanent contact", "P", "#2a7f5f",
                advice="Beyond it the motion is linear, with the stop as one more spring and damper: "
                       "`simulate` and `sweep` compute it."),
)  # fmt: skip
BY_NAME = {row.name: row for row in TYPES}
CODES = {row.name: code for code, row in enumerate(TYPES)}
CURVES = tuple(row.name for row in TYPES if row.condition not in ("", "stick"))  # those of which files hold curves
ON_CIRCLE = tuple(row.name for row in TYPES if any(row.crosses))  # with a multiplier of modulus 1
BIRTHS = tuple(row.name for row in TYPES if row.condition == "flip")  # of a doubled or an asymmetric orbit
WAYS = tuple(row.name for row in reversed(TYPES) if row.beyond)  # from which branches are followed


def name_of(condition: str, sigma: int) -> str:
    """The type that a condition is, of orbits with this sigma; "" where there is none."""
    return next((row.name for row in TYPES if row.condition == condition and row.sigma in (0, sigma)), "")


class Point(NamedTuple):
    """A type of points of codimension two of curves. Labels: those of MatCont where it has one.

    tests : (condition of the curve, what changes its sign there) for each kind of curve: a test of
        engine/continuation/curve_tests.py; "vanishes", the speed of another impact; "touches", the distance of a flight
        from its stop
    turn : angle of the pair of multipliers, in whole turns, where that defines it
    sigma : of the orbits that have it; 0: all
    begins : conditions of the curves of orbits with two (at 1:4 four) times the period that begin there
    ends : conditions of the curves of such orbits that may end there
    """

    name: str
    label: str
    text: str
    tests: tuple[tuple[str, str], ...] = ()
    turn: float = 0.0
    sigma: int = 0
    begins: tuple[str, ...] = ()
    ends: tuple[str, ...] = ()


CODIMENSION_TWO = (
    Point("cusp", "CP", "two folds meet", (("fold", "cusp"),)),
    Point("fold_flip", "LPPD", "multipliers 1 and -1", (("fold", "minus"), ("flip", "plus")),
          begins=("torus",), ends=("fold", "torus")),
    Point("fold_neimark_sacker", "LPNS", "multiplier 1 and a pair on the unit circle",
          (("fold", "pair"), ("torus", "plus"))),
    Point("flip_neimark_sacker", "PDNS", "multiplier -1 and a pair on the unit circle",
          (("flip", "pair"), ("torus", "minus")), begins=("torus",), ends=("flip", "torus")),
    Point("resonance_1_1", "R1", "the multiplier 1 is double", (("fold", "double"),)),
    Point("resonance_1_2", "R2", "the multiplier -1 is double", (("flip", "double"),),
          begins=("torus",), ends=("fold", "torus")),
    Point("resonance_1_3", "R3", "a pair at a third of a turn", turn=1 / 3),
    Point("resonance_1_4", "R4", "a pair at a quarter of a turn", turn=1 / 4, begins=("fold", "fold", "torus")),
    Point("degenerate_flip", "GPD", "a flip (pitchfork) changes its criticality", (("flip", "normal"),),
          begins=("fold",), ends=("fold",)),
    Point("degenerate_neimark_sacker", "CH", "a Neimark-Sacker point changes its criticality", (("torus", "normal"),)),
    Point("fold_graze", "LPGR", "a fold at a graze", (("fold", "touches"), ("graze", "bare_plus"))),
    Point("flip_graze", "PDGR", "a flip at a graze", (("flip", "touches"), ("graze", "bare_minus")),
          sigma=1, begins=("graze",), ends=("graze",)),
    Point("pitchfork_graze", "PFGR", "a pitchfork at a graze", (("flip", "touches"), ("graze", "bare_minus")),
          sigma=-1, begins=("graze",), ends=("graze",)),
    Point("neimark_sacker_graze", "NSGR", "a Neimark-Sacker point at a graze",
          (("torus", "vanishes"), ("torus", "touches"), ("graze", "pair"))),
    Point("resonant_graze", "RG", "a graze whose square root vanishes, or whose corner has a multiplier 1 or -1",
          (("fold", "vanishes"), ("flip", "vanishes"), ("graze", "plus"), ("graze", "minus")), ends=("graze",)),
    Point("double_graze", "GRGR", "two grazes of one orbit", (("graze", "vanishes"), ("graze", "touches"))),
    Point("sticking_graze", "STGR", "another impact grazes at the onset of sticking",
          (("stick", "vanishes"), ("stick", "touches"))),
    Point("closed", "", "the curve comes back to itself"),
    Point("boundary", "", "boundary of the region that was looked at"),
    Point("failed", "", "the curve could not be followed any further"),
    Point("split", "", "within a contact the mass comes back to its stop: two contacts become one"),
    Point("unrelaxed", "", "with `release: force` a stop is touched before it has relaxed: no bifurcation"),
)  # fmt: skip
CODES_OF_CURVES = {row.name: code for code, row in enumerate(CODIMENSION_TWO)}

GRAZES = {  # kinds of them, and what happens
    "persistence": "beyond it the motion has one impact more or less",
    "nonsmooth_fold": "two motions meet, one with an impact more, and neither exists beyond",
}
KINDS = ("none", *GRAZES)
CRITICALITIES = ("none", "super", "sub")
