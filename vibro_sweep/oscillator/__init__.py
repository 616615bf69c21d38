"""The oscillator: its parameters, modes, steady motion and Theorem 1."""
