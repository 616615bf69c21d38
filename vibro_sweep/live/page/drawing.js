// Draws a diagram on a canvas: density of section points, period strip, exponents. It knows no server.

import { shown, ticks } from "./axes.js";
import { measured, titled } from "./units.js";

const LEFT = 62, RIGHT = 20, TOP = 10, BOTTOM = 42, STRIP = 10, SPACE = 8;
const NOMINAL = 200; // section points of a column, whatever it has
const PALE = 0.3; // opacity of what is computed anew
const FAINTEST = 0.5; // opacity of a seldom place of two starts in two colours

export class Drawing {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.exponentRange = null;
  }

  layout() {
    const box = this.canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
    const width = Math.max(200, Math.round(box.width)), height = Math.max(200, Math.round(box.height));
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
    }
    const lower = Math.round((height - TOP - BOTTOM) * 0.26);
    const dots = { x: LEFT, y: TOP, w: width - LEFT - RIGHT, h: height - TOP - BOTTOM - lower - STRIP - 2 * SPACE };
    const strip = { x: LEFT, y: dots.y + dots.h + SPACE, w: dots.w, h: STRIP };
    const exponents = { x: LEFT, y: strip.y + STRIP + SPACE, w: dots.w, h: lower };
    return { ratio, width, height, dots, strip, exponents };
  }

  // picture: {data, pale, view: {low, high, bottom, top}, colours, names, units, marks}; pale: the data are those of an
  // older view
  draw(picture) {
    const { context } = this, place = this.layout();
    this.place = place;
    const theme = themeOf(this.canvas);
    context.setTransform(place.ratio, 0, 0, place.ratio, 0, 0);
    context.fillStyle = theme.paper;
    context.fillRect(0, 0, place.width, place.height);
    const { data, view, units } = picture;
    this.pale = picture.pale;
    if (data) {
      this.tint(data, view, place, picture.certain, theme);
      this.density(data, view, place, picture.colours, theme);
      this.strip(data, view, place, picture.colours);
      context.globalAlpha = 1;
    }
    this.frame(place.dots, theme);
    this.verticalAxis(place.dots, view.bottom, view.top, picture.names.height, units.height, theme);
    if (data) this.exponents(data, view, place, picture.colours, units.exponents, theme);
    this.frame(place.exponents, theme);
    this.horizontalAxis(place, view, picture.names.axis, units.axis, theme);
    this.marks(picture, place, theme);
    if (data?.both) this.legend(place.dots, picture.colours, theme);
  }

  // of a column whose periods and exponents may still be those of the diagram before
  opacity(data, c) {
    return this.pale || data.fresh[c] !== 2 ? PALE : 1;
  }

  density(data, view, place, colours, theme) {
    const { ratio, dots } = place, W = Math.round(dots.w * ratio), H = Math.round(dots.h * ratio);
    if (W < 2 || H < 2 || !(view.top > view.bottom)) return;
    if (!this.image || this.image.width !== W || this.image.height !== H) {
      this.image = this.context.createImageData(W, H);
      this.pixels = new Uint32Array(this.image.data.buffer);
      this.cells = [0, 1].map(() => new Float32Array(W * H));
    }
    const { pixels } = this, scale = H / (view.top - view.bottom), base = view.bottom - data.middle;
    this.cells.forEach((cells) => cells.fill(0));
    const drawn = [...data.drawnColumns()], n = data.columns, thick = ratio >= 1.5 ? 2 : 1;
    for (let c = 0; c < drawn.length; c++) {
      const [from, to] = pixelsOf(data, view, c, W);
      if (to <= 0 || from >= W) continue;
      for (let s = 0; s < data.starts; s++) {
        const points = data.dots[drawn[c] * data.starts + s];
        if (!points || !points.length) continue;
        // up and down have layers of their own; in a preview, where they do not follow, both are there
        const cells = this.cells[data.both && s ? 1 : 0], shared = data.both && data.fresh[drawn[c]] === 1;
        const weight = (NOMINAL / points.length / (data.both ? 1 : data.starts)) * Math.min(1, (W * 1.0) / n);
        for (let i = 0; i < points.length; i++) {
          const row = H - 1 - Math.floor((points[i] - base) * scale);
          if (row < 0 || row >= H) continue;
          for (let x = Math.max(0, from); x < Math.min(W, to); x++) {
            for (let r = row; r < Math.min(H, row + thick); r++) {
              cells[r * W + x] += weight;
              if (shared) this.cells[1][r * W + x] += weight;
            }
          }
        }
      }
    }
    const [first, second] = this.cells, most = Math.log(NOMINAL), alone = tableOf(colours.density, theme);
    const [up, down] = colours.branches.map(([, colour]) => rampOf(colour, theme)), both = rampOf(theme.ink, theme);
    for (let i = 0; i < first.length; i++) {
      const cell = first[i] + second[i];
      const table = !data.both ? alone : !second[i] ? up : first[i] ? both : down;
      pixels[i] = cell === 0 ? theme.clear : table[Math.max(0, Math.min(255, ((Math.log(cell) / most) * 255) | 0))];
    }
    this.layer ??= document.createElement("canvas");
    if (this.layer.width !== W || this.layer.height !== H) [this.layer.width, this.layer.height] = [W, H];
    this.layer.getContext("2d").putImageData(this.image, 0, 0);
    this.context.globalAlpha = this.pale ? PALE : 1;
    this.context.drawImage(this.layer, dots.x, dots.y, dots.w, dots.h);
  }

  tint(data, view, place, certain, theme) {
    if (!data.exponents) return;
    this.context.fillStyle = theme.tint;
    for (let c = 0; c < data.columns; c++) {
      const [from, to] = pixelsOf(data, view, c, place.dots.w);
      const left = Math.max(0, from), right = Math.min(place.dots.w, to);
      if (right <= left) continue;
      this.context.globalAlpha = this.opacity(data, c);
      for (const [s, y, h] of rowsOf(data, place.exponents)) {
        const at = (c * data.starts + s) * data.K;
        if (data.exponents[at] > certain * data.errors[at]) this.context.fillRect(place.exponents.x + left, y, right - left, h);
      }
    }
  }

  strip(data, view, place, colours) {
    const { strip } = place;
    for (let c = 0; c < data.columns; c++) {
      const [from, to] = pixelsOf(data, view, c, strip.w);
      const left = Math.max(0, from), right = Math.min(strip.w, to);
      if (right <= left) continue;
      this.context.globalAlpha = this.opacity(data, c);
      for (const [s, y, h] of rowsOf(data, strip)) {
        const period = data.period[c * data.starts + s];
        if (period < 0) continue;
        this.context.fillStyle = periodColour(period, colours);
        this.context.fillRect(strip.x + left, y, right - left, h);
      }
    }
  }

  fitExponents(data) {
    if (!data?.exponents) return;
    const found = Array.from(data.exponents).filter(Number.isFinite).sort((a, b) => a - b);
    if (!found.length) return;
    const low = found[Math.floor(0.01 * (found.length - 1))], high = found[found.length - 1];
    const top = Math.max(high, 0), bottom = Math.min(low, 0), half = Math.max(0.6 * (top - bottom), 1e-6), centre = (top + bottom) / 2;
    this.exponentRange = [centre - half, centre + half];
  }

  // of up and down the first one in their colours, the others pale; the wider line of one shows below that of the other
  exponents(data, view, place, colours, unit, theme) {
    const { exponents: box } = place, { context } = this;
    if (!data.exponents || !this.exponentRange) return;
    const [low, high] = this.exponentRange, y = (v) => box.y + box.h * (1 - (v - low) / (high - low));
    context.save();
    context.beginPath();
    context.rect(box.x, box.y, box.w, box.h);
    context.clip();
    context.strokeStyle = theme.faint;
    context.lineWidth = 1;
    line(context, box.x, y(0), box.x + box.w, y(0));
    for (let k = data.K - 1; k >= 0; k--) {
      const colour = (theme.dark ? colours.exponents_dark : colours.exponents)[k] ?? theme.faint;
      for (let c = 0; c < data.columns; c++) {
        const [from, to] = pixelsOf(data, view, c, box.w);
        if (to < 0 || from > box.w) continue;
        for (let s = 0; s < data.starts; s++) {
          const v = data.exponents[(c * data.starts + s) * data.K + k], tall = data.both && s === 0 ? 3 : 1.5;
          if (!Number.isFinite(v)) continue;
          context.fillStyle = data.both ? colours.branches[s][1] : colour;
          context.globalAlpha = this.opacity(data, c) * (data.both && k ? 0.4 : 1);
          context.fillRect(box.x + from, y(v) - tall / 2, Math.max(1.2, to - from), tall);
        }
      }
    }
    context.restore();
    this.verticalAxis(box, low, high, "λ", unit, theme);
  }

  frame(box, theme) {
    this.context.strokeStyle = theme.line;
    this.context.lineWidth = 1;
    this.context.strokeRect(box.x - 0.5, box.y - 0.5, box.w + 1, box.h + 1);
  }

  legend(dots, colours, theme) {
    const { context } = this, entries = [...colours.branches, ["both", theme.ink]];
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "right";
    context.textBaseline = "top";
    let right = dots.x + dots.w - 6;
    for (const [words, colour] of entries.reverse()) {
      this.readable(words, right, dots.y + 5, theme);
      right -= context.measureText(words).width + 13;
      context.fillStyle = colour;
      context.fillRect(right, dots.y + 6, 9, 9);
      right -= 9;
    }
  }

  verticalAxis(box, from, to, name, quantity, theme) {
    const low = from * quantity.scale, high = to * quantity.scale;
    const { context } = this, { base, list } = ticks(low, high, Math.max(2, box.h / 60)), words = titled(name, quantity);
    context.fillStyle = theme.ink;
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const one of list) {
      const y = box.y + box.h * (1 - (one.at - low) / (high - low));
      context.fillText(one.text, box.x - 5, y);
      context.fillRect(box.x - 3, y, 3, 1);
    }
    context.save();
    context.translate(11, box.y + box.h / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(base === null ? words : `${words} − ${shown(base)}`, 0, 0);
    context.restore();
  }

  horizontalAxis(place, view, name, quantity, theme) {
    const low = view.low * quantity.scale, high = view.high * quantity.scale, words = titled(name, quantity);
    const { context } = this, box = place.exponents, { base, list } = ticks(low, high, box.w / 90);
    context.fillStyle = theme.ink;
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "top";
    const bottom = box.y + box.h;
    for (const one of list) {
      const x = box.x + (box.w * (one.at - low)) / (high - low);
      context.fillRect(x, bottom, 1, 3);
      context.fillText(one.text, x, bottom + 6);
    }
    context.font = "12px system-ui, sans-serif";
    context.fillText(base === null ? words : `${words} − ${shown(base)}`, box.x + box.w / 2, bottom + 22);
  }

  marks({ view, marks, units }, place, theme) {
    const { context } = this, { dots, exponents } = place;
    const x = (v) => dots.x + (dots.w * (v - view.low)) / (view.high - view.low);
    const y = (v) => dots.y + dots.h * (1 - (v - view.bottom) / (view.top - view.bottom));
    const inside = (v) => v >= view.low && v <= view.high;
    context.save();
    context.beginPath();
    context.rect(dots.x, dots.y, dots.w, exponents.y + exponents.h - dots.y);
    context.clip();
    context.font = "11px system-ui, sans-serif";
    context.textBaseline = "top";
    if (marks.window) {
      const left = Math.max(dots.x, x(marks.window.low.value)), right = Math.min(dots.x + dots.w, x(marks.window.high.value));
      context.fillStyle = theme.window;
      if (right > left) context.fillRect(left, dots.y, right - left, dots.h);
    }
    for (const value of marks.grazing.filter(inside)) {
      context.strokeStyle = context.fillStyle = theme.grazing;
      context.setLineDash([5, 4]);
      line(context, x(value), dots.y, x(value), exponents.y + exponents.h);
      context.setLineDash([]);
      context.textAlign = x(value) > dots.x + dots.w - 30 ? "right" : "left";
      context.fillText("b*", x(value) + (context.textAlign === "left" ? 4 : -4), dots.y + 3);
    }
    context.save();
    context.beginPath();
    context.rect(dots.x, dots.y, dots.w, dots.h); // these have a height there, and none among the exponents
    context.clip();
    for (const values of marks.stops) {
      context.strokeStyle = theme.faint;
      context.setLineDash([2, 3]);
      line(context, x(view.low), y(values[0]), x(view.high), y(values[1]));
      context.setLineDash([]);
    }
    for (const one of marks.branches) this.branch(one, x, y, theme);
    context.restore();
    if (marks.window) this.ends(marks.window, units.axis, x, dots, inside, theme);
    if (marks.line !== null && inside(marks.line)) {
      context.strokeStyle = theme.accent;
      context.lineWidth = 1.2;
      line(context, x(marks.line), dots.y, x(marks.line), exponents.y + exponents.h);
    }
    if (marks.rectangle) {
      const [x0, y0, x1, y1] = marks.rectangle;
      context.fillStyle = theme.window;
      context.strokeStyle = theme.accent;
      context.fillRect(Math.min(x0, x1), Math.min(y0, y1), Math.abs(x1 - x0), Math.abs(y1 - y0));
      context.strokeRect(Math.min(x0, x1), Math.min(y0, y1), Math.abs(x1 - x0), Math.abs(y1 - y0));
    }
    context.restore();
  }

  branch({ value, unstable, y: heights, m }, x, y, theme) {
    const { context } = this;
    for (const wanted of [1, 0]) {
      context.strokeStyle = wanted ? theme.unstable : theme.stable;
      context.setLineDash(wanted ? [4, 3] : []);
      context.lineWidth = wanted ? 1.3 : 1.8;
      for (let j = 0; j < m; j++) {
        context.beginPath();
        for (let i = 1; i < value.length; i++) {
          if (Math.max(unstable[i - 1], unstable[i]) !== wanted) continue;
          context.moveTo(x(value[i - 1]), y(heights[(i - 1) * m + j]));
          context.lineTo(x(value[i]), y(heights[i * m + j]));
        }
        context.stroke();
      }
    }
    context.setLineDash([]);
  }

  // a text over dots
  readable(words, x, y, theme) {
    const { context } = this;
    context.strokeStyle = theme.paper;
    context.lineWidth = 4;
    context.lineJoin = "round";
    context.strokeText(words, x, y);
    context.fillStyle = theme.ink;
    context.fillText(words, x, y);
  }

  ends(window, quantity, x, dots, inside, theme) {
    const { context } = this;
    [window.low, window.high].forEach((end, i) => {
      if (!inside(end.value)) return;
      const left = x(end.value);
      context.strokeStyle = theme.stable;
      context.lineWidth = 1;
      line(context, left, dots.y, left, dots.y + dots.h);
      context.textAlign = i ? "left" : "right";
      if (i === 0 && left - dots.x < 150) context.textAlign = "left";
      if (i === 1 && dots.x + dots.w - left < 150) context.textAlign = "right";
      const by = context.textAlign === "left" ? 4 : -4;
      const level = dots.y + 18 + 28 * i;
      this.readable(end.type, left + by, level, theme);
      this.readable(measured(end.value, quantity, 9), left + by, level + 13, theme);
    });
  }
}

export function periodColour(period, colours) {
  if (period === 0) return colours.no_period;
  return colours.periods[period - 1] ?? colours.longer;
}

export function themeOf(element) {
  const style = getComputedStyle(element), colour = (name) => style.getPropertyValue(name).trim();
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const paper = colour("--paper");
  return {
    dark, paper, clear: packed(paper), ink: colour("--ink"), faint: colour("--faint"), line: colour("--line"),
    accent: colour("--accent"), second: colour("--second"), tint: colour("--tint"), stable: dark ? "#7fd1ff" : "#0a4f8a",
    unstable: dark ? "#ff8f8f" : "#c01830", grazing: dark ? "#d59cf0" : "#7b3294",
    window: dark ? "rgba(106,180,244,.16)" : "rgba(31,111,180,.12)",
  };
}

// [start, top, height]: that of the first start, or of up and down one above the other
function rowsOf(data, box) {
  return data.both ? [[0, box.y, box.h / 2], [1, box.y + box.h / 2, box.h / 2]] : [[0, box.y, box.h]];
}

// the pixels [from, to) of a column: neighbours meet in the middle
export function pixelsOf(data, view, c, W) {
  const n = data.columns - 1, first = data.axis?.[0] ?? view.low, last = data.axis?.[n] ?? view.high;
  const scale = W / (view.high - view.low), step = (last - first) / n;
  const at = data.axis ? data.axis[c] : first + c * step;
  const from = Math.floor((at - step / 2 - view.low) * scale), to = Math.floor((at + step / 2 - view.low) * scale);
  return [from, Math.max(to, from + 1)];
}

function tableOf(density, theme) {
  const key = theme.dark ? "dark" : "light";
  tableOf.kept ??= {};
  if (tableOf.kept[key]) return tableOf.kept[key];
  const table = new Uint32Array(256);
  for (let i = 0; i < 256; i++) {
    const j = theme.dark ? Math.round(165 * (1 - i / 255)) : i;
    table[i] = (255 << 24) | (density[3 * j + 2] << 16) | (density[3 * j + 1] << 8) | density[3 * j];
  }
  return (tableOf.kept[key] = table);
}

// from a pale colour to the colour itself
function rampOf(colour, theme) {
  const full = packed(colour);
  return Uint32Array.from({ length: 256 }, (_, i) => mixed(theme.clear, full, FAINTEST + (1 - FAINTEST) * (i / 255)));
}

function mixed(paper, colour, share) {
  const part = (shift) => Math.round(((paper >> shift) & 255) * (1 - share) + ((colour >> shift) & 255) * share) << shift;
  return ((255 << 24) | part(16) | part(8) | part(0)) >>> 0;
}

function packed(hex) {
  const n = parseInt(hex.slice(1), 16);
  return ((255 << 24) | ((n & 255) << 16) | (((n >> 8) & 255) << 8) | (n >> 16)) >>> 0;
}

function line(context, x0, y0, x1, y1) {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}
