"""Result files made up for pictures, and what their figures show."""

import h5py
import numpy as np
import pytest

from vibro_sweep.store.parts import FORMAT

SETTINGS = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8, b=6.6, tau=2.2293, stops="both")
SETTINGS |= dict(b_star=6.70571674097302, model="flow", section="phase", transient=300, record=20)
OWN = {"lyapunov": ("exponent",), "x1": ("sample",), "v1": ("sample",), "phase": ("sample",)}
OWN |= {"lyapunov_running": ("elapsed", "exponent"), "lyapunov_error": ("exponent",)}
OWN |= {f"trajectory_{name}": ("t_over_T",) for name in ("x1", "v1", "x2", "v2")}
OWN |= {f"trajectory_section_{name}": ("trajectory_section",) for name in ("x1", "v1", "x2")}
OWN |= {f"trajectory_impact_{name}": ("trajectory_impact",) for name in ("t_over_T", "side", "v1", "v1_after", "x2")}


def write(path, coordinates, quantities, done=None, settings=SETTINGS, time=(), along=None):
    """A result file by the contract: `coordinates` in order, then each quantity's own dimensions (OWN).

    along: numbers that follow from swept ones, name -> (key, values).
    """
    shape = tuple(len(values) for values in coordinates.values())
    quantities = {"status": np.where(np.ones(shape, bool) if done is None else done, 0, -1), **quantities}
    with h5py.File(path, "w") as file:
        along = along or {}
        file.attrs.update({name: v for name, v in settings.items() if name not in coordinates and name not in along})
        file.attrs.update({"scene": "", "title": "", "history": "", "provenance": "{}"})
        file.attrs.update({"kind": "sweep", "format": FORMAT, "heap": np.zeros(0, np.uint64)})
        names = [name for name in quantities if name != "status"]
        file.attrs["sweep_dimensions"] = [name for name in coordinates if name != "start"] or h5py.Empty("S1")
        file.attrs["quantities"] = names or h5py.Empty("S1")
        known = dict(coordinates)
        for name, values in quantities.items():
            data = file.create_dataset(name, data=values)
            for i, dim in enumerate((*coordinates, *OWN.get(name, ()))):
                known.setdefault(dim, time if dim == "t_over_T" else np.arange(np.shape(values)[i]))
                if dim not in file:
                    file[dim] = known[dim]
                    file[dim].make_scale(dim)
                data.dims[i].attach_scale(file[dim])
        for name, (key, values) in along.items():
            file[name] = values
            file[name].dims[0].attach_scale(file[key])
        if "lyapunov_error" in file:
            file["lyapunov_error"].attrs["significant"] = 2.0
    return path


def exponents(*shape):
    """A spectrum that is chaotic in the last quarter of the first dimension."""
    spectrum = np.tile([-0.01, -0.02, -0.05, -0.1], (*shape, 1))
    spectrum[3 * shape[0] // 4 :, ..., 0] = 0.004
    return spectrum


@pytest.fixture
def sweep(tmp_path):
    b = np.linspace(6.5, 6.9, 40)
    x1 = b[:, None] - np.random.default_rng(0).uniform(0, 1, (40, 20))
    counts = {"impacts_right": np.full(40, 10), "impacts_left": np.full(40, 5)}
    return write(tmp_path / "sweep.h5", {"b": b}, {"x1": x1, "lyapunov": exponents(40), **counts})


@pytest.fixture
def branches(tmp_path):
    b = np.linspace(6.6, 6.8, 30)
    x1 = np.stack([np.tile(b[:, None], 20) - 1, np.tile(b[:, None], 20) - 2], axis=1)
    coordinates = {"b": b, "start": np.array([b"up", b"down"], dtype=object)}
    return write(tmp_path / "follow.h5", coordinates, {"x1": x1, "lyapunov": exponents(30, 2)})


@pytest.fixture
def trajectory(tmp_path):
    """Bounces between walls at +-2 with speed 1, impacts at t = 2, 6, 10, 14; the forcing period is 8 too."""
    time = np.linspace(0, 16, 41)  # no sample meets an impact
    x1 = np.abs((time - 2) % 8 - 4) - 2
    v1 = np.where((time - 2) % 8 < 4, -1.0, 1.0)
    side = np.array([1, -1, 1, -1, 0])
    nan = np.full(1, np.nan)
    quantities = {
        **{"trajectory_x1": x1, "trajectory_v1": v1, "trajectory_x2": x1 / 2, "x1": np.zeros(2)},
        **{"trajectory_section_x1": np.zeros(3), "trajectory_section_v1": np.ones(3)},
        **{"trajectory_section_x2": np.zeros(3), "trajectory_impacts": 4, "trajectory_impact_side": side},
        "trajectory_impact_t_over_T": np.append([2, 6, 10, 14], nan) / 8,
        "trajectory_impact_v1": np.append(side[:4], nan),
        "trajectory_impact_v1_after": np.append(-side[:4], nan),
        "trajectory_impact_x2": np.append(side[:4], nan),
    }
    settings = SETTINGS | dict(b=2.0, omega=2 * np.pi / 8, R=1.0)
    return write(tmp_path / "one.h5", {}, quantities, settings=settings, time=time / 8)


def drawn(ax):
    """All points drawn as single dots."""
    return np.concatenate([line.get_xydata() for line in ax.lines if line.get_linestyle() == "None"])


def image(ax):
    (only,) = ax.images
    return only


@pytest.fixture
def plane(tmp_path):
    b, omega = np.linspace(6, 7, 4), np.array([0.5, 0.6, 0.8])
    spectrum = np.full((4, 3, 2, 4), -0.1)
    spectrum[1, 2, 0, 0], spectrum[1, 2, 1, 0] = -0.05, 0.02
    period = np.ones((4, 3, 2), int)
    period[1, 2] = 5, 0
    period[3, 0] = 40
    done = np.ones((4, 3, 2), bool)
    done[0, 0] = False
    coordinates = {"b": b, "omega": omega, "start": np.arange(2)}
    return write(tmp_path / "plane.h5", coordinates, {"lyapunov": spectrum, "period": period}, done=done)
