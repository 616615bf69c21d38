"""`vibro_sweep.open`: any file of this program as a Dataset."""

from pathlib import Path
from typing import TYPE_CHECKING

from vibro_sweep.checks.arguments import names_its_arguments
from vibro_sweep.checks.file_names import FileError, checked_path, read_bytes
from vibro_sweep.files.reading import open_whole

if TYPE_CHECKING:
    import xarray


@names_its_arguments
def open(path: str | Path) -> "xarray.Dataset":  # the name that users of xarray expect
    """A file of this program as an `xarray.Dataset` with coordinates; numbers of an HDF5 file are read when used.

    `.attrs["kind"]` says what it holds: sweep, branches, windows, curves or periodic_orbit.
    A file is read through once, for its checksums. Raises StoreError for a file that is none of ours, and for a damaged
    one: it names the datasets. Of a missing file the StoreError is a FileNotFoundError too. A file that xarray or
    another program wrote from one of this program is opened too, with a warning in the log: it has no checksums.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> data = vs.sweep(system, {"b": [3.0, 4.0]}, transient=200, record=10, output="two.h5")
    >>> data.close()
    >>> with vs.open("two.h5") as data:
    ...     print(data.attrs["kind"], data.period.values)
    sweep [1 1]
    """
    place = checked_path("path", path)
    if first_bytes(place).lstrip()[:1] == b"{":  # the JSON of an orbit
        from vibro_sweep.analysis.periodic.orbit_file import load_orbit

        data = load_orbit(place).to_xarray()
        data.encoding["source"] = str(path)
        return data
    return open_whole(place)


def first_bytes(path: Path) -> bytes:
    """With which a file begins; none where it cannot be read."""
    try:
        return read_bytes(path, 16)
    except FileError:
        return b""
