"""The events of an orbit, each held against the exact flight from the one before.

From the state after each event, doubles taken as exact, the flight is followed to the next one in the working
precision, so that chaos plays no part. An error is told in units of the effect of rounding: the sum of what one part in
2^53 of every input of the flight (parameters, force, time, state) does to the result, of the clearance does to x1 on
the way, and what the state does if it is rounded once on the way, at any moment: a displacement by one part in 2^53
makes a stiff spring swing, and speeds of the result are no better known than that swing allows. For this, the state
has the largest displacement, and speed, of each mass at the events. A contact that goes less than `NEAR` times the
effect of rounding on x1 beyond the stop, or misses it by less, is a graze within rounding: both answers are right, and
it is counted apart. After a rest the flight begins with the exact state at the exact release.
"""

from dataclasses import dataclass, field

from mpmath import mp, mpf

from reference.flights import NAMES, SIDES, Flight, NoChatterError, Oscillator, Rest, chatter, clear_until

DIGITS = 60
PART = mpf(2) ** -53
NEAR = 64
NOTHING = mpf(2) ** -106  # a restitution below this is none


@dataclass
class Findings:
    """What was found along one orbit."""

    errors: dict = field(default_factory=dict)  # largest of each kind, in units of the effect of rounding
    defects: list = field(default_factory=list)
    checked: int = 0
    grazes: int = 0  # within rounding: either answer is right
    unchecked: int = 0

    def error(self, kind, found, exact, effect, event):
        scaled = float(abs(mpf(found) - exact) / (effect + PART * abs(exact)))
        worst = self.errors.get(kind)
        if worst is None or not scaled <= worst[0]:
            self.errors[kind] = (scaled, float(abs(mpf(found) - exact)), event)

    def defect(self, kind, event, **details):
        self.defects.append({"kind": kind, "event": event, **{name: plain(x) for name, x in details.items()}})


def plain(x):
    if isinstance(x, (tuple, list)):
        return [plain(a) for a in x]
    return float(x) if isinstance(x, mpf) else x


class Follower:
    """Checks the events of one orbit. params: the numbers by name, tau in radians, and `stops`."""

    def __init__(self, params, accuracy):
        self.params, self.accuracy = params, accuracy
        self.R, self.b = mpf(params["R"]), mpf(params["b"])
        self.sides, self.period = SIDES[params["stops"]], 2 * mp.pi / mpf(params["omega"])
        self.o = Oscillator(params)
        self.moved = [
            *(Oscillator({**params, n: mpf(params[n]) * (1 + PART)}) for n in NAMES if params[n]),
            Oscillator(params, 1 + PART),
        ]
        self.found = Findings()
        self.legs = []  # (time, state) at the beginning of each flight

    def others(self, t, state):
        """The flight with every input moved in turn, and by how much that moves the stops."""
        for o in self.moved:
            yield Flight(o, t, state), 0
        if t:
            yield Flight(self.o, t * (1 + PART), state), 0
        on_stop = abs(state[0]) == self.b
        for i in range(4):
            if state[i]:
                changed = list(state)
                changed[i] *= 1 + PART
                yield Flight(self.o, t, changed), (self.b * PART if i == 0 and on_stop else 0)
        if not on_stop:
            yield Flight(self.o, t, state), self.b * PART

    def effect(self, t, state, u, side):
        """Of rounding: on the gap at the time u of a flight; on the time, v1, x2, v2 of a contact there."""
        _, v1, a1, _, v2, a2 = at = Flight(self.o, t, state).at(u)
        total = [mpf(0)] * 5
        for flight, wall in self.others(t, state):
            d = [p - q for p, q in zip(flight.at(u), at, strict=True)]
            gap = wall - side * d[0]
            late = side * gap / v1 if v1 else mp.inf
            for i, x in enumerate((gap, late, d[1] + a1 * late, d[3] + v2 * late, d[4] + a2 * late)):
                total[i] += abs(x)
        late = PART * self.b / abs(v1) if v1 else mp.inf
        floor = (PART * self.b, late, abs(a1) * late, abs(v2) * late, abs(a2) * late)
        return [x + y + PART * size for x, y, size in zip(total, floor, (0, 0, *self.sizes), strict=True)]

    def follow(self, t, state, impacts, rests, end, count):
        """Check the first `count` events after the start (t, state).

        impacts: (t, side, v1, x2, v2); rests: (t_on, t_off or None, side). end: of the simulation, None where it broke
        off. A rest counts as two events.
        """
        events = sorted([(hit[0], 0, hit) for hit in impacts] + [(rest[0], 1, rest) for rest in rests])
        t, state, n, order = mpf(t), tuple(mpf(x) for x in state), 0, 1
        v1, x2, v2 = (max(map(abs, column)) for column in zip(state[1:], *(hit[2:] for hit in impacts), strict=True))
        self.sizes = self.o.largest(self.b, v1, x2, v2)[1:]
        while True:
            _, is_rest, event = events.pop(0) if events else (None, False, None)
            side = next((s for s in self.sides if state[0] == s * self.b), 0)
            if side and side * state[1] > 0:  # a start with the speed into the stop
                late = abs(event[0] - t) if event else mp.inf  # the time is rounded on its way through the cells
                if late > 8 * PART * (abs(t) + self.period) or is_rest or event[1:3] != (side, state[1]):
                    return self.found.defect("no impact at the start", n, t=t, state=state, hit=event)
            elif is_rest:
                if not side or order == 3:
                    return self.found.defect("rest without impact", n, t=t, state=state, rest=event)
                onset = self.onset(n, t, state, side, event[0])
                if onset is None:
                    return None
                after = self.rest(n, onset[0], side, *onset[1:], event[1], end)
                n += 2
                if after is None or n >= count:
                    return None
                (t, state), order = after, 3
                continue
            else:
                if side and state[1] == 0 and order == 1:
                    order = self.leaves(n, t, state, side)
                if event or end is not None:
                    self.flight(n, t, state, order, event, end)
            if event is None:
                return None
            t, order = mpf(event[0]), 1
            rebound = -self.R * event[2] if self.R > NOTHING else mpf(0)
            state = (event[1] * self.b, rebound, *map(mpf, event[3:]))
            n += 1
            if n >= count:
                return None

    def leaves(self, n, t, state, side):
        """M1 is on a stop without speed, and the engine lets it go: the order of its first derivative that is not 0."""
        derivatives = Flight(self.o, t, state).gap(side, self.b).derivatives(mpf(0), 6)
        if derivatives[2] < 0:
            noise, _ = self.rest_effect(t, side, state[2], state[3], mpf(0))
            if -derivatives[2] > NEAR * noise:
                self.found.defect("no rest", n, t=t, state=state, pull=derivatives[2])
            else:
                self.found.grazes += 1
                return 3
        return next(k for k in range(2, 6) if abs(derivatives[k]) > mpf(10) ** (-DIGITS + 15) or k == 5)

    def flight(self, n, t, state, order, hit, end):
        """The flight from (t, state) to the impact `hit` (t, side, v1, x2, v2), or without contact to the time `end`.

        order: of the first derivative of the gap that is not zero, where M1 is on a stop.
        """
        flight = Flight(self.o, t, state)
        self.legs.append((t, state))
        until = mpf(hit[0] if hit else end) - t
        slack = (until * mpf(2) ** -20 + abs(t) * mpf(2) ** -45) if hit else mpf(0)
        contacts = []
        for side in self.sides:
            gap, start = flight.gap(side, self.b), mpf(0)
            if state[0] == side * self.b:
                leading, start = clear_until(gap, order)
                if leading < 0:
                    return self.found.defect("passes the stop at once", n, t=t, state=state, side=side)
            while True:
                limit = min([until + slack, *(u for u, _ in contacts)])
                u = gap.first_zero(start, limit)
                if u is None:
                    break
                if hit and abs(u - until) <= slack and side == hit[1]:
                    contacts.append((u, side))
                    break
                deepest = self.deepest(gap, u, limit)
                depth = -gap.derivatives(deepest, 1)[0]
                noise = self.effect(t, state, deepest, side)[0]
                if depth > NEAR * noise:
                    contacts.append((u, side))
                    break
                self.found.grazes += 1
                start = max(self.above(gap, deepest, limit), deepest + (limit - deepest) * mpf(2) ** -30)
        first = min(contacts, default=None)
        if hit is None:
            if first:
                self.missed(n, t, state, order, first, hit, flight)
            return
        if first and first[1] == hit[1] and abs(first[0] - until) <= slack:
            self.compare(n, t, state, *first, hit, flight)
        elif first:
            self.missed(n, t, state, order, first, hit, flight)
        else:
            miss = flight.gap(hit[1], self.b).derivatives(until, 1)[0]
            noise = self.effect(t, state, until, hit[1])[0]
            if abs(miss) <= NEAR * noise:
                self.found.grazes += 1
            else:
                ratio = miss / noise
                self.found.defect("invented or early", n, t=t, state=state, hit=hit, miss=miss, noises=ratio)

    def deepest(self, gap, u, limit):
        """Where the gap, negative from u on, is least before it rises or the limit comes."""
        end = gap.derivative().times(-1).first_zero(u, limit)
        return limit if end is None else end

    def above(self, gap, deepest, limit):
        """Where the gap, negative at `deepest`, is positive again, or the limit."""
        end = gap.times(-1).first_zero(deepest, limit)
        return limit if end is None else end

    def missed(self, n, t, state, order, contact, hit, flight):
        u, side = contact
        deepest = self.deepest(flight.gap(side, self.b), u, u + (mpf(hit[0]) - t - u if hit else u))
        depth = -flight.gap(side, self.b).derivatives(deepest, 1)[0]
        noise = self.effect(t, state, deepest, side)[0]
        kind = "missed or late"
        if order > 1 and state[0] == -side * self.b:
            kind = "opposite stop not looked at"
        details = dict(t=t, state=state, contact=t + u, side=side, v1=flight.at(u)[1], depth=depth / self.b, hit=hit)
        self.found.defect(kind, n, order=order, noises=depth / noise, **details)

    def compare(self, n, t, state, u, side, hit, flight):
        _, v1, _, x2, v2, _ = flight.at(u)
        noise = self.effect(t, state, u, side)
        exact = (t + u, v1, x2, v2)
        for kind, found, value, effect in zip(
            ("t", "v1", "x2", "v2"), (hit[0], *hit[2:]), exact, noise[1:], strict=True
        ):
            self.found.error(kind, found, value, effect, n)
        self.found.checked += 1

    def onset(self, n, t, state, side, t_on):
        """Chatter from just after an impact to the onset of rest -> (time, x2, v2), or None."""
        if state[1] == 0:
            on, x2, v2 = t, state[2], state[3]
        else:
            try:
                on, x2, v2 = chatter(self.o, self.R, side, t, state, self.accuracy * mpf(2) ** -12)
            except NoChatterError as error:
                self.found.unchecked += 1
                if "points away" in str(error):
                    self.found.defect("rest invented", n, t=t, state=state, why=str(error), t_on=t_on)
                return None
        w = on - t
        effect = abs(t) * PART + (w * PART * (4 + 4 / (1 - self.R)) if w else 0) + self.accuracy
        self.found.error("t_on", t_on, on, effect, n)
        return on, x2, v2

    def rest(self, n, on, side, x2, v2, t_off, end):
        """Rest from its onset to the release -> (time, state) there, or None if it outlasts the simulation."""
        x1 = side * self.b
        rest = Rest(self.o, on, x1, x2, v2)
        pull = rest.pull.times(side)
        until = mpf(t_off if t_off is not None else end) - on
        first, start = pull.derivatives(mpf(0), 1)[0], mpf(0)
        if first <= 0:
            noise, _ = self.rest_effect(on, side, x2, v2, mpf(0))
            if -first > NEAR * noise:
                self.found.defect("rest against a pull away", n, t=on, pull=first, noises=-first / noise, t_off=t_off)
                return None
            self.found.grazes += 1
            start = until
        slack = until * mpf(2) ** -20 + abs(on) * mpf(2) ** -45 if t_off is not None else mpf(0)
        u = pull.first_zero(start, until + slack) if start < until + slack else None
        if t_off is None:
            if u is not None:
                self.found.defect("release missed", n, t=on, x2=x2, v2=v2, side=side, release=on + u)
            return None
        if u is None:
            value = pull.derivatives(until, 1)[0]
            noise, _ = self.rest_effect(on, side, x2, v2, until)
            if abs(value) > NEAR * noise:
                self.found.defect("release invented", n, t=on, x2=x2, v2=v2, t_off=t_off, noises=value / noise)
                return None
            self.found.grazes += 1
            u = until
        elif abs(u - until) > slack:
            noise, late = self.rest_effect(on, side, x2, v2, u)
            if abs(u - until) > NEAR * late:
                self.found.defect("release late", n, t=on, x2=x2, v2=v2, release=on + u, t_off=t_off, side=side)
                return None
            self.found.grazes += 1
            u = until
        else:
            _, late = self.rest_effect(on, side, x2, v2, u)
            self.found.error("t_off", t_off, on + u, late + self.accuracy, n)
        x2, v2 = rest.x2.derivatives(u, 2)
        return on + u, (x1, mpf(0), x2, v2)

    def rest_effect(self, on, side, x2, v2, u):
        """Of rounding: on the free acceleration at the time u of a rest, and on the time of a release there."""
        x1 = side * self.b
        value, slope = Rest(self.o, on, x1, x2, v2).pull.derivatives(u, 2)
        others = [Rest(o, on, x1, x2, v2) for o in self.moved]
        others.append(Rest(self.o, on * (1 + PART), x1, x2, v2))
        others.append(Rest(self.o, on, x1 * (1 + PART), x2, v2))
        others.append(Rest(self.o, on, x1, x2 * (1 + PART), v2))
        others.append(Rest(self.o, on, x1, x2, v2 * (1 + PART)))
        noise = sum(abs(other.pull.derivatives(u, 1)[0] - value) for other in others)
        return noise, abs(noise / slope) if slope else mp.inf
