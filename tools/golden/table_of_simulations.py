"""What the records of simulated motions, exponents and maps consist of, counted."""

from collections import Counter

import numpy as np
from golden import kept_numbers
from golden.motions import system_of

from tools.golden.between_processors import WIDER

KINDS = ("simulations", "exponents", "maps")


def described(kind: str, records: list[dict]) -> str:
    """A title, a line for each thing that is counted, and a line for each case with a wider allowance."""
    counted = {
        "group": Counter(record["group"] for record in records),
        "stops": Counter(_stops(record["system"]) for record in records),
        "law": Counter(_law(record["system"]) for record in records),
        "preload": Counter("yes" if _preloaded(record["system"]) else "no" for record in records),
        "R": Counter(_restitution(record["system"]) for record in records),
        "tau": Counter(_phase(record["system"]) for record in records),
        "rates apart": Counter(_rates_apart(record["system"]) for record in records),
        **_words(records),
        "rows": _rows(records),
        "numbers": Counter({"all": sum(map(kept_numbers.count, records))}),
    }
    lines = [f"  {name:15}{_line(counter)}" for name, counter in counted.items() if counter]
    lines += [f"  least allowance 1e-9: {name}: {why}" for name, why in WIDER.items() if name.startswith(kind)]
    return "\n".join([f"{kind}: {len(records)}", *lines, ""])


def _words(records) -> dict[str, Counter]:
    words = [record["result"]["words"] for record in records]
    names = {name: None for of_one in words for name in of_one}
    return {name: Counter(_word(of_one.get(name, "not kept")) for of_one in words) for name in names}


def _word(word) -> str:
    """A count is none or some."""
    return word if isinstance(word, str) else "some" if word else "none"


def _rows(records) -> Counter:
    counter = Counter()
    for record in records:
        for name, kept in record["result"]["tables"].items():
            counter[name] += len(kept["rows"])
    return counter


def _stops(system: dict) -> str:
    return system.get("stops", "both")


def _law(system: dict) -> str:
    if "k_stop" not in system:
        return "rigid"
    released = f"left by {system.get('release', 'displacement')}"
    if "R_left" in system:
        return f"{released}, rigid on the left"
    return f"{released}, another one on the left" if "k_stop_left" in system else released


def _preloaded(system: dict) -> bool:
    return any(system.get(name) for name in ("preload", "preload_left"))


def _restitution(system: dict) -> str:
    return "none" if "R" not in system else str(system["R"]) if system["R"] in (0.0, 1.0) else "0 .. 1"


def _phase(system: dict) -> str:
    return "a number" if "tau" in system and system["tau"] != "grazing" else "grazing"


def _rates_apart(system: dict) -> str:
    """The ratio of the fastest rate between the stops, or in a compliant one, to the slowest, in powers of ten."""
    q = system_of(system).linear
    n, rates = q.masses, []
    for k, c in ((0.0, 0.0), (q.contact.k_low, q.contact.c_low), (q.contact.k_high, q.contact.c_high)):
        held, damped = (np.nan_to_num(one) * np.outer(q.contact.normal, q.contact.normal) for one in (k, c))
        inverse = np.linalg.inv(q.M)
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ (q.K + held), -inverse @ (q.C + damped)]])
        rates += [rate for rate in np.abs(np.linalg.eigvals(A)) if rate > 0]
    power = int(np.log10(max(rates, default=1.0) / min(rates, default=1.0)))
    return f"1e{2 * (power // 2)} .. 1e{2 * (power // 2) + 2}"


def _line(counter: Counter) -> str:
    return "; ".join(f"{name}: {count}" for name, count in counter.items())
