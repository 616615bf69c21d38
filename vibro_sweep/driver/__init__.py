"""From a scene to its file: blocks, executors, and the loop that hands results to the store."""

MOST_WORKERS = 1024  # threads
