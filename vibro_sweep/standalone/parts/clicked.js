// The orbit at a value of the swept number: what a click shows of it.

import { heightOf } from "./heights.js";

const SAMPLES = 200; // in a forcing period; at most
const MOST_SHOWN = 12, UNSETTLED = 8; // forcing periods: of a periodic orbit, of another one
const LONGEST = 60; // forcing periods of which impacts are counted
const SAME = 1e-7; // of a forcing period: times that differ by less are the same

export function orbitOf(kernel, task, diagram, motion) {
  const [v] = task.each, found = diagram(kernel, task), T = (2 * Math.PI) / v.omega, [period] = found.period;
  const words = { status: found.status[0], period, T, known: found.known[0], periods: 0 };
  const arrays = { exponents: found.lyapunov, errors: found.lyapunov_error, section: Float32Array.from(found.sections) };
  if (!found.known[0] || (found.status[0] !== 0 && found.status[0] !== task.notSettled)) return { words, arrays };
  const shown = period ? Math.min(period, MOST_SHOWN) : UNSETTLED, whole = period && period <= LONGEST ? period : shown;
  const samples = Math.min(SAMPLES * whole, 2400) + 1, flight = motion(kernel, v, task.plan, whole, samples);
  if (flight.status !== 0) return { words: { ...words, status: flight.status }, arrays };
  const inside = flight.t.findLastIndex((t) => t <= shown * T * (1 + 1e-9)) + 1;
  arrays.t = flight.t.slice(0, inside);
  arrays.states = flight.states.slice(0, inside * 2 * kernel.layout.masses);
  const all = flight.impacts.filter(({ t }) => t < whole * T * (1 - 1e-9)), seen = all.filter(({ t }) => t <= shown * T);
  arrays.impact_t = Float32Array.from(seen, ({ t }) => t);
  arrays.impact_side = Int8Array.from(seen, ({ side }) => side);
  const pressed = contacts(v, flight), drawn = pressed.filter(([touch]) => touch <= shown * T);
  arrays.contact_touch = Float32Array.from(drawn, ([touch]) => touch);
  arrays.contact_release = Float32Array.from(drawn, ([, release]) => Math.min(release, shown * T));
  const begun = pressed.filter(([touch]) => touch > 0).length; // one that goes on at t = 0 begins at the end
  const itinerary = period && whole === period ? word(all, T, period * T) : "";
  return { words: { ...words, periods: shown, impacts: all.length, rests: 0, contacts: begun, itinerary, orbit_status: "ok" }, arrays };
}

// [from, to] of each time that compliant stops are pressed, to within a sample
function contacts(v, { t, states }) {
  const { low, high, normal, pressed } = heightOf.stops(v), found = [], width = 2 * normal.length;
  let inside = false;
  for (let n = 0; n < t.length; n++) {
    const gap = normal.reduce((sum, by, i) => sum + by * states[n * width + 2 * i], 0);
    const beyond = (pressed[0] && gap < low) || (pressed[1] && gap > high);
    if (beyond && !inside) found.push([t[n], t[t.length - 1]]);
    if (!beyond && inside) found.at(-1)[1] = t[n];
    inside = beyond;
  }
  return found;
}

// the stops that are hit, as R and L, from the impact with which the least rotation begins, L < R; ties by the time in
// the forcing period, then by the flights that follow (analysis/periodic/itinerary.py)
function word(impacts, T, length) {
  const letters = impacts.map(({ side }) => (side > 0 ? "R" : "L")).join(""), n = letters.length;
  if (!n) return "";
  const rotation = (k) => letters.slice(k) + letters.slice(0, k);
  let best = [...Array(n).keys()];
  const least = best.map(rotation).reduce((a, b) => (b < a ? b : a));
  best = best.filter((k) => rotation(k) === least);
  return rotation(best[0]);
}
