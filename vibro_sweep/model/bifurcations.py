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
CURVES = ("fold", "flip", "pitchfork", "neimark_sacker", "graze")  # those that are curves in two parameters

CODIMENSION_TWO = (  # labels: those of MatCont where it has one
    Bifurcation("cusp", "CP", "two folds meet"),
    Bifurcation("fold_flip", "LPPD", "multipliers 1 and -1"),
    Bifurcation("fold_neimark_sacker", "LPNS", "multiplier 1 and a pair on the unit circle"),
    Bifurcation("flip_neimark_sacker", "PDNS", "multiplier -1 and a pair on the unit circle"),
    Bifurcation("resonance_1_1", "R1", "the multiplier 1 is double"),
    Bifurcation("resonance_1_2", "R2", "the multiplier -1 is double"),
    Bifurcation("resonance_1_3", "R3", "a pair at a third of a turn"),
    Bifurcation("resonance_1_4", "R4", "a pair at a quarter of a turn"),
    Bifurcation("degenerate_flip", "GPD", "a flip (pitchfork) changes its criticality"),
    Bifurcation("degenerate_neimark_sacker", "CH", "a Neimark-Sacker point changes its criticality"),
    Bifurcation("fold_graze", "LPGR", "a fold at a graze"),
    Bifurcation("flip_graze", "PDGR", "a flip at a graze"),
    Bifurcation("pitchfork_graze", "PFGR", "a pitchfork at a graze"),
    Bifurcation("neimark_sacker_graze", "NSGR", "a Neimark-Sacker point at a graze"),
    Bifurcation("resonant_graze", "RG", "a graze whose square root vanishes"),
    Bifurcation("double_graze", "GRGR", "two grazes of one orbit"),
    Bifurcation("sticking_graze", "STGR", "another impact grazes at the onset of sticking"),
    Bifurcation("closed", "", "the curve comes back to itself"),
    Bifurcation("limit", "", "edge of the box that was looked at"),
    Bifurcation("failed", "", "the curve could not be followed any further"),
)
CODES_OF_CURVES = {one.name: code for code, one in enumerate(CODIMENSION_TWO)}

KINDS = ("none", "persistence", "nonsmooth_fold")  # of a graze
CRITICALITIES = ("none", "super", "sub")
STATUSES = ("ok", "not_real")  # of points of a branch
BRANCH_STATUSES = ("ok", "failed")  # failed: it could not be followed to an end, or not at all

EDGES = {  # of a plane between points of different periods: why; what says most comes first
    "curve": "a curve passes between the two points on which one of their orbits ends or loses its stability",
    "alone": "an orbit ends or loses its stability between the points, but no curve was followed from there",
    "stable_at_both": "the periodic orbits are stable at both points; other starts, or a record that has not settled",
    "not_settled": "the recorded orbit is not yet the periodic one that it approaches",
    "failed": "the orbit could not be followed",
    "open": "not looked at",
}

REASONS = {  # why a point of a sweep lies in no window; 0: it lies in one
    "in_a_window": "in a window",
    "chaos": "the largest Lyapunov exponent is positive",
    "quasi_periodic": "the largest Lyapunov exponent is zero within its error, and the orbit not periodic",
    "sticking": "the mass rests on a stop after infinitely many impacts: such orbits have no finite list of impacts",
    "not_settled": "neither periodic within the record nor known to be anything else, or not yet where it attracts to",
    "failed": "the orbit, or the equations of its impacts, could not be computed",
    "not_computed": "the file has no orbit there",
    "not_isolated": "one of a family of orbits: of a mass that nothing holds, or of a mode without losses in resonance",
}
ATTRACTORS = ("chaos", "quasi_periodic", "sticking")  # reasons that say where an orbit went to
