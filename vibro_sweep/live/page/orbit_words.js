// What is known of an orbit, in words.

import { short } from "./axes.js";
import { measured, titled } from "./units.js";

export function paragraph(one) {
  const p = document.createElement("p"), head = document.createElement("b");
  head.textContent = `${one.axis} = ${measured(one.value, one.axisUnit)}${one.way ? `, ${one.way}` : ""}: `;
  const rate = one.units.lyapunov, text = (v, digits) => short(v * rate.scale, digits);
  const exponents = [...one.arrays.exponents].map((v, k) => `${text(v, 4)} ± ${text(one.arrays.errors[k], 1)}`);
  const kind = one.period ? `period ${one.period}` : one.arrays.exponents[0] > one.certain * one.arrays.errors[0] ? "chaotic" : "no period found";
  const touching = one.contacts ? counted(one.contacts, "contact") : "no impacts";
  const itinerary = one.itinerary === undefined ? "" : one.itinerary.length > 40 ? counted(one.impacts, "impact") : one.itinerary || (one.period ? touching : "");
  const words = [kind, itinerary, one.rests ? `${counted(one.rests, "rest")} on a stop` : "", `${titled("λ", rate)} = ${exponents.join(", ")}`];
  if (one.status !== "computed") words.push(one.status);
  if (one.orbit_status && one.orbit_status !== "ok") words.push(one.orbit_status);
  if (one.alone) words.push("from the start of the scene alone, not from where the points before it lead");
  p.append(head, words.filter(Boolean).join("; "));
  return p;
}

function counted(n, word) {
  return `${n} ${word}${n === 1 ? "" : "s"}`;
}
