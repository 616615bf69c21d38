// The orbit at a value of the swept number: what is known of it, its pictures, and the masses that move.

import { drawMasses } from "./film.js";
import { paragraph } from "./orbit_words.js";
import { at, axes, clipped, dot, horizontal, polyline, prepare, pressed, scales, stops, vertical } from "./small_plots.js";
import { RATIO } from "./units.js";

const LONGEST = 12; // forcing periods of a time history; the next ones follow while the masses move
const PERIODS_A_SECOND = 0.4;

export class OrbitPanel {
  constructor(root) {
    this.root = root;
    this.orbit = null;
    this.playing = false;
    this.time = 0;
    this.canvases = Object.fromEntries(["masses", "history", "portrait", "section"].map((id) => [id, root.querySelector(`#${id}`)]));
    this.captions = Object.fromEntries(Object.entries(this.canvases).map(([id, one]) => [id, one.parentElement.querySelector("figcaption")]));
    this.step = this.step.bind(this);
  }

  show(orbit) {
    this.orbit = prepared(orbit);
    const hidden = this.root.hidden;
    this.root.hidden = false;
    if (hidden && this.playing) this.play(true);
    this.root.querySelector("#facts").replaceChildren(paragraph(this.orbit));
    this.draw();
  }

  clear() {
    this.orbit = null;
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

  draw() {
    const { mapping, contacts } = this.orbit;
    for (const id of ["masses", "history", "portrait"]) this.canvases[id].parentElement.hidden = mapping;
    this.captions.history.textContent = contacts
      ? "Time history; thick where a stop is pressed" : "Time history; circles are impacts";
    this.captions.section.textContent = mapping ? "Points of the mapping" : "Section, t = 0 mod T";
    this.masses();
    this.history();
    this.portrait();
    this.section();
  }

  // the orbit, if it has a motion: one of a mapping, or that has failed, has none
  get moving() {
    return this.orbit?.periods ? this.orbit : null;
  }

  // forcing periods since the orbit began
  get clock() {
    const { periods } = this.orbit;
    return ((this.time % periods) + periods) % periods;
  }

  history() {
    const one = this.moving, { context, theme, box } = prepare(this.canvases.history);
    if (!one) return;
    const span = Math.min(LONGEST, one.periods), first = span * Math.floor(this.clock / span);
    const view = { low: first, high: first + span, ...vertical(one.gap) };
    const { x, y } = scales(box, view);
    axes(context, box, view, { name: "t/T", ...RATIO }, names(one)[0], theme);
    clipped(context, box, () => {
      stops(context, one, view, x, y, theme);
      const repeats = one.periods === one.period; // and not a part of a longer orbit
      const from = repeats ? one.periods * Math.floor(first / one.periods) : 0, to = repeats ? first + span : 1;
      for (let shift = from; shift < to; shift += one.periods) this.flight(context, one, (t) => x(shift + t / one.T), y, theme);
      dot(context, x(this.clock), y(at(one, one.gap, this.clock)), theme.accent);
    });
  }

  // an orbit over time, once
  flight(context, one, x, y, theme) {
    polyline(context, one.t.length, (k) => x(one.t[k]), (k) => y(one.gap[k]), theme.accent);
    pressed(context, one, (k) => x(one.t[k]), (k) => y(one.gap[k]), theme.accent);
    context.fillStyle = theme.paper;
    context.strokeStyle = theme.accent;
    one.arrays.impact_t.forEach((t, k) => {
      context.beginPath();
      context.arc(x(t), y(one.arrays.impact_side[k] > 0 ? one.high : one.low), 3, 0, 7);
      context.fill();
      context.stroke();
    });
  }

  portrait() {
    const one = this.moving, { context, theme, box } = prepare(this.canvases.portrait);
    if (!one) return;
    const view = { ...horizontal(one.gap), ...vertical(one.rate) };
    const { x, y } = scales(box, view);
    axes(context, box, view, ...names(one), theme);
    clipped(context, box, () => {
      context.strokeStyle = theme.faint;
      context.setLineDash([3, 3]);
      for (const stop of [one.low, one.high]) {
        if (stop !== null) polyline(context, 2, () => x(stop), (k) => (k ? box.y : box.y + box.h), theme.faint);
      }
      context.setLineDash([]);
      polyline(context, one.t.length, (k) => x(one.gap[k]), (k) => y(one.rate[k]), theme.accent);
      pressed(context, one, (k) => x(one.gap[k]), (k) => y(one.rate[k]), theme.accent);
      dot(context, x(at(one, one.gap, this.clock)), y(at(one, one.rate, this.clock)), theme.accent);
    });
  }

  section() {
    const one = this.orbit, { context, theme, box } = prepare(this.canvases.section);
    if (!one.arrays.section.length) return;
    const view = { ...horizontal(one.sectionGap), ...vertical(one.sectionRate) };
    const { x, y } = scales(box, view), size = one.period ? 5 : 2;
    axes(context, box, view, ...names(one), theme);
    clipped(context, box, () => {
      context.fillStyle = theme.accent;
      for (let k = 0; k < one.sectionGap.length; k++) {
        context.fillRect(x(one.sectionGap[k]) - size / 2, y(one.sectionRate[k]) - size / 2, size, size);
      }
    });
  }

  masses() {
    if (this.moving) drawMasses(this.canvases.masses, this.orbit, this.clock);
    else prepare(this.canvases.masses);
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
  const gap = sum(states, 0), reach = Math.max(0, ...[gap, ...positions].map((one) => one.reduce((most, v) => Math.max(most, Math.abs(v)), 0)));
  return {
    ...orbit, t: arrays.t ?? new Float32Array(0), gap, rate: sum(states, 1), positions, reach,
    sectionGap: sum(arrays.section, 0), sectionRate: sum(arrays.section, 1),
    gapIsFirst: normal[0] === 1 && normal.slice(1).every((one) => one === 0),
  };
}

function names(one) {
  const [gap, velocity] = one.gapIsFirst ? ["x1", "v1"] : ["gap", "velocity of the gap"];
  return [{ name: gap, ...one.units.gap }, { name: velocity, ...one.units.gap_velocity }];
}
