"""Edits of the file of a sweep in b that observes all, with which it is no longer one: each is refused."""

import numpy as np

from support.changes import set_text

EDITS = {
    **{
        f"no {name}": lambda file, name=name: file.attrs.pop(name)
        for name in ("title", "history", "scene", "quantities", "provenance", "sweep_dimensions", "heap")
    },
    "provenance no object": set_text("provenance", "[1, 2]"),
    "provenance no JSON": set_text("provenance", "{"),
    "title a number": lambda file: file.attrs.create("title", 3),
    **{f"no {name}": lambda file, name=name: file.pop(name) for name in ("x1", "lyapunov", "status", "b")},
    "x1 a group": lambda file: (file.pop("x1"), file.create_group("x1")),
    "x1 of another shape": lambda file: (file.pop("x1"), file.create_dataset("x1", data=np.zeros((3, 6)))),
    "x1 of texts": lambda file: (file.pop("x1"), file.create_dataset("x1", data=["a"] * 12)),
    "quantities of others": set_text("quantities", ["nothing", ".", "/", "b/c", ""]),
    "dimensions of others": set_text("sweep_dimensions", ["x1"]),
    "a later format": lambda file: file.attrs.modify("format", 3),
    "mu_m of several numbers": lambda file: file.attrs.create("mu_m", [1.0, 2.0, 3.0]),
    "omega a text": set_text("omega", "0.63"),
    "stops a number": lambda file: file.attrs.create("stops", 2.0),
    "a map without its order": set_text("dynamics", "map"),
    "a heap of nonsense": lambda file: file.attrs.modify("heap", np.array([5, 5, 5], np.uint64)),
}
