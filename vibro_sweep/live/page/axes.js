// Ticks and labels of an axis, from numbers that may lie as close together as doubles do.

const DIGITS = 17;

export function ticks(low, high, most) {
  // [{at, text}], and `base`: the number from which the texts count where they would have too many digits
  const span = high - low;
  if (!(span > 0) || !isFinite(span)) return { base: null, list: [] };
  const near = span < 1e-5 * Math.max(Math.abs(low), Math.abs(high));
  const base = near ? (low + high) / 2 : 0;
  const raw = span / Math.max(1, most), power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw * 0.999);
  const list = [];
  for (let k = Math.ceil((low - base) / step); k * step <= high - base + 1e-9 * span; k++) {
    list.push({ at: base + k * step, text: near ? signed(k * step) : plain(k * step, step) });
    if (list.length > 50) break;
  }
  if (list.length < 2 && most < 64) return ticks(low, high, 2 * most); // one number alone gives no scale
  return { base: near ? base : null, list };
}

export function shown(value) {
  // a number as short as it can be, with all digits that count
  return Number.isFinite(value) ? String(Number(value.toPrecision(DIGITS - 1))) : "none";
}

export function short(value, digits = 5) {
  return Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : "none";
}

function plain(value, step) {
  const decimals = Math.max(0, Math.min(12, -Math.floor(Math.log10(step) + 1e-9)));
  if (Math.abs(value) < step / 2) return "0";
  if (step >= 1e5 || step < 1e-6) return value.toExponential(2);
  return value.toFixed(decimals);
}

function signed(value) {
  if (value === 0) return "0";
  const text = Math.abs(value) < 1e-4 ? value.toExponential(1) : String(Number(value.toPrecision(6)));
  return value > 0 ? `+${text}` : text;
}
