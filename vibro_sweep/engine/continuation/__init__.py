"""One residual for periodic orbits with events, its derivatives, one corrector and one stepper."""
