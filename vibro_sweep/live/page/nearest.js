// Which orbit a place in the picture means: that of the nearest dot.

import { pixelsOf } from "./drawing.js";

const REACH = 6; // pixels to both sides: an orbit is shown at the value that was pointed at

// {column, start} of the dot nearest to (x, y), pixels of the canvas, or of the nearest exponent; null without a diagram
export function orbitNear(data, { place, exponentRange }, { view, range, start }, x, y) {
  if (!data?.axis) return null;
  const { dots, exponents } = place, scale = dots.h / (range[1] - range[0]);
  const column = data.column(view.low + ((view.high - view.low) * (x - dots.x)) / dots.w);
  if (y >= exponents.y) return { column, start: startOfExponent(data, column, exponents, exponentRange, y) ?? start };
  let best = { column, start }, least = Infinity;
  for (let c = 0; c < data.columns; c++) {
    const [from, to] = pixelsOf(data, view, c, dots.w), across = Math.max(0, dots.x + from - x, x - dots.x - to);
    if (across > REACH) continue;
    for (let s = 0; s < data.starts; s++) {
      for (const point of data.dots[c * data.starts + s] ?? []) {
        const up = dots.y + (range[1] - data.middle - point) * scale - y;
        const away = across * across + up * up;
        if (away < least) [least, best] = [away, { column: c, start: s }];
      }
    }
  }
  return best;
}

function startOfExponent(data, column, box, range, y) {
  if (!data.exponents || !range) return null;
  const at = range[1] - ((range[1] - range[0]) * (y - box.y)) / box.h, first = column * data.starts * data.K;
  let best = null, least = Infinity;
  data.exponents.subarray(first, first + data.starts * data.K).forEach((value, n) => {
    if (Math.abs(value - at) < least) [least, best] = [Math.abs(value - at), Math.floor(n / data.K)];
  });
  return best;
}
