"""Windows of a sweep: where each periodic orbit is stable, and what ends it there."""
