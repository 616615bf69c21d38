// Between the view of the page, in which every number has a place of its own, and the scene that a request holds.

export const requestOf = (view) => ({ scene: sceneOf(view), y: view.y });

function sceneOf({ axis, low, high, columns, start, transient, record, system, numbers = {}, map, picture = null }) {
  const whole = structuredClone(system);
  for (const [name, value] of Object.entries(numbers)) {
    const [, list, at] = /^(.*?)(\d+)$/.exec(name) ?? [];
    if (Array.isArray(whole[list])) whole[list][at - 1] = value;
    else whole[name] = value;
  }
  const sweep = { [axis]: { start: low, stop: high, num: columns } };
  return { ...map, system: whole, sweep, start, orbit: { transient, record }, picture };
}

export function viewOf({ scene, y }) {
  const { system, sweep, start, orbit, dynamics, order, expand_at, picture } = scene, [[axis, ends]] = Object.entries(sweep);
  const map = dynamics === "map" ? { dynamics, order, expand_at } : {};
  return { axis, low: ends.start, high: ends.stop, columns: ends.num, start, ...orbit, system, numbers: {}, map, picture, y };
}
