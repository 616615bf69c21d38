"""Pictures of a result file or a Dataset, from these alone.

`plot` is `vibro_sweep.plot`; `write_pictures` writes those of the command line; `kinds` says what a file can show.
Nothing here computes an orbit: what is not in the file is not in the picture. No display is needed or touched.
"""

from vibro_sweep.plotting.pictures import SUFFIXES, check_output
from vibro_sweep.plotting.plot import KINDS, default_name, kinds, plot, write_pictures
from vibro_sweep.plotting.source import PlotError

__all__ = ["KINDS", "SUFFIXES", "PlotError", "check_output", "default_name", "kinds", "plot", "write_pictures"]
