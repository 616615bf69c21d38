"""Results as data: the empty Dataset of a scene, and what everything that reads asks of a sweep's Dataset."""
