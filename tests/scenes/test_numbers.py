"""A file says with which numbers it was computed: nobody has to read the scene again."""

import h5py
import numpy as np
import pytest
import xarray
from support import sample, slow_cases
from support.oscillators import PAPER_NUMBERS
from support.scene_texts import parsed

import vibro_sweep as vs

PAPER = f"{PAPER_NUMBERS}, b: 6.6"
ORBIT = "orbit: {transient: 3, record: 4}\nobserve: [impacts]"
SWEEPS = {
    "one orbit": "",
    "b": "sweep: {b: {values: [6.5, 6.6, 6.7]}}",
    "omega": "sweep: {omega: {values: [0.6, 0.63, 0.65]}}",
    "tau": "sweep: {tau: {values: [0, 1, 2]}}",
    "R, zeta": "sweep: {R: {values: [0.7, 0.8]}, zeta: {values: [0.05, 0.1, 0.2]}}",
    "omega, b": "sweep: {omega: {values: [0.65, 0.6]}, b: {values: [6.5, 6.6, 6.7]}}",
    "omega, mu_m": "sweep: {omega: {values: [0.6, 0.63, 0.65]}, mu_m: {values: [1, 10]}}\nstart: {random: 2}",
    "x1, f2": "sweep: {x1: {values: [0, 1]}, f2: {values: [0, 0.5, 1]}}\nstart: {v1: 0.5}",
    "follow": "sweep: {mu_k: {values: [5, 4]}}\nstart: {follow: both}",
}


def run(folder, text, system=PAPER, orbit=ORBIT):
    path = folder / "out.h5"
    scene = parsed(f"system: {{{system}}}\n{text}\n{orbit}")
    vs.run(scene, path)
    return scene, path


@pytest.mark.parametrize("tau", ["grazing", *slow_cases("1.25")])
@pytest.mark.parametrize("kind", sample(3, SWEEPS))
def test_every_number_of_every_point_is_in_the_file(tmp_path, kind, tau):
    """As an attribute or a coordinate, what the block of the point was computed with; b* is that of `vs.grazing`."""
    scene, path = run(tmp_path, SWEEPS[kind], f"{PAPER}, tau: {tau}" if kind != "tau" else PAPER)
    used = {name: values for name, values in scene.parameters().items() if not name.startswith("start_")}
    with vs.open(path) as data, xarray.open_dataset(path, engine="h5netcdf") as plain:
        assert set(plain.coords) == set(data.coords)
        lead = [name for name in data.status.dims if name != "start"]
        stars = np.empty(scene.sweep_shape)
        for place in np.ndindex(stars.shape):
            system = scene.system.replace(**{name: float(used[name][place]) for name in used if name != "tau"})
            stars[place] = vs.grazing(system).b
        follow = {"offset", "R_left", "mu_c"}  # that are not given are not told
        assert not follow & {*data.attrs, *data.coords}
        for name, values in {**used, "b_star": stars}.items():
            if name in follow:
                continue
            assert (name in data.attrs) != (name in data.coords), name
            if name in data.attrs:
                assert isinstance(data.attrs[name], float)
                np.testing.assert_allclose(values, data.attrs[name], rtol=4e-16)
            else:
                stored = data[name].broadcast_like(data.status).transpose(*data.status.dims)
                if "start" in stored.dims:
                    stored = stored.isel(start=0)
                assert list(stored.dims) == lead
                np.testing.assert_allclose(stored, values, rtol=4e-16, err_msg=name)
        assert (data.attrs["transient"], data.attrs["record"], data.attrs["stops"]) == (3, 4, "both")
        given = {name for name in data.attrs if name.startswith("start_")}
        assert given == (set() if "random" in scene.text else {
            f"start_{name}" for name in ("x1", "v1", "x2", "v2")
        } - set(scene.sweep))  # fmt: skip


def test_words_of_maps_and_impact_sections(tmp_path):
    text = "dynamics: map\norder: 2\nexpand_at: 6.7107356\norbit: {transient: 3, record: 4}"
    _, path = run(tmp_path, text, orbit="")
    with vs.open(path) as data:
        assert (data.attrs["dynamics"], data.attrs["order"], data.attrs["expand_at"]) == ("map", 2, 6.7107356)
        assert data.attrs["section"] == "phase" and "section_stop" not in data.attrs
    path.unlink()
    _, path = run(tmp_path, "section: {kind: impact, stop: left}\norbit: {transient: 3, record: 4}", orbit="")
    with vs.open(path) as data:
        assert (data.attrs["section"], data.attrs["section_stop"], data.attrs["dynamics"]) == ("impact", "left", "flow")
        assert "order" not in data.attrs


def test_numbers_that_follow_are_there_from_the_beginning(tmp_path):
    """Before anything is computed."""
    scene, path = run(tmp_path, SWEEPS["omega, mu_m"], f"{PAPER}")
    with vs.open(path) as data:
        whole = data["b_star"].load()

    def stop(*_):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        vs.run(scene, tmp_path / "y.h5", progress=stop)
    with vs.open(tmp_path / "y.h5") as data:
        assert data["b_star"].equals(whole) and np.all(data.status == -1)


# What YAML 1.1 reads otherwise: 2e2 is a text there, 010 is eight and 0100 is 64

ODD = PAPER.replace("10,", "010,", 1)


@pytest.mark.parametrize(("record", "count"), [("2e2", 200), ("0100", 100), ("40", 40)])
def test_impacts_are_drawn_by_the_record_of_the_run(tmp_path, record, count):
    orbit = f"orbit: {{transient: 100, record: {record}}}\nobserve: [impacts]"
    _, path = run(tmp_path, SWEEPS["b"], ODD, orbit)
    ax = vs.plot(path, kind="impacts").axes[0]
    with h5py.File(path) as file:
        assert file.attrs["record"] == count and file.attrs["mu_m"] == 10
        right = {line.get_label(): line.get_ydata() for line in ax.lines}["right"]
        assert np.array_equal(right, file["impacts_right"][()] / count) and right.max() > 0
    assert ax.get_ylabel() == "impacts / $T$" and r"\mu_m = 10" in ax.figure.get_suptitle()


def test_a_text_of_the_scene_that_says_something_else_is_not_asked(tmp_path):
    """The numbers are those of the attributes."""
    _, path = run(tmp_path, SWEEPS["b"])
    with h5py.File(path, "r+") as file:
        file.attrs["scene"] = "system: {mu_m: 3"
    assert r"\mu_m = 10" in vs.plot(path).get_suptitle()
