// The masses between their stops, at one moment.

import { at, polyline, prepare } from "./small_plots.js";

// clock: forcing periods since the orbit began
export function drawMasses(canvas, orbit, clock) {
  const { context, theme, box: { x: left, w, fullHeight: h } } = prepare(canvas, 8);
  const { gapIsFirst, masses: N, low, high } = orbit;
  const rows = gapIsFirst ? N : N + 1, height = h / rows, size = Math.min(34, height * 0.42);
  const reach = Math.max(1e-9, orbit.reach, Math.abs(low ?? 0), Math.abs(high ?? 0));
  const scale = (w / 2 - size - 6) / reach, middle = left + w / 2;
  context.font = "11px system-ui, sans-serif";
  context.textBaseline = "middle";
  context.textAlign = "center";
  for (let r = 0; r < rows; r++) {
    const ofGap = r === 0, mass = gapIsFirst ? r : r - 1, centre = height * (r + 0.5);
    polyline(context, 2, (k) => (k ? left + w : left), () => centre + size / 2 + 1, theme.line);
    const value = at(orbit, ofGap ? orbit.gap : orbit.positions[mass], clock), x = middle + scale * value;
    if (ofGap) walls(context, orbit, value, { x: (v) => middle + scale * v, centre, size, height, near: 0.004 * reach }, theme);
    context.fillStyle = ofGap ? theme.accent : theme.faint;
    context.fillRect(x - size / 2, centre - size / 2, size, size);
    context.fillStyle = theme.paper;
    context.fillText(ofGap && !gapIsFirst ? "gap" : String(mass + 1), x, centre);
  }
}

// the stops; one that is compliant goes with the mass that presses it
function walls(context, orbit, value, { x, centre, size, height, near }, theme) {
  [[orbit.low, -1], [orbit.high, 1]].forEach(([stop, side], k) => {
    if (stop === null) return;
    const beyond = orbit.pressed[k] && side * (value - stop) > 0;
    const wall = x(beyond ? value : stop) + side * (size / 2), edge = side > 0 ? wall : wall - 5;
    context.fillStyle = beyond || Math.abs(value - stop) < near ? theme.second : theme.faint;
    context.fillRect(edge, centre - height * 0.36, 5, height * 0.72);
  });
}
