// What is known of a diagram: section points, exponents and periods by column, as they come.

export class DiagramData {
  constructor(about) {
    this.columns = about.columns;
    this.starts = about.starts;
    this.middle = about.middle;
    this.record = about.record;
    this.axis = null;
    this.dots = new Array(this.columns * this.starts).fill(null); // Float32Array, relative to `middle`
    this.period = new Int32Array(this.columns * this.starts).fill(-1); // -1: not known yet
    this.status = new Int8Array(this.columns * this.starts).fill(-1);
    this.fresh = new Uint8Array(this.columns); // 1: a preview, 2: the numbers themselves
    this.exponents = null; // (columns, starts, K)
    this.errors = null;
    this.K = 0;
  }

  // exponents and periods of the diagram before, until there are new ones
  inherit(other) {
    if (!other || other.columns !== this.columns || other.starts !== this.starts) return;
    this.K = other.K;
    this.exponents = other.exponents?.slice() ?? null;
    this.errors = other.errors?.slice() ?? null;
    this.period = other.period.slice();
  }

  take(frame) {
    const { arrays } = frame;
    if (arrays.axis) this.axis = arrays.axis;
    const preview = frame.kind === "preview";
    const columns = Math.ceil((this.columns - frame.first) / frame.step);
    const orbits = arrays.count.length;
    let here = Math.max(1, Math.round(orbits / columns)); // starts in this frame
    const length = frame.length ?? orbits / here;
    const K = arrays.lyapunov ? arrays.lyapunov.length / orbits : 0;
    if (K && (!this.exponents || this.K !== K)) {
      this.K = K;
      this.exponents = new Float32Array(this.columns * this.starts * K).fill(NaN);
      this.errors = new Float32Array(this.columns * this.starts * K).fill(NaN);
    }
    let at = 0;
    for (let i = 0, n = 0; i < length; i++) {
      const column = frame.first + i * frame.step;
      const late = preview && this.fresh[column] === 2; // the numbers themselves came first, from another worker
      for (let s = 0; s < here; s++, n++) {
        const to = column * this.starts + (frame.first_start ?? 0) + s;
        const count = arrays.count[n];
        if (!late) this.dots[to] = arrays.y.subarray(at, at + count);
        at += count;
        if (preview) continue;
        this.status[to] = arrays.status[n];
        this.period[to] = arrays.period[n];
        for (let k = 0; k < K; k++) {
          this.exponents[to * K + k] = arrays.lyapunov[n * K + k];
          this.errors[to * K + k] = arrays.lyapunov_error[n * K + k];
        }
      }
      this.fresh[column] = preview ? Math.max(1, this.fresh[column]) : 2;
    }
  }

  // for each column that which is drawn there: itself, or the last one before it that is known
  *drawnColumns() {
    let last = this.fresh.findIndex((one) => one > 0);
    if (last < 0) return;
    for (let c = 0; c < this.columns; c++) {
      if (this.fresh[c]) last = c;
      yield last;
    }
  }

  range() {
    let low = Infinity, high = -Infinity;
    for (const dots of this.dots) {
      if (!dots) continue;
      for (const y of dots) {
        if (y < low) low = y;
        if (y > high) high = y;
      }
    }
    if (!(low <= high)) return null;
    const half = Math.max(0.53 * (high - low), 1e-3 * Math.abs((low + high) / 2 + this.middle), 1e-12);
    const centre = (low + high) / 2 + this.middle;
    return [centre - half, centre + half];
  }

  column(value) {
    if (!this.axis) return -1;
    const n = this.columns - 1, first = this.axis[0], last = this.axis[n];
    return Math.max(0, Math.min(n, Math.round((n * (value - first)) / (last - first))));
  }
}
