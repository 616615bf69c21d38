"""Orbits, branches and curves as solution sets of one problem: the oscillator, its points, corrections."""
