// Points, blocks of orbits and the motion of one orbit, by the kernel. Rates are those of the machine's own time in the
// kernel (oscillator/own_time.py), and of the user's in all that comes in and goes out.

import { numbersOf, powers, STOPS } from "./oscillator.js";
import { restState, steadyGap } from "./steady.js";

const SET_UP = 0, DIAGRAM = 1, TRAJECTORY = 2;
const ROUND = 64; // sizes are multiples of this
const FAR = 1000; // times their distance: stops that lie so far on one side of 0
const NOT_SET_UP = 100; // status of what this page cannot compute
const ROOM = { hits: 4096, samples: 2401, periods: 60, kept: 2400 }; // of the motion of an orbit
const READ = { i1: "getInt8", i4: "getInt32", i8: "getBigInt64", f8: "getFloat64" };

// set up the points of these numbers, as of controls; returns which could be, and the rate of their own time
function setUp(kernel, each, plan) {
  const { layout } = kernel, m = each.length, width = layout.machine, rate = 2 ** Math.round(Math.log2(each[0].omega));
  const scales = powers.map((power) => rate ** power);
  const machines = each.map((v) => numbersOf(v).map((value, n) => value / scales[n]));
  const steady = machines.map(steadyGap), follows = each.map((v) => typeof v.tau !== "number");
  machines.forEach((numbers, i) => { // (18): the phase at which the steady gap is largest at t = 0; 0 where there is none
    if (follows[i]) numbers[width - 1] = steady[i] ? Math.atan2(-steady[i].imaginary, steady[i].real) : 0;
    kernel.floats("machines", width, i * width).set(numbers.slice(0, width));
    kernel.floats("stops", 4, 4 * i).set(numbers.slice(STOPS, STOPS + 4));
    if (layout.compliant) kernel.floats("laws", 6, 6 * i).set(numbers.slice(STOPS + 4));
  });
  kernel.set("task", SET_UP);
  kernel.set("plan.lyapunov", plan.lyapunov);
  for (const name of ["machines", "known"]) kernel.shape(name, m);
  kernel.shape("stops", m, 4);
  if (layout.compliant) kernel.shape("laws", m, 2, 3);
  kernel.set("release", layout.release);
  kernel.shape("points", 1, m);
  kernel.call();
  const known = new Uint8Array(kernel.memory.buffer, kernel.place.known.at, m).slice();
  const { at } = kernel.place.points, { size, cells: [cells] } = layout.point;
  machines.forEach((numbers, i) => { // its phase and rest are known, too, and 0 is near enough to count from
    const [low, high] = numbers.slice(STOPS), far = Math.max(low, -high) > FAR * (high - low);
    if (!far && !(follows[i] && steady[i] === undefined) && restState(numbers)) return;
    kernel.view.setBigInt64(at + i * size + cells, 0n, true);
    known[i] = 0;
  });
  return { known, rate, steady };
}

const rounded = (count) => ROUND * Math.ceil(count / ROUND);

function read(kernel, array, fields, i, name, n = 0) {
  const [offset, type] = fields[name], value = kernel.view[READ[type]](kernel.place[array].at + i * fields.size + offset + n * Number(type[1]), true);
  return typeof value === "bigint" ? Number(value) : value;
}

const pointOf = (kernel, i, name, n = 0) => read(kernel, "points", kernel.layout.point, i, name, n);
const resultOf = (kernel, i, name, n = 0) => read(kernel, "results", kernel.layout.result, i, name, n);

// parts of the record, of which the errors of exponents follow
const partsOf = (kernel, plan) => (plan.lyapunov ? Math.min(plan.record, kernel.layout.batches) : 0);

// room for a block, with cells enough for its points
function prepare(kernel, each, plan) {
  const sizes = { orbits: rounded(each.length), record: plan.record, logged: plan.side ? plan.record : 0, parts: partsOf(kernel, plan), ...ROOM };
  let { cells } = kernel;
  for (;;) {
    kernel.make({ ...sizes, cells });
    const found = setUp(kernel, each, plan);
    const most = Math.max(...each.map((_, i) => pointOf(kernel, i, "cells")));
    if (most <= cells) return found;
    kernel.cells = cells = rounded(most);
  }
}

// the orbits of a block: side by side, or one after the other in a chain. starts: states of the masses, and of a chain
// that goes on where it has come to: {begun}. Returns arrays over the orbits.
export function diagram(kernel, { each, starts, plan, chain, begun }) {
  const { layout } = kernel, m = each.length, states = 2 * layout.masses, width = states + 3;
  const { known, rate, steady } = prepare(kernel, each, plan), orbits = chain ? 1 : m;
  for (const [name, value] of Object.entries({
    transient: plan.transient, record: plan.record, warm_up: plan.lyapunov ? Math.min(plan.transient, layout.warm_up) : 0, settle: 0,
    states: true, lyapunov: plan.lyapunov, impacts: false, contacts: false, energy: false, attractors: false, section_side: plan.side,
    periods: 0, parts: partsOf(kernel, plan), order: 0, step: 0,
  })) kernel.set(`plan.${name}`, value);
  kernel.set("task", DIAGRAM);
  const lead = chain ? [m, 1] : [1, m];
  kernel.shape("points", ...lead);
  kernel.shape("results", ...lead);
  kernel.shape("sections", ...lead, plan.record, states);
  kernel.shape("phases", ...lead, plan.side ? plan.record : 0);
  kernel.shape("running", ...lead, 0, states);
  kernel.shape("starts", 2, orbits, width);
  kernel.shape("w.ensemble.records.times", 0, 2);
  kernel.shape("w.ensemble.records.samples", 0, states);
  const fill = Uint8Array.from(layout.fill.match(/../g), (two) => parseInt(two, 16));
  for (let i = 0; i < m; i++) kernel.bytes.set(fill, kernel.place.results.at + i * fill.length);
  kernel.floats("sections", m * plan.record * states).fill(NaN);
  for (let step = 0; step < 2; step++) {
    for (let i = 0; i < orbits; i++) {
      const row = kernel.floats("starts", width, (step * orbits + i) * width);
      row.set(starts[i]);
      row.set([0, 0, NaN], states);
      for (let j = 1; j < states; j += 2) row[j] /= rate;
      if (step === 0 && begun) row.set(begun);
    }
  }
  kernel.call();
  const sections = kernel.floats("sections", m * plan.record * states).slice();
  for (let j = 1; j < sections.length; j += 2) sections[j] *= rate;
  const exponents = (name) => Float32Array.from({ length: plan.lyapunov ? m * states : 0 }, (_, n) => rate * resultOf(kernel, Math.floor(n / states), name, n % states));
  const ends = Float64Array.from({ length: m * states }, (_, n) => resultOf(kernel, Math.floor(n / states), "end", n % states) * (n % 2 ? rate : 1));
  const last = m - 1, own = Array.from({ length: states }, (_, j) => resultOf(kernel, last, "end", j));
  return {
    sections, ends, known,
    status: Int8Array.from({ length: m }, (_, i) => (known[i] ? resultOf(kernel, i, "status") : NOT_SET_UP)),
    period: Int32Array.from({ length: m }, (_, i) => resultOf(kernel, i, "period")),
    lyapunov: exponents("lyapunov"), lyapunov_error: exponents("lyapunov_error"),
    steady: steady[0],
    begun: Number.isFinite(own[0]) ? [...own, 0, 0, pointOf(kernel, last, "tau")] : null,
  };
}

// the end of an orbit in contact coordinates, behind no rigid stop, and at one where it rests (driver/energy_columns.py)
function beginAtContact(kernel) {
  const { layout } = kernel, N = layout.masses, { at } = kernel.place.results, [offset] = layout.result.end;
  let [low, high] = kernel.floats("stops", 2);
  if (layout.compliant && kernel.floats("laws", 6)[0] > 0) low = -Infinity;
  if (layout.compliant && kernel.floats("laws", 6)[3] > 0) high = Infinity;
  const side = resultOf(kernel, 0, "resting"), wall = side > 0 ? high : low, rests = side !== 0 && Number.isFinite(wall);
  const state = Array.from({ length: 2 * N }, (_, j) => {
    let sum = 0;
    for (let i = 0; i < N; i++) sum += pointOf(kernel, 0, "P", Math.floor(j / 2) * N + i) * resultOf(kernel, 0, "end", 2 * i + (j % 2));
    return sum;
  });
  state[0] = rests ? wall : Math.min(Math.max(state[0], low), high);
  if (rests) state[1] = 0;
  state.forEach((value, j) => kernel.view.setFloat64(at + offset + 8 * j, value, true));
}

// the motion of the orbit that `diagram` has just computed alone, over so many periods more
export function motion(kernel, each, plan, periods, samples) {
  const { layout } = kernel, N = layout.masses, states = 2 * N, rate = 2 ** Math.round(Math.log2(each.omega));
  beginAtContact(kernel);
  kernel.set("task", TRAJECTORY);
  kernel.set("plan.periods", periods);
  kernel.set("plan.lyapunov", false);
  kernel.shape("w.ensemble.records.times", samples, 2);
  kernel.shape("w.ensemble.records.samples", samples, states);
  kernel.shape("kept.samples", 1, 1, samples, states);
  kernel.shape("kept.sections", 1, 1, periods + 1, states);
  kernel.call();
  const status = resultOf(kernel, 0, "status");
  if (status !== 0) return { status };
  const back = Array.from({ length: N * N }, (_, n) => pointOf(kernel, 0, "back", n));
  const masses = (state) => { // of a state in contact coordinates
    const found = new Array(states);
    for (let i = 0; i < N; i++) for (let k = 0; k < 2; k++) {
      let sum = 0;
      for (let j = 0; j < N; j++) sum += back[i * N + j] * state[2 * j + k];
      found[2 * i + k] = k ? rate * sum : sum;
    }
    return found;
  };
  const T = (2 * Math.PI) / each.omega, stops = kernel.floats("stops", 2);
  const count = Math.min(Number(kernel.view.getBigInt64(kernel.place["kept.counts"].at, true)), ROOM.kept);
  const sampled = kernel.floats("kept.samples", samples * states), width = states + 2;
  const points = Array.from({ length: samples }, (_, n) => ({ t: (periods * T * n) / (samples - 1), state: masses(sampled.slice(n * states, (n + 1) * states)) }));
  const impacts = [];
  for (let n = 0; n < count; n++) {
    const [t, side, before, after, ...others] = kernel.floats("kept.impacts", width, n * width);
    impacts.push({ t: t * T, side });
    const stop = stops[side > 0 ? 1 : 0];
    points.push({ t: t * T, state: masses([stop, before, ...others]) }, { t: t * T, state: masses([stop, after, ...others]) });
  }
  points.sort((a, b) => a.t - b.t);
  return { status, t: Float32Array.from(points, (one) => one.t), states: Float32Array.from(points.flatMap((one) => one.state)), impacts, count };
}
