"""One machine in SI, in kg, mm and s, and in g, mm and ms: tables, `info` and pictures are the same in mm, Hz, N, s.

Machines are drawn at random, of those whose motions are periodic and attract: rounding is not amplified then.
"""

import functools
import re

import numpy as np
import pytest
from support.programs import ended

import vibro_sweep as vs

SYSTEMS = [
    ("SI", (1.0, 1.0, 1.0)),
    ({"mass": "kg", "length": "mm", "time": "s"}, (1.0, 1e-3, 1.0)),
    ({"mass": "g", "length": "mm", "time": "ms"}, (1e-3, 1e-3, 1e-3)),
]
POWERS = {  # of kg, m and s in the unit of a number
    **dict.fromkeys(("m", "M"), (1, 0, 0)),
    **dict.fromkeys(("k", "K", "k_stop"), (1, 0, -2)),
    **dict.fromkeys(("c", "C", "c_stop"), (1, 0, -1)),
    **dict.fromkeys(("force", "constant", "preload"), (1, 1, -2)),
    **dict.fromkeys(("b", "offset", "stop_left", "stop_right"), (0, 1, 0)),
    **dict.fromkeys(("omega", "frequency"), (0, 0, -1)),
}
SHOWN = "mm,Hz,N,kg,s,W"  # without W the power is in W or \N{MICRO SIGN}W: what is not named stays in the system's own
CLOSE = 1e-8
MACHINES, SEEN, DRAWN = range(10), (0, 6), (0,)  # windows and pictures, which take longest, of some
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")
ROUNDING = ("_error", "_residual", "approached_distance", "approached_factor")  # names of what says how large it is


def converted(numbers, sizes):
    """Numbers of a machine in SI, in units of these sizes."""
    units = {name: np.prod(np.power(sizes, powers, dtype=float)) for name, powers in POWERS.items()}
    return {
        name: (np.asarray(value) / units[name]).tolist() if name in POWERS else value for name, value in numbers.items()
    }


def drawn(rng):
    """Numbers of a machine in SI, without a frequency; its resonance in Hz."""
    hertz, zeta = rng.uniform(5, 60), rng.uniform(0.03, 0.15)
    m = rng.uniform(0.3, 4)
    k = m * (2 * np.pi * hertz) ** 2
    c = 2 * zeta * np.sqrt(k * m)
    clearance = rng.uniform(0.3e-3, 3e-3)
    force = k * clearance * rng.uniform(0.1, 0.6)
    kind = rng.choice(["one mass", "two masses", "linear"])
    if kind == "one mass":
        numbers = {"type": "chain", "m": [m], "k": [k, 0], "c": [c, 0], "force": [force]}
    elif kind == "two masses":
        other = rng.uniform(1, 4)
        numbers = {"type": "chain", "m": [m, other * m], "k": [0, k, other * k], "c": [0, c, other * c]}
        numbers["force"] = [force, 0]
    else:
        numbers = {"type": "linear", "M": [[m]], "K": [[k]], "C": [[c]], "force": [force], "contact_normal": [1]}
        numbers["constant"] = [force * rng.uniform(-0.3, 0.3)]
    if rng.random() < 0.5:
        numbers |= {"R": rng.uniform(0.3, 0.9)}
    else:
        numbers |= {"k_stop": k * rng.uniform(3, 30), "c_stop": c * rng.uniform(0.5, 5)}
    stops = rng.choice(["right", "both"])
    numbers |= {"stop_right": clearance} | (
        {"stop_left": -clearance * rng.uniform(0.7, 1.5)} if stops == "both" else {}
    )
    return numbers, hertz * rng.uniform(0.9, 1.1, size=1)[0]


def swept(numbers, hertz, units, sizes, path):
    numbers = converted(numbers | {"frequency": hertz[0]}, sizes)
    system = vs.Oscillator.named(numbers.pop("type"), **numbers, units=units)
    events = "contacts" if "k_stop" in numbers else "impacts"
    return vs.sweep(
        system, {"frequency": hertz * sizes[2]}, observe=["section", "lyapunov", events, "energy"], transient=400,
        record=20, output=path, mode="overwrite",
    )  # fmt: skip


def attracts(data) -> bool:
    """Whether all motions are periodic, some with events, and multipliers below 0.95."""
    periods = data.period.values
    if not ((data.status == 0).all() and (periods > 0).all()):
        return False
    multipliers = np.exp(data.lyapunov.values[:, 0] * periods / data.frequency.values)
    events = sum(data[name].values for name in data if re.match("(impacts|contacts)_", str(name)))
    return bool((multipliers < 0.95).all() and (events > 0).any())


@functools.cache
def machine(seed, folder):
    """The sweep of one machine in all systems of units; their files."""
    rng = np.random.default_rng([20, seed])
    paths = [folder / f"{seed}_{k}.h5" for k in range(len(SYSTEMS))]
    for _ in range(60):
        numbers, around = drawn(rng)
        hertz = around * np.linspace(0.95, 1.1, int(rng.integers(4, 7)))
        if attracts(swept(numbers, hertz, *SYSTEMS[0], paths[0])):
            for (units, sizes), path in zip(SYSTEMS[1:], paths[1:], strict=True):
                swept(numbers, hertz, units, sizes, path)
            return paths
    raise AssertionError("no machine is periodic")


def printed(*arguments) -> str:
    end = ended(*arguments)
    assert end.status == 0, end
    return end.out


def columns(text):
    """Names of the columns of a table, and what stands in each."""
    head, *rows = [line.split(",") for line in text.splitlines()]
    return {name: list(values) for name, values in zip(head, zip(*rows, strict=True), strict=True)}


def table_faults(one, other) -> list[str]:
    """Columns that are not the same; numbers but for rounding, in parts of the largest of the column."""
    one, other = columns(one), columns(other)
    if [*one] != [*other]:
        return [f"{[*one]} and {[*other]}"]
    found = []
    for name, values in one.items():
        if name.partition(" ")[0].endswith(ROUNDING):
            continue
        try:
            x, y = (np.array(column, float) for column in (values, other[name]))
        except ValueError:
            same = values == other[name]
        else:
            size = np.abs(x[np.isfinite(x)]).max(initial=0)
            same = len(x) == len(y) and np.allclose(x, y, rtol=0, atol=CLOSE * size, equal_nan=True)
        found += [] if same else [f"{name}: {values} and {other[name]}"]
    return found


def text_faults(one, other) -> list[str]:
    """Lines that are not the same, in words, or in numbers but for rounding; their spaces are as wide as numbers."""
    lines = [text.splitlines() for text in (one, other)]
    if len(lines[0]) != len(lines[1]):
        return [f"{one}\n{other}"]
    found = []
    for pair in zip(*lines, strict=True):
        words = [NUMBER.sub("#", line).split() for line in pair]
        x, y = (np.array(NUMBER.findall(line), float) for line in pair)
        same = words[0] == words[1] and np.allclose(x, y, rtol=CLOSE, atol=0)
        found += [] if same else [f"{pair[0]!r} and {pair[1]!r}"]
    return found


def words_of(text) -> str:
    """Without the names of files, the accuracy that rounding leaves, how it was made, and starts for a scene, which are
    in the system's own units."""
    text = text.partition("\nmade by")[0]
    lines = [line for line in text.splitlines()[1:] if not re.search(r"exact sum|were found within", line)]
    return "\n".join(line.partition("x1: ")[0] for line in lines)


def faults_of(compare, command, names, *options) -> list[str]:
    """Of what the command prints of files, held against that of the first."""
    first, *others = [printed(command, name, *options, "--units", SHOWN) for name in names]
    return [fault for other in others for fault in compare(first, other)]


def of_words(one, other):
    return text_faults(words_of(one), words_of(other))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("machines")


def cases(seeds):
    return [pytest.param(seed, marks=[] if seed in DRAWN else pytest.mark.slow) for seed in seeds]


@pytest.mark.parametrize("seed", cases(MACHINES))
def test_numbers_of_a_sweep(seed, folder):
    paths = machine(seed, folder)
    assert faults_of(table_faults, "table", paths) == []
    assert seed % 6 or faults_of(table_faults, "table", paths, "--variable", "x1") == []


@pytest.mark.parametrize("seed", cases(SEEN))
def test_exponents_windows_and_info(seed, folder):
    paths = machine(seed, folder)
    assert faults_of(table_faults, "table", paths, "--variable", "lyapunov") == []
    assert faults_of(of_words, "info", paths) == []
    results = [path.with_suffix(".windows") for path in paths]
    outputs = [
        printed("windows", path, "-o", result, "--overwrite", "--units", SHOWN)
        for path, result in zip(paths, results, strict=True)
    ]
    assert "Hz]: " in outputs[0] and "graze" in outputs[0]
    assert [of_words(outputs[0], other) for other in outputs[1:]] == [[], []]
    assert faults_of(table_faults, "table", results) == []


@pytest.mark.parametrize(
    "seed, kind", [(6, "bifurcation"), (0, "lyapunov"), (0, "impacts"), (6, "contacts"), (6, "energy")]
)
def test_labels_and_limits_of_axes(seed, kind, folder):
    paths = machine(seed, folder)
    figures = [vs.plot(path, kind, units=SHOWN.replace(",", ", ")) for path in paths]
    shown = [[(ax.get_xlabel(), ax.get_ylabel()) for ax in figure.axes] for figure in figures]
    ends = [np.array([[*ax.get_xlim(), *ax.get_ylim()] for ax in figure.axes]) for figure in figures]
    assert any("Hz" in label for label, _ in shown[0])
    for k in (1, 2):
        assert shown[k] == shown[0]
        assert np.allclose(ends[k], ends[0], rtol=CLOSE, atol=CLOSE * np.ptp(ends[0]))
        assert text_faults(figures[0].get_suptitle(), figures[k].get_suptitle()) == []


def test_other_numbers_and_words_are_seen():
    table = "frequency [Hz],x1 [mm],status\n1.0,2.5,ok\n"
    assert table_faults(table, table.replace("2.5", "2.50000000001")) == []
    for old, new in (("2.5", "2.5000001"), ("ok", "not_settled"), ("[mm]", "[m]"), ("2.5", "nan"), ("1.0", "1.001")):
        assert table_faults(table, table.replace(old, new)) != [], old
    assert text_faults("from 7.25 Hz  graze\n", "from 7.2500000001  Hz graze\n") == []
    assert text_faults("from 7.25 Hz\n", "from 7.251 Hz\n") != [] != text_faults("7 Hz\n", "7 mm\n")
