"""Oscillators with compliant stops that several tests have."""

import vibro_sweep as vs

FREE = dict(k=0, zeta=0, F=0, omega=1, b=1, stops="right", tau=0.0)
PAPER = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63)
ELASTIC = dict(k=1, zeta=0.01, F=0.5, omega=0.8, b=1, stops="right", tau=0.0)


def one_mass(**changes):
    return vs.Oscillator.named("one_mass", **changes)
