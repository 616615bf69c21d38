"""Files and other programs: what CF and netCDF ask of a file, and files that xarray has written from ours."""

import re

import h5py
import matplotlib
import netCDF4
import numpy as np
import pytest
import xarray
from matplotlib.backends.backend_agg import FigureCanvasAgg
from support.kinds_of_files import KINDS, RAGGED
from support.programs import main

import vibro_sweep as vs

pytestmark = pytest.mark.slow  # one file of each kind is made

NAME = re.compile("[A-Za-z][A-Za-z0-9_]*")  # CF 2.3
UNITS = ("1", "rad")  # what is used here of UDUNITS
LENGTH = b"This is a netCDF dimension but not a netCDF variable"  # the name of those
# how HDF5 joins datasets and their dimensions, and how CF names coordinates
SCALES = ("CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST", "coordinates")


def lengths_and_variables(file):
    """Datasets that are nothing but a dimension, and all others."""
    datasets = {name: one for name, one in file.items() if isinstance(one, h5py.Dataset)}
    lengths = {name for name, one in datasets.items() if one.attrs.get("NAME", b"").startswith(LENGTH)}
    return lengths, {name: one for name, one in datasets.items() if name not in lengths}


@pytest.mark.parametrize("name", KINDS)
def test_rules_of_cf_and_netcdf(kinds, name):
    """By hand from the text of CF 1.11: names, units, dimensions, coordinates, flags, counts of ragged arrays."""
    with h5py.File(kinds(name)) as file:
        lengths, variables = lengths_and_variables(file)
        assert file.attrs["Conventions"] == "CF-1.11"
        for one in (file, *variables.values()):
            for attribute, value in one.attrs.items():
                assert NAME.fullmatch(attribute)
                if attribute not in SCALES:
                    assert np.ndim(value) <= 1, attribute  # netCDF has no others
        for key, one in variables.items():
            assert NAME.fullmatch(key) and one.attrs["units"] in UNITS and one.attrs["long_name"]
            dimensions = [dimension[0].name[1:] for dimension in one.dims] if not one.is_scale else [key]
            assert len(dimensions) == one.ndim == len(set(dimensions)) and set(dimensions) <= {*lengths, *variables}
            for coordinate in one.attrs.get("coordinates", "").split():  # CF 5
                along = {dimension[0].name[1:] for dimension in variables[coordinate].dims}
                assert along <= set(dimensions) and coordinate not in dimensions
            if "flag_values" in one.attrs:  # CF 3.5
                values, words = one.attrs["flag_values"], one.attrs["flag_meanings"].split()
                assert values.dtype == one.dtype and len(values) == len(words) == len(set(values.tolist()))
        if name in RAGGED:  # CF 9.3.3
            counted = {
                one.attrs["sample_dimension"]: one for one in variables.values() if "sample_dimension" in one.attrs
            }
            assert set(counted) == {"point", "special"}
            for dimension, counts in counted.items():
                assert counts.dtype.kind == "i" and counts[()].sum() == len(file[dimension])


def test_matrices_are_variables(kinds):
    with vs.open(kinds("linear")) as data, xarray.open_dataset(kinds("linear"), engine="h5netcdf") as other:
        for one in (data, other):
            assert np.array_equal(one.M, [[1, 0], [0, 2]]) and np.array_equal(one.K, [[3, -1], [-1, 2]])
            assert one.C.dims == ("row", "column") and "C" in one.coords and "M" not in one.attrs


def test_matrices_as_attributes_are_still_read(kinds, tmp_path):
    """As in files that were made before."""
    content = tmp_path / "x.h5"
    content.write_bytes((kinds("linear")).read_bytes())
    with h5py.File(content, "a") as file:
        file.attrs["coordinates"] = "tau b_star"
        for name in "MKC":
            values = file[name][()]
            del file[name]
            file.attrs[name] = values
    with vs.open(content) as data:
        assert np.array_equal(data.attrs["M"], [[1, 0], [0, 2]])
        vs.plot(data)
    assert main(["info", str(content)]) == 0


@pytest.mark.parametrize("name", KINDS)
def test_netcdf4_reads_all_of_it(kinds, name):
    """The C library of netCDF: every variable and attribute, no group but ours."""
    with netCDF4.Dataset(kinds(name)) as file, vs.open(kinds(name)) as data:
        assert set(file.groups) <= {"check"}
        lengths = {key for key in file.dimensions if key not in data.variables}
        assert set(file.variables) - lengths == set(data.variables)
        for key, one in data.variables.items():
            there = file.variables[key]
            there.set_auto_mask(False)
            assert there.dimensions == one.dims
            assert one.dtype.kind == "U" or there[...].tobytes() == one.values.tobytes(), key
        for key in data.attrs.keys() - {"history", "provenance", "sweep_dimensions"}:
            assert np.array_equal(np.atleast_1d(file.getncattr(key)), np.atleast_1d(data.attrs[key])), key


# What xarray has written


@pytest.fixture(scope="module")
def written(kinds, tmp_path_factory):
    """A copy of each kind by xarray."""
    folder = tmp_path_factory.mktemp("written")
    for name in KINDS:
        with xarray.open_dataset(kinds(name), engine="h5netcdf") as data:
            data.to_netcdf(folder / f"{name}.h5", engine="h5netcdf")
    return folder


def pixels(figure):
    with matplotlib.rc_context():
        figure.set_dpi(60)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        return np.array(canvas.buffer_rgba())


@pytest.mark.parametrize("name", KINDS)
def test_it_opens_with_a_warning(kinds, written, name, caplog):
    with vs.open(kinds(name)) as ours, vs.open(written / f"{name}.h5") as theirs:
        assert set(ours.variables) == set(theirs.variables)
        assert all(ours[key].equals(theirs[key]) for key in ours.variables)
    assert caplog.text.count("was written, or changed, by another program") == 1 and "damaged" not in caplog.text


@pytest.mark.parametrize("name", [name for name in KINDS if name != "windows"])
def test_one_picture_of_a_file_its_dataset_and_its_copy(kinds, written, name):
    expected = pixels(vs.plot(kinds(name)))
    with vs.open(kinds(name)) as data:
        assert np.array_equal(pixels(vs.plot(data)), expected)
    assert np.array_equal(pixels(vs.plot(written / f"{name}.h5")), expected)


def test_commands_on_it(kinds, written, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    sweep, branches = str(written / "sweep.h5"), str(written / "branches.h5")
    before = (written / "sweep.h5").read_bytes()
    assert main(["info", sweep]) == 0
    told = capsys.readouterr()
    assert (
        "checksums    none: written, or changed, by another program" in told.out
        and "begun by vibro_sweep" in told.out
        and not told.err
    )
    assert main(["plot", sweep, "-o", "x.png", "--windows", str(written / "windows.h5")]) == 0
    assert main(["plot", branches, "-o", "y.png", "--over", sweep]) == 0
    told = capsys.readouterr().err
    assert told.count("warning: ") == told.count("was written, or changed, by another program") == 4
    scene = str(kinds.folder / "sweep.yaml")
    for words in (
        ["windows", sweep, "-o", "w.h5"],
        ["run", scene, "-o", sweep],
        ["run", scene, "-o", sweep, "--resume"],
    ):
        assert main(words) == 2
        told = capsys.readouterr().err
        assert "was written, or changed, by another program" in told and "damaged" not in told
    assert (written / "sweep.h5").read_bytes() == before


def test_a_part_of_it(kinds, tmp_path):
    """What a user keeps of a file is drawn as far as it goes; what is lacking is said."""
    with vs.open(kinds("sweep")) as data:
        data[["x1", "status"]].isel(b=slice(0, 3)).to_netcdf(tmp_path / "few.nc", engine="h5netcdf")
        data.drop_vars("status").to_netcdf(tmp_path / "none.nc", engine="h5netcdf")
    with vs.open(kinds("branches")) as data:
        data.isel(point=slice(0, 5)).to_netcdf(tmp_path / "cut.nc", engine="h5netcdf")
    assert vs.plot(tmp_path / "few.nc").axes
    with pytest.raises(vs.PlotError, match=r"is not from `vibro_sweep\.open`"):
        vs.plot(tmp_path / "none.nc")
    with pytest.raises(vs.PlotError, match=r"cut\.nc does not hold all that branches are: `branch_"):
        vs.plot(tmp_path / "cut.nc")


def test_windows_as_a_dataset_are_drawn_as_stable_branches(kinds):
    with vs.open(kinds("windows")) as data:
        lines = vs.plot(data).axes[0].lines
        assert sum(len(line.get_xdata()) > 1 for line in lines) >= data.sizes["window"]
