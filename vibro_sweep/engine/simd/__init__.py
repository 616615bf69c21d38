"""Eight numbers at a time, and how kernels are compiled."""

import threading

FREE = threading.Event()  # set once LLVM optimises a kernel that takes long, or one is there: Python has time for more
OWN_PROCESS = False  # whether it is the command line's: what compiling leaves there is never looked through for garbage
