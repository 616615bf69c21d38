// Numbers in the units that they are shown in. All other parts of the page have them in those of the system: a quantity
// has `scale`, by which its numbers are multiplied to be shown, and `unit`, the text of the unit that they then have.

import { short, shown } from "./axes.js";

const DIGITS = 15; // of a product, whose last digit is rounding

export const RATIO = { unit: "", scale: 1 };

// as short as it can be, with all digits that count
export function whole(value, { scale }) {
  return scale === 1 ? shown(value) : short(value * scale, DIGITS);
}

export function typed(text, { scale }) {
  return Number(text) / scale;
}

// a number with its unit; a unit may have a factor, as "5 mm"
export function measured(value, quantity, digits = null) {
  const text = digits === null ? whole(value, quantity) : short(value * quantity.scale, digits), { unit } = quantity;
  return unit ? `${text} ${/^\d/.test(unit) ? "× " : ""}${unit}` : text;
}

// the name of an axis with its unit
export function titled(name, { unit }) {
  return unit ? `${name} [${unit}]` : name;
}
