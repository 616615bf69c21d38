// Pointer, wheel and keys on the diagram: zoom, move, choose an orbit.

import { orbitNear } from "./nearest.js";

const CLICK = 5; // pixels that a click may move
const ZOOM = 1.0015; // a unit of the wheel
const PAUSE = 500; // ms, after which turning the wheel is another step to go back

export function steer(canvas, actions) {
  const { state, drawing } = actions;
  let down = null, turned = -Infinity;

  const place = (event) => {
    const rect = canvas.getBoundingClientRect();
    return [event.clientX - rect.left, event.clientY - rect.top];
  };
  const value = (x) => {
    const { dots } = drawing.place;
    return state.view.low + ((state.view.high - state.view.low) * (x - dots.x)) / dots.w;
  };
  const height = (y) => {
    const { dots } = drawing.place, [bottom, top] = state.range;
    return top - ((top - bottom) * (y - dots.y)) / dots.h;
  };
  const near = ([x, y]) => orbitNear(actions.data(), drawing, state, x, y);
  const ready = () => state.view && state.range && drawing.place;
  const inDots = ([x, y]) => {
    const { dots, exponents } = drawing.place;
    return x >= dots.x && x <= dots.x + dots.w && y >= dots.y && y <= exponents.y + exponents.h;
  };

  canvas.addEventListener("pointerdown", (event) => {
    if (!ready() || event.button > 1 || !inDots(place(event))) return;
    canvas.setPointerCapture(event.pointerId);
    down = { at: place(event), pan: event.button === 1 || event.shiftKey, view: { ...state.view }, range: [...state.range], moved: false, pushed: false };
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!down) return ready() && actions.hover(inDots(place(event)) ? near(place(event)) : null);
    const [x, y] = place(event), [x0, y0] = down.at;
    if (!down.moved && Math.hypot(x - x0, y - y0) < CLICK) return;
    down.moved = true;
    if (!down.pan) return actions.setRectangle([x0, y0, x, y]);
    const { dots } = drawing.place;
    const by = ((down.view.high - down.view.low) * (x0 - x)) / dots.w;
    const up = ((down.range[1] - down.range[0]) * (y - y0)) / dots.h;
    const to = [down.view.low + by, down.view.high + by, [down.range[0] + up, down.range[1] + up]];
    actions.go(...to, down.pushed);
    down.pushed = true;
  });
  canvas.addEventListener("pointerup", (event) => {
    if (!down) return;
    const [x, y] = place(event), [x0, y0] = down.at, { moved, pan } = down;
    down = null;
    actions.setRectangle(null);
    if (!moved) return actions.choose(value(x), near([x, y]));
    if (pan) return;
    const { dots } = drawing.place, clamp = (v) => Math.max(dots.x, Math.min(dots.x + dots.w, v));
    const across = [value(clamp(x0)), value(clamp(x))].sort((a, b) => a - b);
    const flat = Math.abs(y - y0) < 2 * CLICK || Math.max(y, y0) > dots.y + dots.h;
    const up = flat ? [...state.range] : [height(y0), height(y)].sort((a, b) => a - b);
    if (Math.abs(x - x0) < 2 * CLICK) actions.go(state.view.low, state.view.high, up);
    else actions.go(...across, up);
  });
  canvas.addEventListener("pointercancel", () => {
    down = null;
    actions.setRectangle(null);
  });
  canvas.addEventListener("pointerleave", () => actions.hover(null));
  canvas.addEventListener("wheel", (event) => {
    if (!ready()) return;
    event.preventDefault();
    const [x, y] = place(event), on = event.timeStamp - turned < PAUSE;
    turned = event.timeStamp;
    zoom(ZOOM ** event.deltaY, value(x), height(y), y <= drawing.place.dots.y + drawing.place.dots.h, on);
  }, { passive: false });

  function zoom(factor, cx, cy, both = true, on = false) {
    const { low, high } = state.view, [bottom, top] = state.range;
    const range = both ? [cy - (cy - bottom) * factor, cy + (top - cy) * factor] : [bottom, top];
    actions.go(cx - (cx - low) * factor, cx + (high - cx) * factor, range, on);
  }

  function pan(across, up) {
    const { low, high } = state.view, [bottom, top] = state.range, by = across * (high - low), to = up * (top - bottom);
    actions.go(low + by, high + by, [bottom + to, top + to]);
  }

  const keys = {
    ArrowLeft: (e) => (e.shiftKey ? pan(-0.1, 0) : actions.move(e.ctrlKey ? -10 : -1)),
    ArrowRight: (e) => (e.shiftKey ? pan(0.1, 0) : actions.move(e.ctrlKey ? 10 : 1)),
    ArrowUp: (e) => e.shiftKey && pan(0, 0.1),
    ArrowDown: (e) => e.shiftKey && pan(0, -0.1),
    Enter: () => actions.move(0),
    Home: actions.home,
    f: actions.fit,
    w: actions.why,
    o: () => document.getElementById("trail").click(),
    "+": () => zoom(0.5, state.line ?? (state.view.low + state.view.high) / 2, (state.range[0] + state.range[1]) / 2),
    "-": () => zoom(2, state.line ?? (state.view.low + state.view.high) / 2, (state.range[0] + state.range[1]) / 2),
  };
  canvas.addEventListener("keydown", (event) => {
    if (!ready() || event.altKey || event.metaKey || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key](event);
  });
  document.addEventListener("keydown", (event) => {
    if (!event.altKey || !ready() || !["ArrowLeft", "ArrowRight"].includes(event.key)) return;
    event.preventDefault();
    if (event.key === "ArrowLeft") actions.back();
    else actions.forward();
  });
}
