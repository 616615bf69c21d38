"""What results have in common: a table, which notebooks show; those that a file can hold also a Dataset and a file."""

import html
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep.checks.errors import ArgumentError, MissingPackageError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.oscillator.wording import itinerary_text

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.figure import Figure

ROWS = 30  # of a table in a notebook
FORMATS = {
    "itinerary": lambda word: word and itinerary_text(word),
    "error": lambda error: f"{error:.1e}" if error > 0 else "",
    "stop": lambda side: {1: "right", -1: "left"}.get(side, ""),
}


class Result:
    """A result with a table."""

    def _table(self) -> dict[str, list]:
        """The columns of the table, lists of one length, by their names."""
        raise NotImplementedError

    def to_dataframe(self) -> "pandas.DataFrame":
        """The table: contacts, else impacts, of an orbit, special points of a branch or a curve, or windows.

        Raises MissingPackageError where pandas is not installed.
        """
        try:
            import pandas
        except ImportError:
            raise MissingPackageError("to_dataframe: needs the package pandas, which is not installed") from None
        return pandas.DataFrame(self._table())

    def _picture_of(self, row: int) -> str:
        """A small picture of what is in a row of the table, as SVG; "" where there is none."""
        return ""

    def _title(self) -> str:
        """What stands above the table."""
        return repr(self)

    def _repr_html_(self) -> str:
        rows = self.to_dataframe()
        return f"<pre>{html.escape(self._title())}</pre>{_html(rows, self._picture_of) if len(rows) else ''}"


def _html(rows: "pandas.DataFrame", picture_of: Callable[[int], str]) -> str:
    """A table, of many rows the first and the last ones, with a column of pictures where there are any."""
    import pandas

    places = [*range(len(rows))] if len(rows) <= ROWS else [*range(ROWS // 2), *range(len(rows) - ROWS // 2, len(rows))]
    shown, pictures = rows.iloc[places].dropna(axis=1, how="all"), [picture_of(place) for place in places]
    if any(pictures):
        shown.insert(0, "orbit", pictures)
    with pandas.option_context("display.max_colwidth", None):
        return shown.to_html(border=0, na_rep="", escape=False, formatters=FORMATS, float_format="{:.10g}".format)


class FileResult(Result):
    """A branch, a curve or windows: `save` writes the file that a scene writes for it, `load` reads it again."""

    def to_xarray(self) -> "xarray.Dataset":
        """The Dataset that `vibro_sweep.open` gives of its file."""
        from vibro_sweep.driver.saved_results import dataset_of

        return dataset_of(self)

    def plot(self, **options: Any) -> "Figure | None":
        """`vibro_sweep.plot` of it, with the same options."""
        from vibro_sweep.plotting.plot import plot

        return plot(self, **options)

    def save(self, path: str | Path) -> Path:
        """Write its HDF5 file, for `vibro_sweep.load` and `vibro_sweep.open`.

        Raises ExistingFileError where there is a file, StoreError where none can be written, ValueError for what no
        file can hold: an orbit of a `Family`, and a curve of onsets of sticking.
        """
        from vibro_sweep.driver.saved_results import save

        return save(self, path)


def shows_force(kind: str | None) -> bool:
    """Whether the picture of an orbit that is asked for is that of forces. Raises ArgumentError for another word."""
    if kind is None or (isinstance(kind, str) and kind == "contact-force"):
        return kind is not None
    raise ArgumentError(not_allowed("kind", kind, '"contact-force", or None'))


def columns_of(records: np.ndarray) -> dict[str, np.ndarray]:
    """The fields of structured records by name; of several masses one by one, as x1, x2, ..."""
    result = {}
    for name in records.dtype.names or ():
        values = records[name]
        result |= {name: values} if values.ndim == 1 else {f"{name}{i}": one for i, one in enumerate(values.T, 1)}
    return result


def event_table(orbit: Any) -> dict[str, list]:
    """The table of an orbit: its contacts where stops are compliant, else its impacts."""
    events = orbit.contacts if len(orbit.contacts) else orbit.impacts
    return {name: values.tolist() for name, values in columns_of(events).items()}
