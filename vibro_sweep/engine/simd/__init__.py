"""Eight numbers at a time, and how kernels are compiled."""

OWN_PROCESS = False  # whether it is the command line's: what compiling leaves there is never looked through for garbage
