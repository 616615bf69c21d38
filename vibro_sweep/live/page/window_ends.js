// Why a window ends: the branches that are drawn, and words.

import { measured } from "./units.js";

// the arrays of each branch, one behind the other
export function branchesOf({ arrays, branches = [] }) {
  let first = 0, at = 0;
  return branches.map(([n, m]) => {
    const own = (values) => values.subarray(first, first + n);
    const one = { value: own(arrays.value), unstable: own(arrays.unstable), y: arrays.y.subarray(at, at + n * m), m };
    first += n;
    at += n * m;
    return one;
  });
}

// quantity : unit and scale of the swept number
export function wordsOfWindow(why, axis, quantity) {
  if (why.reason) return [paragraph(`At ${axis} = ${measured(why.value, quantity)}: ${why.reason}.`)];
  const error = (one) => (one.error ? ` ± ${measured(one.error, quantity, 1)}` : "");
  const end = (one, side) => paragraph(`${side} end ${measured(one.value, quantity)}${error(one)}: ${one.type}, ${one.text}`);
  const kind = `${why.itinerary || `without ${why.event}s`}, period ${why.period}${why.symmetric ? ", symmetric" : why.mirrored ? ", or its mirror image" : ""}`;
  const others = why.specials.filter((one) => one.type !== "boundary").map((one) => `${one.type} at ${measured(one.value, quantity, 8)}`);
  return [
    paragraph(`Window of the orbit ${kind}:`), end(why.low, "lower"), end(why.high, "upper"),
    paragraph(`On its branch, stable (solid) or not (dashed): ${others.join(", ") || "no special point"}.`),
    ...(why.branches.length > 1 ? [paragraph(`Dashed, too: the motions that meet it at a graze, with one ${why.event} more or less.`)] : []),
  ];
}

function paragraph(words) {
  const element = document.createElement("p");
  element.textContent = words;
  return element;
}
