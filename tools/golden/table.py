"""What the record consists of, counted: the head of its log."""

from collections import Counter

from golden import records
from golden.motions import system_of

from tools.golden import table_of_simulations

KINDS = (  # of which the table tells
    "branches", "curves", "searches", "windows", "compliant_branches", "compliant_curves", "compliant_searches",
    "compliant_windows", "births", "onsets", *table_of_simulations.KINDS,
)  # fmt: skip
WITHOUT_POINTS = ("windows", "compliant_windows", "births", "onsets")


def table() -> str:
    made = [kind for kind in KINDS if (records.FOLDER / f"{kind}.jsonl.gz").exists()]
    head = "The golden record: PYTHONPATH=tests python -m tools.golden. Its origin and its gaps: notes.txt\n\n"
    return head + "\n".join(_of_kind(kind, list(records.read(kind).values())) for kind in made)


def _of_kind(kind: str, records: list[dict]) -> str:
    if kind in table_of_simulations.KINDS:
        return table_of_simulations.described(kind, records)
    results = [part for one in records for part in _parts(kind, one["result"])]
    orbits = [one.get("orbit", one) for one in results]
    linear = [system_of(one["system"]).linear for one in records]
    counted = {
        "model": Counter(one["system"]["type"] for one in records),
        "masses": Counter(system_of(one["system"]).masses for one in records),
        "stops": Counter(one["system"].get("stops", "both") for one in records),
        "R": Counter(_restitution(one["system"]) for one in records),
        "parameter": Counter(" ".join(one.get("names", [one.get("parameter")])) for one in records if kind != "births"),
    }
    if any(q.compliant for q in linear):
        counted["law"] = Counter(_law(one["system"]) for one in records)
        counted["release"] = Counter(one["system"]["release"] for one in records)
        counted["preload"] = Counter(_any(one["system"], "preload") for one in records)
        counted["stop damping"] = Counter(_any(one["system"], "c_stop") for one in records)
    if kind == "births":
        counted["born"] = Counter(one["born"] for one in results)
    if not kind.endswith("curves"):
        counted["period"] = Counter(_range(one["period"], (1, 2, 3, 4, 8)) for one in orbits)
        counted["impacts"] = Counter(_range(len(one["itinerary"]), (0, 1, 2, 3, 4, 8, 16)) for one in orbits)
        counted["symmetric"] = Counter("yes" if one["symmetric"] else "no" for one in orbits)
        counted["with rests"] = Counter("yes" if one.get("rests") else "no" for one in orbits)
    else:
        counted["type"] = Counter(one["type"] for one in results)
    specials = [special for one in results for special in one.get("special", one.get("ends", []))]
    counted["special points"] = Counter(one["type"] for one in specials)
    if kind not in WITHOUT_POINTS:
        counted["points"] = Counter({"all": sum(_points(one["points"]) for one in results)})
        errors = [e for one in results for e in one["points"].get("error", [])]
        if errors:
            counted["points"]["without an error"] = sum(e is None for e in errors)
    title = f"{kind}: {len(records)}" + (f", {len(results)} {_PARTS[kind]}" if kind in _PARTS else "")
    return "\n".join([title, *(f"  {name:15}{_line(one)}" for name, one in counted.items() if one), ""])


_PARTS = {
    "searches": "branches", "windows": "windows", "compliant_searches": "branches", "compliant_windows": "windows",
    "births": "orbits", "onsets": "onsets",
}  # fmt: skip


def _parts(kind: str, result) -> list[dict]:
    """Branches, curves, windows, orbits or onsets of a result."""
    if kind.endswith("windows"):
        return result["windows"]
    return [one for one in result if one] if isinstance(result, list) else [result]


def _points(points: dict) -> int:
    return len(next(iter(points.values())))


def _law(system: dict) -> str:
    """Of the stops; the left one has the numbers of the right one where it has none of its own."""
    rigid = [side for side in ("R", "R_left") if system.get(side) is not None]
    if rigid:
        return "one compliant, one rigid"
    return "compliant, unlike" if system.get("k_stop_left") is not None else "compliant"


def _any(system: dict, name: str) -> str:
    return "yes" if system.get(name) or system.get(f"{name}_left") else "no"


def _restitution(system: dict) -> str:
    values = {value for value in (system.get("R"), system.get("R_left")) if value is not None}
    if not values:
        return "no rigid stop"
    return "two of them" if len(values) > 1 else _range(values.pop(), (0, 0.3, 0.6, 0.9999, 1))


def _range(value: float, limits) -> str:
    """Up to which of the limits."""
    i = next((i for i, limit in enumerate(limits) if value <= limit), len(limits))
    if i == len(limits):
        return f"> {limits[-1]}"
    whole = i == 0 or (isinstance(value, int) and limits[i] == limits[i - 1] + 1) or value == limits[i] == 1
    return str(limits[i]) if whole else f"{limits[i - 1]} .. {limits[i]}"


def _line(counter: Counter) -> str:
    return ", ".join(f"{name} {count}" for name, count in sorted(counter.items(), key=lambda item: str(item[0])))
