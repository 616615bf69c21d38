"""Oscillators for tests of periodic orbits, with any number of masses, as families with parameters."""

import numpy as np

import vibro_sweep as vs
from vibro_sweep.types import Family, Linear, LinearContact

PAPER_NUMBERS = "mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8"  # as scenes write them; b is left out
PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=2.0)


def bouncing_ball(*, A, omega, G, R) -> Linear:
    """Height above a table that moves as A sin(omega t) downwards: x'' = -G + A omega^2 sin(omega t), x >= 0."""
    zero = np.zeros((1, 1))
    return Linear(
        M=np.eye(1), K=zero, C=zero, constant=np.array([-G]), sine=np.array([A * omega**2]),
        cosine=np.zeros(1), omega=omega, tau=0.0, contacts=[LinearContact(np.ones(1), 0.0, np.inf, R, R)],
    )  # fmt: skip


def one_mass(*, damping, F, omega, R, b) -> Linear:
    """x'' + damping x' + x = F cos(omega t), x <= b (arXiv 2510.16218)."""
    return Linear(
        M=np.eye(1), K=np.eye(1), C=damping * np.eye(1), constant=np.zeros(1), sine=np.zeros(1),
        cosine=F * np.ones(1), omega=omega, tau=0.0, contacts=[LinearContact(np.ones(1), -np.inf, b, R, R)],
    )  # fmt: skip


def chain(*, c, k, F, omega, R, R_left, b, offset, tau=None) -> Linear:
    """Three masses between walls, forced at the third; the contact is between the first two. Damping is arbitrary."""
    K = np.array([[1 + k, -k, 0], [-k, k + 2, -2], [0, -2, 3.0]])
    C = c * np.array([[3, -1, 0], [-1, 1, 0], [0, 0, 0.5]])
    M = np.array([[1, 0.1, 0], [0.1, 2, 0], [0, 0, 1.5]])
    return Linear(
        M=M, K=K, C=C, constant=np.array([0.1, 0, 0]), sine=np.array([0, 0, 1.0]) * F, cosine=np.zeros(3), omega=omega,
        tau=tau, contacts=[LinearContact(np.array([1.0, -1, 0]), offset - b, offset + b, R_left, R)],
    )  # fmt: skip


def ball_in_cavity(*, ratio, zeta, F, omega, R, b) -> Linear:
    """A sprung host x1 of mass 1 and a free ball x2 in it, |x2 - x1| < b."""
    return Linear(
        M=np.array([[1, 0], [0, ratio]]), K=np.array([[1.0, 0], [0, 0]]), C=2 * zeta * np.array([[1.0, 0], [0, 0]]),
        constant=np.zeros(2), sine=np.array([1.0, 0]) * F, cosine=np.zeros(2), omega=omega,
        tau=0.0, contacts=[LinearContact(np.array([-1.0, 1]), -b, b, R, R)],
    )  # fmt: skip


def long_chain(*, k, c, F, omega, R, b) -> Linear:
    """Eight masses between walls, forced at the first; the fourth moves between two stops."""
    N = 8
    K = k * (2 * np.eye(N) - np.eye(N, k=1) - np.eye(N, k=-1))
    force, along = np.zeros(N), np.zeros(N)
    force[0], along[3] = F, 1
    return Linear(
        M=np.diag(1 + 0.1 * np.arange(N)), K=K, C=c * K, constant=np.zeros(N), sine=force,
        cosine=np.zeros(N), omega=omega, tau=None, contacts=[LinearContact(along, -b, b, R, R)],
    )  # fmt: skip


LONG_CHAIN = Family(long_chain, {"k": 1.0, "c": 0.05, "F": 10.0, "omega": 0.5, "R": 0.7, "b": 50.0})
BALL = Family(bouncing_ball, {"A": 1.0, "omega": 1.0, "G": 1.0, "R": 0.8})
ONE_MASS = Family(one_mass, {"damping": 0.04, "F": 0.36, "omega": 0.81, "R": 0.9, "b": 1.0})
CHAIN = Family(chain, {"c": 0.1, "k": 0.7, "F": 3.0, "omega": 0.9, "R": 0.8, "R_left": 0.6, "b": 0.3, "offset": 0.1})
CAVITY = Family(ball_in_cavity, {"ratio": 0.2, "zeta": 0.05, "F": 1.0, "omega": 1.3, "R": 0.7, "b": 0.5})
