"""The kinds of pictures by name, in order of preference, for scenes and the command line; plotting/ draws them."""

PICTURES = (
    "basins",
    "coexistence",
    "plane",
    "bifurcation",
    "lyapunov",
    "impacts",
    "energy",
    "phase-portrait",
    "configuration",
    "history",
    "iteration",
    "poincare",
    "convergence",
)
