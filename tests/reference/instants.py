"""What happens at one instant: impacts one after the other, touches and releases, who is held, everything else.

The rules: of all closed rigid stops that are approached, the first of the list is struck with its own R, then all are
looked at again. Candidates to be held are closed rigid stops, preloaded ones and friction elements without speed. All
of them are held at first; then the first whose state contradicts itself changes, until none does. Exactly at a limit
the first coefficient of the Taylor series that is not zero decides; if all are zero, the state holds.
"""

from flint import arb, arb_mat

from reference.balls import from_ball, to_ball
from reference.flow import FREE, HELD, PRESSED, RELAXING, SLIP

MOST_IMPACTS = 1000  # at one instant
MOST_CHANGES = 1000  # of modes at one instant, with static_force; then with friction_force


def order_and_sign(c, sizes, small, zeros=0):
    """The first coefficient beyond rounding and its sign; None, 0 if there is none. The first `zeros` count as 0."""
    least = float(small) * sizes.max()
    for n in range(zeros, len(c)):
        if abs(float(c[n])) > least:
            return n, 1 if c[n] > 0 else -1
    return None, 0


class Instant:
    """The events of a Motion at its time t."""

    def __init__(self, motion):
        self.m, self.phases = motion, motion.phases
        self.elements, self.before = motion.phases.elements, motion.modes
        self.delayed = {}  # rests that begin when the chatter still to come is over

    def start(self, limits):
        """Modes at the start: free, but for stops that relax, stops that are pressed, and slips."""
        m, modes = self.m, []
        for e, element in enumerate(self.elements):
            if element.rubs:
                w = m.value(self.phases.speed(e))
                modes.append(HELD if abs(w) <= m.small else SLIP[1 if w > 0 else -1])
                continue
            depth, s = m.value(self.phases.depth(e)), m.began.get(e, arb(0))
            inside = depth - s > self.tolerance(element)
            if element.rigid and inside:
                raise ValueError("the start lies behind a stop")
            mode = RELAXING if e in m.began else FREE
            if element.compliant and inside:
                if element.law.relaxes and m.value(self.phases.force(e)) < 0:
                    m.relax(e)
                    mode = RELAXING
                else:
                    mode = PRESSED
                    m.press(e)
            modes.append(mode)
        m.modes, self.before = tuple(modes), tuple(FREE if mode == HELD else mode for mode in modes)
        self.happen(None, limits)

    def tolerance(self, element):
        return self.m.small * (1 + abs(to_ball(element.law.place)))

    def happen(self, hit, limits):
        m = self.m
        phase = self.phases.phase(m.modes)
        self.near = {name for name in phase.flow.names if name == hit or self.is_near(phase, name)}
        speeds = [abs(a) for a in m.y.entries()[1 : 2 * self.phases.N : 2]]
        belts = [abs(to_ball(element.law.belt_speed)) for element in self.elements if element.rubs]
        m.fastest = max([m.fastest, *speeds, *belts])
        self.slow = m.small * m.fastest
        self.closed = [
            e for e, el in enumerate(self.elements) if el.rigid and (m.modes[e] == HELD or ("reach", e) in self.near)
        ]
        self.impacts(limits)
        if limits.get("impacts") is not None and m.enough(limits):
            return
        modes, candidates = list(m.modes), []
        for e, element in enumerate(self.elements):
            speed = m.value(self.phases.speed(e))
            if element.compliant:
                modes[e] = self.compliant(e, element, modes[e], speed, candidates)
            elif element.rubs or e in self.closed:
                if abs(speed) <= self.slow or e in self.delayed:
                    candidates.append(e)
                else:
                    modes[e] = SLIP[1 if speed > 0 else -1] if element.rubs else FREE
        m.decided = set(candidates) | set(self.closed) | {e for _, e in self.near}
        m.modes = self.settled(modes, candidates)
        self.report()

    def is_near(self, phase, name):
        """Whether a guard is zero at this time, or will be within the resolution of times."""
        c, sizes = phase.flow.series(name, self.m.y)
        late = abs(self.m.t / phase.flow.h) * abs(c[1])
        return c[0] <= self.m.small * (to_ball(float(sizes.max())) + late)

    def impacts(self, limits):
        m, struck = self.m, []
        for _ in range(MOST_IMPACTS):
            e = next((e for e in self.closed if m.value(self.phases.speed(e)) > self.slow), None)
            if e is None:
                break
            speed, law = m.value(self.phases.speed(e)), self.elements[e].law
            m.log("impact", e, law.side, speed)
            if limits.get("impacts") is not None and m.enough(limits):
                return
            m.taken += (1 - to_ball(law.R) ** 2) * speed * speed / (2 * self.yielding(e))
            self.kick(e, -(1 + to_ball(law.R)) * speed)
            struck.append(e)
        else:
            self.stop_all()
        if len(struck) == 1:
            self.chatter(struck[0])

    def yielding(self, e):
        """row M^-1 row^T: the change of delta' by an impulse 1."""
        return (self.phases.rows[e] * self.phases.push[e])[0, 0].mid()

    def kick(self, e, change):
        """Change delta' of this element, by an impulse along its row."""
        self.impulse(self.phases.push[e] * (change / self.yielding(e)))

    def impulse(self, v):
        y = self.m.y.entries()
        for i in range(self.phases.N):
            y[2 * i + 1] = (y[2 * i + 1] + v[i, 0]).mid()
        self.m.y = arb_mat(self.phases.size, 1, y)

    def stop_all(self):
        """Impacts without end: all closed stops that are approached are brought to rest together."""
        stopped = []
        while more := [e for e in self.closed if e not in stopped and self.m.value(self.phases.speed(e)) > self.slow]:
            stopped = sorted([*stopped, *more])
            self.bring_to_rest(stopped)

    def bring_to_rest(self, elements):
        """Project the velocities in the metric of M, so that these elements have none."""
        modes = tuple(HELD if e in elements else FREE for e in range(len(self.elements)))
        carrying = list(self.phases.phase(modes).reactions)
        if carrying:
            rows = arb_mat([self.phases.rows[e].entries() for e in carrying])
            speeds = arb_mat([[self.m.value(self.phases.speed(e))] for e in carrying])
            gram = self.phases.phase(modes).gram(rows, carrying)
            for e, (impulse,) in zip(carrying, gram.solve(speeds).tolist(), strict=True):
                self.impulse(self.phases.push[e] * -impulse)

    def chatter(self, e):
        """Whether the impacts still to come on this stop can be summed up, as a geometric series."""
        m, R = self.m, to_ball(self.elements[e].law.R)
        modes = tuple(FREE if i == e else mode for i, mode in enumerate(m.modes))
        flow = self.phases.phase(modes).flow
        c, _ = flow.series(("depth", e), m.y, self.phases.depth(e))
        speed, pull = -c[1] / flow.h, 2 * c[2] / flow.h**2
        if speed > self.slow and pull > 0 and 2 * speed < m.small.sqrt() * pull * (1 - R):
            self.delayed[e] = from_ball(m.t + 2 * speed / (pull * (1 - R)))

    def compliant(self, e, element, mode, speed, candidates):
        """The mode of a compliant stop after this instant; where speed does not tell it, a candidate."""
        m, law = self.m, element.law
        if mode == PRESSED and law.relaxes and (("force", e) in self.near or m.value(self.phases.force(e)) < 0):
            m.release(e)
            m.relax(e)
            return RELAXING
        if mode == RELAXING and ("reach", e) in self.near:
            s = m.y[self.phases.place_of_s[e], 0]
            of_stop = -(to_ball(law.k) * s + to_ball(law.p)) / to_ball(law.c)
            if speed - of_stop > self.slow:
                m.press(e)
                return PRESSED
            return RELAXING
        if ("relaxed", e) in self.near:
            m.forget(e)
            return FREE
        if mode == HELD or {("reach", e), ("open", e)} & self.near:
            if abs(speed) <= self.slow:
                candidates.append(e)
                return mode
            if speed > 0 and mode != PRESSED:
                m.press(e)
            elif speed < 0 and mode == PRESSED:
                m.release(e)
            return PRESSED if speed > 0 else FREE
        return mode

    def settled(self, modes, candidates):
        """Who is held: begin with all candidates, and change the first whose state contradicts itself."""
        self.bring_to_rest([e for e in candidates if self.can_be_held(e)])
        for e in candidates:
            modes[e] = HELD if self.can_be_held(e) else FREE
        for change in range(2 * MOST_CHANGES):
            phase = self.phases.phase(tuple(modes))
            for e in candidates:
                mode = self.contradiction(phase, e, modes[e], change < MOST_CHANGES)
                if mode is not None:
                    modes[e] = mode
                    break
            else:
                return tuple(modes)
        raise ArithmeticError("nobody knows who is held")

    def can_be_held(self, e):
        return not self.elements[e].compliant or self.elements[e].law.p > 0

    def contradiction(self, phase, e, mode, static):
        """The mode that this element has instead; None if nothing contradicts."""
        element, law = self.elements[e], self.elements[e].law
        sign = lambda name, row, zeros: self.sign(phase, (name, e), row, zeros)  # noqa: E731
        if mode == HELD and e in phase.reactions:
            reaction, number = phase.reactions[e], lambda a: self.phases.function(e, constant=to_ball(a))
            if element.rubs:
                limit = number(law.static_force if static else law.friction_force)
                if sign(f"up {static}", limit - reaction, 0) < 0:
                    return SLIP[1]
                if sign(f"down {static}", limit + reaction, 0) < 0:
                    return SLIP[-1]
            elif sign("pull", reaction, 0) < 0:
                return FREE
            elif element.compliant and sign("press", number(law.p) - reaction, 0) < 0:
                return PRESSED
        elif mode == FREE and sign("depth", self.phases.depth(e), 2) > 0:
            return HELD if self.can_be_held(e) else PRESSED
        elif mode == PRESSED and sign("depth", self.phases.depth(e), 2) < 0:
            return HELD if self.can_be_held(e) else FREE
        elif mode in SLIP.values() and sign("slip", self.phases.speed(e) * (1 if mode == SLIP[1] else -1), 1) < 0:
            return HELD
        return None

    def sign(self, phase, name, row, zeros):
        c, sizes = phase.flow.series(name, self.m.y, row)
        return order_and_sign(c, sizes, self.m.small, zeros)[1]

    def report(self):
        """What has changed: contacts, rests, sticks and slips begin and end."""
        m = self.m
        for e, (element, old, new) in enumerate(zip(self.elements, self.before, m.modes, strict=True)):
            side = 0 if element.rubs else element.law.side
            if element.compliant and new == PRESSED and e not in m.touched:
                m.press(e)
            if element.compliant and new != PRESSED and e in m.touched:
                m.release(e)
            if new == HELD and old != HELD:
                t = self.delayed.get(e, from_ball(m.t))
                m.log("stick" if element.rubs else "rest", e, side, t=t)
                if not element.rubs:
                    m.rest_since[e] = t
            elif old == HELD and new != HELD and not element.rubs:
                m.log("leave", e, side)
                m.end_rest(e, m.rest_since.pop(e))
            elif new in SLIP.values() and new != old and m.started:
                m.log("slip", e, 1 if new == SLIP[1] else -1)
        m.started = True
