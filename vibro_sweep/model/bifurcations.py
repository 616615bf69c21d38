"""Types of special points of branches, declared once: codes and words of files, labels of pictures."""

from typing import NamedTuple


class Bifurcation(NamedTuple):
    name: str
    label: str  # in pictures; empty: it is not marked
    text: str


TYPES = (
    Bifurcation("fold", "LP", "two orbits meet and vanish"),
    Bifurcation("flip", "PD", "period doubling, multiplier -1"),
    Bifurcation("pitchfork", "BP", "a symmetric orbit loses its symmetry"),
    Bifurcation("neimark_sacker", "NS", "a torus is born, a pair of multipliers of modulus 1"),
    Bifurcation("graze", "GR", "an impact appears or vanishes"),
    Bifurcation("sticking", "ST", "a rest on a stop begins, ends or is interrupted"),
    Bifurcation("closed", "", "the branch comes back to itself"),
    Bifurcation("limit", "", "end of the range that was looked at"),
    Bifurcation("failed", "", "the branch could not be followed any further"),
)
CODES = {one.name: code for code, one in enumerate(TYPES)}

KINDS = ("none", "persistence", "nonsmooth_fold")  # of a graze
CRITICALITIES = ("none", "super", "sub")
STATUSES = ("ok", "not_real")  # of points of a branch

REASONS = {  # why a point of a sweep lies in no window; 0: it lies in one
    "in_a_window": "in a window",
    "chaos": "the largest Lyapunov exponent is positive",
    "quasi_periodic": "the largest Lyapunov exponent is zero within its error, and the orbit not periodic",
    "sticking": "the mass rests on a stop after infinitely many impacts: such orbits have no finite list of impacts",
    "not_settled": "neither periodic within the record nor known to be anything else, or not yet where it attracts to",
    "failed": "the orbit, or the equations of its impacts, could not be computed",
    "not_computed": "the file has no orbit there",
}
ATTRACTORS = ("chaos", "quasi_periodic", "sticking")  # reasons that say where an orbit went to
