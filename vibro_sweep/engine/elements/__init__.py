"""Motion with any number of contacts and of dry friction, one orbit from phase to phase."""
