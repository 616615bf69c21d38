// Between the view of the page, in which every number has a place of its own, and the scene that a request holds.

export const requestOf = (view) => ({ scene: sceneOf(view), y: view.y });

function sceneOf({ axis, low, high, columns, start, transient, record, system, numbers = {}, map }) {
  const whole = structuredClone(system);
  for (const [name, value] of Object.entries(numbers)) {
    const [, list, at] = /^(.*?)(\d+)$/.exec(name) ?? [];
    if (Array.isArray(whole[list])) whole[list][at - 1] = value;
    else whole[name] = value;
  }
  return { ...map, system: whole, sweep: { [axis]: { start: low, stop: high, num: columns } }, start, orbit: { transient, record } };
}

export function viewOf({ scene, y }) {
  const { system, sweep, start, orbit, dynamics, order, expand_at } = scene, [[axis, ends]] = Object.entries(sweep);
  const map = dynamics === "map" ? { dynamics, order, expand_at } : {};
  return { axis, low: ends.start, high: ends.stop, columns: ends.num, start, ...orbit, system, numbers: {}, map, y };
}
