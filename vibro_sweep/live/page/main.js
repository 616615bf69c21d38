// The page: it asks for a view with each event, and draws what has come once a display interval.

import { short } from "./axes.js";
import { Controls } from "./controls.js";
import { DiagramData } from "./diagram_data.js";
import { Drawing } from "./drawing.js";
import { EXPLAINS, Link, TAKEN_OVER, WAITING } from "./link.js";
import { OrbitPanel } from "./orbit_panel.js";
import { copyLink, keep } from "./saving.js";
import { requestOf, viewOf } from "./scene.js";
import { steer } from "./steering.js";
import { measured, RATIO, titled, typed, whole } from "./units.js";
import { fromAddress, ViewState } from "./view_state.js";
import { branchesOf, wordsOfWindow } from "./window_ends.js";

const $ = (id) => document.getElementById(id);
const root = document.documentElement;
const LATE = 120; // ms without an answer, after which what is shown is pale: it does not flicker behind a slider
const LONG = 1500; // ms without an answer, after which the page says what may take so long

const state = new ViewState();
const drawing = new Drawing($("diagram"));
const panel = new OrbitPanel($("orbit"));
const controls = new Controls($("numbers"), (name, value) => {
  if (value === null) delete state.view.numbers[name];
  else state.view.numbers[name] = value;
  request();
});
let model = null, data = null, asked = 0, dirty = false, fitNext = true, arrived = null, branches = [], why = null;
let timer = null, askedWhy = 0, askedOrbit = 0, since = 0, line = null, failed = false, late = false, rectangle = null;

const link = new Link({ open: begin, answer, closed });

function begin() {
  const found = fromAddress();
  if (state.view) {
    open({ view: requestOf(state.view) }, { view: state.view, range: state.range, home: state.home, line, start: state.start });
  } else if (found) open({ view: requestOf(found.view) }, found);
  else open({}, null);
}

let restored = null, clickTimer = null, lateTimer = null, takenOver = "";
function open(what, found) {
  restored = found;
  say(model ? "Opening" : "Connected");
  computing();
  link.ask("open", what);
}

function closed(event, tries) {
  set("computing");
  if (event.code === TAKEN_OVER) {
    clearTimeout(timer);
    clearTimeout(clickTimer);
    takenOver = `${event.reason}. Reload this one to go on here.`;
    return say("");
  }
  if (event.code === 1008) return say(`The program refused a request: ${event.reason}`, true);
  if (tries > 0 || !model) say("The connection is lost. If the program still runs, this page connects again by itself; if it was started again, open the address that it has printed.", true);
}

function answer(message) {
  ({ model: opened, frame, orbit, window: windowFound, saved, error })[message.type](message);
}

function opened(message) {
  model = message;
  state.begin(viewOf(message.view));
  if (restored) {
    state.range = restored.range ?? null;
    state.home = restored.home ?? state.home;
    line = restored.line ?? null;
  } else line = null;
  state.start = restored?.start ?? 0;
  data = null;
  drawing.exponentRange = null;
  since = link.seq;
  fitNext = !state.range;
  forgetWhy();
  panel.clear();
  fill();
  request();
  redraw();
  askOrbit();
}

function fill() {
  const { view } = state;
  options($("presets"), ["", ...model.presets].map((name) => [name, name || "(this view)"]), model.name);
  options($("axis"), model.numbers.map((one) => [one.name, titled(`${one.symbol}  ${one.label}`, one)]), view.axis);
  options($("height"), model.heights.map(([name, label]) => [name, titled(label, model.units[name])]), view.y);
  $("dynamics").value = view.map.dynamics ?? "flow";
  $("motion").hidden = !model.mapping;
  $("presets").parentElement.hidden = !model.presets.length;
  $("why").hidden = !EXPLAINS;
  $("start").value = view.start.follow ?? (view.start.random ? "random" : "state");
  controls.build(model.numbers, view.axis);
  fields();
  $("masses").setAttribute("aria-label", `The masses between the stops: ${model.title}`);
}

function fields() {
  const { view } = state;
  for (const end of ["low", "high"]) $(end).value = whole(view[end], axisUnit());
  for (const one of document.querySelectorAll(".of-axis")) one.textContent = axisUnit().unit;
  $("transient").value = view.transient;
  $("record").value = view.record;
  $("back").disabled = !state.past.length;
  $("forward").disabled = !state.coming.length;
}

// unit and scale of the swept number
function axisUnit() {
  return model.numbers.find((one) => one.name === state.view.axis) ?? RATIO;
}

// an end of the range from its field; one that was not changed keeps all its digits
function endTyped(id) {
  const text = $(id).value, value = state.view[id];
  return text === whole(value, axisUnit()) ? value : typed(text, axisUnit());
}

// ask for the view as it is now
function request() {
  const { view } = state;
  failed = false;
  asked = link.ask("sweep", { view: requestOf(view), middle: state.range ? (state.range[0] + state.range[1]) / 2 : 0 });
  computing();
  forgetWhy();
  state.write();
  fields();
  if (panel.orbit) askOrbit();
}

function computing() {
  set("computing");
  clearTimeout(timer);
  timer = setTimeout(() => say(WAITING), LONG);
  for (const id of ["status", "under"]) $(id).classList.add("stale");
  lateTimer ??= setTimeout(() => paleFrom(true), LATE);
}

function paleFrom(now) {
  clearTimeout(lateTimer);
  lateTimer = null;
  late = now;
  redraw();
}

function frame(message) {
  clearTimeout(timer);
  if (!data || message.seq !== data.seq) {
    const next = new DiagramData(message);
    next.seq = message.seq;
    next.both = next.starts === 2 && state.view.start.follow === "both";
    next.inherit(data);
    data = next;
    paleFrom(false);
    if (data.seq !== asked) lateTimer = setTimeout(() => paleFrom(true), LATE);
  }
  data.take(message);
  if (fitNext && (message.kind === "preview" || message.last)) {
    state.range = data.range() ?? state.range;
    if (message.last) fitNext = false;
  }
  data.stars = message.b_star ?? [];
  arrived = message;
  if (message.last && message.seq === asked) {
    drawing.fitExponents(data);
    summary();
    $("under").classList.remove("stale");
  }
  redraw();
}

function summary() {
  const counts = new Map();
  for (const code of data.status) if (code !== 0) counts.set(code, (counts.get(code) ?? 0) + 1);
  const words = [...counts].map(([code, n]) => code === model.not_settled
    ? `${n} not settled yet: a longer transient or record may tell`
    : `${n} ${n > 1 ? "orbits" : "orbit"}: ${model.statuses[code] ?? code}`);
  const { names: { axis, height }, units } = picture();
  const ends = `${whole(state.view.low, units.axis)} to ${measured(state.view.high, units.axis)}`;
  $("diagram").setAttribute("aria-label", `${titled(height, units.height)} over ${axis} from ${ends}`);
  say([`${data.columns} values of ${state.view.axis}`, ...words].join("; "));
}

// which of several starts, in words
function wayOf(start) {
  const { follow, random } = state.view.start;
  return follow === "both" ? ["up", "down"][start] : random > 1 ? `start ${start}` : "";
}

function orbit(message) {
  if (message.seq <= since) return; // of another oscillator
  clearTimeout(clickTimer);
  $("orbit").classList.toggle("stale", message.seq !== askedOrbit);
  const { view: { axis } } = state, { certain, units } = model;
  panel.show({ ...message, axis, axisUnit: axisUnit(), way: wayOf(message.start), certain, units });
  redraw();
}

function windowFound(message) {
  if (message.seq !== askedWhy) return;
  clearTimeout(clickTimer);
  why = message;
  say(message.reason ? "No window was found" : "The window and its two ends");
  branches = branchesOf(message);
  showWhy();
  redraw();
}

function forgetWhy() {
  if (!branches.length && !why) return;
  branches = [];
  why = null;
  askedWhy = 0;
  showWhy();
}

function showWhy() {
  const box = $("window");
  box.hidden = !why;
  if (!why) return;
  box.replaceChildren(...wordsOfWindow(why, state.view.axis, axisUnit()));
}

function saved(message) {
  keep(new Blob([message.text]), "explored.yaml");
  say("Saved");
}

function error(message) {
  clearTimeout(clickTimer);
  if (message.of === "open" && model) $("dynamics").value = state.view.map.dynamics ?? "flow";
  if (!["sweep", "open"].includes(message.of)) return say(message.text, true);
  if (message.of === "sweep" && message.seq !== asked) return;
  clearTimeout(timer);
  paleFrom(message.of === "sweep");
  failed = true;
  say(message.text, true);
  set("final");
}

function set(value) {
  root.dataset.state = value;
}

function say(words, bad = false) {
  $("status").textContent = takenOver || words;
  $("status").classList.toggle("bad", bad || takenOver !== "");
  $("status").classList.remove("stale");
}

function options(select, list, value) {
  select.replaceChildren(...list.map(([name, words]) => {
    const option = document.createElement("option");
    option.value = name;
    option.textContent = words;
    return option;
  }));
  select.value = value;
}

export function redraw() {
  if (dirty) return;
  dirty = true;
  requestAnimationFrame(paint);
}

function picture() {
  const { view, range } = state, [bottom, top] = range ?? [-1, 1];
  const height = model.heights.find(([name]) => name === view.y)?.[1] ?? view.y;
  const number = model.numbers.find((one) => one.name === view.axis);
  return {
    data, pale: late, certain: model.certain, colours: model.colours, view: { low: view.low, high: view.high, bottom, top },
    names: { axis: number ? `${number.label} ${number.symbol}` : view.axis, height },
    units: { axis: axisUnit(), height: model.units[view.y] ?? RATIO, exponents: model.units.lyapunov },
    marks: {
      grazing: view.axis === "b" ? data?.stars ?? [] : [], line, branches, window: why && !why.reason ? why : null, stops: stopLines(), rectangle,
    },
  };
}

function stopLines() {
  // where the stops stand, if the gap is on the vertical axis
  const { view } = state, value = (name) => view.numbers[name] ?? view.system[name] ?? 0;
  if (view.y !== "gap" && !(view.y === "x1" && !model.heights.some(([name]) => name === "gap"))) return [];
  return model.stops.flatMap((stop, i) => {
    const sign = i ? 1 : -1;
    const at = (x) => (view.axis === "offset" ? x : value("offset")) + sign * (view.axis === "b" ? x : value("b"));
    return stop === null ? [] : [[at(view.low), at(view.high)]];
  });
}

function paint() {
  dirty = false;
  if (!model) return;
  drawing.draw(picture());
  if (!arrived) return;
  if (arrived.seq === asked && !failed) {
    if (arrived.last) {
      set("final");
      if (state.view.start.follow || data.starts > 1) askOrbit(); // which now goes on from where its dots end
    } else {
      if (state.view.start.follow && root.dataset.state === "computing") say("Preview: each point starts by itself; the final picture follows them.");
      set("preview");
    }
  }
  root.dataset.frame = Number(root.dataset.frame) + 1;
  arrived = null;
}

const trailing = () => !$("orbit").hidden && $("trail").getAttribute("aria-pressed") === "true";

function underPointer({ column, start }) {
  const at = column * data.starts + start, period = data.period[at], K = data.K, rate = model.units.lyapunov;
  const way = data.starts > 1 ? wayOf(start) : "";
  const words = [`${state.view.axis} = ${measured(data.axis[column], axisUnit(), 9)}${way ? `, ${way}` : ""}`];
  if (period > 0) words.push(`period ${period}`);
  if (K && Number.isFinite(data.exponents?.[at * K])) {
    const [value, error] = [data.exponents, data.errors].map((numbers) => rate.scale * numbers[at * K]);
    words.push(`${titled("λ₁", rate)} = ${short(value, 4)} ± ${short(error, 1)}`);
  }
  return words.join(": ").replace(": λ", ", λ");
}

function soon() {
  clearTimeout(clickTimer);
  clickTimer = setTimeout(() => say(WAITING), LONG);
}

// the column of the final picture in which the orbit is, from whose end it goes on
function columnOfOrbit() {
  return data && data.seq === asked && root.dataset.state === "final" ? data.column(line) : -1;
}

function askOrbit() {
  if (line === null || !state.view) return;
  soon();
  const column = columnOfOrbit(), value = column >= 0 && data.axis ? data.axis[column] : line;
  askedOrbit = link.ask("orbit", { view: requestOf(state.view), value, start: state.start, column });
  $("orbit").classList.add("stale");
}

const actions = {
  state, drawing, redraw, request,
  data: () => data,
  setRectangle(value) {
    rectangle = value;
    redraw();
  },
  go(low, high, range, on = false) {
    if (!(high > low) || !range || !(range[1] > range[0])) return;
    state.go(low, high, range, on);
    fitNext = false;
    request();
    redraw();
  },
  back: () => state.back() && (request(), redraw()),
  forward: () => state.forward() && (request(), redraw()),
  home() {
    state.go(state.home.low, state.home.high, null);
    fitNext = true;
    request();
  },
  fit() {
    const range = data?.range();
    if (range) state.go(state.view.low, state.view.high, range), request();
    drawing.fitExponents(data);
    redraw();
  },
  // the orbit at a value, or that which is near: {column, start}
  choose(value, near = null) {
    const column = near?.column ?? data?.column(value) ?? -1;
    state.line = line = column >= 0 && data.axis ? data.axis[column] : value;
    state.start = near?.start ?? state.start;
    forgetWhy();
    askOrbit();
    state.write();
    redraw();
  },
  hover(near) {
    $("under").textContent = near ? underPointer(near) : "";
    if (!near || !trailing() || (data.axis[near.column] === line && near.start === state.start)) return;
    actions.choose(data.axis[near.column], near);
  },
  move(by) {
    const column = data?.column(line ?? (state.view.low + state.view.high) / 2) ?? 0;
    if (data?.axis) actions.choose(data.axis[Math.max(0, Math.min(data.columns - 1, column + by))]);
  },
  why() {
    if (line === null || !EXPLAINS) return;
    say("Following the periodic orbit of this window");
    why = { reason: "its periodic orbit is being followed", value: line };
    showWhy();
    soon();
    askedWhy = link.ask("window", { view: requestOf(state.view), value: line, start: state.start, column: columnOfOrbit() });
  },
};

steer($("diagram"), actions);

$("presets").addEventListener("change", (event) => event.target.value && open({ name: event.target.value }, null));
$("axis").addEventListener("change", (event) => {
  const number = model.numbers.find((one) => one.name === event.target.value);
  let { low, high } = number;
  const shown = controls.rows.get(number.name).value * number.scale;
  if (number.log) [low, high] = [0.7, 1.4].map((part) => Number((shown * part).toPrecision(4)) / number.scale);
  if (line !== null) { // the number that was swept stays where the orbit is
    state.view.numbers[state.view.axis] = line;
    controls.set(state.view.axis, line, false);
  }
  state.begin({ ...state.view, axis: number.name, low, high });
  fitNext = true;
  line = data = null;
  panel.clear();
  controls.mark(number.name);
  request();
});
$("height").addEventListener("change", (event) => {
  state.begin({ ...state.view, y: event.target.value });
  fitNext = true;
  request();
});
$("dynamics").addEventListener("change", (event) => {
  const map = event.target.value === "map" ? { dynamics: "map", order: 1 } : {};
  open({ view: requestOf({ ...state.view, map, y: "x1" }) }, null);
});
$("start").addEventListener("change", (event) => {
  const { follow, random, seed, ...rest } = state.view.start, value = event.target.value;
  state.view.start = { state: rest, random: { random: 4, seed: seed ?? 0 } }[value] ?? { ...rest, follow: value };
  state.start = 0;
  request();
});
for (const id of ["low", "high"]) {
  $(id).addEventListener("change", () => {
    const [low, high] = ["low", "high"].map(endTyped);
    if ($("low").value === "" || $("high").value === "" || !(high > low)) return say("The range must rise: from a smaller to a greater number.", true);
    state.go(low, high, state.range);
    request();
  });
}
for (const id of ["transient", "record"]) {
  $(id).addEventListener("change", () => {
    if (!$(id).checkValidity() || $(id).value === "") return say(`${id}: a whole number from ${$(id).min} to ${$(id).max}`, true);
    state.view[id] = Number($(id).value);
    request();
  });
}
$("back").addEventListener("click", actions.back);
$("forward").addEventListener("click", actions.forward);
$("home").addEventListener("click", actions.home);
$("fit").addEventListener("click", actions.fit);
$("why").addEventListener("click", actions.why);
$("trail").addEventListener("click", () => $("trail").setAttribute("aria-pressed", String($("trail").getAttribute("aria-pressed") !== "true")));
$("close").addEventListener("click", () => {
  panel.clear();
  state.line = line = null;
  forgetWhy();
  redraw();
});
$("play").addEventListener("click", () => {
  const on = $("play").getAttribute("aria-pressed") !== "true";
  $("play").setAttribute("aria-pressed", String(on));
  $("play").textContent = on ? "Pause" : "Play";
  panel.play(on);
});
$("controls").addEventListener("submit", (event) => event.preventDefault());
$("save").addEventListener("click", (event) => {
  const form = event.target.dataset?.form;
  if (!form) return;
  $("save").open = false;
  if (form === "png") $("diagram").toBlob((picture) => keep(picture, "explored.png"));
  else if (form === "link") copyLink(state).then(say, () => say("The browser did not allow copying", true));
  else link.ask("save", { view: requestOf(state.view) });
});
const later = () => {
  redraw();
  if (!$("orbit").hidden) panel.draw();
};
new ResizeObserver(later).observe($("diagram"));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", later);
