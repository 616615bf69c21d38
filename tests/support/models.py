"""Numbers of each model with a name, for tests."""

import vibro_sweep as vs

PAPER = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0.25, omega=0.63, R=0.8, b=6.6)
GIVEN = {
    "two_mass": PAPER,
    "one_mass": dict(zeta=0.02, F=0.35, omega=0.8, R=0.9, b=1, stops="right"),
    "ball_in_cavity": dict(mass_ratio=0.05, zeta=0.01, F=0.1, omega=1.0, R=0.7, b=1.0),
    "chain": dict(
        m=[1, 2, 3], k=[1, 2, 0.5, 0], c=[0.1, 0.2, 0, 0.3], force=[0, 1, 0.5], stop_at=2, omega=0.9, R=0.6, b=2,
    ),
    "linear": dict(
        M=[[2, 0.3], [0.3, 1]], K=[[3, -1], [-1, 2]], rayleigh=[0.02, 0.03], force=[1, 0.5], force_cos=[0, 0.2],
        constant=[0.3, 0], force_power=2, contact_normal=[1, -1], omega=0.9, b=1, offset=0.2, R=0.8,
    ),
}  # fmt: skip


def oscillator(name, **changes):
    return vs.Oscillator.named(name, **(GIVEN[name] | changes))
