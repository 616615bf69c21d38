"""A diagram as one HTML file, in which the kernels of the engine run as WebAssembly."""
