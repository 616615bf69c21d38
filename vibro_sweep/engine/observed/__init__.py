"""What is observed of orbits: sections, their periods, whether they have arrived, averages."""
