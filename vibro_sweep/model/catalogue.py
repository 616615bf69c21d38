"""Any variable or number of a file by its name: coordinates of files and axes of pictures are described by it."""

from vibro_sweep.model.observables import DIMENSIONS, VARIABLES, Dimension, Variable
from vibro_sweep.model.parameters import B_STAR, PARAMETERS, Parameter
from vibro_sweep.model.state import INITIAL

NUMBERS: dict[str, Parameter] = {one.name: one for one in (*PARAMETERS, B_STAR, *INITIAL)}
AXES: dict[str, Parameter | Dimension] = NUMBERS | DIMENSIONS
BY_NAME: dict[str, Parameter | Dimension | Variable] = AXES | {one.name: one for one in VARIABLES}
