"""Random scenes, valid and broken: each is made by its number alone."""

import copy
import json
import random
import string

SEED = "vibro_sweep"
SYSTEM = ("mu_m", "mu_k", "zeta", "f2", "omega", "R", "b")
OBSERVATIONS = ("section", "lyapunov", "impacts", "attractors", "convergence")
ODD = [
    float("nan"), float("inf"), -float("inf"), 0, -0.0, -1, 1e-320, 1e-200, 1e200, 1.7e308, 1e19, -1e19, 10**400, 2**63,
    0.5, 1e12, 1e9, True, None, "", "text", "1e-9", "grazing", "both", [], [1], [[1]], {}, {"a": 1}, [float("nan")],
    {"start": 1, "stop": 2, "step": 1e-12}, {"start": 1, "stop": 2, "num": 1e7}, {"values": [2, 1, 3]}, {"values": []},
]  # fmt: skip
SNIPPETS = [
    "&a", "*a", "!!int", "? ", ": ", "- ", "{", "}", "[", "]", "'", '"', "\t", "\n", "#", "|", ">", "%YAML 1.2\n",
    "---\n", "...\n", '"\\UFFFFFFFF"', '"\\uD800"', '"\\x"', "\x00", "\u2028", "\ufeff",
    "\U0001f600", "<<: *a\n", "@", "`", "0x", "0o9", "1_0",
]  # fmt: skip


def scene(n: int) -> dict:
    """A scene that can be computed in some milliseconds, of every kind that there is."""
    choose = random.Random(f"{SEED} {n}")
    numbers = {
        "mu_m": _size(choose, 0.05, 50),
        "mu_k": _size(choose, 0.05, 50),
        "zeta": choose.choice([0, 0, _size(choose, 1e-3, 2), _size(choose, 0.01, 0.3)]),
        "f2": choose.choice([0, 1, round(choose.random(), 3)]),
        "omega": _size(choose, 0.2, 4),
        "R": choose.choice([0, 1, 0.8, round(choose.uniform(0.05, 1), 3)]),
        "b": _size(choose, 0.01, 20),
    }
    is_map = choose.random() < 0.15
    follow = choose.random() < 0.2
    swept = choose.sample([*SYSTEM, "tau"][: 7 if is_map else 8], choose.choice([1, 1, 2] if follow else [0, 1, 1, 2]))
    initial = not follow and choose.random() < 0.15
    if initial:
        swept = choose.sample(["x1", "v1", "x2", "v2"], choose.choice([1, 2]))
    system = {name: value for name, value in numbers.items() if name not in swept or choose.random() < 0.3}
    system["stops"] = choose.choice(["both", "both", "right", "left"])
    if (not is_map and numbers["zeta"] == 0) or choose.random() < 0.3:
        system["tau"] = round(choose.uniform(-4, 4), 3)
    result = {
        "system": system,
        "orbit": {"transient": choose.choice([0, 3, 50]), "record": choose.choice([1, 2, 7, 40])},
    }
    if is_map:
        result["dynamics"] = "map"
        result["system"].pop("tau", None)
        numbers["zeta"] = result["system"]["zeta"] = numbers["zeta"] or 0.05  # an undamped steady motion may not exist
        if choose.random() < 0.5:
            result["order"] = choose.choice([1, 2])
        if choose.random() < 0.3:
            result["expand_at"] = _size(choose, 0.1, 10)
        swept = [name for name in swept if name != "zeta"]
    if follow and not swept:
        swept = ["b"]
    if swept:
        result["sweep"] = {name: _axis(choose, name, numbers) for name in swept}
    result["observe"] = choose.sample(OBSERVATIONS, choose.choice([1, 1, 2, 3, 5]))
    if follow:
        result["start"] = {"follow": choose.choice(["up", "down", "both"])}
    elif not initial and choose.random() < 0.4:
        result["start"] = {"random": choose.choice([1, 2, 9]), "seed": choose.choice([0, 5, 2**63 - 1])}
    elif choose.random() < 0.4:
        free = [name for name in ("v1", "x2", "v2") if name not in swept]
        result["start"] = {name: round(choose.gauss(0, 1), 3) for name in free}
    if not is_map:
        if "section" in result["observe"] and choose.random() < 0.3:
            stop = system["stops"] if system["stops"] != "both" else choose.choice(["right", "left"])
            result["section"] = {"kind": "impact", "stop": stop}
        if choose.random() < 0.3:
            result["trajectory"] = {"periods": choose.choice([1, 3]), "samples": choose.choice([2, 5, 50])}
    return result


def _size(choose: random.Random, low: float, high: float) -> float:
    return float(f"{low * (high / low) ** choose.random():.4g}")


def _axis(choose: random.Random, name: str, numbers: dict) -> dict:
    if name in ("x1", "v1", "x2", "v2", "tau"):
        low, high = (-0.9 * numbers["b"], 0.9 * numbers["b"]) if name == "x1" else (-2.0, 2.0)
    elif name in ("R", "f2"):
        low, high = 0.1, 0.9
    else:
        low = numbers[name] or 0.01
        high = low * choose.choice([1.01, 1.5, 3])
    count = choose.choice([2, 3, 5])
    ends = (low, high) if choose.random() < 0.7 else (high, low)
    form = choose.choice(["step", "num", "values", "one"])
    if form == "num":
        return {"start": ends[0], "stop": ends[1], "num": count}
    if form == "step":
        return {"start": ends[0], "stop": ends[1], "step": (ends[1] - ends[0]) / (count - 1) * 0.99}
    if form == "one":
        return {"values": [low]}
    return {"values": sorted((low + (high - low) * choose.random() for _ in range(count)), reverse=ends[0] > ends[1])}


def broken(n: int) -> bytes:
    """The text of a scene with something wrong with it, or nothing, or everything."""
    choose, data = random.Random(f"{SEED} broken {n}"), scene(n)
    for _ in range(choose.choice([0, 0, 1, 1, 1, 5])):
        _break_value(choose, data)
    text = to_yaml(data, choose)
    for _ in range(choose.choice([0, 0, 0, 0, 1, 5])):
        text = _break_text(choose, text)
    result = text.encode(errors="surrogatepass")
    if choose.random() < 0.03:
        at = choose.randrange(len(result) + 1)
        result = result[:at] + choose.randbytes(choose.choice([1, 50])) + result[at:]
    return result


def _places(node, found: list) -> list:
    """Every (container, key) of a scene."""
    for key in list(node) if isinstance(node, dict) else range(len(node)):
        found.append((node, key))
        if isinstance(node[key], (dict, list)):
            _places(node[key], found)
    return found


def _break_value(choose: random.Random, data: dict) -> None:
    places = _places(data, [])
    if not places:
        return
    node, key = choose.choice(places)
    how = choose.random()
    if how < 0.6:
        node[key] = _odd(choose)
    elif how < 0.75:
        del node[key]
    elif isinstance(node, dict):
        words = [
            *SYSTEM,
            "tau",
            "x1",
            "order",
            "dynamics",
            "sweep",
            "start",
            "section",
            "trajectory",
            "physical",
            "colour",
            "values",
        ]
        other, value = choose.choice(places)
        node[choose.choice(words)] = choose.choice([_odd(choose), copy.deepcopy(other[value])])
    else:
        node.append(_odd(choose))


def _odd(choose: random.Random):
    return copy.deepcopy(choose.choice(ODD))


def _break_text(choose: random.Random, text: str) -> str:
    at = choose.randrange(len(text) + 1)
    how = choose.random()
    if how < 0.5:
        return text[:at] + choose.choice([*SNIPPETS, choose.choice(string.printable)]) + text[at:]
    if how < 0.8:
        return text[:at] + text[at + choose.choice([1, 1, 3, 20]) :]
    return text[:at] if how < 0.9 else text[at:]


def to_yaml(value, choose: random.Random | None = None, depth: int = 0) -> str:
    """The text of a value, in blocks at the top and within brackets below."""
    if isinstance(value, dict) and depth == 0:
        return "".join(f"{key}: {to_yaml(item, choose, 1)}\n" for key, item in value.items()) or "{}\n"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {to_yaml(item, choose, 2)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(to_yaml(item, choose, 2) for item in value) + "]"
    if isinstance(value, float):
        words = {"nan": ".nan", "inf": ".inf", "-inf": "-.inf"}
        return words.get(str(value), repr(value))
    return json.dumps(value)
