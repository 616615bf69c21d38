"""What Python functions are given: a result, or a ValueError that names the argument and what is allowed."""

import json
import math

import numpy as np
import pytest
import xarray as xr

import vibro_sweep as vs
from vibro_sweep.model.parameters import ParameterError
from vibro_sweep.scene import parse_scene

SYSTEM = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
REST = (0.0, 0.0, 0.0, 0.0)
STATES = [
    (0, 0, 0, math.nan),
    (0, 0, 0, math.inf),
    ("0", "0", "0", "0"),
    "rest",
    None,
    (0, 0, 0),
    (0, (1, 2), 0, 0),
    (True, False, True, True),
    (0, 0, 0, 1j),
    (0, 0, 0, 10**400),
]


@pytest.mark.parametrize("state", STATES, ids=repr)
@pytest.mark.parametrize(
    "call",
    [
        lambda state: vs.simulate(SYSTEM, state, periods=1),
        lambda state: vs.lyapunov(SYSTEM, state, transient=0, record=1),
        lambda state: vs.discontinuity_map(SYSTEM)(state),
        lambda state: vs.discontinuity_map(SYSTEM).jacobian(state),
    ],
    ids=["simulate", "lyapunov", "map", "jacobian"],
)
def test_states(call, state):
    with pytest.raises(ValueError, match=r"state: .* is not allowed; it must be four finite numbers"):
        call(state)


@pytest.mark.parametrize("value", [-1, 0.5, math.nan, math.inf, "3", None, True, 1e300, 10**400, [1], 1j])
def test_counts(value):
    for call in (
        lambda: vs.simulate(SYSTEM, REST, periods=value),
        lambda: vs.lyapunov(SYSTEM, REST, transient=value, record=1),
        lambda: vs.lyapunov(SYSTEM, REST, transient=0, record=value),
    ):
        with pytest.raises(
            ValueError, match=r"(periods|transient|record): .* is not allowed; it must be a whole number"
        ):
            call()


def test_numbers_of_any_kind_are_numbers():
    for one in (1, 1.0, np.int8(1), np.float32(1), np.longdouble(1), np.array(1)):
        assert len(vs.simulate(SYSTEM, np.zeros(4, np.int8), periods=one, start_time=one).section) == 2


@pytest.mark.parametrize("value", [1e300, 1e17, -1e11, math.nan, math.inf, "0", None, True])
def test_start_times(value):
    with pytest.raises(ValueError, match=r"start_time: .* is not allowed; it must be a number of at most"):
        vs.simulate(SYSTEM, REST, periods=1, start_time=value)


def test_more_exponents_than_memory_is_to_be_taken_for():
    with pytest.raises(ValueError, match=r"record: 1000000000 is not allowed; .* <= 12500000"):
        vs.lyapunov(SYSTEM, REST, transient=0, record=10**9)


@pytest.mark.parametrize(
    "argument, value",
    [("order", True), ("order", 3), ("order", "1"), ("order", None)]
    + [("expand_at", value) for value in (math.nan, math.inf, 0, -1.0, "6.7", True, [6.7])],
)
def test_maps(argument, value):
    with pytest.raises(ValueError, match=f"{argument}: .* is not allowed; it must be"):
        vs.discontinuity_map(SYSTEM, **{argument: value})


@pytest.mark.parametrize("name", ["mu_m", "mu_k", "zeta", "omega", "b", "tau"])
@pytest.mark.parametrize("value", [np.longdouble("1e4000"), 10**400], ids=["longdouble", "integer"])
def test_numbers_beyond_the_floats(name, value):
    with pytest.raises(ParameterError) as caught:
        SYSTEM.replace(**{name: value})
    assert caught.value.key == name


@pytest.mark.parametrize("workers", [0, -1, 1.5, True, "2", 10**20, math.nan])
def test_workers(tmp_path, workers):
    text = (
        "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}\norbit: {transient: 0, record: 1}"
    )
    with pytest.raises(ValueError, match=r"workers: .* is not allowed; it must be a whole number from 1 to 1024"):
        vs.run(parse_scene(text), tmp_path / "out.h5", workers=workers)
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def orbit():
    return vs.periodic_orbit(SYSTEM.replace(b=3.0), itinerary="LR")


@pytest.mark.parametrize(
    "times", [None, "0", [None], [True], [[0.0]], [[0.0], [1.0, 2.0]], {}, 1j, math.nan, [math.inf], 1e300, -(10**400)]
)
def test_sampled_times(orbit, times):
    for one in (orbit, vs.simulate(SYSTEM, REST, periods=1)):
        with pytest.raises(ValueError, match=r"times: .* is not allowed; it must be"):
            one.sample(times)
        assert one.sample([]).shape == (0, 4) and one.sample(0).shape == (1, 4)


def test_branches(orbit):
    for bounds in (("1", "4"), (True, 4), (1,), 4, None, (1, math.nan), {1: 2, 4: 5}):
        with pytest.raises(ValueError, match=r"bounds: .* is not allowed; it must be \(lo, hi\)"):
            vs.continue_orbit(orbit, "b", bounds)
    for depth in (True, -1, 1.5, "1", None):
        with pytest.raises(ValueError, match=r"depth: .* is not allowed; it must be a whole number"):
            vs.follow_branches(orbit, "b", (1, 4), depth=depth)
    for follow in ("flip", 5, None, ["fold"], [5]):
        with pytest.raises(ValueError, match=r"follow: .* is not allowed; it must be a list of"):
            vs.follow_branches(orbit, "b", (1, 4), follow=follow)


@pytest.mark.parametrize("guess", [5, "abc", [(0, 1)], [("0", 1, 1)], [(0, True, 1)], [(0, 1, None)], [(0, 1, 1j)]])
def test_guesses(guess):
    with pytest.raises(ValueError, match=r"guess: .* is not allowed; it must be \(t, side, v\)"):
        vs.periodic_orbit(SYSTEM, guess=guess)


MASKED = np.ma.masked_greater([6.5, 6.6, 0, 0], 6.55)
IN_ITSELF: list = []
IN_ITSELF.append(IN_ITSELF)
PATH = r"is not allowed; it must be the path of a file"


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: SYSTEM.replace(stops=np.array(["both", "right"])), r"stops: array\(.* it must be both, right or left"),
        (lambda: vs.Oscillator.named([]), r"model: \[\] is not allowed; it must be one of two_mass"),
        (lambda: vs.Oscillator.named("two_mass", colour=1), r"colour: 1 is not allowed; it must be left out"),
        (
            lambda: vs.Oscillator([[1], [2, 3]], 1, contact_normal=1, omega=1, b=1, R=1),
            r"M: \[\[1\], \[2, 3\]\] is not allowed",
        ),
        (lambda: vs.Oscillator(IN_ITSELF, 1, contact_normal=1, omega=1, b=1, R=1), r"M: \[\[.* is not allowed"),
        (
            lambda: vs.Oscillator(1, 1, force=IN_ITSELF, contact_normal=1, omega=1, b=1, R=1),
            r"force\[0\]: \[\[.* is not allowed",
        ),
        (lambda: vs.discontinuity_map(SYSTEM, order=np.array([1, 2])), r"order: array.* it must be 1 or 2"),
        (lambda: vs.simulate(SYSTEM, MASKED, 1), r"state: masked_array.*of masked data the entries must be filled"),
        (lambda: vs.simulate(SYSTEM, bytearray(4), 1), r"state: bytearray.* it must be four finite numbers"),
        (lambda: vs.simulate(SYSTEM, REST, 10**10), r"periods: 10000000000 is not allowed; .* <= 100000000"),
        (lambda: vs.sweep(SYSTEM, {"b": MASKED}), r"sweep\.b = .*of masked data the entries must be filled"),
        (lambda: vs.sweep(SYSTEM, {"b": IN_ITSELF}), r"sweep\.b\.values\[0\] = \[\[.*: must be a number"),
        (lambda: vs.sweep(SYSTEM, {"b": [6.6]}, observe="x" * 5000), r'observe = "x{56}\.\.\.: must be a list'),
        (
            lambda: vs.sweep(SYSTEM, {"b": [6.6]}, progress=True),
            r"progress: True .* callable as progress\(done, total\)",
        ),
        (lambda: vs.sweep(SYSTEM, {"b": [6.6]}, progress=len), r"progress: <built-in.* callable as progress"),
        (
            lambda: vs.sweep(SYSTEM, {"b": [6.6]}, mode=["new"]),
            r"mode: \['new'\] is not allowed; it must be one of 'new'",
        ),
        (lambda: vs.sweep(SYSTEM, {"b": [6.6]}, output="nodir/x.h5"), r"nodir/x\.h5: there is no folder nodir$"),
        (lambda: vs.sweep(lambda c: SYSTEM, {"b": [6.6]}), r"system: <function .* or a function of b"),
        (lambda: vs.sweep(lambda **_: SYSTEM, {"status": [6.6]}), r"axes: 'status' is not allowed"),
        (lambda: vs.plot("x.h5", at=["b"]), r"at: \['b'\] is not allowed; it must be a mapping"),
        (lambda: vs.plot("x.h5", kind=np.array(["plane", "energy"])), r"kind: array.* is not allowed"),
        (
            lambda: vs.windows("x.h5", parameter=["b", "R"]),
            r"parameter: \['b', 'R'\] is not allowed; it must be the name of",
        ),
        (lambda: vs.load_scene(None), f"path: None {PATH}"),
        (lambda: vs.load_scene(3), f"path: 3 {PATH}"),
        (lambda: vs.load_scene(b"x"), f"path: b'x' {PATH}"),
        (lambda: vs.load_scene("."), r"\.: cannot be read: Is a directory"),
        (lambda: vs.load_scene(""), f"path: '' {PATH}, and not empty"),
        (lambda: vs.open("a\0b"), f"path: 'a.x00b' {PATH}, without a NUL"),
        (lambda: vs.load("\ud800"), f"path: '.ud800' {PATH}, of whole characters"),
        (lambda: vs.plot("x" * 5000), rf"data: 'x{{56}}\.\.\. {PATH}, and shorter"),
        (lambda: vs.sweep(SYSTEM, {"b": [6.6]}, output="x" * 252), f"output: 'x.* {PATH}, and shorter"),
    ],
)
def test_one_message_that_names_argument_value_and_what_is_allowed(call, message):
    with pytest.raises((TypeError, ValueError), match=message) as caught:
        call()
    assert len(str(caught.value)) < 400


def test_values_of_xarray_and_what_is_not_masked():
    wanted = vs.sweep(SYSTEM, {"b": [6.5, 6.6]}, transient=0, record=3)
    for axis in (xr.DataArray([6.5, 6.6], dims="b"), {"values": xr.DataArray([6.5, 6.6])}, np.ma.array([6.5, 6.6])):
        assert vs.sweep(SYSTEM, {"b": axis}, transient=0, record=3).equals(wanted)
    assert SYSTEM.replace(b=wanted.b[1]) == SYSTEM
    assert np.array_equal(
        vs.simulate(SYSTEM, xr.DataArray(np.zeros(4)), 2).section, vs.simulate(SYSTEM, REST, 2).section
    )


DEEP = "[" * 100_000


@pytest.mark.parametrize(
    "text", [DEEP, '{"format": "vibro_sweep periodic orbit 1", "system": ' + DEEP, "1" * 10_000, "\ud800", ""]
)
def test_texts_that_are_no_orbits(tmp_path, text):
    (tmp_path / "x.json").write_bytes(text.encode(errors="surrogatepass"))
    with pytest.raises(ValueError, match="not a file of the format"):
        vs.load(tmp_path / "x.json")


@pytest.mark.parametrize(
    "key, value",
    [
        *(("halves", value) for value in (10**400, math.inf)),
        *(("sides", value) for value in ([math.inf], 3)),
        *(("unknowns", value) for value in ([10**400], [[1]], "x")),
        *(("system", value) for value in ([], {"type": []}, {"b": 10**400}, {"x" * 1000: 1})),
        ("rests", [1e300]),
        ("sigma", "1"),
        ("residual", 10**400),
    ],
)
def test_edited_orbits(orbit, tmp_path, key, value):
    record = json.loads(orbit.save(tmp_path / "x.json").read_text())
    (tmp_path / "y.json").write_text(json.dumps(record | {key: value}))
    with pytest.raises(ValueError, match=r"y\.json: damaged: "):
        vs.load(tmp_path / "y.json")


def test_places_where_no_orbit_can_be_read_or_saved(orbit, tmp_path):
    orbit.save(tmp_path / "x.json")
    with pytest.raises(FileExistsError, match=r"x\.json: there is a file already"):
        orbit.save(tmp_path / "x.json")
    with pytest.raises(ValueError, match=r"cannot be written: there is no folder .*nodir$"):
        orbit.save(tmp_path / "nodir" / "x.json")
    with pytest.raises(FileNotFoundError, match=r"y\.json: there is no such file"):
        vs.load(tmp_path / "y.json")
    with pytest.raises(OSError, match="cannot be read: Is a directory"):
        vs.load(tmp_path)
