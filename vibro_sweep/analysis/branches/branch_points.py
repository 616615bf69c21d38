"""The points of a branch as columns."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.continuation.recorded import Rows
from vibro_sweep.analysis.periodic.orbit_multipliers import multipliers_of, squared
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses.flow import flow
from vibro_sweep.oscillator.linear import Linear, forcing_period
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.file_columns import OF_CONTACTS


def columns_from_file(arrays: dict[str, np.ndarray], name: str) -> dict[str, tuple]:
    """`columns`, from the arrays of a file (branch_arrays.py)."""
    words, sides = state(arrays["state"].shape[1] // 2), np.tile(arrays["impact_side"], (len(arrays["value"]), 1))
    values = {"multiplier_re": "multiplier", "multiplier_im": "multiplier", "impact_t": "impact", "impact_v": "impact"}
    result = {name: ("point", arrays["value"])} | {one: (("point", d), arrays[one]) for one, d in values.items()}
    result |= {word: ("point", arrays["state"][:, i]) for i, word in enumerate(words)}
    numbers = ("unstable", "stop_distance", "min_impact_speed", "residual")
    result |= {one: ("point", arrays[one]) for one in numbers}
    result |= {one.name: ("point", arrays[one.name]) for one in OF_CONTACTS if one.name in arrays}
    return result | {"impact_side": (("point", "impact"), sides)}


def of_contacts(orbits: Iterable[PeriodicOrbit]) -> dict[str, tuple]:
    """The columns `OF_CONTACTS` of the orbits of all points."""
    tables = [orbit.contacts for orbit in orbits]
    fields = {"contact_force_max": "max_force", "penetration_max": "max_penetration"}
    return {
        name: ("point", np.array([table[key].max() if len(table) else np.nan for table in tables]))
        for name, key in fields.items()
    }


def columns(start: Solution, name: str, frame: tuple[int, int], rows: Rows) -> dict[str, tuple]:
    """Dimensions and values over `point`, in order: the parameter; `multiplier_re`, `multiplier_im` (multiplier) of the
    whole period; `unstable`, the number of multipliers outside the unit circle; the state x1 v1 .. at t = 0;
    `stop_distance`; `min_impact_speed`; `residual`, the largest jump of the gap between two flights, relative to its
    size; `impact_t`, `impact_side` and `impact_v` (impact) as `orbit.impacts` of the first point, from there on
    continuous: times are not wrapped.
    """
    oscillators = _oscillators(start, name, rows)
    T = np.array([[forcing_period(q)] for q in oscillators])
    multipliers = _multipliers(start, name, oscillators, rows)
    states, (t, sides, v) = rows.state, _impacts(start, frame, rows, T)
    names = [f"{kind}{i + 1}" for i in range(states.shape[1] // 2) for kind in "xv"]
    return {
        name: ("point", rows.p),
        "multiplier_re": (("point", "multiplier"), multipliers.real),
        "multiplier_im": (("point", "multiplier"), multipliers.imag),
        "unstable": ("point", np.count_nonzero(np.abs(multipliers) > 1, axis=1)),
        **{word: ("point", states[:, i]) for i, word in enumerate(names)},
        "stop_distance": ("point", rows.stop_distance),
        "min_impact_speed": ("point", np.abs(v).min(axis=1, initial=np.inf)),
        "residual": ("point", rows.residual),
        "impact_t": (("point", "impact"), t),
        "impact_side": (("point", "impact"), np.tile(sides, (len(rows.p), 1))),
        "impact_v": (("point", "impact"), v),
    }


def impacts(
    start: Solution, name: str, frame: tuple[int, int], rows: Rows
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (points, K), sides (K,) and velocities (points, K) of the impacts, as `columns` has them."""
    T = np.array([[forcing_period(start.family.linear)]])
    if start.family.derivative(name).omega:
        T = np.array([[forcing_period(q)] for q in _oscillators(start, name, rows)])
    return _impacts(start, frame, rows, T)


def _impacts(start: Solution, frame: tuple[int, int], rows: Rows, T: np.ndarray):
    t, v, sides = rows.t, rows.motion[:, :, 0], np.array(start.sides, int)
    half = T / 2 * start.half_periods
    if start.sigma == -1:
        t, v, sides = np.hstack([t, t + half]), np.hstack([v, -v]), np.append(sides, -sides)
    first, shift = frame
    length = half * (2 if start.sigma == -1 else 1)
    t = np.hstack([t[:, first:], t[:, :first] + length]) - shift * T
    return t, np.roll(sides, -first), np.roll(v, -first, axis=1)


def _oscillators(start: Solution, name: str, rows: Rows) -> list[Linear]:
    return [start.family.replace(**{name: p}).linear for p in rows.p.tolist()]


def _multipliers(start: Solution, name: str, oscillators: list[Linear], rows: Rows) -> np.ndarray:
    """(points, 2N) of the whole period, by falling modulus, of a pair +im first."""
    result, sides, contacts = [], np.array(start.sides), np.zeros((start.K, 2))  # where stops are does not matter
    for p, q, t, D, ends, motion in zip(rows.p, oscillators, rows.t, rows.D, rows.ends, rows.motion, strict=True):
        if start.rests:
            family = start.family.replace(**{name: float(p)})
            result.append(replace(start, family=family, u=np.concatenate([t, D, ends])).multipliers)
            continue
        contacts[:, 1] = 1 + q.contact.restitution(sides)
        P, u = forcing_period(q) / 2 * start.half_periods, np.concatenate([t, D])
        result.append(multipliers_of(flow(q), start.sigma, P, contacts, u, motion))
    values = np.array(result) if start.sigma == 1 else squared(np.array(result))
    order = np.lexsort((-values.imag, -np.abs(values)), axis=-1)
    return np.take_along_axis(values, order, axis=-1)
