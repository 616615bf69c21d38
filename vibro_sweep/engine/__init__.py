"""Every jitted line: orbits from impact to impact in closed form, eight at a time."""
