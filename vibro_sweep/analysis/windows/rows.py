"""The orbits of a sweep, row by row: a row is all points along the number that is followed, other keys held."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from vibro_sweep.analysis.single.orbit import simulate
from vibro_sweep.checks.arguments import checked_word
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import cut
from vibro_sweep.oscillator.checked_numbers import range_of
from vibro_sweep.oscillator.function_model import BUILD
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.file_columns import SWEEP
from vibro_sweep.tables.outcomes import NOT_COMPUTED, REASONS, codes, is_valid

BEYOND = 1.0  # of the sweep's length: so far beyond its ends windows are followed
BEFORE = 0.25  # of the way from where a number must not be: there a frequency's period is infinite
REASON_CODES = codes(REASONS)


@dataclass(frozen=True)
class Row:
    """Points (values, starts) of a row, by rising values of the parameter.

    held : the other keys of the sweep and their values
    axis : of the parameter among the keys of the sweep
    places : of the values in the file
    states : (values, starts, 2N), the last recorded section state
    period : (values, starts), 0 where the orbit is not periodic
    reason : (values, starts), codes of `REASONS`, 0 for periodic orbits
    """

    system: Any
    parameter: str
    held: dict[str, float]
    axis: int
    values: np.ndarray
    places: np.ndarray
    states: np.ndarray
    period: np.ndarray
    reason: np.ndarray

    def system_at(self, value: float):
        """The oscillator at a value of the parameter."""
        return self.system.replace(**{self.parameter: float(value)})

    @cached_property
    def bounds(self) -> tuple[float, float]:
        """The range within which windows are followed."""
        lo, hi = float(self.values[0]), float(self.values[-1])
        more = BEYOND * (hi - lo)
        lo, hi = lo - more, hi + more
        allowed = range_of(self.system.described[self.parameter], self.system.options.get("stops", "both")).bounds
        lo = max(lo, allowed.get("minimum", lo))
        if "exclusiveMinimum" in allowed:
            least = allowed["exclusiveMinimum"]
            lo = max(lo, least + BEFORE * (float(self.values[0]) - least))
        return lo, min(hi, allowed.get("maximum", np.inf))


def chosen_key(data: Sweep, system, parameter: str | None) -> str:
    """The swept number along which windows are followed, by default the first. Raises ValueError."""
    swept = data.keys
    able = [name for name in swept if name in system.described and data.sizes[name] > 1]
    if not able:
        given = ", ".join(f"{name} of {data.sizes[name]}" for name in swept) or "nothing"
        raise ArgumentError(f"sweep: {given} is swept; windows need a number of the system at two values or more")
    return checked_word("parameter", parameter, able, optional=True) or able[0]


def check_data(data: Sweep) -> None:
    """Raise ValueError for what is not a sweep, or has no section states of the oscillator itself."""
    if data.attrs.get("kind", SWEEP) != SWEEP:
        raise ArgumentError(f"holds {cut(str(data.attrs['kind']))}, not a sweep")
    if data.attrs.get("type") == BUILD:
        raise ArgumentError("type: 'build' is not allowed; the function that made the oscillators is not in the file")
    if data.attrs.get("dynamics", "flow") != "flow":
        raise ArgumentError("dynamics: 'map' is not allowed; windows are those of the oscillator itself, 'flow'")
    if "period" not in data or "x1" not in data:
        raise ArgumentError("observe: has no 'section'; windows start from the section states of a sweep")
    if "status" not in data:
        raise ArgumentError("has no `status`, which tells the orbits that are computed; it is needed")
    if more := [name for name in data.dims("period") if name not in (*data.keys, "start")]:
        raise ArgumentError(f"has the dimension {more[0]}, which its sweep has not; take one part by `isel`")
    for name, value in data.numbers.items():
        if name in data.attrs and data.attrs[name] != value:
            raise ArgumentError(
                f"{name}: the coordinate says {value!r} and the attribute {data.attrs[name]!r}; they must agree"
            )


def rows_of(data: Sweep, system, key: str) -> Iterator[Row]:
    """The rows of a sweep of `system` along `key`, in the order of the file."""
    swept = data.keys
    others = [name for name in swept if name != key]
    lead = [*others, key, *(["start"] if "start" in data.dims("period") else [])]
    at_impacts = "phase" in data
    points = [data.values(name, lead) for name in state(system.masses)]
    last = [_last(values) if at_impacts else values[..., -1] for values in points]
    arrays = {"states": np.stack(last, axis=-1), "period": data.values("period", lead)}
    phases = data.values("phase", lead) if at_impacts else None
    arrays["reason"] = _reasons(data.values("status", lead), arrays["period"])
    if phases is not None:
        arrays["phases"] = _last(phases)
    if "start" not in lead:
        arrays = {name: np.expand_dims(values, len(lead)) for name, values in arrays.items()}
    axes = {name: data.values(name) for name in (*others, key)}
    order = np.argsort(axes[key], kind="stable")
    for place in np.ndindex(*(data.sizes[name] for name in others)):
        held = {name: float(axes[name][i]) for name, i in zip(others, place, strict=True)}
        there = system.replace(**{name: value for name, value in held.items() if name in system.described})
        parts = {name: values[place][order] for name, values in arrays.items()}
        values = axes[key][order].astype(float)
        if at_impacts:
            parts["states"] = _at_section(there, key, values, parts["states"], parts.pop("phases"), parts["reason"])
        yield Row(there, key, held, swept.index(key), values, order, **parts)


def _last(points: np.ndarray) -> np.ndarray:
    """Of section points (..., n) at impacts, NaN behind the last one, that one; NaN where there is none."""
    known = np.isfinite(points)
    place = np.where(known.any(-1), points.shape[-1] - 1 - np.argmax(known[..., ::-1], axis=-1), 0)
    return np.take_along_axis(points, place[..., None], -1)[..., 0]


def _at_section(system, key: str, values: np.ndarray, states: np.ndarray, phases: np.ndarray, reason: np.ndarray):
    """The states (values, starts, 2N) at the next t = 0 mod T after impacts at these phases; where there was none, or
    the orbit is not valid, they stay as they are."""
    result, bad = states.copy(), (REASON_CODES["not_computed"], REASON_CODES["failed"])
    for i, j in np.argwhere(np.isfinite(phases) & ~np.isin(reason, bad)).tolist():
        there = system.replace(**{key: float(values[i])})
        orbit = simulate(there, states[i, j], 1, phases[i, j] / there.omega)
        result[i, j] = orbit.section[0]
    lost = np.isnan(result).any(-1) & (reason == 0)
    reason[lost] = REASON_CODES["not_settled"]  # without an impact the file does not say where the orbit is
    return np.where(np.isfinite(result), result, 0.0)


def _reasons(status: np.ndarray, period: np.ndarray) -> np.ndarray:
    """Codes of `REASONS`: 0 for periodic orbits, `not_settled` for others until they have been computed further."""
    return first_reason(not_computed=status == NOT_COMPUTED, failed=~is_valid(status), in_a_window=period > 0)


def first_reason(**holds: np.ndarray) -> np.ndarray:
    """Codes of the first of these reasons that holds; `not_settled` where none does."""
    codes = [REASON_CODES[name] for name in holds]
    return np.select(list(holds.values()), codes, REASON_CODES["not_settled"]).astype(np.int8)
