"""The points of a bifurcation curve as a Dataset."""

import math
from dataclasses import replace
from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.analysis.branches import branch_points
from vibro_sweep.analysis.branches.special import bare
from vibro_sweep.analysis.continuation.recorded import Rows
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.periodic.orbit_multipliers import multipliers_of, squared
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.engine.continuation.curve_tests import TOUCHING
from vibro_sweep.engine.continuation.problem import FLIP, FOLD, GRAZE, STICK, TORUS
from vibro_sweep.engine.continuation.workspace import THETA
from vibro_sweep.engine.impulses.flights import free_part, new_workspace
from vibro_sweep.engine.impulses.flow import Flow, contact_coordinates, flow, steady_motion
from vibro_sweep.oscillator.linear import Linear, forcing_period
from vibro_sweep.tables.coordinates import state

if TYPE_CHECKING:
    import xarray

free_numbers = attrgetter("M", "K", "C", "contact.normal", "constant")  # on which the free flight depends


def dataset(curve: SolutionCurve, rows: Rows) -> "xarray.Dataset":
    """Over `point`, in order: both parameters; the state x1 v1 .. at t = 0, before an impact there; `multiplier_re`,
    `multiplier_im` (multiplier) of the whole period, at a graze of the orbit without the grazing impact; `unstable`,
    how many lie outside the unit circle beside those that the curve is about; `virtual`, whether the orbit is no
    motion: an impulse pulls or a flight passes a stop; `stop_distance`, the least distance of its other turning points
    from their stop; `residual`; `impact_t`, `impact_side` and `impact_v` (impact): of the half orbit where it is
    symmetric, times not wrapped.

    At an onset of sticking there are no multipliers and no states (NaN). The impacts are the end of the chatter, with
    no speed, and those before the next end that are written out (NaN: fewer than elsewhere on the curve).
    """
    s, kind, names, K = curve.orbit, curve.problem.kind, curve.names, rows.t.shape[1]
    sides = curve.resized(K).problem.sides.astype(int)
    others = np.delete(np.arange(K), curve.problem.index) if kind >= GRAZE else np.arange(K)
    multipliers, shifts, states = [], [], []
    oscillators = [curve.oscillators.at(p).linear for p in rows.p]
    flows = _flows(oscillators) if kind != STICK else oscillators
    for q, f, p, t, D, ends, motion, h in zip(
        oscillators, flows, rows.p, rows.t, rows.D, rows.ends, rows.motion, rows.state, strict=True
    ):
        contacts = np.column_stack([q.contact.stop(sides), 1 + q.contact.restitution(sides)])[others]
        P, u = forcing_period(q) / 2 * s.half_periods, np.concatenate([t[others], D[others]])
        shifts.append((curve.tau - q.tau) / q.omega)
        if kind == STICK:
            multipliers.append(np.full(2 * q.masses, np.nan, complex))
            states.append(np.full(2 * q.masses, np.nan))
            continue
        if s.rests:
            values = _with_contacts(curve, p, t + shifts[-1], D, ends + shifts[-1])
            multipliers.append(values[0])
            states.append(values[1])
            continue
        multipliers.append(multipliers_of(f, s.sigma, P, contacts, u, motion[others]))
        states.append(_state(q, f, s.sigma, P, t + shifts[-1], D, h))
    values = np.array(multipliers)
    unstable = others_outside(values, kind, rows.p[:, THETA])
    values = values if s.sigma == 1 else squared(values)
    order = np.lexsort((-values.imag, -np.abs(values)), axis=-1)
    values = np.take_along_axis(values, order, axis=-1)
    pulls = -sides[others] * rows.D[:, others] <= -TOUCHING * curve.units.speed
    pushes = ~np.any(pulls, axis=1)  # NaN: not written out
    variables = {
        names[0]: ("point", rows.p[:, 0]),
        names[1]: ("point", rows.p[:, 1]),
        **{name: ("point", values) for name, values in zip(state(q.masses), np.transpose(states), strict=True)},
        "multiplier_re": (("point", "multiplier"), values.real),
        "multiplier_im": (("point", "multiplier"), values.imag),
        "unstable": ("point", unstable),
        "virtual": ("point", ~(pushes & (rows.stop_distance > -TOUCHING * curve.units.length))),
        "stop_distance": ("point", rows.stop_distance),
        "residual": ("point", rows.residual),
        "impact_t": (("point", "impact"), rows.t + np.array(shifts)[:, None]),
        "impact_side": (("point", "impact"), np.tile(sides, (len(rows.p), 1))),
        "impact_v": (("point", "impact"), rows.motion[:, :, 0]),
    }
    import xarray

    return xarray.Dataset(variables)


def dataset_from_file(arrays: dict[str, np.ndarray], names: tuple[str, str]) -> "xarray.Dataset":
    """The same, from the arrays of a file (curve_arrays.py), which has the impacts of whole orbits."""
    import xarray

    one = xarray.Dataset(branch_points.columns_from_file(arrays | {"value": arrays["value"][:, 0]}, names[0]))
    if arrays["branch_symmetric"]:
        one = one.isel(impact=slice(one.sizes["impact"] // 2))
    more = {names[1]: ("point", arrays["value"][:, 1]), "virtual": ("point", arrays["status"] != 0)}
    return xarray.Dataset({**one, **more}).drop_vars("min_impact_speed")


def _with_contacts(curve: SolutionCurve, p, t, D, ends) -> tuple[np.ndarray, np.ndarray]:
    """Multipliers and state (2N,) at t = 0 of a point whose orbit has contacts with compliant stops."""
    point = replace(curve.orbit, family=curve.oscillators.at(p), u=np.concatenate([t, D, ends]))
    own = bare(point, curve.problem.index) if curve.problem.kind == GRAZE else point
    return own.multipliers, PeriodicOrbit(point.family, "ok", point, (0, 0)).state


def _state(q: Linear, f: Flow, sigma: int, P: float, t: np.ndarray, D: np.ndarray, h: np.ndarray) -> np.ndarray:
    """(2N,) at t = 0, before an impact there: that at a multiple of P after the first impact."""
    later = math.ceil(t[0] / P) if len(t) else 0
    workspace, N = new_workspace(len(f.B)), q.masses
    free_part(f, h, t, D, P, later * P, workspace)
    y = (workspace.state[: 2 * N] + steady_motion(q, later * P)) * (1 if sigma == 1 or later % 2 == 0 else -1)
    return contact_coordinates(q).to_masses(y)


def _flows(oscillators: list[Linear]) -> list[Flow]:
    """The flow of each point; one for all where only force and stops change along the curve."""
    first = oscillators[0]
    own = free_numbers(first)
    if all(np.array_equal(one, other) for q in oscillators for one, other in zip(free_numbers(q), own, strict=True)):
        return [flow(first)] * len(oscillators)
    return [flow(q) for q in oscillators]


def others_outside(values: np.ndarray, kind: int, theta: np.ndarray) -> np.ndarray:
    """(points,) how many of the multipliers (points, 2N) lie outside the unit circle, without the critical ones."""
    outside, rows, values = np.abs(values) > 1, np.arange(len(values)), values.copy()
    angles = {FOLD: [0 * theta], FLIP: [0 * theta + np.pi], TORUS: [theta, -theta], GRAZE: [], STICK: []}[kind]
    for angle in angles:
        nearest = np.abs(values - np.exp(1j * angle)[:, None]).argmin(axis=1)
        outside[rows, nearest] = False
        values[rows, nearest] = np.inf  # at 1 and -1 both of a pair are equally near
    return outside.sum(axis=1)
