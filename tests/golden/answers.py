"""Answers of the live page as records: views, diagrams, clicked orbits, ends of windows, saved scenes.

A case is a page and the requests that it is asked, of which the last is answered in the record. A diagram comes in
pieces of any size: its numbers are put together. How many points a branch has is no part of the record.
"""

import io
from contextlib import contextmanager, redirect_stdout

import numpy as np
from support.explorers import answers

import vibro_sweep as vs
from golden.drawn import array
from golden.files import PAPER, comparable
from golden.shown import different

PAGES = {
    "paper": lambda: vs.explore(PAPER, "b", (4.2, 7)),
    "one mass": lambda: vs.explore(_one_mass(R=0.8, b=1.0), "omega", (0.4, 1.2)),
    "compliant": lambda: vs.explore(_one_mass(k_stop=29.0, b=1.0), "b", (0.4, 1.6)),
}
OF_EACH_START = ("y", "lyapunov", "lyapunov_error", "period", "status")
OF_THE_TRANSFER = ("type", "seq", "arrays", "ms")


def _one_mass(**numbers):
    return vs.Oscillator.named("one_mass", zeta=0.02, F=1.0, omega=0.5, stops="right", **numbers)


@contextmanager
def opened(name: str):
    """A socket to a page that is served in this process."""
    from websockets.sync.client import connect

    with redirect_stdout(io.StringIO()):
        page = PAGES[name]()
    host, token = page.url.removeprefix("http://").split("/?token=")
    try:
        with connect(f"ws://{host}/socket?token={token}", origin=f"http://{host}", max_size=None) as socket:
            yield socket
    finally:
        page.close()


def result_of(case: dict, numbers: dict | None = None) -> dict:
    """The last answer. numbers : of the system, in place of those of the page"""
    with opened(case["page"]) as socket:
        view = answers(socket, "open", 1)[0]["view"]
        for seq, request in enumerate(case["requests"], 2):
            words = dict(request)
            kind, changes = words.pop("type"), words.pop("view", None)
            if changes is not None:
                words["view"] = view | changes | ({"numbers": numbers | changes.get("numbers", {})} if numbers else {})
            answer = answers(socket, kind, seq, **words)
    return _diagram(answer) if isinstance(answer, list) else _answer(*answer)


def _diagram(frames) -> dict:
    """Of each column and start what is shown; of the frames the words that they share."""
    pieces = [frame for frame in frames if frame[0]["kind"] == "piece"]
    words, result = _words(pieces[0][0]), {}
    shape = words["columns"], words["starts"]
    for about, arrays in pieces:
        parts = arrays | {"y": np.split(arrays["y"], np.cumsum(arrays["count"])[:-1])}
        here = len(arrays["count"]) // about["length"]
        for name in OF_EACH_START:
            of_this = result.setdefault(name, np.full(shape, None, object))
            for n in range(len(arrays["count"])):
                column, start = about["first"] + n // here * about["step"], about["first_start"] + n % here
                per = len(parts[name]) // len(arrays["count"])
                values = parts[name][n] if name == "y" else parts[name][n * per : (n + 1) * per]
                of_this[column, start] = [_shown(value) for value in values]
    of_pieces = ("kind", "first", "step", "length", "first_start", "last", "exact")
    return {
        "words": {key: value for key, value in words.items() if key not in of_pieces},
        "axis": array(frames[0][1]["axis"]),
        "kinds": sorted({frame[0]["kind"] for frame in frames}),
        "columns": {name: values.tolist() for name, values in result.items()},
    }


def _answer(words: dict, arrays: dict) -> dict:
    kept = _words(words)
    if words["type"] == "window" and "branches" in kept:
        kept["branches"] = [lines for _, lines in kept["branches"]]
        arrays = {name: [arrays[name].min(), arrays[name].max()] for name in ("value", "y")}
    return {"type": words["type"], "words": kept, "arrays": {name: array(values) for name, values in arrays.items()}}


def _words(words: dict) -> dict:
    return {key: value for key, value in words.items() if key not in OF_THE_TRANSFER}


def _shown(value) -> float | None:
    return float(f"{value:.8g}") if np.isfinite(value) else None


def differences_from(record: dict) -> list[str]:
    """Between a record and what the page answers now."""
    return different(comparable(record["result"]), comparable(result_of(record)))
