"""Eight numbers at a time, and how kernels are compiled."""
