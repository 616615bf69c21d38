"""Scenes of every kind, and their numbers as arrays that can be compared bit for bit."""

import numpy as np
import xarray  # noqa: F401  before a run begins that `done` is to see in the middle: loading it takes a second

import vibro_sweep as vs
from support.contents import arrays_of
from support.oscillators import PAPER_NUMBERS
from support.scene_texts import parsed

PAPER = f"{PAPER_NUMBERS}, b: 6.6"
ALL = "observe: [section, lyapunov, impacts]"

# every kind of sweep, of start and of observation among them
SCENES = {
    "random": f"""
sweep: {{b: {{start: 6.5, stop: 6.8, num: 23}}}}
start: {{random: 3, seed: 5}}
orbit: {{transient: 100, record: 40}}
section: {{kind: impact, stop: right}}
trajectory: {{periods: 2, samples: 50}}
{ALL}""",
    "plane": f"""
sweep: {{omega: {{start: 0.5, stop: 0.8, num: 5}}, b: {{start: 0.3, stop: 6.8, num: 7}}}}
orbit: {{transient: 60, record: 40}}
{ALL}""",
    "follow": f"""
sweep: {{b: {{start: 6.5, stop: 6.8, num: 9}}, R: {{values: [0.9, 0.8, 0.3]}}}}
start: {{follow: both}}
orbit: {{transient: 60, record: 40}}
{ALL}""",
    "attractors": """
sweep: {b: {start: 6.6, stop: 6.8, num: 9}}
start: {random: 5, seed: 2}
orbit: {transient: 1500, record: 100}
observe: [attractors]""",
    "basins": """
sweep: {x1: {values: [-6, 0, 6]}, v1: {start: -1, stop: 1, num: 5}}
orbit: {transient: 100, record: 40}
observe: [attractors, section]""",
}

# of each law of contact, as (text, system): a scene with what it may observe
SOFT = "type: one_mass, zeta: 0.02, F: 2.4, omega: 0.8, b: 4, k_stop: 400"
SLOW = "type: one_mass, zeta: 0.02, F: 2.4, omega: 0.8, k_stop: 2, release: force, preload: 0.01"
CONTACTS = "observe: [section, lyapunov, multipliers, contacts]"
COMPLIANT = {
    "compliant": (
        f"""
sweep: {{b: {{start: 3, stop: 7, num: 19}}}}
start: {{random: 2, seed: 5}}
orbit: {{transient: 60, record: 40}}
trajectory: {{periods: 2, samples: 50}}
{CONTACTS}""",
        f"{SOFT}, c_stop: 2",
    ),
    "compliant, force": (
        f"""
sweep: {{k_stop: {{values: [3, 100, 1e6]}}, b: {{start: 3, stop: 6, num: 5}}}}
orbit: {{transient: 60, record: 40}}
{CONTACTS}""",
        f"{SOFT}, c_stop: 8, release: force, preload: 0.1",
    ),
    "compliant, left rigid": (
        """
sweep: {b: {start: 3, stop: 7, num: 17}}
orbit: {transient: 60, record: 40}
observe: [section, lyapunov, contacts, impacts]""",
        f"{SOFT}, c_stop: 2, R_left: 0.8",
    ),
    "compliant, attractors": (
        """
sweep: {b: {start: 3, stop: 6, num: 7}}
start: {random: 4, seed: 2}
orbit: {transient: 400, record: 100}
observe: [attractors, contacts, energy]""",
        f"{SOFT}, c_stop: 2, preload: 0.2",
    ),
    # stops that relax for longer than a period: at the sections between two steps, some are not where they will be
    "compliant, follow": (
        """
sweep: {b: {start: 3, stop: 5, num: 9}, c_stop: {values: [300, 20, 6]}}
start: {follow: both}
orbit: {transient: 3, record: 4}
observe: [section, lyapunov, contacts, energy]""",
        SLOW,
    ),
}

# what `run` and `scene_of` take, by name
EVERY = {name: (text,) for name, text in SCENES.items()} | COMPLIANT


def scene_of(text, system=PAPER):
    return parsed(f"system: {{{system}}}\n{text}")


def run(folder, text, system=PAPER, **options):
    """The scene's file, as arrays."""
    path = folder / f"{len(list(folder.iterdir()))}.h5"
    vs.run(scene_of(text, system), path, **options)
    return arrays_of(path)


def done(output):
    """Orbits in the file of a run."""
    try:
        with vs.open(output) as data:
            return np.count_nonzero(data["status"].values != -1)
    except vs.StoreError:  # it is being made
        return 0
