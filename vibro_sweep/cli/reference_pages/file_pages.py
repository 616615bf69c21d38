"""Variables of files: of sweeps, and of branches, windows and curves."""

from collections.abc import Iterator

from vibro_sweep.model.branch_file import BRANCHES, CHART, WINDOWS, columns
from vibro_sweep.model.curve_columns import OF_EDGES
from vibro_sweep.model.dimensions import DIMENSIONS
from vibro_sweep.model.observables import VARIABLES
from vibro_sweep.model.wording import sentence

from .markdown import head, table


def of_sweeps() -> Iterator[str]:
    yield from head(
        "Variables of the file of a sweep",
        "What a sweep writes. [Accuracy](../how/accuracy.md) says what the numbers allow to conclude,\n"
        "[files](files.md) how the file is laid out.",
    )
    yield "Dimensions come after those of the sweep, and `start` if there are several.\n"
    yield (
        "Units are those of a system in SI (`units: SI`). Of `physical`, and of other `units`, they have a factor, as\n"
        "`0.005 m`; without `units` all but radians are `1`.\n"
    )
    rows = ((f"`{one.name}`", sentence(one.text), ", ".join(one.dimensions), one.dtype, one.units) for one in VARIABLES)
    yield from table(("name", "`description`", "dimensions", "type", "units"), rows)
    yield "## Dimensions\n"
    yield from table(("name", "meaning"), ((f"`{name}`", one.text) for name, one in DIMENSIONS.items()))


def of_branches() -> Iterator[str]:
    """Variables of the other kinds of files, of branches in b and curves in b and omega."""
    yield from head(
        "Variables of files of branches, windows and curves",
        "What scenes with `continue`, `vibro-sweep windows` and `.save` write. `vibro_sweep.load` gives these files\n"
        "as objects, `vibro_sweep.open` as an `xarray.Dataset` with the variables below.",
    )
    known: set[str] = set()
    edges = ((CHART, ["b", "omega"], "curves", OF_EDGES),)
    for kind, parameters, name, more in ((BRANCHES, ["b"], "branches", ()), (WINDOWS, ["b"], "windows", ()), *edges):
        yield f"## A file of {name}\n"
        yield "Beside those of a file of branches.\n" if known else ""
        found = [one for one in (*columns(kind, parameters, 2), *more) if one.name not in known]
        known = known or {one.name for one in found}
        rows = ((f"`{one.name}`", sentence(one.text), ", ".join(one.dimensions), one.dtype) for one in found)
        yield from table(("name", "`description`", "dimensions", "type"), rows)
