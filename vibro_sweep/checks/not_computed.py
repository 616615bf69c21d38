"""What users ask for and no model has: a refusal says so, by the name that they give it."""

from typing import NamedTuple

PAGE = "docs/start/your_machine.md says what is"


class NotComputed(NamedTuple):
    """What is not computed: the sentence of a refusal, names by which it is asked for; and in a table of that page what
    a machine has, and what to take instead."""

    sentence: str
    names: tuple[str, ...]
    machine: str
    instead: str


ROWS = (
    NotComputed(
        "springs and stops are linear, others are not computed",
        ("exponent", "hertz", "power", "n_hertz"),
        "a stop whose force is not linear in how far it is pressed",
        "any integrator with event detection (SciPy, heyoka)",
    ),
    NotComputed(
        "there is one contact, several are not computed",
        ("contacts", "gaps", "clearances", "normals", "contact_normals"),
        "two or more gaps",
        "an event-driven or time-stepping simulator: Siconos, or a general integrator",
    ),
    NotComputed(
        "dry friction is not computed",
        ("friction", "mu_f", "mu_s", "mu_d", "coulomb"),
        "dry friction",
        "Siconos; of continuation programs those for Filippov systems",
    ),
    NotComputed(
        "springs are linear, others are not computed",
        ("k3", "k_3", "k_cubic", "cubic", "knl", "k_nl", "duffing"),
        "a nonlinear spring",
        "AUTO, MatCont or COCO for smooth systems; BifurcationKit.jl; heyoka for orbits",
    ),
    NotComputed(
        "dampers are linear, drag is not computed",
        ("drag", "quadratic", "c_quadratic"),
        "drag, or another nonlinear damper",
        "a general integrator with event detection",
    ),
    NotComputed(
        "the force has one frequency, several are not computed",
        ("omegas", "omega2", "omega_2", "frequencies"),
        "a force with several frequencies, noise, or a control law",
        "a general integrator with event detection",
    ),
    NotComputed(
        "gyroscopic forces are not computed",
        ("G", "gyro", "gyroscopic"),
        "gyroscopic or circulatory forces: a matrix that is not symmetric",
        "a general integrator with event detection",
    ),
    NotComputed(
        "R is one number, restitution that depends on the speed is not computed",
        ("R_of_v", "restitution_law", "R_speed"),
        "restitution that depends on the speed",
        "a general integrator with event detection; near one speed a constant `R` may do",
    ),
)
_SENTENCES = {name: row.sentence for row in ROWS for name in row.names}


def why_not_computed(name: str) -> str | None:
    """The sentence on what a name stands for; None where it may be a slip."""
    sentence = _SENTENCES.get(name) or _SENTENCES.get(name.lower())
    return sentence and f"{sentence}; {PAGE}"
