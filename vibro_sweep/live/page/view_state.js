// What the page shows: the view that it asks for, its vertical range, and the views before and after it.

import { requestOf } from "./scene.js";

const PAUSE = 400; // ms, before the address is changed: browsers allow few changes

export class ViewState {
  constructor() {
    this.view = null; // as a request has it
    this.range = null; // [bottom, top]
    this.home = null;
    this.past = [];
    this.coming = [];
    this.line = null;
    this.start = 0; // which of the starts that a value has: 0 up and 1 down, or the number of a random one
  }

  begin(view) {
    this.view = view;
    this.home = { low: view.low, high: view.high };
    this.range = null;
    this.past = [];
    this.coming = [];
    this.line = null;
  }

  place() {
    const { axis, low, high, y } = this.view;
    return { axis, low, high, y, range: this.range && [...this.range] };
  }

  // move to another part of the plane; it can be gone back to. on: the movement before goes on
  go(low, high, range, on = false) {
    if (!on) this.past.push(this.place());
    if (this.past.length > 200) this.past.shift();
    this.coming = [];
    Object.assign(this.view, { low, high });
    this.range = range;
  }

  back() {
    return this.step(this.past, this.coming);
  }

  forward() {
    return this.step(this.coming, this.past);
  }

  step(from, to) {
    const { axis, y } = this.view;
    let place;
    do place = from.pop();
    while (place && (place.axis !== axis || place.y !== y));
    if (!place) return false;
    to.push(this.place());
    Object.assign(this.view, { low: place.low, high: place.high });
    this.range = place.range;
    return true;
  }

  // the fragment of the address; the token is not a part of it
  fragment() {
    const { view, range, home, line, start } = this;
    return `#${encodeURIComponent(JSON.stringify({ view, range, home, line, start }))}`;
  }

  write() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => history.replaceState(null, "", location.pathname + location.search + this.fragment()), PAUSE);
  }
}

export function fromAddress() {
  if (location.hash.length < 2) return null;
  try {
    const { view, range, home, line, start } = JSON.parse(decodeURIComponent(location.hash.slice(1)));
    requestOf(view); // which is not made of every view
    const rising = (low, high) => Number.isFinite(low) && Number.isFinite(high) && low < high;
    return {
      view, range: Array.isArray(range) && rising(...range) ? range.slice(0, 2) : null, home: rising(home?.low, home?.high) ? home : null,
      line: Number.isFinite(line) ? line : null, start: Number.isInteger(start) && start >= 0 ? start : 0,
    };
  } catch {
    return null;
  }
}
