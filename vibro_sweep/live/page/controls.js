// Sliders and fields for the numbers of an oscillator, in the units that are shown. A slider is an index; the exact
// number is in the field.

import { typed, whole } from "./units.js";

const STEPS = 1000;

export class Controls {
  // change: called with (name, value) for each event
  constructor(box, change) {
    this.box = box;
    this.change = change;
    this.rows = new Map();
  }

  build(numbers, axis) {
    this.box.querySelectorAll(".number").forEach((row) => row.remove());
    this.rows.clear();
    for (const one of numbers) {
      const row = document.createElement("div");
      row.className = "number";
      const name = document.createElement("span");
      name.className = "name";
      name.title = `${one.name}: ${one.text} (${one.allowed})`;
      name.append(`${one.symbol} `);
      const words = document.createElement("i");
      words.textContent = one.label;
      const unit = document.createElement("span");
      unit.className = "unit";
      unit.textContent = one.unit;
      name.append(words, " ", unit);
      const field = document.createElement("input");
      field.type = "number";
      field.step = "any";
      field.id = `field-${one.name}`;
      field.setAttribute("aria-label", `${one.label} ${one.name}${one.unit ? ` in ${one.unit}` : ""}`);
      const slider = document.createElement("input");
      slider.type = "range";
      slider.min = 0;
      slider.max = STEPS;
      slider.step = 1;
      slider.id = `slider-${one.name}`;
      slider.setAttribute("aria-label", `${one.label} ${one.name}, slider`);
      row.append(name, field, slider);
      this.box.append(row);
      const entry = { ...one, row, field, slider };
      this.rows.set(one.name, entry);
      slider.addEventListener("input", () => this.set(one.name, valueAt(entry, Number(slider.value)), true));
      slider.addEventListener("wheel", (event) => {
        if (document.activeElement !== slider) return;
        event.preventDefault();
        this.nudge(entry, event.deltaY < 0 ? 1 : -1);
      }, { passive: false });
      field.addEventListener("keydown", (event) => {
        if (!["ArrowUp", "ArrowDown"].includes(event.key)) return;
        event.preventDefault();
        this.nudge(entry, event.key === "ArrowUp" ? 1 : -1);
      });
      field.addEventListener("change", () => {
        const value = typed(field.value, entry);
        if (field.value !== "" && Number.isFinite(value)) this.set(one.name, value, true);
        else if (field.value === "" && entry.leader) this.follow(entry);
        else field.value = whole(entry.value, entry);
      });
      if (one.leader) name.title += `; it is ${one.leader} until it is changed, and again once its field is emptied`;
      this.set(one.name, one.value, false);
    }
    this.mark(axis);
  }

  nudge(entry, by) {
    const index = Math.max(0, Math.min(STEPS, Number(entry.slider.value) + by * 5));
    this.set(entry.name, valueAt(entry, index), true);
  }

  set(name, value, tell) {
    const entry = this.rows.get(name);
    if (!entry) return;
    entry.value = value;
    if (typed(entry.field.value, entry) !== value || entry.field.value === "") entry.field.value = whole(value, entry);
    entry.slider.value = indexOf(entry, value);
    entry.slider.setAttribute("aria-valuetext", whole(value, entry));
    if (tell) entry.follows = false;
    for (const other of this.rows.values()) if (other.follows && other.leader === name) this.set(other.name, value, false);
    if (tell) this.change(name, value);
  }

  // a number that was changed has the value of another one again
  follow(entry) {
    entry.follows = true;
    this.set(entry.name, this.rows.get(entry.leader).value, false);
    this.change(entry.name, null);
  }

  // the swept number has no slider: it is along the axis
  mark(axis) {
    for (const [name, entry] of this.rows) {
      const swept = name === axis;
      entry.row.classList.toggle("swept", swept);
      entry.slider.disabled = entry.field.disabled = swept;
    }
  }
}

// a number that is short in the unit that is shown
function valueAt({ low, high, log, scale }, index) {
  const share = index / STEPS;
  const value = scale * (log ? low * (high / low) ** share : low + (high - low) * share);
  const digits = 4 + Math.ceil(Math.max(0, Math.log10(Math.abs(value || 1) / (scale * (high - low)))));
  return Number(value.toPrecision(digits)) / scale;
}

function indexOf({ low, high, log }, value) {
  const share = log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.round(STEPS * Math.max(0, Math.min(1, share)));
}
