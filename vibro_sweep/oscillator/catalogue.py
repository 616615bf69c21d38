"""Any variable or number of a file by its name: coordinates of files and axes of pictures are described by it.

A name means the same in all models, and has one symbol and one label.
"""

from vibro_sweep.oscillator.models import MODELS
from vibro_sweep.oscillator.models.two_mass import PAPER
from vibro_sweep.tables.coordinates import INITIAL, MOST_MASSES
from vibro_sweep.tables.observables import DIMENSIONS, variables
from vibro_sweep.tables.parameters import B_LEFT, B_RIGHT, B_STAR
from vibro_sweep.tables.quantity import Parameter, Quantity

# Of all oscillators; the paper's say what a name means.
OF_A_SYSTEM: dict[str, Parameter] = {x.name: x for x in PAPER}
OF_A_SYSTEM |= {name: x for model in MODELS.values() for name, x in model.flat(MOST_MASSES).items()} | OF_A_SYSTEM

NUMBERS: dict[str, Parameter] = OF_A_SYSTEM | {x.name: x for x in (B_STAR, B_RIGHT, B_LEFT, *INITIAL)}
AXES: dict[str, Quantity] = NUMBERS | DIMENSIONS
BY_NAME: dict[str, Quantity] = AXES | {x.name: x for gap in (True, False) for x in variables(MOST_MASSES, gap)}
