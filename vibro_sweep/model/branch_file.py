"""Which variables files of branches, windows and curves have, in the units of a system, and what counts them."""

from vibro_sweep.model.any_oscillator import AnyOscillator
from vibro_sweep.model.branch_columns import BRANCH_SECTIONS, OF_BRANCHES
from vibro_sweep.model.column import OF_FIRST, OF_PARAMETER, Column
from vibro_sweep.model.curve_columns import OF_CURVES
from vibro_sweep.model.state import coordinates
from vibro_sweep.model.window_columns import OF_WINDOWS, UNVISITED
from vibro_sweep.tables.units import unit_in

BRANCHES, WINDOWS, CHART = "branches", "windows", "curves"  # the kinds of such files
SWEEP = "sweep"  # the kind of other HDF5 files


def columns(kind: str, parameters: list[str], masses: int) -> list[Column]:
    """All variables of a file; parameters : the names of numbers along which branches lead."""
    units = {one.name: one.units for one in coordinates(masses)}
    own = [Column(name, ("point",), "f8", name, f"value of the parameter {name}") for name in parameters]
    own += [Column(n, ("point",), "f8", n, f"value of {n} at t = 0, before an impact there", units[n]) for n in units]
    if kind == CHART:
        return [*own, *OF_CURVES]
    if kind == WINDOWS:
        text = "at t = 0 mod T, of a start that stays on the window's orbit at `unvisited_at`; NaN where none is known"
        starts = [Column(f"unvisited_{n}", ("unvisited",), "f8", n, f"value of {n} {text}", units[n]) for n in units]
        return [*own, *OF_BRANCHES, *OF_WINDOWS, *UNVISITED.values(), *starts]
    sections = [Column(f"section_{n}", ("section",), "f8", n, f"value of {n} at t = 0 mod T", units[n]) for n in units]
    return [*own, *OF_BRANCHES, BRANCH_SECTIONS, *sections]


def columns_of(kind: str, parameters: list[str], system: AnyOscillator, more: tuple[Column, ...] = ()) -> list[Column]:
    """These, and more, in the units of a system."""
    of_each = {name: system.described[name].units for name in parameters}
    first, *others = of_each.values()
    common = {OF_FIRST: first, OF_PARAMETER: first if all(one == first for one in others) else "1"}

    def unit(column: Column) -> str:
        return unit_in(of_each.get(column.name) or common.get(column.units, column.units), system.units)

    return [one._replace(units=unit(one)) for one in (*columns(kind, parameters, system.masses), *more)]


RAGGED = {  # dimension -> (counts of each branch, what each of them counts for): one branch after another
    "point": ("branch_row_size",),
    "impact": ("branch_row_size", "branch_impacts"),
    "special": ("branch_special",),
    "section": ("branch_row_size", "branch_sections"),
}
