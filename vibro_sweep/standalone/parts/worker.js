// A worker of the page: it computes what it is sent, one after the other.

import { diagram, motion } from "./block.js";
import { Kernel } from "./kernel.js";
import { orbitOf } from "./clicked.js";

let ready = null; // the kernel, once its module is there
const tasks = { diagram, orbit: (kernel, task) => orbitOf(kernel, task, diagram, motion) };

async function started(module, layout) {
  const memory = new WebAssembly.Memory({ initial: 64, maximum: 65536 });
  const kernel = new Kernel(await WebAssembly.instantiate(module, { env: { memory } }), memory, layout);
  kernel.cells = 64;
  return kernel;
}

self.onmessage = async ({ data: { module, layout, number, task } }) => {
  if (module) {
    ready = started(module, layout);
    return;
  }
  try {
    const kernel = await ready, began = performance.now(), found = tasks[task.kind](kernel, task);
    self.postMessage({ number, found, ms: performance.now() - began });
  } catch (error) {
    self.postMessage({ number, error: error instanceof RangeError ? "there is not enough memory for so many points" : String(error.message ?? error) });
  }
};
