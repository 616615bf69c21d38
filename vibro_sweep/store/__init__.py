"""The HDF5 file: written by one process, block by block, and read by everybody; readers write nothing.

While a run goes on its blocks are appended to FILE.h5.part, which becomes the file at the end
(docs/development/stored_results.md).
"""

from importlib import import_module

_HOME = {
    "Complete": "writing",
    "StoreError": "opening",
    "Writer": "writing",
    "contents": "reading",
    "coordinates": "layout",
    "open": "reading",
    "quantities": "layout",
    "size": "layout",
    "ragged_run": "creating",
    "sweep_run": "creating",
    "writer": "beginning",
}

__all__ = [*_HOME]


def __getattr__(name: str):
    """Import what is asked for when it is asked for: drawing a file must not wait for the engine."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
