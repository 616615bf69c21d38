"""HDF5 files: a Dataset is written, a file is opened, the file of a sweep is filled in place."""
