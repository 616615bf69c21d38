"""Which word is meant by one that is not known: by its spelling, or as a synonym."""

import difflib
from collections.abc import Iterable

from vibro_sweep.checks.refusals import cut

SYNONYMS = {
    "start": ("from", "min", "begin", "low", "lo", "initial", "init", "ic", "initial_state", "x0"),
    "stop": ("to", "max", "end", "high", "hi", "until", "side"),
    "num": ("n", "count", "number", "points", "steps", "size", "samples", "length"),
    "step": ("by", "increment", "delta", "dx", "stride"),
    "values": ("list", "value", "at"),
    "omega": ("w", "ω", "Omega", "Ω"),
    "frequency": ("freq", "hz", "cycles"),
    "b": ("clearance", "gap", "delta", "B", "stop_right", "stop_left"),
    "Omega": ("f", "frequency", "freq", "hz", "w"),
    "B": ("clearance", "gap", "delta"),
    "R": ("e", "restitution", "cor", "r"),
    "zeta": ("ζ", "damping", "xi", "ξ"),
    "mu_m": ("μ_m", "m", "mass_ratio"),
    "mu_k": ("μ_k", "k", "stiffness_ratio"),
    "f2": ("f", "f_2"),
    "tau": ("phi", "phase", "τ"),
    "stops": ("sides", "walls"),
    "x1": ("x", "x_1"),
    "v1": ("v", "v_1", "xdot1"),
    "x2": ("y", "x_2"),
    "v2": ("v_2", "xdot2"),
    "transient": ("skip", "discard", "warmup", "warm_up"),
    "record": ("periods", "keep", "total"),
    "kind": ("type",),
    "periods": ("length", "time", "duration"),
    "samples": ("n", "num", "points"),
    "system": ("parameters", "params", "oscillator"),
    "sweep": ("scan", "parameter", "vary", "sweeps"),
    "orbit": ("time", "periods", "duration", "simulation"),
    "observe": ("output", "outputs", "observables", "compute", "quantities"),
    "lyapunov": ("exponents", "exponent", "lyap", "le", "lle", "spectrum", "chaos"),
    "section": ("poincare", "bifurcation", "points", "period", "states", "x1"),
    "multipliers": ("floquet", "eigenvalues", "stability"),
    "attractors": ("basins", "basin", "coexistence"),
    "map": ("mapping", "discontinuity"),
    "flow": ("oscillator", "ode", "exact"),
    "dynamics": ("model",),
    "contact_normal": ("along", "normal", "n"),
    "parameter": ("along",),
    "both": ("two", "2", "left and right", "right and left", "all"),
    "up": ("yes", "true", "forward", "increasing"),
    "down": ("backward", "decreasing"),
}


def meant(word: object, options: Iterable[str]) -> str | None:
    """The option for which a word stands, if any: by spelling, or as a synonym."""
    text, options = cut(str(word)), list(options)
    by_lower = {option.lower(): option for option in reversed(options)}
    if text.lower() in by_lower:
        return by_lower[text.lower()]
    for option in options:
        if text in SYNONYMS.get(option, ()) or text.lower() in SYNONYMS.get(option, ()):
            return option
    close = difflib.get_close_matches(text.lower(), by_lower, n=1)
    return by_lower[close[0]] if close else None


def did_you_mean(word: object, options: Iterable[str]) -> str:
    """The beginning of a refusal of a word that is not one of these."""
    likely = meant(word, options)
    return f"did you mean `{likely}`? " if likely else ""
