"""Inventories of the objects of other packages that docstrings name, so that links need no network at the build."""

import zlib
from pathlib import Path

OBJECTS = {  # base address: {name: (type, page)}
    "https://docs.python.org/3/": {
        "collections.abc.Callable": ("class", "library/collections.abc.html"),
        "collections.abc.Iterable": ("class", "library/collections.abc.html"),
        "collections.abc.Mapping": ("class", "library/collections.abc.html"),
        "collections.abc.Sequence": ("class", "library/collections.abc.html"),
        "concurrent.futures.Executor": ("class", "library/concurrent.futures.html"),
        "pathlib.Path": ("class", "library/pathlib.html"),
        "typing.Any": ("data", "library/typing.html"),
        "typing.Literal": ("data", "library/typing.html"),
        "typing.NamedTuple": ("class", "library/typing.html"),
        "typing.Protocol": ("class", "library/typing.html"),
        **{
            name: ("class", page)
            for page, names in {
                "library/functions.html": ("bool", "float", "int", "object"),
                "library/stdtypes.html": ("dict", "list", "str", "tuple"),
            }.items()
            for name in names
        },
        **{
            name: ("exception", "library/exceptions.html")
            for name in (
                "Exception",
                "FileNotFoundError",
                "ImportError",
                "KeyboardInterrupt",
                "OSError",
                "RuntimeError",
            )
        },
        "TypeError": ("exception", "library/exceptions.html"),
        "ValueError": ("exception", "library/exceptions.html"),
    },
    "https://numpy.org/doc/stable/": {
        "numpy.ndarray": ("class", "reference/generated/numpy.ndarray.html"),
        "numpy.typing.ArrayLike": ("data", "reference/typing.html"),
    },
    "https://docs.xarray.dev/en/stable/": {"xarray.Dataset": ("class", "generated/xarray.Dataset.html")},
    "https://matplotlib.org/stable/": {
        "matplotlib.axes.Axes": ("class", "api/_as_gen/matplotlib.axes.Axes.html"),
        "matplotlib.figure.Figure": ("class", "api/_as_gen/matplotlib.figure.Figure.html"),
    },
    "https://pandas.pydata.org/docs/": {"pandas.DataFrame": ("class", "reference/api/pandas.DataFrame.html")},
}


def mapping(folder: Path) -> dict[str, tuple[str, str]]:
    """Write the inventories into a folder; what `intersphinx_mapping` is then."""
    found = {}
    for base, objects in OBJECTS.items():
        name = base.split("/")[2].split(".")[-2]
        rows = "".join(f"{one} py:{kind} 1 {page}#$ -\n" for one, (kind, page) in objects.items())
        head = f"# Sphinx inventory version 2\n# Project: {name}\n# Version: \n# The rest is compressed using zlib.\n"
        (folder / f"{name}.inv").write_bytes(head.encode() + zlib.compress(rows.encode()))
        found[name] = (base, str(folder / f"{name}.inv"))
    return found
