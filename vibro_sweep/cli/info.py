"""The lines that `info` says of a file, and the tables of its branches, curves or windows."""

import contextlib
import json
import math
from collections import Counter
from pathlib import Path

import numpy as np
import xarray

from vibro_sweep.checks.arguments import MAX_COUNT
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.cli.described_machine import quiet_line
from vibro_sweep.cli.ragged_tables import curves_table, special_table, windows_table
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.opening import open_file
from vibro_sweep.files.reading import open_whole
from vibro_sweep.files.verifying import REMEDY, damage
from vibro_sweep.oscillator.contact_laws.compliant import LAW as COMPLIANT
from vibro_sweep.results import ragged_dataset
from vibro_sweep.results.declared_units import display_in, shown_dataset
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.tables.exponents import CERTAIN, periods_to_go, sign_of
from vibro_sweep.tables.file_columns import CHART, SWEEP, WINDOWS
from vibro_sweep.tables.observables import GAP
from vibro_sweep.tables.outcomes import NOT_COMPUTED, NOT_SETTLED, REASONS, VALID, named, status_of
from vibro_sweep.tables.units import Display, shown_unit, unit_text

STRUCK = ("impacts_right", "impacts_left", "sticking_time")
PRESSED = ("contacts_right", "contacts_left", "contact_time")


def tables(path: str | Path, display: Display | None = None) -> list[str]:
    """The tables of a file of branches or windows, line by line, in these units. Raises StoreError."""
    with open_whole(Path(path)) as data:
        return _tables(data, display)


def description_of(path: Path, display: Display | None = None) -> tuple[str, bool]:
    """The lines about a file, and whether they say `damaged`: what is in it, how it was made, how far it is, and its
    stated accuracy. Raises StoreError.

    display : the units of numbers; None: those that its scene says
    """
    with open_file(path) as data:
        try:
            return _examined(data, path, display)
        except ArgumentError as error:
            raise StoreError(f"{path}: {error}") from None
        except (OSError, RuntimeError, ValueError, KeyError, TypeError) as error:
            raise StoreError(f"{path} is damaged ({error})") from None


def _examined(data: xarray.Dataset, path: Path, display: Display | None) -> tuple[str, bool]:
    lines = [f"{path}: {data.attrs['title']}"]
    sealed, lost = data.encoding["sealed"], damage(data)
    checked = f"damaged      {lost}; {REMEDY}" if lost else "checksums    all hold"
    if not sealed:
        checked = "checksums    none: written, or changed, by another program"
    made_by = ["made by" if sealed else "written from a file that was made by"]
    made_by += _record(data.attrs["provenance"], data.attrs["history"])
    if data.attrs["kind"] != SWEEP:
        ragged_dataset.check(data)
        return "\n".join([*lines, *_tables(data, display), checked, *made_by]), False
    sweep = Sweep(data, str(path), display=display)
    for name in sweep.keys:
        axis, unit = sweep.values(name), unit_text(sweep.unit(name))
        lines.append(f"  {name:<10} {axis[0]:g} .. {axis[-1]:g}{f' {unit}' if unit else ''} ({len(axis):,} values)")
    if "start" in sweep.dims("status"):
        lines.append(f"  {'start':<10} {sweep.sizes['start']} at each point")
    lines.append("datasets")
    lines += [_dataset(name, data[name].shape, data[name].attrs.get("description", "")) for name in _in_order(sweep)]
    lines += [*_progress(sweep), checked]
    if not data.encoding["complete"] and NOT_COMPUTED not in sweep.values("status"):
        lines.append("unfinished   its last line is missing; `--resume` completes it")
    if not lost:
        lines += quiet_line(sweep)
        lines += [*_untouched(sweep), *_turning(sweep), *_exponents(sweep), *_accuracy(sweep)]
    return "\n".join([*lines, *made_by]), bool(lost)


def _in_order(sweep: Sweep) -> list[str]:
    """The names of what is computed, `status` last."""
    return [*(name for name in sweep.names if name != "status"), "status"]


def _record(provenance: str, history: str) -> list[str]:
    """The lines about how a file was made."""
    try:
        known = json.loads(provenance)
    except (TypeError, ValueError):
        known = {}
    pairs = known.items() if isinstance(known, dict) else ()
    return [
        *(f"  {key:<12} {value}" for key, value in pairs if value is not None),
        *(f"  {line}" for line in history.splitlines()),
    ]


def _dataset(name: str, shape: tuple[int, ...], description: str) -> str:
    return f"  {name:<18} {' x '.join(map(str, shape)) or 'one':<16} {description}"


def _tables(data: xarray.Dataset, display: Display | None) -> list[str]:
    """The tables of a file of branches or windows."""
    data = shown_dataset(data, display_in(data) if display is None else display)
    arrays = {str(name): variable.values for name, variable in data.data_vars.items()}
    names = [str(name) for name in np.atleast_1d(data.attrs["parameters"])]
    parameters = {name: f"{name}{shown_unit(data[name].attrs.get('units'))}" for name in names}
    if data.attrs["kind"] == WINDOWS:
        return windows_table(arrays, parameters)
    if data.attrs["kind"] == CHART:
        return curves_table(arrays, parameters)
    return special_table(arrays, parameters)


def _progress(sweep: Sweep) -> list[str]:
    """Done, missing and failed."""
    counts, total = Counter(sweep.values("status").ravel().tolist()), sweep.values("status").size
    done = total - counts[NOT_COMPUTED]
    failed = {status_of(code): count for code, count in sorted(counts.items()) if code not in (*VALID, NOT_COMPUTED)}
    return [
        f"computed     {done:,} of {total:,} orbits ({100 * done / total:.4g} %)",
        f"missing      {total - done:,}",
        f"failed       {sum(failed.values()):,}",
        *(
            f"  {outcome.name}: {count:,}" + f"\n    {outcome.advice}" * bool(outcome.advice)
            for outcome, count in failed.items()
        ),
        *([f"not settled  {counts[NOT_SETTLED]:,}{_to_go(sweep)}"] if counts[NOT_SETTLED] else []),
    ]


def _to_go(sweep: Sweep) -> str:
    """How many periods more orbits need that approach a periodic one, as far as it is known."""
    if "approached_factor" not in sweep:
        return ""
    with np.errstate(all="ignore"):
        needed = periods_to_go(sweep.values("approached_distance"), sweep.values("approached_factor"))
    needed = needed[np.isfinite(needed) & (needed > 0)]
    if not len(needed):
        return ""
    half, longest = (f"{float(f'{periods:.2g}'):,.0f}" for periods in (np.median(needed), needed.max()))
    most = "" if half == longest else f", half of them within {half}"
    done = max(sweep.attrs["transient"], sweep.attrs.get("settle", 0))
    # twice, since predictions are too short while the motion still changes
    enough = min(10 ** math.ceil(math.log10(done + 2 * needed.max())), MAX_COUNT)
    within = f"; {len(needed):,} arrive at a periodic orbit within about {longest} periods more{most}"
    return f"{within}: with `orbit: settle: {enough}` each goes on for as many as it needs"


def _untouched(sweep: Sweep) -> list[str]:
    """The line on sweeps in which nothing is struck or pressed, as far as contacts of all its stops are observed."""
    soft = any(names[0] in {*sweep.attrs, *sweep.keys} for names in COMPLIANT.names.values())
    names = [name for name in (*STRUCK, *PRESSED) if name in sweep]
    if not set(PRESSED if soft else STRUCK) <= {*names}:
        return []
    computed = np.isin(sweep.values("status"), VALID)
    if not computed.any() or any(sweep.values(name)[computed].any() for name in names):
        return []
    return ["no contact   no orbit touches a stop: b is too large; `vibro-sweep grazing SCENE.yaml` says b*"]


def _turning(sweep: Sweep) -> list[str]:
    """The line on orbits without a period because nothing holds the masses: only a contact between them leaves that."""
    if not {GAP, "period"} <= set(sweep.names):
        return []
    without = int((sweep.values("period") == 0).sum())
    if not without:
        return []
    from vibro_sweep.engine.impulses.free_modes import turns  # these two take a second to be imported
    from vibro_sweep.scene.scene import parse_scene

    with contextlib.suppress(ValueError):  # there is no text of what a function made
        if turns(parse_scene(sweep.attrs["scene"]).system.linear):
            return [f"turning      {without:,} orbits: {named(REASONS, 'turning').text}"]
    return []


def _exponents(sweep: Sweep) -> list[str]:
    """The line on how many orbits are chaotic."""
    if not {"lyapunov", "lyapunov_error"} <= set(sweep.names):
        return []
    certain = float(sweep.attribute("lyapunov_error", "significant") or CERTAIN)
    largest, error = (sweep.values(name)[..., 0] for name in ("lyapunov", "lyapunov_error"))
    counts = Counter(sign_of(largest, error, certain)[~np.isnan(largest)].tolist())
    words = f"{counts[1]:,} of {counts.total():,} orbits; not told from zero: {counts[0]:,}"
    return [f"lambda_1     above zero by more than {certain:g} errors: {words}"] if counts else []


def _accuracy(sweep: Sweep) -> list[str]:
    lines = []
    if {"lyapunov", "lyapunov_residual"} <= set(sweep.names):
        total, residuals = _finite(sweep.values("lyapunov")[..., 0]).size, _finite(sweep.values("lyapunov_residual"))
        if residuals.size:
            lines.append(f"accuracy     |sum of exponents - exact sum| <= {np.abs(residuals).max():.2g}")
        if residuals.size < total:
            unknown = f"{total - residuals.size:,} of {total:,} orbits"
            lines.append(f"             not known where dimensions are lost: {unknown}")
    if "contact_error" in sweep and (missed := _finite(sweep.values("contact_error"))).size:
        unit = unit_text(sweep.unit("contact_error"))
        lines.append(f"             impacts were found within {f'{missed.max():.2g} {unit}'.strip()} of the stop")
    if "min_impact_speed" in sweep and (speeds := _finite(sweep.values("min_impact_speed"))).size:
        unit = unit_text(sweep.unit("min_impact_speed"))
        lines.append(f"             slowest impact {f'{speeds.min():.2g} {unit}'.strip()}: the nearest to a graze")
    return lines


def _finite(values: np.ndarray) -> np.ndarray:
    return values[np.isfinite(values)]
