// The orbit at a value of the swept number: what is known of it, its pictures, and the masses that move.

import { drawMasses } from "./film.js";
import { paragraph } from "./orbit_words.js";
import { at, axes, clipped, colourOf, dot, horizontal, polyline, prepare, pressed, scales, stops, vertical } from "./small_plots.js";

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
    drawMasses(this.canvases.masses, this.shown, (one) => this.phase(one));
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
  const gap = sum(states, 0), reach = Math.max(0, ...[gap, ...positions].map((one) => one.reduce((most, v) => Math.max(most, Math.abs(v)), 0)));
  return {
    ...orbit, t: arrays.t ?? new Float32Array(0), gap, rate: sum(states, 1), positions, reach,
    sectionGap: sum(arrays.section, 0), sectionRate: sum(arrays.section, 1),
    gapIsFirst: normal[0] === 1 && normal.slice(1).every((one) => one === 0),
  };
}

function names([[one]]) {
  return one.gapIsFirst ? ["x1", "v1"] : ["gap", "velocity of the gap"];
}
