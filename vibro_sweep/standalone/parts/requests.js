// What may be asked for: whatever an address holds, nothing is computed that is too large or of another machine.

const isNumber = Number.isFinite;
const isWhole = (value, low, high) => Number.isInteger(value) && value >= low && value <= high;
const same = (one, other) => JSON.stringify(one) === JSON.stringify(other);

// why a view is refused, "" where it is not; page: all that the page knows of its oscillator
export function refusalOf(view, page) {
  try {
    return ofSystem(view.scene, page) || ofSweep(view.scene, page) || ofStart(view.scene.start, page) || ofHeight(view.y, page);
  } catch {
    return "not a view of this page";
  }
}

// other numbers than the page's own are allowed, other options are another kernel or other formulas
function ofSystem({ system, dynamics = "flow" }, { model, ranges }) {
  const own = model.view.scene.system;
  if (dynamics !== "flow") return "dynamics: this page computes the oscillator itself";
  for (const name of new Set([...Object.keys(own), ...Object.keys(system)])) {
    const value = system[name], mine = own[name];
    if (same(value, mine) || (value === undefined && isNumber(mine))) continue; // what is left out is as the page has it
    const list = Array.isArray(value) && value.every(isNumber) && `${name}1` in ranges && value.length === mine.length;
    const number = isNumber(value) && (name in ranges || name === "frequency");
    if (!list && !number) return mine === undefined ? `${name}: no number of this page's oscillator` : `${name}: this page is of ${JSON.stringify(mine)}`;
  }
  return "";
}

function ofSweep({ sweep, orbit: { transient, record }, start }, { ranges, most }) {
  const [[axis, { start: low, stop: high, num }], ...others] = Object.entries(sweep);
  if (others.length || !(axis in ranges || axis === "frequency")) return `sweep: one of ${Object.keys(ranges).join(", ")}`;
  if (!(isNumber(low) && isNumber(high) && low < high)) return `${axis}: from a number to a larger one`;
  if (!isWhole(num, 2, most.columns)) return `columns: 2 to ${most.columns}`;
  if (!isWhole(transient, 0, most.transient)) return `transient: 0 to ${most.transient} periods`;
  if (!isWhole(record, 1, most.record)) return `record: 1 to ${most.record} periods`;
  const orbits = num * (start.random ?? (start.follow === "both" ? 2 : 1));
  if (orbits * record > most.dots) return `at most ${most.dots.toExponential(0)} section points: fewer columns, starts or recorded periods`;
  if (orbits * (record + transient) > most.periods) return `at most ${most.periods.toExponential(0)} periods: fewer columns, starts or periods`;
  return "";
}

function ofStart(start, { layout: { masses } }) {
  const states = Array.from({ length: masses }, (_, n) => [`x${n + 1}`, `v${n + 1}`]).flat();
  for (const [name, value] of Object.entries(start)) {
    const allowed = name === "follow" ? ["up", "down", "both"].includes(value)
      : name === "random" ? isWhole(value, 1, 1e6)
        : name === "seed" ? Number.isInteger(value) : states.includes(name) && isNumber(value);
    if (!allowed) return `start: ${name} = ${JSON.stringify(value)} is not allowed`;
  }
  return "";
}

function ofHeight(y, { model }) {
  const names = model.heights.map(([name]) => name);
  return names.includes(y) ? "" : `y: one of ${names.join(", ")}`;
}
