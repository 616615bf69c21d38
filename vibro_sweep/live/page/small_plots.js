// What the small plots of an orbit have in common: canvas, axes, lines.

import { ticks } from "./axes.js";
import { themeOf } from "./drawing.js";
import { titled } from "./units.js";

const PAD = { left: 58, right: 8, top: 8, bottom: 30 };

export function prepare(canvas, pad = 0) {
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

function extent(values) {
  let low = Infinity, high = -Infinity;
  for (const v of values) [low, high] = [Math.min(low, v), Math.max(high, v)];
  const half = Math.max(0.55 * (high - low), 0.01 * Math.max(Math.abs(low), Math.abs(high)), 1e-12), centre = (low + high) / 2;
  return [centre - half, centre + half];
}

export function horizontal(values) {
  const [low, high] = extent(values);
  return { low, high };
}

export function vertical(values) {
  const [bottom, top] = extent(values);
  return { bottom, top };
}

export function scales(box, view) {
  return {
    x: (v) => box.x + (box.w * (v - view.low)) / (view.high - view.low),
    y: (v) => box.y + box.h * (1 - (v - view.bottom) / (view.top - view.bottom)),
  };
}

// across, up : what is on the axes, with `name`, `unit` and `scale`
export function axes(context, box, view, across, up, theme) {
  const { x, y } = scales(box, view);
  context.strokeStyle = theme.line;
  context.lineWidth = 1;
  context.strokeRect(box.x + 0.5, box.y + 0.5, box.w - 1, box.h - 1);
  context.fillStyle = theme.ink;
  context.font = "10px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "top";
  for (const one of scaled(view.low, view.high, across, box.w / 50)) context.fillText(one.text, x(one.at), box.y + box.h + 3);
  context.fillText(titled(across.name, across), box.x + box.w / 2, box.y + box.h + 16);
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (const one of scaled(view.bottom, view.top, up, box.h / 40)) context.fillText(one.text, box.x - 3, y(one.at));
  context.save();
  context.translate(7, box.y + box.h / 2);
  context.rotate(-Math.PI / 2);
  context.textAlign = "center";
  context.fillText(titled(up.name, up), 0, 0);
  context.restore();
}

function scaled(low, high, { scale }, most) {
  return ticks(low * scale, high * scale, most).list.map(({ at, text }) => ({ at: at / scale, text }));
}

export function stops(context, one, view, x, y, theme) {
  context.setLineDash([3, 3]);
  for (const stop of [one.low, one.high]) {
    if (stop !== null) polyline(context, 2, (k) => x(k ? view.high : view.low), () => y(stop), theme.faint);
  }
  context.setLineDash([]);
}

export function clipped(context, box, draw) {
  context.save();
  context.beginPath();
  context.rect(box.x, box.y, box.w, box.h);
  context.clip();
  draw();
  context.restore();
}

// where a compliant stop is pressed, once more and thick
export function pressed(context, one, x, y, colour) {
  one.arrays.contact_touch.forEach((touch, c) => {
    const release = one.arrays.contact_release[c], from = one.t.findIndex((t) => t >= touch);
    let n = 0;
    while (from + n < one.t.length && one.t[from + n] <= release) n++;
    if (from >= 0) polyline(context, n, (k) => x(from + k), (k) => y(from + k), colour, 3.5);
  });
}

export function polyline(context, n, x, y, colour, width = 1.2) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.beginPath();
  for (let k = 0; k < n; k++) context.lineTo(x(k), y(k));
  context.stroke();
}

export function dot(context, x, y, colour) {
  context.fillStyle = colour;
  context.beginPath();
  context.arc(x, y, 4, 0, 7);
  context.fill();
}

export function at(one, values, phase) {
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
