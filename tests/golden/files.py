"""Files of all kinds as records: what is in them and what is shown of them, never their bytes.

The texts are those of any run: the date is DATE, the folder is FOLDER, of what made the file (version, machine,
seconds) the names are kept and not the values. How many points a branch has, and how many of a run that is broken off
are done, is no part of the record.
"""

import re
import tempfile
from contextlib import chdir
from functools import cache
from pathlib import Path

import h5py
import numpy as np
from support.programs import ended

import vibro_sweep as vs
from golden import records
from golden.shown import different
from vibro_sweep.types import Branch

OF_THE_RUN = ("history", "provenance", "heap", "identity", "source", "sweep")  # the last two: identities of other files
OF_THE_FORMAT = ("format", "quantities")
OF_HDF5 = ("DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME")
PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
BALL = vs.Oscillator.named(
    "one_mass", k=0, zeta=0, constant=-1, base=True, F=1.5, omega=1, R=0.5, b=0, stops="left", tau=0
)
MADE_BY = re.compile(r"(?<=\nmade by\n)(  \w+ .*\n)+")
REPLACED = (
    (r"\d{4}-\d\d-\d\dT[\d:.+]+", "DATE"),
    (r"begun by vibro_sweep .*", "begun by vibro_sweep VERSION"),
    (r"\b\d+ (of \d+ )?points", "N points"),
    (r"\b\d+ of them a motion", "N of them a motion"),
    (r"(largest modulus of multipliers )\S+( \.\. \S+)?(?=(\n.*)* graze )", r"\1N"),  # no bound there: rounding ends it
)


class BrokenOff(Exception):  # noqa: N818
    pass


def symmetric_branch():
    return vs.continue_orbit(vs.periodic_orbit(PAPER, itinerary="LR"), "b", (2, 6.5))


def pitchfork_curve():
    point = next(special for special in symmetric_branch().special if special.type == "pitchfork")
    return vs.bifurcation_curve(point, ("b", "omega"), ((2, 6.5), (0.62, 0.64)))


SAVED = {  # what `.save` writes
    "one branch": symmetric_branch,
    "one curve": pitchfork_curve,
    "other periodic orbit": lambda: vs.periodic_orbit(BALL, itinerary="L", which=1),
    "periodic orbit": lambda: vs.periodic_orbit(PAPER.replace(b=1), itinerary="LLRR"),
}


@cache
def _folder() -> tempfile.TemporaryDirectory:
    return tempfile.TemporaryDirectory()


def file_of(record: dict) -> Path:
    """The file of a case, made now, beside those that it is made from."""
    path = Path(_folder().name) / record["file"]
    if not path.exists():
        if record["source"]:
            file_of(records.read("files")[record["source"]])
        with chdir(path.parent):  # scenes name files of the current folder
            MAKE[record["made"]](record, path)
    return path


def _run(record: dict, path: Path) -> None:
    vs.run(_scene(record, path), path, workers=1)


def _broken_off(record: dict, path: Path) -> None:
    def progress(done, _):
        if done:
            raise BrokenOff

    try:
        vs.run(_scene(record, path), path, workers=1, progress=progress)
    except BrokenOff:
        pass


def _windows(record: dict, path: Path) -> None:
    status, _, errors = ended("windows", path.with_name("sweep.h5"), "-o", path, "--workers", "1", "--quiet")
    if status:
        raise ValueError(errors)


def _scene(record: dict, path: Path):
    scene = path.with_name(f"{path.name.partition('.')[0]}.yaml")
    scene.write_text(record["scene"])
    return vs.load_scene(scene)


MAKE = {
    "run": _run,
    "broken off": _broken_off,
    "windows": _windows,
    "saved": lambda record, path: SAVED[record["name"]]().save(path),
}


def result_of(path: Path) -> dict:
    """What is kept of a file."""
    status, out, errors = ended("info", path)
    result = {"status": status, "info": text_of(out + errors)}
    if path.suffix == ".json":
        return result | {"loaded": [_loaded(vs.load(path))]}
    if h5py.is_hdf5(path):  # which a file that is not finished need not be
        with h5py.File(path) as file:
            result["layout"] = {name: _layout(file[name]) for name in file if isinstance(file[name], h5py.Dataset)}
            result["attrs"] = _attributes(file)
    status, out, errors = ended("table", path)
    result["table"] = out.partition("\n")[0] or errors
    with vs.open(path) as data:
        result["opened"] = {
            name: {"dims": list(variable.dims), "dtype": str(variable.dtype), "coordinate": name in data.coords}
            for name, variable in data.variables.items()
        }
        result["attributes"] = {key: _plain(value) for key, value in data.attrs.items() if key not in OF_THE_RUN}
        result["yaml"] = _written_again(data.attrs["scene"], path)
        if data.attrs["kind"] != "sweep":
            loaded = vs.load(path)
            results = [loaded] if hasattr(loaded, "to_dataframe") else loaded
            result["loaded"] = [_loaded(single) for single in results]
    return result


def text_of(text: str) -> str:
    """Without what is another in each run."""
    for pattern, word in REPLACED:
        text = re.sub(pattern, word, text)
    text = MADE_BY.sub(lambda part: re.sub(r"(\w+) .*", r"\1 VALUE", part[0]), text)
    return text.replace(_folder().name, "FOLDER")


def counts_left_out(text: str) -> str:
    """Of `info` of a run that is broken off: how much of it was done."""
    head, word, rest = text.partition("\ncomputed")
    return head + word + re.sub(r"\b\d[\d.]*(e[-+]\d+)?\b", "N", rest)


def differences_from(record: dict) -> list[str]:
    """Between a record and the file that is made now."""
    now = kept(record)
    if record["made"] == "broken off":  # which was no HDF5 file in format 2
        now = {name: value for name, value in now.items() if name not in ("layout", "attrs")}
    return different(comparable(record["result"]), comparable(now))


def comparable(what):
    """Without what format 3 has otherwise: the order of variables and attributes, how texts are stored."""
    if isinstance(what, list):
        return [comparable(one) for one in what]
    if not isinstance(what, dict):
        return what
    found = {name: comparable(what[name]) for name in sorted(what) if name not in OF_THE_FORMAT}
    return found | ({"dtype": "text"} if str(what.get("dtype"))[:2] in ("ob", "<U", "|S") else {})


def kept(record: dict) -> dict:
    """What is kept of the file of a case, made now."""
    result = result_of(file_of(record))
    if record["made"] == "broken off":
        result["info"] = counts_left_out(result["info"])
    return result


def _layout(dataset) -> dict:
    dims = [scales[0].name.strip("/") if len(scales) else "" for scales in dataset.dims]
    return {"dims": dims, "dtype": str(dataset.dtype), "attrs": _attributes(dataset)}


def _attributes(part) -> dict:
    names = sorted(set(part.attrs) - {*OF_THE_RUN, *OF_HDF5})
    return {name: _plain(part.attrs[name]) for name in names}


def _written_again(scene: str, path: Path) -> str:
    """The scene of a file as `to_yaml` writes it."""
    again = path.with_name("again.yaml")
    again.write_text(scene)
    return vs.load_scene(again).to_yaml()


def _loaded(result) -> dict:
    """What Python shows of a result: its class, its text, its table."""
    table = result.to_dataframe()
    rows = [[_plain(value) for value in row] for row in table.itertuples(index=False)]
    text = text_of(repr(result))
    points = {"points": _points(result.points)} if isinstance(result, Branch) else {}
    return {"class": type(result).__name__, "repr": text, "columns": list(table.columns), "rows": rows} | points


def _points(data) -> dict:
    """The variables of the points of a branch, and of its parameter the values at both ends."""
    ((parameter, values),) = data.coords.items()
    return {"variables": {name: list(x.dims) for name, x in data.variables.items()}} | {
        str(parameter): values.values[[0, -1]].tolist()
    }


def _plain(value):
    """As JSON has it."""
    if isinstance(value, h5py.Empty):
        return None
    if isinstance(value, (np.ndarray, np.generic)):
        return _plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [_plain(inner) for inner in value]
    if isinstance(value, bytes):
        return value.decode()
    return None if value != value else value  # tables have NaN and None in the same place
