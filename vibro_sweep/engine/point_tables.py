"""From a point to its tables, and between the coordinates of its masses and those of its contact."""

from vibro_sweep.engine.simd.jit import jit

ON_STOP = 2.0**-50  # of the terms of the gap: a distance from a stop, and a speed, that are rounding


@jit
def same_tables(a, b):
    """Whether two points share their tables: they may differ in the stops."""
    same = a.cells == b.cells and a.omega == b.omega and a.tau == b.tau and a.frame_scale[0] == b.frame_scale[0]
    for i in range(len(a.force)):
        for j in range(len(a.force)):
            same = same and a.stiffness[i, j] == b.stiffness[i, j] and a.damping[i, j] == b.damping[i, j]
        for j in range(3):
            same = same and a.force[i, j] == b.force[i, j]
        same = same and a.push[i] == b.push[i]
    return same


@jit
def set_graze(q, point):
    """The point at which the discontinuity mapping is expanded."""
    for j in range(len(q.graze)):
        q.graze[j] = point.graze[j]


@jit
def turn(matrix, x, scratch):
    """The coordinates and velocities x1, v1, x2, ... become those of the matrix times x."""
    masses = len(matrix)
    for k in range(2):
        for i in range(masses):
            total = 0.0
            for j in range(masses):
                total += matrix[i, j] * x[2 * j + k]
            scratch[2 * i + k] = total
    for j in range(2 * masses):
        x[j] = scratch[j]


@jit
def to_contact(point, x, stops, scratch):
    """The state x in contact coordinates; on a stop, and at rest there, if it is so but for rounding."""
    if not point.turned:
        return
    size, speed = 0.0, 0.0
    for j in range(len(point.P)):
        size += abs(point.P[0, j] * x[2 * j])
        speed += abs(point.P[0, j] * x[2 * j + 1])
        x[2 * j] -= point.origin[j]
    turn(point.P, x, scratch)
    if abs(x[1]) <= ON_STOP * speed:
        x[1] = 0.0
    if abs(x[0] - stops.left) <= ON_STOP * size:
        x[0] = stops.left
    if abs(x[0] - stops.right) <= ON_STOP * size:
        x[0] = stops.right


@jit
def to_masses(point, x, scratch):
    """The state x, in contact coordinates, of the masses themselves."""
    if point.turned:
        turn(point.back, x, scratch)
        for j in range(len(point.P)):
            x[2 * j] += point.origin[j]
