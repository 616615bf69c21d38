"""What kernels are given of each point: coordinates at a contact and of tangent vectors, and bounds of motion."""
