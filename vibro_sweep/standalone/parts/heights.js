// What stands on the vertical axis, from the section points of the masses.

import { MASSES, NORMAL, numbersOf, STOPS } from "./oscillator.js";
import { restState } from "./steady.js";

export const heightOf = {
  // the stops, the normal of the gap and which stops are compliant, of an oscillator with these numbers
  stops(v) {
    const numbers = numbersOf(v), [low, high, , , k_low, , , k_high] = numbers.slice(STOPS);
    return { low, high, normal: numbers.slice(NORMAL, NORMAL + MASSES), pressed: [k_low > 0, k_high > 0] };
  },

  // positions of the masses at rest; none where they are not known
  rest: (v) => restState(numbersOf(v)) ?? [],

  // one number for each section point
  values(y, sections, v) {
    const width = 2 * MASSES, n = sections.length / width, { normal } = this.stops(v);
    const place = /^([xv])(\d+)$/.exec(y);
    const of = place
      ? (at) => sections[at + 2 * (place[2] - 1) + (place[1] === "v" ? 1 : 0)]
      : (at) => normal.reduce((sum, by, i) => sum + by * sections[at + 2 * i + (y === "gap" ? 0 : 1)], 0) * (y === "speed_left" ? -1 : 1);
    return Float64Array.from({ length: n }, (_, k) => of(k * width));
  },
};
