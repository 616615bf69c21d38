// The kernel in the memory of its module: where its arguments lie, and how it is called.

const LINE = 64; // bytes
const RETURNED = 4096; // bytes before the arguments, for what numba's functions return by address
const PAGE = 65536;

export class Kernel {
  // instance, memory: of the module; layout: as of standalone/kernel_arguments.py
  constructor(instance, memory, layout) {
    this.memory = memory;
    this.layout = layout;
    const { exports } = instance;
    this.run = exports[Object.keys(exports).find((name) => name.startsWith("_ZN"))];
    this.base = aligned(exports.__heap_base.value);
    this.sizes = null;
  }

  // room for so many of each, all of it zero but for the numbers of the lanes; kept where there is room already
  make(sizes) {
    const key = JSON.stringify(sizes);
    if (key === this.sizes) return;
    this.sizes = null;
    this.arguments = [this.base, this.base + RETURNED / 2];
    this.place = {};
    let at = this.base + RETURNED;
    for (const [name, kind, shape] of this.layout.arguments) {
      const here = { first: this.arguments.length, at, item: kind };
      this.place[name] = here;
      if (!shape) {
        this.arguments.push(kind === "i" ? 0n : 0);
        continue;
      }
      const lengths = shape.map(([start, slope]) => Object.entries(slope).reduce((sum, [size, by]) => sum + by * sizes[size], start));
      here.count = lengths.reduce((product, length) => product * length, 1);
      const strides = lengths.map((_, axis) => lengths.slice(axis + 1).reduce((product, length) => product * length, kind));
      this.arguments.push(0, 0, BigInt(here.count), BigInt(kind), at, ...lengths.map(BigInt), ...strides.map(BigInt));
      at = aligned(at + Math.max(here.count * kind, 1));
    }
    const missing = at - this.memory.buffer.byteLength;
    if (missing > 0) this.memory.grow(Math.ceil(missing / PAGE)); // throws where there is no memory
    this.bytes = new Uint8Array(this.memory.buffer);
    this.view = new DataView(this.memory.buffer);
    this.bytes.fill(0, this.base, at);
    const lanes = this.place["w.ensemble.orbits"];
    for (let n = 0; n < lanes.count; n++) this.view.setBigInt64(lanes.at + n * lanes.item + this.layout.lane, BigInt(n), true);
    this.sizes = key;
  }

  set(name, value) {
    const { first, item } = this.place[name];
    this.arguments[first] = item === "i" ? BigInt(value) : value;
  }

  // give an array these lengths, in the room that it has
  shape(name, ...lengths) {
    const { first, item } = this.place[name];
    lengths.forEach((length, axis) => {
      this.arguments[first + 5 + axis] = BigInt(length);
      const inner = lengths.slice(axis + 1).reduce((product, one) => product * one, item);
      this.arguments[first + 5 + lengths.length + axis] = BigInt(inner);
    });
  }

  floats(name, count, from = 0) {
    return new Float64Array(this.memory.buffer, this.place[name].at + 8 * from, count);
  }

  call() {
    const status = this.run(...this.arguments);
    if (status !== 0) throw new Error(`the kernel ended with status ${status}`);
  }
}

function aligned(place) {
  return Math.ceil(place / LINE) * LINE;
}
