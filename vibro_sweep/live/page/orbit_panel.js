// The orbit at a value of the swept number: what is known of it, its pictures, and the masses that move.

import { short, shown, ticks } from "./axes.js";
import { themeOf } from "./drawing.js";

const PAD = { left: 58, right: 8, top: 8, bottom: 30 };
const LONGEST = 12; // forcing periods of a time history; the next ones follow while the masses move
const PERIODS_A_SECOND = 0.4;

export class OrbitPanel {
  constructor(root) {
    this.root = root;
    this.slots = [null, null];
    this.playing = false;
    this.time = 0;
    this.canvases = Object.fromEntries(["masses", "history", "portrait", "section"].map((id) => [id, root.querySelector(`#${id}`)]));
    this.captions = Object.fromEntries(Object.entries(this.canvases).map(([id, one]) => [id, one.parentElement.querySelector("figcaption")]));
    this.step = this.step.bind(this);
  }

  show(orbit) {
    this.slots[orbit.slot] = prepared(orbit);
    const hidden = this.root.hidden;
    this.root.hidden = false;
    if (hidden && this.playing) this.play(true);
    this.facts();
    this.draw();
  }

  clear() {
    this.slots = [null, null];
    this.root.hidden = true;
  }

  play(on) {
    this.playing = on;
    this.last = null;
    if (on) requestAnimationFrame(this.step);
  }

  step(now) {
    if (!this.playing || this.root.hidden) return;
    const speed = PERIODS_A_SECOND * 10 ** Number(this.root.querySelector("#speed").value);
    if (this.last !== null) this.time += ((now - this.last) / 1000) * speed;
    this.last = now;
    this.masses();
    this.history();
    this.portrait();
    requestAnimationFrame(this.step);
  }

  facts() {
    const box = this.root.querySelector("#facts");
    box.replaceChildren(...this.slots.flatMap((one, i) => (one ? [paragraph(one, i)] : [])));
  }

  draw() {
    const known = this.slots.filter(Boolean), mapping = known.some((one) => one.mapping);
    for (const id of ["masses", "history", "portrait"]) this.canvases[id].parentElement.hidden = mapping;
    this.captions.history.textContent = known.some((one) => one.contacts)
      ? "Time history; thick where a stop is pressed" : "Time history; circles are impacts";
    this.captions.section.textContent = mapping ? "Points of the mapping" : "Section, t = 0 mod T";
    this.masses();
    this.history();
    this.portrait();
    this.section();
  }

  get shown() {
    return this.slots.map((one, i) => [one, i]).filter(([one]) => one && one.periods);
  }

  // forcing periods since the longest orbit that is shown began
  get clock() {
    const longest = Math.max(...this.shown.map(([one]) => one.periods));
    return ((this.time % longest) + longest) % longest;
  }

  history() {
    const shown = this.shown;
    const { context, theme, box } = prepare(this.canvases.history);
    if (!shown.length) return;
    const span = Math.min(LONGEST, Math.max(...shown.map(([one]) => one.periods)));
    const first = span * Math.floor(this.clock / span);
    const view = { low: first, high: first + span, ...vertical(shown, "gap") };
    const { x, y } = scales(box, view);
    axes(context, box, view, "t/T", names(shown)[0], theme);
    clipped(context, box, () => {
      for (const [one] of shown) stops(context, one, view, x, y, theme);
      for (const [one, i] of shown) {
        const repeats = one.periods === one.period; // and not a part of a longer orbit
        const from = repeats ? one.periods * Math.floor(first / one.periods) : 0, to = repeats ? first + span : 1;
        for (let shift = from; shift < to; shift += one.periods) this.flight(context, one, (t) => x(shift + t / one.T), y, colourOf(i, theme), theme);
        dot(context, x(repeats ? this.clock : this.phase(one)), y(at(one, one.gap, this.phase(one))), colourOf(i, theme));
      }
    });
  }

  // an orbit over time, once
  flight(context, one, x, y, colour, theme) {
    polyline(context, one.t.length, (k) => x(one.t[k]), (k) => y(one.gap[k]), colour);
    pressed(context, one, (k) => x(one.t[k]), (k) => y(one.gap[k]), colour);
    context.fillStyle = theme.paper;
    context.strokeStyle = colour;
    one.arrays.impact_t.forEach((t, k) => {
      context.beginPath();
      context.arc(x(t), y(one.arrays.impact_side[k] > 0 ? one.high : one.low), 3, 0, 7);
      context.fill();
      context.stroke();
    });
  }

  portrait() {
    const shown = this.shown;
    const { context, theme, box } = prepare(this.canvases.portrait);
    if (!shown.length) return;
    const view = { ...horizontal(shown, "gap"), ...vertical(shown, "rate") };
    const { x, y } = scales(box, view);
    axes(context, box, view, ...names(shown), theme);
    clipped(context, box, () => {
      context.strokeStyle = theme.faint;
      context.setLineDash([3, 3]);
      for (const stop of shown.flatMap(([one]) => [one.low, one.high])) {
        if (stop !== null) polyline(context, 2, () => x(stop), (k) => (k ? box.y : box.y + box.h), theme.faint);
      }
      context.setLineDash([]);
      for (const [one, i] of shown) {
        polyline(context, one.t.length, (k) => x(one.gap[k]), (k) => y(one.rate[k]), colourOf(i, theme));
        pressed(context, one, (k) => x(one.gap[k]), (k) => y(one.rate[k]), colourOf(i, theme));
        const phase = this.phase(one);
        dot(context, x(at(one, one.gap, phase)), y(at(one, one.rate, phase)), colourOf(i, theme));
      }
    });
  }

  section() {
    const shown = this.slots.map((one, i) => [one, i]).filter(([one]) => one?.arrays.section.length);
    const { context, theme, box } = prepare(this.canvases.section);
    if (!shown.length) return;
    const view = { ...horizontal(shown, "sectionGap"), ...vertical(shown, "sectionRate") };
    const { x, y } = scales(box, view);
    axes(context, box, view, ...names(shown), theme);
    clipped(context, box, () => {
      for (const [one, i] of shown) {
        context.fillStyle = colourOf(i, theme);
        const size = one.period ? 5 : 2;
        for (let k = 0; k < one.sectionGap.length; k++) {
          context.fillRect(x(one.sectionGap[k]) - size / 2, y(one.sectionRate[k]) - size / 2, size, size);
        }
      }
    });
  }

  masses() {
    const shown = this.shown;
    const { context, theme, box: { x: left, w, fullHeight: h } } = prepare(this.canvases.masses, 8);
    if (!shown.length) return;
    const [[one]] = shown, N = one.masses;
    const rows = one.gapIsFirst ? N : N + 1, height = h / rows, size = Math.min(34, height * 0.42);
    const reach = Math.max(1e-9, ...shown.flatMap(([{ reach, low, high }]) => [reach, Math.abs(low ?? 0), Math.abs(high ?? 0)]));
    const scale = (w / 2 - size - 6) / reach, middle = left + w / 2;
    context.font = "11px system-ui, sans-serif";
    context.textBaseline = "middle";
    context.textAlign = "center";
    for (let r = 0; r < rows; r++) {
      const gapRow = r === 0, mass = one.gapIsFirst ? r : r - 1, centre = height * (r + 0.5);
      const name = gapRow && !one.gapIsFirst ? "gap" : String(mass + 1);
      polyline(context, 2, (k) => (k ? left + w : left), () => centre + size / 2 + 1, theme.line);
      for (const [each, i] of [...shown].reverse()) {
        const value = at(each, mass < 0 || (gapRow && each.gapIsFirst) ? each.gap : each.positions[mass], this.phase(each));
        if (gapRow) this.walls(context, each, value, { x: (v) => middle + scale * v, centre, size, height, near: 0.004 * reach }, i, theme);
        const x = middle + scale * value, colour = i ? theme.second : gapRow ? theme.accent : theme.faint;
        context.strokeStyle = context.fillStyle = colour;
        if (i) context.strokeRect(x - size / 2, centre - size / 2, size, size);
        else context.fillRect(x - size / 2, centre - size / 2, size, size);
        context.fillStyle = i ? colour : theme.paper;
        context.fillText(name, x, centre);
      }
    }
  }

  // the stops of an orbit; one that is compliant goes with the mass that presses it
  walls(context, one, value, { x, centre, size, height, near }, i, theme) {
    [[one.low, -1], [one.high, 1]].forEach(([stop, side], k) => {
      if (stop === null) return;
      const beyond = one.pressed[k] && side * (value - stop) > 0;
      const wall = x(beyond ? value : stop) + side * (size / 2), edge = side > 0 ? wall : wall - 5;
      context.fillStyle = context.strokeStyle = beyond || Math.abs(value - stop) < near ? theme.second : theme.faint;
      if (i) context.strokeRect(edge, centre - height * 0.36, 5, height * 0.72);
      else context.fillRect(edge, centre - height * 0.36, 5, height * 0.72);
    });
  }

  phase(one) {
    return this.clock % one.periods;
  }
}

function prepared(orbit) {
  const { arrays, masses: N, normal } = orbit, width = 2 * N;
  const column = (values, i) => Float32Array.from({ length: values.length / width }, (_, k) => values[k * width + i]);
  const sum = (values, from) => {
    const result = new Float32Array(values.length / width);
    for (let k = 0; k < result.length; k++) for (let j = 0; j < N; j++) result[k] += normal[j] * values[k * width + 2 * j + from];
    return result;
  };
  const states = arrays.states ?? new Float32Array(0);
  const positions = Array.from({ length: N }, (_, j) => column(states, 2 * j));
  const reach = Math.max(0, ...positions.map((one) => one.reduce((most, v) => Math.max(most, Math.abs(v)), 0)));
  return {
    ...orbit, t: arrays.t ?? new Float32Array(0), gap: sum(states, 0), rate: sum(states, 1), positions, reach,
    sectionGap: sum(arrays.section, 0), sectionRate: sum(arrays.section, 1),
    gapIsFirst: normal[0] === 1 && normal.slice(1).every((one) => one === 0),
  };
}

function paragraph(one, i) {
  const p = document.createElement("p"), head = document.createElement("b");
  head.className = i ? "second" : "first";
  head.textContent = `${one.axis} = ${shown(one.value)}: `;
  const exponents = [...one.arrays.exponents].map((v, k) => `${short(v, 4)} ± ${short(one.arrays.errors[k], 1)}`);
  const kind = one.period ? `period ${one.period}` : one.arrays.exponents[0] > one.certain * one.arrays.errors[0] ? "chaotic" : "no period found";
  const touching = one.contacts ? counted(one.contacts, "contact") : "no impacts";
  const itinerary = one.itinerary === undefined ? "" : one.itinerary.length > 40 ? counted(one.impacts, "impact") : one.itinerary || (one.period ? touching : "");
  const words = [kind, itinerary, one.rests ? `${counted(one.rests, "rest")} on a stop` : "", `λ = ${exponents.join(", ")}`];
  if (one.status !== "computed") words.push(one.status);
  if (one.orbit_status && one.orbit_status !== "ok") words.push(one.orbit_status);
  if (one.alone) words.push("from the start of the scene alone, not from where the points before it lead");
  p.append(head, words.filter(Boolean).join("; "));
  return p;
}

function counted(n, word) {
  return `${n} ${word}${n === 1 ? "" : "s"}`;
}

function names([[one]]) {
  return one.gapIsFirst ? ["x1", "v1"] : ["gap", "velocity of the gap"];
}

function prepare(canvas, pad = 0) {
  const rect = canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
  const width = Math.max(120, rect.width), height = Math.max(80, rect.height);
  const pixels = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== pixels[0] || canvas.height !== pixels[1]) [canvas.width, canvas.height] = pixels;
  const context = canvas.getContext("2d"), theme = themeOf(canvas);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.fillStyle = theme.paper;
  context.fillRect(0, 0, width, height);
  const box = pad ? { x: pad, w: width - 2 * pad, fullHeight: height }
    : { x: PAD.left, y: PAD.top, w: width - PAD.left - PAD.right, h: height - PAD.top - PAD.bottom };
  return { context, theme, box };
}

function extent(shown, name) {
  let low = Infinity, high = -Infinity;
  for (const [one] of shown) for (const v of one[name]) [low, high] = [Math.min(low, v), Math.max(high, v)];
  const half = Math.max(0.55 * (high - low), 0.01 * Math.max(Math.abs(low), Math.abs(high)), 1e-3), centre = (low + high) / 2;
  return [centre - half, centre + half];
}

function horizontal(shown, name) {
  const [low, high] = extent(shown, name);
  return { low, high };
}

function vertical(shown, name) {
  const [bottom, top] = extent(shown, name);
  return { bottom, top };
}

function scales(box, view) {
  return {
    x: (v) => box.x + (box.w * (v - view.low)) / (view.high - view.low),
    y: (v) => box.y + box.h * (1 - (v - view.bottom) / (view.top - view.bottom)),
  };
}

function axes(context, box, view, across, up, theme) {
  const { x, y } = scales(box, view);
  context.strokeStyle = theme.line;
  context.lineWidth = 1;
  context.strokeRect(box.x + 0.5, box.y + 0.5, box.w - 1, box.h - 1);
  context.fillStyle = theme.ink;
  context.font = "10px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "top";
  for (const one of ticks(view.low, view.high, box.w / 50).list) context.fillText(one.text, x(one.at), box.y + box.h + 3);
  context.fillText(across, box.x + box.w / 2, box.y + box.h + 16);
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (const one of ticks(view.bottom, view.top, box.h / 40).list) context.fillText(one.text, box.x - 3, y(one.at));
  context.save();
  context.translate(7, box.y + box.h / 2);
  context.rotate(-Math.PI / 2);
  context.textAlign = "center";
  context.fillText(up, 0, 0);
  context.restore();
}

function stops(context, one, view, x, y, theme) {
  context.setLineDash([3, 3]);
  for (const stop of [one.low, one.high]) {
    if (stop !== null) polyline(context, 2, (k) => x(k ? view.high : view.low), () => y(stop), theme.faint);
  }
  context.setLineDash([]);
}

function clipped(context, box, draw) {
  context.save();
  context.beginPath();
  context.rect(box.x, box.y, box.w, box.h);
  context.clip();
  draw();
  context.restore();
}

// where a compliant stop is pressed, once more and thick
function pressed(context, one, x, y, colour) {
  one.arrays.contact_touch.forEach((touch, c) => {
    const release = one.arrays.contact_release[c], from = one.t.findIndex((t) => t >= touch);
    let n = 0;
    while (from + n < one.t.length && one.t[from + n] <= release) n++;
    if (from >= 0) polyline(context, n, (k) => x(from + k), (k) => y(from + k), colour, 3.5);
  });
}

function polyline(context, n, x, y, colour, width = 1.2) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.beginPath();
  for (let k = 0; k < n; k++) context.lineTo(x(k), y(k));
  context.stroke();
}

function dot(context, x, y, colour) {
  context.fillStyle = colour;
  context.beginPath();
  context.arc(x, y, 4, 0, 7);
  context.fill();
}

function colourOf(i, theme) {
  return i ? theme.second : theme.accent;
}

function at(one, values, phase) {
  // at a time in forcing periods
  const { t } = one, time = phase * one.T;
  let low = 0, high = t.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (t[middle] <= time) low = middle;
    else high = middle;
  }
  const share = t[high] > t[low] ? (time - t[low]) / (t[high] - t[low]) : 0;
  return values[low] + Math.min(1, Math.max(0, share)) * (values[high] - values[low]);
}
