"""Single orbits: simulated, their exponents, the discontinuity map."""
