"""Pictures of a result file or a Dataset, from these alone.

`plot.plot` is `vibro_sweep.plot`; `plot.write_pictures` writes those of the command line. What files of pictures need
of names and errors is in `picture_files`, which loads no matplotlib.
Nothing here computes an orbit: what is not in the file is not in the picture. No display is needed or touched.
"""
