"""The HDF5 file: written by one process, block by block, and read by everybody.

While a run goes on the file is FILE.h5.part. A block changes several chunks, their checksums and the lists of chunks.
HDF5 alone writes these one by one, so that a kill in between would damage finished blocks too; it therefore writes
through a `vibro_sweep.journal`: a block is in the file as a whole or not at all.
"""

from vibro_sweep.store.layout import coordinates, quantities, size
from vibro_sweep.store.opening import StoreError
from vibro_sweep.store.reading import describe, open
from vibro_sweep.store.writing import Writer, writer

__all__ = ["StoreError", "Writer", "coordinates", "describe", "open", "quantities", "size", "writer"]
