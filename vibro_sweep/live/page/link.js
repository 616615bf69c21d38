// The socket to the program: requests as text, answers as text or as arrays behind a text.

const TYPES = {
  float64: Float64Array, float32: Float32Array, int32: Int32Array, uint32: Uint32Array, int8: Int8Array, uint8: Uint8Array,
};
export const TAKEN_OVER = 4000; // code with which the socket is closed when another page has come
export const EXPLAINS = true; // it says why a window ends
export const SHARING = "Copied. The link has no token: who opens it adds the ?token=... of a running program before the #.";
export const WAITING = "Computing. The first use of a kind of oscillator compiles its kernels, once: that takes up to a minute.";
const WAITS = [200, 500, 1000, 2000, 4000]; // ms before it tries again

export class Link {
  // on: {open, answer, closed}
  constructor(on) {
    this.on = on;
    this.tries = 0;
    this.seq = 0;
    this.connect();
  }

  connect() {
    const token = new URLSearchParams(location.search).get("token") ?? "";
    this.socket = new WebSocket(`ws${location.protocol === "https:" ? "s" : ""}://${location.host}/socket?token=${encodeURIComponent(token)}`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.tries = 0;
      this.on.open();
    };
    this.socket.onmessage = (event) => this.on.answer(decoded(event.data));
    this.socket.onclose = (event) => {
      this.on.closed(event, this.tries);
      if (event.code === TAKEN_OVER) return;
      setTimeout(() => this.connect(), WAITS[Math.min(this.tries++, WAITS.length - 1)]);
    };
  }

  get ready() {
    return this.socket.readyState === WebSocket.OPEN;
  }

  ask(type, values) {
    const seq = ++this.seq;
    if (this.ready) this.socket.send(JSON.stringify({ type, seq, ...values }));
    return seq;
  }
}

export function decoded(message) {
  if (typeof message === "string") return JSON.parse(message);
  const length = new DataView(message).getUint32(0, true);
  const text = JSON.parse(new TextDecoder().decode(new Uint8Array(message, 4, length)));
  let at = 4 + length;
  const arrays = {};
  for (const [name, type, size] of text.arrays) {
    arrays[name] = new TYPES[type](message, at, size);
    at += Math.ceil(arrays[name].byteLength / 8) * 8;
  }
  return { ...text, arrays };
}
