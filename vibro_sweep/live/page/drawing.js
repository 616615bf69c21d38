// Draws a diagram on a canvas: density of section points, period strip, exponents. It knows no server.

import { short, shown, ticks } from "./axes.js";

const LEFT = 62, RIGHT = 20, TOP = 10, BOTTOM = 42, STRIP = 10, SPACE = 8;
const NOMINAL = 200; // section points of a column, whatever it has

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

  // picture: {data, view: {low, high, bottom, top}, colours, names, marks}
  draw(picture) {
    const { context } = this, place = this.layout();
    this.place = place;
    const theme = themeOf(this.canvas);
    context.setTransform(place.ratio, 0, 0, place.ratio, 0, 0);
    context.fillStyle = theme.paper;
    context.fillRect(0, 0, place.width, place.height);
    const { data, view } = picture;
    if (data) {
      this.tint(data, view, place, picture.certain, theme);
      this.density(data, view, place, picture.colours, theme);
      this.strip(data, view, place, picture.colours);
    }
    this.frame(place.dots, theme);
    this.verticalAxis(place.dots, view.bottom, view.top, picture.names.height, theme);
    if (data) this.exponents(data, view, place, picture.colours, theme);
    this.frame(place.exponents, theme);
    this.horizontalAxis(place, view, picture.names.axis, theme);
    this.marks(picture, place, theme);
  }

  density(data, view, place, colours, theme) {
    const { ratio, dots } = place, W = Math.round(dots.w * ratio), H = Math.round(dots.h * ratio);
    if (W < 2 || H < 2 || !(view.top > view.bottom)) return;
    if (!this.image || this.image.width !== W || this.image.height !== H) {
      this.image = this.context.createImageData(W, H);
      this.pixels = new Uint32Array(this.image.data.buffer);
      this.cells = new Float32Array(W * H);
    }
    const { cells, pixels } = this, scale = H / (view.top - view.bottom), base = view.bottom - data.middle;
    cells.fill(0);
    const drawn = [...data.drawnColumns()], n = data.columns, thick = ratio >= 1.5 ? 2 : 1;
    for (let c = 0; c < drawn.length; c++) {
      const [from, to] = pixelsOf(data, view, c, W);
      if (to <= 0 || from >= W) continue;
      for (let s = 0; s < data.starts; s++) {
        const points = data.dots[drawn[c] * data.starts + s];
        if (!points || !points.length) continue;
        const weight = (NOMINAL / points.length / data.starts) * Math.min(1, (W * 1.0) / n);
        for (let i = 0; i < points.length; i++) {
          const row = H - 1 - Math.floor((points[i] - base) * scale);
          if (row < 0 || row >= H) continue;
          for (let x = Math.max(0, from); x < Math.min(W, to); x++) {
            cells[row * W + x] += weight;
            if (thick === 2 && row + 1 < H) cells[(row + 1) * W + x] += weight;
          }
        }
      }
    }
    const table = tableOf(colours.density, theme), most = Math.log(NOMINAL);
    for (let i = 0; i < cells.length; i++) {
      const cell = cells[i];
      pixels[i] = cell === 0 ? theme.clear : table[Math.max(0, Math.min(255, ((Math.log(cell) / most) * 255) | 0))];
    }
    this.layer ??= document.createElement("canvas");
    if (this.layer.width !== W || this.layer.height !== H) [this.layer.width, this.layer.height] = [W, H];
    this.layer.getContext("2d").putImageData(this.image, 0, 0);
    this.context.drawImage(this.layer, dots.x, dots.y, dots.w, dots.h);
  }

  tint(data, view, place, certain, theme) {
    if (!data.exponents) return;
    this.context.fillStyle = theme.tint;
    for (let c = 0; c < data.columns; c++) {
      const at = c * data.starts * data.K;
      if (!(data.exponents[at] > certain * data.errors[at])) continue;
      const [from, to] = pixelsOf(data, view, c, place.dots.w);
      const left = Math.max(0, from), right = Math.min(place.dots.w, to);
      if (right > left) this.context.fillRect(place.exponents.x + left, place.exponents.y, right - left, place.exponents.h);
    }
  }

  strip(data, view, place, colours) {
    const { strip } = place;
    for (let c = 0; c < data.columns; c++) {
      const period = data.period[c * data.starts];
      if (period < 0) continue;
      const [from, to] = pixelsOf(data, view, c, strip.w);
      const left = Math.max(0, from), right = Math.min(strip.w, to);
      if (right <= left) continue;
      this.context.fillStyle = periodColour(period, colours);
      this.context.fillRect(strip.x + left, strip.y, right - left, strip.h);
    }
  }

  fitExponents(data) {
    if (!data?.exponents) return;
    const found = Array.from(data.exponents).filter(Number.isFinite).sort((a, b) => a - b);
    if (!found.length) return;
    const low = found[Math.floor(0.01 * (found.length - 1))], high = found[found.length - 1];
    const half = Math.max(0.6 * (high - low), 1e-6), centre = (Math.max(high, 0) + Math.min(low, 0)) / 2;
    this.exponentRange = [centre - half, centre + half];
  }

  exponents(data, view, place, colours, theme) {
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
      context.fillStyle = (theme.dark ? colours.exponents_dark : colours.exponents)[k] ?? theme.faint;
      for (let c = 0; c < data.columns; c++) {
        const [from, to] = pixelsOf(data, view, c, box.w);
        if (to < 0 || from > box.w) continue;
        for (let s = 0; s < data.starts; s++) {
          const v = data.exponents[(c * data.starts + s) * data.K + k];
          if (Number.isFinite(v)) context.fillRect(box.x + from, y(v) - 0.7, Math.max(1.2, to - from), 1.5);
        }
      }
    }
    context.restore();
    this.verticalAxis(box, low, high, "λ", theme);
  }

  frame(box, theme) {
    this.context.strokeStyle = theme.line;
    this.context.lineWidth = 1;
    this.context.strokeRect(box.x - 0.5, box.y - 0.5, box.w + 1, box.h + 1);
  }

  verticalAxis(box, low, high, name, theme) {
    const { context } = this, { base, list } = ticks(low, high, Math.max(2, box.h / 60));
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
    context.fillText(base === null ? name : `${name} − ${shown(base)}`, 0, 0);
    context.restore();
  }

  horizontalAxis(place, view, name, theme) {
    const { context } = this, box = place.exponents, { base, list } = ticks(view.low, view.high, box.w / 90);
    context.fillStyle = theme.ink;
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "top";
    const bottom = box.y + box.h;
    for (const one of list) {
      const x = box.x + (box.w * (one.at - view.low)) / (view.high - view.low);
      context.fillRect(x, bottom, 1, 3);
      context.fillText(one.text, x, bottom + 6);
    }
    context.font = "12px system-ui, sans-serif";
    context.fillText(base === null ? name : `${name} − ${shown(base)}`, box.x + box.w / 2, bottom + 22);
  }

  marks({ view, marks }, place, theme) {
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
    for (const values of marks.stops) {
      context.strokeStyle = theme.faint;
      context.setLineDash([2, 3]);
      line(context, x(view.low), y(values[0]), x(view.high), y(values[1]));
      context.setLineDash([]);
    }
    for (const one of marks.branches) this.branch(one, x, y, theme);
    if (marks.window) this.ends(marks.window, x, dots, inside, theme);
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

  ends(window, x, dots, inside, theme) {
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
      this.readable(short(end.value, 9), left + by, level + 13, theme);
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

function pixelsOf(data, view, c, W) {
  // the pixels [from, to) of a column: neighbours meet in the middle
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
