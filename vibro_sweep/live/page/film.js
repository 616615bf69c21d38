// The masses between their stops, at one moment.

import { at, polyline, prepare } from "./small_plots.js";

// shown: [orbit, slot] of each; phase: forcing periods since an orbit began, of each
export function drawMasses(canvas, shown, phase) {
  const { context, theme, box: { x: left, w, fullHeight: h } } = prepare(canvas, 8);
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
      const value = at(each, mass < 0 || (gapRow && each.gapIsFirst) ? each.gap : each.positions[mass], phase(each));
      if (gapRow) walls(context, each, value, { x: (v) => middle + scale * v, centre, size, height, near: 0.004 * reach }, i, theme);
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
function walls(context, one, value, { x, centre, size, height, near }, i, theme) {
  [[one.low, -1], [one.high, 1]].forEach(([stop, side], k) => {
    if (stop === null) return;
    const beyond = one.pressed[k] && side * (value - stop) > 0;
    const wall = x(beyond ? value : stop) + side * (size / 2), edge = side > 0 ? wall : wall - 5;
    context.fillStyle = context.strokeStyle = beyond || Math.abs(value - stop) < near ? theme.second : theme.faint;
    if (i) context.strokeRect(edge, centre - height * 0.36, 5, height * 0.72);
    else context.fillRect(edge, centre - height * 0.36, 5, height * 0.72);
  });
}
