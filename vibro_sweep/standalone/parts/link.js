// The link of a page that computes by itself: requests go to workers of this page in place of a program. The requests
// and their answers are those of the live page.

import { heightOf } from "./heights.js";
import { refusalOf } from "./requests.js";

export const TAKEN_OVER = 4000; // no other page takes over here
export const EXPLAINS = false; // there is no continuation here, that says why a window ends
export const SHARING = "Copied. Who opens it needs this file, at the place that the link names.";
export const WAITING = "Computing";

const OTHERWISE = "That is in the address, behind #; without it the page opens as it was made.";
const PREVIEW = { columns: 256, parts: 8, transient: 300, record: 50 };
const WORKERS = Math.max(1, Math.min(8, navigator.hardwareConcurrency ?? 2));
const PIECE = 64; // columns
const RELAXING = 300; // forcing periods
const STUCK = 300; // ms that a worker may take for what is not wanted any more

export class Link {
  // on: {open, answer, closed}
  constructor(on) {
    this.on = on;
    this.seq = 0;
    this.waiting = []; // tasks
    this.complete = null; // of the last diagram: its view, and where its orbits have ended
    this.page = window.standalone.page; // by loader.js
    this.page.layout.release = this.page.release;
    this.module = window.standalone.module.then((code) => WebAssembly.compile(code));
    this.workers = Array.from({ length: WORKERS }, () => this.hire());
    queueMicrotask(() => on.open());
  }

  hire() {
    const worker = new Worker(window.standalone.worker), hired = { worker, task: null, ready: false };
    worker.onmessage = ({ data }) => this.done(hired, data);
    worker.onerror = (error) => this.fail(error);
    this.module.then((module) => {
      worker.postMessage({ module, layout: this.page.layout });
      hired.ready = true;
      this.next();
    }, (error) => this.fail(error));
    return hired;
  }

  fail(error) {
    this.on.answer({ type: "error", of: "sweep", seq: this.swept ?? 0, text: `This browser cannot run the page's code: ${error.message}` });
  }

  done(hired, data) {
    const { task } = hired;
    hired.task = null;
    if (task && !task.dropped) {
      if (data.error) task.failed(data.error);
      else task.found(data.found, data.ms);
    }
    this.next();
  }

  next() {
    for (const hired of this.workers) {
      if (!hired.ready || hired.task || !this.waiting.length) continue;
      hired.task = this.waiting.shift();
      hired.since = performance.now();
      hired.worker.postMessage({ number: hired.task.number, task: hired.task.what });
    }
  }

  // what is not wanted any more: tasks that wait go, and workers that are long at one are replaced
  drop(kind) {
    this.waiting = this.waiting.filter(({ what }) => what.kind !== kind);
    this.workers.forEach((hired, n) => {
      if (hired.task?.what.kind !== kind) return;
      hired.task.dropped = true;
      const { task } = hired;
      setTimeout(() => {
        if (hired.task !== task) return;
        hired.worker.terminate();
        this.workers[n] = this.hire();
        this.next();
      }, STUCK);
    });
  }

  enter(what, found, failed) {
    this.waiting.push({ what, found, failed, number: ++this.seq });
  }

  ask(type, values) {
    const seq = ++this.seq, refusal = values.view ? refusalOf(values.view, this.page) : "";
    if (refusal) queueMicrotask(() => this.on.answer({ type: "error", of: type, seq, text: type === "open" ? `${refusal}. ${OTHERWISE}` : refusal }));
    else queueMicrotask(() => this[type](seq, values));
    return seq;
  }

  open(seq, { view }) {
    const { model } = this.page;
    this.on.answer({ type: "model", seq, ...model, view: view ?? model.view });
  }

  save(seq, { view }) {
    const { scene, y } = view, section = { speed_right: "right", speed_left: "left" }[y];
    const whole = { ...scene, observe: ["section", "lyapunov"], ...(section && { section: { kind: "impact", stop: section } }) };
    for (const key of Object.keys(whole)) if (whole[key] === null) delete whole[key];
    this.on.answer({ type: "saved", seq, text: `${JSON.stringify(whole, null, 2)}\n` }); // JSON is YAML
  }

  window(seq) {
    this.on.answer({ type: "error", of: "window", seq, text: "This page has no continuation: `vibro-sweep windows` says why a window ends." });
  }

  sweep(seq, { view, middle }) {
    this.drop("diagram");
    this.swept = seq;
    const diagram = new Diagram(this.page, view, middle, seq);
    const failed = (text) => this.swept === seq && this.on.answer({ type: "error", of: "sweep", seq, text });
    this.complete = null;
    if (diagram.refusal) return failed(diagram.refusal);
    const pieces = diagram.pieces();
    let left = pieces.reduce((sum, chain) => sum + chain.length, 0);
    const say = (part, kind, last) => (found, ms) => {
      if (this.swept !== seq || (kind === "preview" && left === 0)) return; // a worker may be long over its first task
      diagram.keep(part, kind, found);
      const frame = diagram.frame(part, kind, found, ms);
      frame.last = last();
      if (frame.last) this.complete = { view: JSON.stringify(view), diagram };
      this.on.answer(frame);
    };
    for (const part of diagram.previews()) this.enter(diagram.task(part, "preview"), say(part, "preview", () => false), failed);
    const go = (chain, n, begun) => { // parts of a chain one after the other
      if (n === chain.length) return;
      const part = chain[n], told = say(part, "piece", () => --left === 0);
      this.enter(diagram.task(part, "piece", begun), (found, ms) => {
        go(chain, n + 1, found.begun);
        this.next(); // a worker goes on while this part is drawn
        told(found, ms);
      }, failed);
    };
    for (const chain of pieces) go(chain, 0, null);
    this.next();
  }

  orbit(seq, { view, value, start, column }) {
    this.drop("orbit");
    const { complete } = this, went_on = complete?.view === JSON.stringify(view) && column >= 0;
    const one = new Diagram(this.page, view, 0, seq, [value]), failed = (text) => this.on.answer({ type: "error", of: "orbit", seq, text });
    if (one.refusal) return failed(one.refusal);
    const task = one.orbitTask(start, went_on ? complete.diagram.endOf(column, start) : null, this.page.model.not_settled);
    this.enter(task, ({ words, arrays }) => {
      const { statuses } = this.page.model, { low, high, normal, pressed } = one.stopsAt(0);
      this.on.answer({
        type: "orbit", seq, ...words, arrays, value, start, went_on, low, high, normal, masses: this.page.layout.masses, pressed,
        alone: Boolean(view.scene.start.follow) && !went_on, mapping: false, status: statuses[words.status],
      });
    }, failed);
    this.next();
  }
}

// A diagram that is asked for: its columns, and the tasks that compute it.
class Diagram {
  constructor(page, view, middle, seq, values = null) {
    const { scene } = view, [[axis, ends]] = Object.entries(scene.sweep);
    Object.assign(this, { page, view, middle, seq, axis, scene });
    const step = (ends.stop - ends.start) / (ends.num - 1);
    this.values = values ?? Float64Array.from({ length: ends.num }, (_, n) => (n === ends.num - 1 ? ends.stop : ends.start + n * step));
    this.columns = this.values.length;
    this.numbers = numbersOfScene(page.numbers, scene.system);
    this.starts = scene.start.random ?? (scene.start.follow === "both" ? 2 : 1);
    this.plan = { transient: scene.orbit.transient, record: scene.orbit.record, lyapunov: true, side: { speed_right: 1, speed_left: -1 }[view.y] ?? 0 };
    this.ends = new Float64Array(this.columns * this.starts * 2 * page.layout.masses).fill(NaN);
    this.unknown = 0;
  }

  // why it is not computed; "" where it is
  get refusal() {
    for (const v of [this.at(0), this.at(this.columns - 1)]) {
      for (const [name, [text, low, high, open]] of Object.entries(this.page.ranges)) {
        const value = v[name];
        if (value === undefined || (typeof value !== "number" && name === "tau")) continue;
        const under = low !== null && (open ? value <= low : value < low), over = high !== null && value > high;
        if (!Number.isFinite(value) || under || over) return `${name} = ${value}: must be ${text}`;
      }
    }
    return "";
  }

  at(column) {
    const v = { ...this.numbers, [this.axis]: this.values[column] };
    if (this.axis === "frequency") v.omega = 2 * Math.PI * v.frequency;
    for (const [name, leader] of Object.entries(this.page.leaders)) v[name] ??= v[leader];
    return v;
  }

  stopsAt(column) {
    const { low, high, ...others } = heightOf.stops(this.at(column));
    return { low: Number.isFinite(low) ? low : null, high: Number.isFinite(high) ? high : null, ...others };
  }

  // columns of an early picture, in parts, so that the first dots are there soon; those of a chain start each by itself
  previews() {
    const step = Math.max(1, Math.ceil(this.columns / PREVIEW.columns));
    const parts = reversed(PREVIEW.parts).map((n) => part(n * step, PREVIEW.parts * step, this.columns, 0, this.starts));
    return parts.filter(({ columns }) => columns.length);
  }

  // chains of parts: each part of its own, every n-th column; or the parts of a chain along the swept number
  pieces() {
    const { follow } = this.scene.start;
    if (!follow) {
      const wanted = Math.ceil(Math.log2(Math.max(1, (this.columns * this.starts) / PIECE)));
      const count = 2 ** Math.min(wanted, Math.floor(Math.log2(this.columns)));
      return reversed(count).map((first) => [part(first, count, this.columns, 0, this.starts)]);
    }
    return (follow === "both" ? ["up", "down"] : [follow]).map((way, start) => {
      const parts = [];
      for (let first = 0; first < this.columns; first += PIECE) {
        const columns = Array.from({ length: Math.min(PIECE, this.columns - first) }, (_, n) => (way === "up" ? first + n : this.columns - 1 - first - n));
        parts.push({ first: Math.min(...columns), step: 1, columns, start, starts: 1, chain: true });
      }
      return parts;
    });
  }

  task({ columns, start, starts, chain }, kind, begun = null) {
    const each = columns.flatMap((column) => Array(starts).fill(this.at(column)));
    const plan = kind === "preview"
      ? { ...this.plan, transient: Math.min(this.plan.transient, PREVIEW.transient), record: Math.min(this.plan.record, PREVIEW.record), lyapunov: false }
      : this.plan;
    const inOrder = Boolean(chain) && kind === "piece", started = inOrder ? columns.slice(0, 1) : columns;
    const states = started.flatMap((column) => Array.from({ length: starts }, (_, s) => this.startAt(column, start + s)));
    return { kind: "diagram", each, plan, starts: states, chain: inOrder, begun };
  }

  orbitTask(start, end, notSettled) {
    const lead = this.page.release ? RELAXING : 0; // where stops relax is no part of a state
    const plan = { ...this.plan, side: 0, transient: end ? lead : this.plan.transient };
    return { kind: "orbit", each: [this.at(0)], plan, starts: [end ?? this.startAt(0, start)], chain: false, begun: null, notSettled };
  }

  startAt(column, start) {
    const { start: from } = this.scene, N = this.page.layout.masses;
    if (from.random) return this.drawn(column, start);
    const state = Array.from({ length: 2 * N }, (_, j) => from[`${j % 2 ? "v" : "x"}${1 + Math.floor(j / 2)}`]);
    const rest = state.some((x) => x !== undefined) ? [] : heightOf.rest(this.at(column));
    return state.map((x, j) => x ?? (j % 2 ? 0 : (rest[j / 2] ?? 0)));
  }

  // a random state with the gap between the stops; its numbers follow from the seed, the column and the start
  drawn(column, start) {
    const v = this.at(column), { low, high, normal } = heightOf.stops(v), b = Math.abs(v.b), { seed = 0, box = {} } = this.scene.start;
    const draw = generator([seed, column, start]), N = this.page.layout.masses;
    const middle = v.b >= 0 ? (v.offset ?? 0) : high < Infinity ? high - b : low + b;
    let state, gap;
    for (let attempt = 0; attempt < 100; attempt++) {
      state = Array.from({ length: 2 * N }, (_, j) => {
        const share = 2 * draw() - 1, range = box[`${j % 2 ? "v" : "x"}${1 + Math.floor(j / 2)}`];
        if (range) return range[0] + ((share + 1) / 2) * (range[1] - range[0]);
        return j % 2 ? share * v.omega * b : middle + share * b;
      });
      gap = normal.reduce((sum, n, i) => sum + n * state[2 * i], 0);
      if (gap >= low && gap <= high) return state;
    }
    // the masses lie around the middle of the stops, their gap does not: it is moved there
    const bottom = high === Infinity ? low : Math.max(low, high - 2 * b), top = low === -Infinity ? high : Math.min(high, low + 2 * b);
    const by = (bottom + draw() * (top - bottom) - gap) / normal.reduce((sum, n) => sum + n * n, 0);
    return state.map((x, j) => (j % 2 ? x : x + by * normal[j / 2]));
  }

  // where orbits have ended, and how many could not be set up
  keep({ columns, start, starts }, kind, { ends, known }) {
    if (kind === "preview") return;
    const width = 2 * this.page.layout.masses;
    columns.forEach((column, i) => {
      for (let s = 0; s < starts; s++) {
        const from = (i * starts + s) * width;
        this.ends.set(ends.subarray(from, from + width), (column * this.starts + start + s) * width);
        this.unknown += known[i * starts + s] ? 0 : 1;
      }
    });
  }

  endOf(column, start) {
    const width = 2 * this.page.layout.masses, from = (column * this.starts + Math.min(start, this.starts - 1)) * width;
    const end = Array.from(this.ends.subarray(from, from + width));
    return end.every(Number.isFinite) ? end : null;
  }

  // the message of the live page with what was found of a part
  frame({ first, step, columns, start, starts }, kind, found, ms) {
    const rising = columns.length < 2 || columns[1] > columns[0], m = columns.length * starts;
    const order = rising ? null : columns.map((_, i) => columns.length - 1 - i); // a chain downwards; it has one start
    const width = 2 * this.page.layout.masses, record = found.sections.length / width / m, K = found.lyapunov.length / m;
    const height = heightOf.values(this.view.y, found.sections, this.at(0)), count = new Uint32Array(m), y = [];
    const place = (n) => (order ? order[n] : n);
    for (let n = 0; n < m; n++) {
      const i = place(n), period = found.period[i];
      const from = kind === "piece" && !this.plan.side && period > 0 ? record - period : 0;
      for (let k = Math.max(0, from); k < record; k++) {
        const value = height[i * record + k];
        if (!Number.isFinite(value)) continue;
        y.push(value - this.middle);
        count[n]++;
      }
    }
    const taken = (values, size, Type) => (order ? Type.from({ length: values.length }, (_, k) => values[place(Math.floor(k / size)) * size + (k % size)]) : values);
    const arrays = { count, y: Float32Array.from(y), status: taken(found.status, 1, Int8Array) };
    if (kind === "preview") arrays.axis = this.values;
    else {
      arrays.period = taken(found.period, 1, Int32Array);
      for (const name of ["lyapunov", "lyapunov_error"]) arrays[name] = taken(found[name], K, Float32Array);
    }
    const message = { type: "frame", seq: this.seq, kind, first, step, length: columns.length, first_start: start, exact: kind === "piece", ms, arrays };
    return { ...message, columns: this.columns, starts: this.starts, middle: this.middle, record: this.plan.record, b_star: this.grazes(found) };
  }

  // the grazing clearances, where the clearance is swept
  grazes({ steady, known }) {
    if (this.axis !== "b" || !known[0] || !steady) return undefined;
    const { middle } = steady, swing = Math.hypot(steady.real, steady.imaginary), offset = this.numbers.offset ?? 0, { low, high } = heightOf.stops(this.at(0));
    const both = [...(high < Infinity ? [middle + swing - offset] : []), ...(low > -Infinity ? [swing - middle + offset] : [])];
    return [...new Set(both)].sort((a, b) => a - b);
  }
}

function part(first, step, all, start, starts) {
  const columns = [];
  for (let column = first; column < all; column += step) columns.push(column);
  return { first, step, columns, start, starts };
}

// 0 .. count - 1, a power of two, so that those that have come are spread evenly: 0 4 2 6 1 5 3 7
function reversed(count) {
  let order = [0];
  while (order.length < count) order = [...order.map((n) => 2 * n), ...order.map((n) => 2 * n + 1)];
  return order;
}

// the numbers of a system, those of its lists by name and place; of the page's own what it leaves out
function numbersOfScene(own, system) {
  const found = { ...own };
  for (const [name, value] of Object.entries(system)) {
    if (Array.isArray(value)) value.forEach((one, n) => typeof one === "number" && (found[`${name}${n + 1}`] = one));
    else if (typeof value === "number") found[name] = value;
  }
  if (typeof system.frequency === "number") found.omega = 2 * Math.PI * system.frequency;
  return found;
}

// uniform numbers in [0, 1) from whole numbers, by the mixing function of SplitMix32
function generator(words) {
  let state = words.reduce((sum, word) => mixed(sum ^ mixed(word)), 1);
  return () => mixed((state = (state + 0x9e3779b9) | 0)) / 2 ** 32;
}

function mixed(x) {
  x = Math.imul(x ^ (x >>> 16), 0x21f0aaad);
  x = Math.imul(x ^ (x >>> 15), 0x735a2d97);
  return (x ^ (x >>> 15)) >>> 0;
}
