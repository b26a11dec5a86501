// Figures of a page that answer: zoom, pan, the value under the pointer, curves on and off, copies to keep.
// A figure's data stand beside its static picture (figure_data.hpp), which stays where this does not run.
'use strict';
const beamid = {};
beamid.bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
beamid.dark = matchMedia('(prefers-color-scheme: dark)');
beamid.make = (parent, tag, attributes = {}, text = '') => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text) element.textContent = text;
  parent.append(element);
  return element;
};
beamid.save = (name, blob) => {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
};

(() => {
const {make, bytes} = beamid;
const font = '"DejaVu Sans", Verdana, sans-serif';
const palette = {
  light: {blue: '#0072b2', vermillion: '#d55e00', green: '#009e73', purple: '#cc79a7', orange: '#e69f00', sky: '#56b4e9',
    black: '#000000', grey: '#7f7f7f', ink: '#222222', grid: '#dcdcdc', ground: '#ffffff'},
  dark: {blue: '#5ab4f0', vermillion: '#ff8a4c', green: '#2fd0a0', purple: '#e7a3c9', orange: '#f2b632', sky: '#8fd0f7',
    black: '#f0f0f0', grey: '#a0a0a0', ink: '#dddddd', grid: '#3a3a3a', ground: '#1a1a1a'}};
const theme = () => palette[beamid.dark.matches ? 'dark' : 'light'];

// "a_{eq}^{2}" as [text, 0 | 1 up | -1 down].
function pieces(label) {
  const found = [], mark = /([\^_])\{([^{}]*)\}/g;
  let last = 0, hit;
  while ((hit = mark.exec(label))) {
    if (hit.index > last) found.push([label.slice(last, hit.index), 0]);
    found.push([hit[2], hit[1] === '^' ? 1 : -1]);
    last = mark.lastIndex;
  }
  if (last < label.length) found.push([label.slice(last), 0]);
  return found;
}
const plain = (label) => pieces(label).map((piece) => piece[0]).join('');
function number(value) {
  if (!Number.isFinite(value)) return '-';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return value.toExponential(5).replace(/\.?0+e/, 'e');
  return String(Number(value.toPrecision(7)));
}
const unit = (label) => (/\[([^\]]*)\]\s*$/.exec(plain(label)) || ['', ''])[1];
const named = (label) => plain(label).replace(/\s*\[[^\]]*\]\s*$/, '');
Object.assign(beamid, {font, theme, number, unit, named});

// What a picture is drawn with: a canvas or the text of an SVG.
class CanvasPen {
  constructor(context) { this.c = context; }
  clip(x, y, w, h) { this.c.save(); this.c.beginPath(); this.c.rect(x, y, w, h); this.c.clip(); }
  unclip() { this.c.restore(); }
  fill(x, y, w, h, colour) { this.c.fillStyle = colour; this.c.fillRect(x, y, w, h); }
  path(parts, colour, width, dash = [], area = 0) {
    const c = this.c;
    c.beginPath();
    for (const part of parts)
      for (let i = 0; i < part.length; i += 2) i ? c.lineTo(part[i], part[i + 1]) : c.moveTo(part[i], part[i + 1]);
    if (area) { c.globalAlpha = area; c.fillStyle = colour; c.fill(); c.globalAlpha = 1; return; }
    c.strokeStyle = colour; c.lineWidth = width; c.lineJoin = 'round'; c.setLineDash(dash); c.stroke(); c.setLineDash([]);
  }
  text(label, x, y, {size = 13, anchor = 'middle', turn = 0, colour}) {
    const c = this.c, runs = pieces(label), at = (raised) => `${raised ? size * 0.75 : size}px ${font}`;
    c.save(); c.translate(x, y); c.rotate(turn); c.fillStyle = colour; c.textBaseline = 'alphabetic';
    const widths = runs.map(([text, raised]) => { c.font = at(raised); return c.measureText(text).width; });
    let place = -widths.reduce((a, b) => a + b, 0) * {start: 0, middle: 0.5, end: 1}[anchor];
    runs.forEach(([text, raised], i) => { c.font = at(raised); c.fillText(text, place, -0.35 * size * raised); place += widths[i]; });
    c.restore();
  }
}
const ruler = document.createElement('canvas').getContext('2d');
const textWidth = (text, size = 13) => { ruler.font = `${size}px ${font}`; return ruler.measureText(plain(text)).width; };
beamid.textWidth = textWidth;
const fitted = (text, room, size) => Math.max(8, Math.min(size, size * room / Math.max(1, textWidth(text, size))));
const escapes = {'&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;'};
const escaped = (text) => text.replace(/[&<>"]/g, (c) => escapes[c]);
class SvgPen {
  constructor() { this.out = []; this.clips = 0; }
  clip(x, y, w, h) {
    this.out.push(`<clipPath id="c${++this.clips}"><rect x="${x}" y="${y}" width="${w}" height="${h}"/></clipPath><g clip-path="url(#c${this.clips})">`);
  }
  unclip() { this.out.push('</g>'); }
  fill(x, y, w, h, colour) { this.out.push(`<rect x="${x}" y="${y}" width="${w}" height="${h}" fill="${colour}"/>`); }
  path(parts, colour, width, dash = [], area = 0) {
    let d = '';
    for (const part of parts)
      for (let i = 0; i < part.length; i += 2) d += `${i ? 'L' : 'M'}${part[i].toFixed(2)} ${part[i + 1].toFixed(2)}`;
    this.out.push(area ? `<path d="${d}" fill="${colour}" fill-opacity="${area}"/>`
      : `<path d="${d}" fill="none" stroke="${colour}" stroke-width="${width}" stroke-linejoin="round"${dash.length ? ` stroke-dasharray="${dash}"` : ''}/>`);
  }
  text(label, x, y, {size = 13, anchor = 'middle', turn = 0, colour}) {
    const runs = pieces(label).map(([text, raised]) => raised
      ? `<tspan font-size="${size * 0.75}" dy="${-0.35 * size * raised}">${escaped(text)}</tspan><tspan dy="${0.35 * size * raised}">\u200b</tspan>` : `<tspan>${escaped(text)}</tspan>`);
    this.out.push(`<text transform="translate(${x} ${y}) rotate(${turn * 180 / Math.PI})" font-size="${size}" text-anchor="${anchor}" fill="${colour}">${runs.join('')}</text>`);
  }
  svg(width, height) {
    const space = new DOMParser().parseFromString('<svg/>', 'text/html').querySelector('svg').namespaceURI;
    return `<svg xmlns="${space}" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family='${font}'>${this.out.join('\n')}</svg>\n`;
  }
}

// An axis: value -> place in [0, 1], and back.
const warp = (axis, value) => axis.log ? Math.log10(value) : value;
const unwarp = (axis, value) => axis.log ? 10 ** value : value;
const part = (axis, range, value) => (warp(axis, value) - warp(axis, range[0])) / (warp(axis, range[1]) - warp(axis, range[0]));
const value = (axis, range, place) => unwarp(axis, warp(axis, range[0]) + place * (warp(axis, range[1]) - warp(axis, range[0])));

function ticks(axis, range, room) {
  if (axis.names) return axis.names.map((name, i) => [i + 1, name]);
  const low = Math.min(...range), high = Math.max(...range), found = [];
  if (axis.log && high / low > 8) {
    const decades = Math.log10(high / low), every = Math.max(1, Math.ceil(decades / room));
    const factors = decades < room / 3 ? [1, 2, 5] : [1];
    const written = low >= 1e-3 && high < 1e5;
    for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high) + 1; ++power)
      for (const factor of factors) {
        const tick = factor * 10 ** power;
        if (tick < low || tick > high || (factor === 1 && power % every)) continue;
        found.push([tick, written ? String(Number(tick.toPrecision(3))) : factor === 1 ? `10^{${power}}` : '']);
      }
    return found;
  }
  const power = 10 ** Math.floor(Math.log10((high - low) / room));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= (high - low) / room * 0.999);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i)
    found.push([i * step, Math.max(Math.abs(low), Math.abs(high)) < 1e6 && digits < 7 ? (i * step).toFixed(digits).replace(/^-(0(\.0*)?)$/, '$1') : number(i * step)]);
  return found.length < 2 && room < 40 ? ticks(axis, range, 2 * room) : found;  // one number alone is no scale
}

// A column of numbers: {n, from, step}, or in the figure's bytes {n, at, size}, with counts of steps or codes of the range
// (figure_data.hpp). What a code does not hold is not shown as digits.
function column(spec, data) {
  if (!spec) return null;
  if ('from' in spec && !spec.counts) return Float64Array.from({length: spec.n}, (_, i) => spec.from + i * spec.step);
  const raw = data.slice(spec.at, spec.at + spec.n * spec.size).buffer;
  if (spec.counts) {
    let count = 0;
    return Float64Array.from(spec.size === 1 ? new Uint8Array(raw) : new Uint16Array(raw), (more) => spec.from + spec.step * (count += more));
  }
  if (spec.size === 2) {
    const digits = spec.log ? 0 : 10 ** Math.ceil(-Math.log10(spec.step));
    return Float32Array.from(new Uint16Array(raw), (code) => code === 65535 ? NaN : spec.log ? Math.exp(spec.low + spec.step * code)
      : Math.round((spec.low + spec.step * code) * digits) / digits);
  }
  return spec.size === 4 ? new Float32Array(raw) : new Float64Array(raw);
}
function ascending(x) {
  for (let i = 1; i < x.length; ++i) if (!(x[i] >= x[i - 1])) return false;
  return x.length > 0 && Number.isFinite(x[0]);
}
function first(x, wanted) {  // index of the first that is not below
  let low = 0, high = x.length;
  while (low < high) { const middle = (low + high) >> 1; x[middle] < wanted ? low = middle + 1 : high = middle; }
  return low;
}

const lines = ['line', 'dashed', 'dotted', 'thin'], dashes = {dashed: [9, 5], dotted: [2, 4]};
// The highest point of an amplitude within 12 pixels, and where the curve passes its 1/sqrt(2) on either side; null
// where the highest lies at the end of these pixels, as on a slope, or where a side stays above.
function peak({x, y}, place, at) {
  const from = first(x, place(at - 12)), until = Math.min(x.length - 1, first(x, place(at + 12)));
  let top = from;
  for (let i = from; i <= until; ++i) if (y[i] > y[top]) top = i;
  if (top <= from || top >= until) return null;
  const half = y[top] / Math.SQRT2;
  const side = (step) => {
    let i = top;
    while (y[i] > half && y[i] <= y[top]) i += step;
    if (!(y[i] <= half)) return NaN;
    return x[i] + (x[i - step] - x[i]) * (half - y[i]) / (y[i - step] - y[i]);
  };
  const width = side(1) - side(-1);
  return width > 0 ? {at: x[top], width} : null;
}

const panels = [];  // of the whole page, for linked axes
class Panel {
  constructor(spec, figure, cell) {
    Object.assign(this, spec, {figure, cell});
    for (const curve of this.curves) {
      for (const key of ['x', 'y', 'lower', 'upper']) curve[key] = column(curve[key], figure.data);
      curve.sorted = ascending(curve.x);
      for (const fact of curve.facts || []) fact.values = column(fact.values, figure.data);
      if (curve.shapes) curve.shapes = curve.shapes.map((part) => column(part, figure.data));
    }
    this.answers = this.curves.some((curve) => curve.facts || curve.details);
    this.home = {x: this.x.range, y: this.y.range};
    this.view = {x: [...this.x.range], y: [...this.y.range]};
    this.canvas = make(cell, 'canvas', {tabindex: 0, role: 'img', 'aria-label': (plain(this.title) || figure.alt) +
      '. Arrow keys move the reading, plus and minus zoom, 0 resets.' +
      (this.answers ? ' Enter shows what stands behind the nearest point, comma and point the one before and after.' : '')});
    this.reading = make(cell, 'div', {class: 'reading', role: 'status'});
    this.reading.hidden = true;
    this.listen();
    panels.push(this);
  }
  tickRoom(axis, pixels, upright) { return Math.max(2, Math.floor(pixels / (upright ? 40 : 90))); }
  margin() { return Math.max(...ticks(this.y, this.view.y, this.tickRoom(this.y, this.height - 80, true)).map((tick) => textWidth(tick[1]))) + (this.y.label ? 40 : 18); }
  linked() {
    const same = (other) => plain(other.x.label) === plain(this.x.label) && this.x.label && other.x.log === this.x.log && !this.x.names &&
      other.figure.section === this.figure.section &&
      [0, 1].every((end) => Math.abs(other.home.x[end] - this.home.x[end]) <= 0.01 * Math.abs(this.home.x[1] - this.home.x[0]));
    return panels.filter((other) => other === this || same(other));
  }
  setX(range) {
    for (const panel of this.linked()) { panel.view.x = [...range]; panel.later(); }
  }
  reset() { this.setX(this.home.x); this.view.y = [...this.home.y]; this.later(); }
  later() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.draw(); });
  }
  frame(w, h) {
    const left = Math.min(Math.max(...this.figure.panels.map((panel) => panel.margin())), 0.6 * w);
    const wanted = this.remarks ? 12 + Math.max(...this.remarks.map((text) => textWidth(text))) : 22;
    this.remarked = this.remarks && w - left - wanted > 0.3 * w;  // on a narrow page the readings have them
    const right = this.remarked ? wanted : 22;
    return {l: left, t: this.title ? 34 : 12, w: Math.max(20, w - left - right), h: Math.max(20, h - (this.title ? 34 : 12) - (this.x.label ? 46 : 26))};
  }
  draw() {
    const w = this.canvas.clientWidth, h = this.height, scale = window.devicePixelRatio || 1;
    if (!w) return;
    this.canvas.width = w * scale; this.canvas.height = h * scale;
    const context = this.canvas.getContext('2d');
    context.scale(scale, scale);
    const pen = new CanvasPen(context), colours = theme();
    this.box = this.render(pen, 0, 0, w, h);
    this.canvas.dataset.box = [this.box.l, this.box.t, this.box.w, this.box.h].join(' ');
    this.canvas.dataset.x = this.view.x.join(' ');
    this.canvas.dataset.y = this.view.y.join(' ');
    if (this.marks) for (const [x, y, colour] of this.marks) pen.path([circle(x, y, 5)], colour, 2);
    if (this.picked) {
      const {curve, i} = this.picked, at = [this.box.px(curve.x[i]), this.box.py(curve.y[i])];
      pen.path([circle(...at, 8)], colours.ground, 5);
      pen.path([circle(...at, 8)], colours.ink, 2.5);
    }
    if (this.drag && this.drag.box) {
      const {x, y, w: bw, h: bh} = this.drag.box;
      pen.path([[x, y, x + bw, y, x + bw, y + bh, x, y + bh, x, y]], theme().blue, 1, [4, 3]);
    }
  }
  render(pen, ox, oy, w, h) {
    const colours = theme(), f = this.frame(w, h), l = ox + f.l, t = oy + f.t;
    const px = (v) => l + f.w * part(this.x, this.view.x, v), py = (v) => t + f.h * (1 - part(this.y, this.view.y, v));
    pen.fill(ox, oy, w, h, colours.ground);
    const bottom = t + f.h;
    let free = -Infinity;  // where the next label may begin
    for (const [at, label] of ticks(this.x, this.view.x, this.tickRoom(this.x, f.w, false))) {
      const x = px(at);
      if (x < l - 1 || x > l + f.w + 1) continue;
      pen.path([[x, t, x, bottom]], colours.grid, 0.7);
      const half = 0.5 * textWidth(label);
      if (x - half < free) continue;
      pen.text(label, x, bottom + 18, {colour: colours.ink});
      free = x + half + 6;
    }
    for (const [at, label] of ticks(this.y, this.view.y, this.tickRoom(this.y, f.h, true))) {
      const y = py(at);
      if (y < t - 1 || y > bottom + 1) continue;
      pen.path([[l, y, l + f.w, y]], colours.grid, 0.7);
      pen.text(label, l - 7, y + 4.5, {anchor: 'end', colour: colours.ink, size: fitted(label, f.l - 9 - (this.y.label ? 20 : 0), 13)});
    }
    if (this.remarked) this.remarks.forEach((text, i) => {
      const y = py(i + 1);
      if (y >= t && y <= bottom) pen.text(text, l + f.w + 8, y + 4.5, {anchor: 'start', colour: colours.ink});
    });
    pen.path([[l, t, l, bottom, l + f.w, bottom]], colours.ink, 1);
    if (this.title) {
      const size = fitted(this.title, w - 8, 14), half = 0.5 * textWidth(this.title, size);
      const middle = Math.max(ox + 4 + half, Math.min(ox + w - 4 - half, l + f.w / 2));
      pen.text(this.title, middle, oy + 22, {size, colour: colours.ink});
    }
    if (this.x.label) {
      const size = fitted(this.x.label, w - 8, 13), half = 0.5 * textWidth(this.x.label, size);
      pen.text(this.x.label, Math.min(l + f.w / 2, ox + w - 4 - half), bottom + 39, {colour: colours.ink, size});
    }
    if (this.y.label) pen.text(this.y.label, ox + 15, t + f.h / 2, {turn: -Math.PI / 2, colour: colours.ink, size: fitted(this.y.label, h - 8, 13)});
    pen.clip(l, t, f.w, f.h);
    for (const curve of this.curves) if (!this.figure.off.has(curve.label) || !curve.label) this.curve(pen, curve, px, py, l, f.w);
    pen.unclip();
    return {l, t, w: f.w, h: f.h, px, py};
  }
  // Indices to draw; of a long curve the lowest and the highest of every pixel.
  chosen(curve, y, px, l, w) {
    const x = curve.x, end = x.length;
    if (!curve.sorted || end < 3) return Array.from({length: end}, (_, i) => i);
    const begin = Math.max(0, first(x, Math.min(...this.view.x)) - 1), stop = Math.min(end, first(x, Math.max(...this.view.x)) + 2);
    if (stop - begin < 4 * w) return Array.from({length: stop - begin}, (_, i) => begin + i);
    const kept = [];
    for (let i = begin; i < stop;) {
      const pixel = Math.floor(px(x[i]));
      let low = i, high = i, j = i, gap = -1;
      for (; j < stop && (j === i || Math.floor(px(x[j])) <= pixel); ++j) {
        if (y[j] < y[low] || !(y[low] === y[low])) low = j;
        if (y[j] > y[high] || !(y[high] === y[high])) high = j;
        if (!(y[j] === y[j])) gap = j;
      }
      for (const k of [...new Set([i, low, high, j - 1].concat(gap < 0 ? [] : [gap]))].sort((a, b) => a - b)) kept.push(k);
      i = j;
    }
    return kept;
  }
  curve(pen, curve, px, py, l, w) {
    const colour = theme()[curve.colour], {x, y, lower, upper, style} = curve;
    const floor = (v) => this.y.log && !(v > 0) ? 1e-300 : v;
    if (style === 'band') {
      const kept = this.chosen(curve, upper, px, l, w).filter((i) => Number.isFinite(lower[i] + upper[i]));
      const line = [];
      for (const i of kept) line.push(px(x[i]), py(floor(upper[i])));
      for (const i of kept.reverse()) line.push(px(x[i]), py(floor(lower[i])));
      pen.path([line], colour, 0, [], 0.22);
      return;
    }
    if (style === 'arrows') {
      for (let i = 0; i < x.length; ++i) {
        const a = px(lower[i]), b = px(upper[i]), at = py(y[i]), back = Math.sign(a - b) * 7;
        pen.path([[a, at, b, at], [b + back, at - 4, b, at, b + back, at + 4]], colour, 1.6);
      }
      return;
    }
    if (lines.includes(style)) {
      const parts = [];
      let run = [];
      for (const i of this.chosen(curve, y, px, l, w)) {
        const a = px(x[i]), b = py(this.y.log ? floor(y[i]) : y[i]);
        if (Number.isFinite(a + b)) run.push(a, Math.max(-1e5, Math.min(1e5, b)));
        else if (run.length) { parts.push(run); run = []; }
      }
      parts.push(run);
      pen.path(parts, colour, style === 'thin' ? 0.8 : 1.8, dashes[style]);
      return;
    }
    const bars = [], stems = [], marks = [], size = style === 'open_points' ? 4.2 : style === 'stems' ? 2.4 : 3.4;
    const zero = this.y.log ? 1e9 : py(0);
    for (let i = 0; i < x.length; ++i) {
      const a = px(x[i]), b = py(y[i]);
      if (!Number.isFinite(a + b)) continue;
      if (style === 'stems') stems.push([a, zero, a, b]);
      if (lower && style === 'intervals') bars.push([px(lower[i]), b, px(upper[i]), b], [px(lower[i]), b - 3, px(lower[i]), b + 3], [px(upper[i]), b - 3, px(upper[i]), b + 3]);
      else if (lower) bars.push([a, py(floor(lower[i])), a, py(upper[i])], [a - 3, py(upper[i]), a + 3, py(upper[i])], [a - 3, py(floor(lower[i])), a + 3, py(floor(lower[i]))]);
      marks.push(mark(curve.mark, a, b, size));
    }
    pen.path(stems, colour, 1.6);
    pen.path(bars, colour, 1.2);
    if (style === 'open_points') pen.path(marks, colour, 1.4);
    else pen.path(marks, colour, 0, [], 1);
  }
  // What stands under the pointer: of each curve in sight its nearest point.
  read(mx, my) {
    const box = this.box, found = [];
    if (!box) return;
    for (const curve of this.curves) {
      if (this.figure.off.has(curve.label) && curve.label) continue;
      const y = curve.style === 'band' ? curve.upper : curve.y;
      const lineLike = curve.sorted && ['line', 'dashed', 'dotted', 'thin', 'stems', 'band'].includes(curve.style);
      let best = -1, distance = Infinity;
      const look = (i) => {
        const a = box.px(curve.x[i]), b = box.py(y[i]);
        const away = lineLike ? Math.abs(a - mx) : Math.hypot(a - mx, b - my);
        if (Number.isFinite(b) && away < distance) { distance = away; best = i; }
      };
      if (curve.sorted && lineLike) {
        const i = first(curve.x, value(this.x, this.view.x, (mx - box.l) / box.w));
        for (let k = Math.max(0, i - 1); k <= Math.min(curve.x.length - 1, i); ++k) look(k);
      } else for (let i = 0; i < curve.x.length; ++i) look(i);
      if (best >= 0 && distance < (lineLike ? 40 : 30)) found.push({curve, i: best, distance, y: y[best]});
    }
    this.marks = found.filter(({curve}) => curve.style !== 'band').map(({curve, i, y}) => [box.px(curve.x[i]), box.py(y), theme()[curve.colour]]);
    this.reading.hidden = found.length === 0;
    this.reading.textContent = '';
    const ux = unit(this.x.label), uy = unit(this.y.label), withUnit = (text, u) => u ? `${text} ${u}` : text;
    const nameX = (v) => this.x.names ? this.x.names[Math.round(v) - 1] || '' : withUnit(number(v), ux);
    const nameY = (v) => this.y.names ? this.y.names[Math.round(v) - 1] || '' : withUnit(number(v), uy);
    if (found.length) {
      const nearest = found.reduce((a, b) => a.distance <= b.distance ? a : b);
      make(this.reading, 'b', {}, `${named(this.x.label)} ${nameX(nearest.curve.x[nearest.i])}`);
      for (const {curve, i} of found.slice(0, 9)) {
        const row = make(this.reading, 'div');
        make(row, 'span', {class: 'key'}).style.background = theme()[curve.colour];
        let text = curve.style === 'band' ? `${nameY(curve.lower[i])} to ${nameY(curve.upper[i])}` : nameY(curve.y[i]);
        if (curve.style === 'intervals') text += `: ${nameX(curve.x[i])} (${number(curve.lower[i])} to ${number(curve.upper[i])})`;
        else if (curve.style !== 'band' && curve.lower) text += ` (${number(curve.lower[i])} to ${number(curve.upper[i])})`;
        row.append(`${plain(curve.label || named(this.y.label))} ${text}`);
      }
      const {curve: spectrum} = nearest;
      if (this.y.log && spectrum.sorted && lines.includes(spectrum.style) && /^frequency/.test(plain(this.x.label))) {
        const top = peak(spectrum, (at) => value(this.x, this.view.x, (at - box.l) / box.w), mx);
        if (top) make(this.reading, 'div', {}, `peak ${nameX(top.at)}: half-power width ${number(Number(top.width.toPrecision(3)))} ${ux}`);
      }
      const wide = this.cell.clientWidth;
      this.reading.style.top = `${box.t + 4}px`;
      this.reading.style.left = mx < wide / 2 ? 'auto' : `${box.l + 4}px`;
      this.reading.style.right = mx < wide / 2 ? '4px' : 'auto';
    }
    this.pointer = [mx, my];
    this.later();
  }
  // The nearest point with an answer within so many pixels.
  point(mx, my, within) {
    const box = this.box;
    let best = null, distance = within;
    for (const curve of box && this.answers ? this.curves : []) {
      if (!(curve.facts || curve.details) || (curve.label && this.figure.off.has(curve.label))) continue;
      for (let i = 0; i < curve.x.length; ++i) {
        let a = box.px(curve.x[i]);
        const b = box.py(curve.y[i]);
        if (!(a >= box.l - 1 && a <= box.l + box.w + 1 && b >= box.t - 1 && b <= box.t + box.h + 1)) continue;
        if (curve.style === 'intervals') a = Math.max(Math.min(mx, box.px(curve.upper[i])), box.px(curve.lower[i])) || a;
        const away = Math.hypot(a - mx, b - my);
        if (away <= distance) { distance = away; best = {curve, i}; }
      }
    }
    return best;
  }
  choose(found) {
    if (!found) return;
    for (const panel of this.figure.panels) if (panel.picked) { panel.picked = null; panel.later(); }
    this.picked = found;
    beamid.answer(this, found, () => this.shut());
    this.later();
  }
  shut() {
    if (!this.picked) return;
    this.picked = null;
    this.figure.answers.textContent = '';
    this.canvas.focus({preventScroll: true});
    this.later();
  }
  quiet() { this.reading.hidden = true; this.marks = null; this.later(); }
  zoom(factor, mx, my, both) {
    const box = this.box, zoomed = (axis, range, place) => [value(axis, range, place * (1 - factor)), value(axis, range, place + (1 - place) * factor)];
    this.setX(zoomed(this.x, this.view.x, (mx - box.l) / box.w));
    if (both) this.view.y = zoomed(this.y, this.view.y, 1 - (my - box.t) / box.h);
    this.later();
  }
  pan(dx, dy) {
    const box = this.box, moved = (axis, range, by) => [value(axis, range, by), value(axis, range, 1 + by)];
    this.setX(moved(this.x, this.view.x, -dx / box.w));
    this.view.y = moved(this.y, this.view.y, dy / box.h);
    this.later();
  }
  listen() {
    const place = (event) => { const r = this.canvas.getBoundingClientRect(); return [event.clientX - r.left, event.clientY - r.top]; };
    const fingers = new Map();
    this.canvas.addEventListener('pointerdown', (event) => {
      const at = place(event);
      fingers.set(event.pointerId, at);
      this.tap = fingers.size === 1 ? at : null;
      if (event.pointerType === 'touch') { this.read(...at); return; }
      if (event.button !== 0) return;
      this.canvas.setPointerCapture(event.pointerId);
      this.drag = {from: at, last: at, pan: event.shiftKey || this.figure.panning};
    });
    this.canvas.addEventListener('pointermove', (event) => {
      const at = place(event);
      if (fingers.size === 2 && fingers.has(event.pointerId)) {
        const before = [...fingers.values()];
        fingers.set(event.pointerId, at);
        const after = [...fingers.values()], span = ([a, b]) => Math.max(20, Math.hypot(a[0] - b[0], a[1] - b[1]));
        const middle = ([a, b]) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], was = middle(before), is = middle(after);
        this.pan(is[0] - was[0], is[1] - was[1]);
        this.zoom(span(before) / span(after), ...is, false);
        return;
      }
      if (this.drag) {
        if (this.drag.pan) { this.pan(at[0] - this.drag.last[0], at[1] - this.drag.last[1]); this.drag.last = at; }
        else {
          const [x, y] = this.drag.from, box = this.box, flat = Math.abs(at[1] - y) < 25;
          this.drag.box = {x: Math.min(x, at[0]), w: Math.abs(at[0] - x), y: flat ? box.t : Math.min(y, at[1]), h: flat ? box.h : Math.abs(at[1] - y), flat};
          this.later();
        }
      } else {
        this.read(...at);
        this.canvas.style.cursor = this.point(...at, 14) ? 'pointer' : '';
      }
    });
    const end = (event) => {
      fingers.delete(event.pointerId);
      const drag = this.drag;
      this.drag = null;
      if (!drag || !drag.box || drag.box.w < 5) {
        const at = place(event), touched = event.pointerType === 'touch';
        if (event.type === 'pointerup' && this.tap && Math.hypot(at[0] - this.tap[0], at[1] - this.tap[1]) < (touched ? 10 : 5))
          this.choose(this.point(...at, touched ? 24 : 14));
        this.later();
        return;
      }
      const box = this.box, b = drag.box, at = (x) => value(this.x, this.view.x, (x - box.l) / box.w);
      if (!b.flat) {
        const up = (y) => value(this.y, this.view.y, 1 - (y - box.t) / box.h);
        this.view.y = [up(b.y + b.h), up(b.y)];
      }
      this.setX([at(b.x), at(b.x + b.w)]);
      this.later();
    };
    this.canvas.addEventListener('pointerup', end);
    this.canvas.addEventListener('pointercancel', end);
    this.canvas.addEventListener('pointerleave', () => { if (!this.drag) this.quiet(); });
    this.canvas.addEventListener('dblclick', () => this.reset());
    this.canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && document.activeElement !== this.canvas) return;  // the page scrolls on
      event.preventDefault();
      this.zoom(event.deltaY > 0 ? 1.25 : 0.8, ...place(event), event.shiftKey);
    }, {passive: false});
    this.canvas.addEventListener('keydown', (event) => {
      const box = this.box, middle = this.pointer || [box.l + box.w / 2, box.t + box.h / 2], step = event.shiftKey ? 20 : 2;
      const moves = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]};
      if (event.key in moves) this.read(Math.min(box.l + box.w, Math.max(box.l, middle[0] + moves[event.key][0])), middle[1] + moves[event.key][1]);
      else if (event.key === '+' || event.key === '=') this.zoom(0.7, ...middle, false);
      else if (event.key === '-') this.zoom(1 / 0.7, ...middle, false);
      else if (event.key === '0') this.reset();
      else if (event.key === 'Enter' && this.answers) this.choose(this.point(...middle, Infinity));
      else if ((event.key === ',' || event.key === '.') && this.picked) {
        const {curve, i} = this.picked, next = i + (event.key === ',' ? -1 : 1);
        if (next >= 0 && next < curve.x.length) this.choose({curve, i: next});
      } else if (event.key === 'Escape') { this.quiet(); this.shut(); }
      else return;
      event.preventDefault();
    });
  }
}
function circle(x, y, r) {
  const line = [];
  for (let i = 0; i <= 12; ++i) line.push(x + r * Math.cos(i * Math.PI / 6), y + r * Math.sin(i * Math.PI / 6));
  return line;
}
function mark(kind, x, y, r) {
  const corners = [null, [-1, -1, 1, -1, 1, 1, -1, 1], [0, -1.3, 1.2, 0.9, -1.2, 0.9], [0, -1.4, 1.4, 0, 0, 1.4, -1.4, 0], [0, 1.3, 1.2, -0.9, -1.2, -0.9]][kind % 5];
  if (!corners) return circle(x, y, r);
  return corners.concat(corners.slice(0, 2)).map((c, i) => (i % 2 ? y : x) + r * c);
}

// A curve's sample in a legend, from x to x + 26 about the height y: with the dashes and marks of the curve.
function sample(pen, {style, colour, mark: kind}, x, y) {
  const ink = theme()[colour], w = 26;
  if (style === 'band') pen.path([[x, y - 5, x + w, y - 5, x + w, y + 5, x, y + 5]], ink, 0, [], 0.35);
  else if (lines.includes(style)) pen.path([[x, y, x + w, y]], ink, style === 'thin' ? 1.2 : 2, dashes[style]);
  else if (style === 'arrows') pen.path([[x, y, x + w, y], [x + w - 7, y - 4, x + w, y, x + w - 7, y + 4]], ink, 1.6);
  else {
    const dot = [mark(kind, x + w / 2, y, style === 'open_points' ? 4.2 : 3.6)];
    if (style === 'intervals') pen.path([[x + 3, y, x + w - 3, y]], ink, 1.2);
    if (style === 'open_points') pen.path(dot, ink, 1.4);
    else pen.path(dot, ink, 0, [], 1);
  }
}

class Figure {
  constructor(element) {
    const spec = JSON.parse(new TextDecoder().decode(bytes(element.dataset.figure)));
    this.name = spec.name;
    this.data = bytes(element.dataset.values || '');
    this.section = element.closest('section');
    this.alt = element.querySelector('img')?.alt || spec.name;
    this.off = new Set();
    this.panning = false;
    const live = document.createElement('div');
    live.className = 'live';
    element.prepend(live);
    const bar = make(live, 'div', {class: 'bar', role: 'toolbar', 'aria-label': 'figure'});
    const button = (text, help, action) => {
      const made = make(bar, 'button', {type: 'button', title: help}, text);
      made.addEventListener('click', action);
      return made;
    };
    const pan = button('Pan', 'drag moves the picture instead of zooming in', () => {
      this.panning = !this.panning;
      pan.setAttribute('aria-pressed', this.panning);
    });
    pan.setAttribute('aria-pressed', false);
    button('Reset', 'all axes as they were', () => this.panels.forEach((panel) => panel.reset()));
    button('PNG', 'save what is shown', () => this.png());
    button('SVG', 'save what is shown', () => this.svg());
    button('CSV', 'save the values between the ends of the horizontal axes', () => this.csv());
    const clicks = spec.panels.some(({curves}) => curves.some((curve) => curve.facts || curve.details));
    make(bar, 'span', {class: 'help'}, `${clicks ? 'click a point: its values · ' : ''}drag: zoom · shift-drag: pan · Ctrl + wheel: zoom · double click: reset`);
    const grid = make(live, 'div', {class: 'grid'});
    grid.style.setProperty('--columns', spec.columns);
    this.columns = spec.columns;
    this.details = spec.details || [];
    this.panels = spec.panels.map((panel) => new Panel(panel, this, make(grid, 'div', {class: 'cell'})));
    for (const panel of this.panels) {
      panel.height = spec.row_height;
      panel.canvas.style.height = `${spec.row_height}px`;
    }
    this.answers = make(live, 'div', {'aria-live': 'polite'});
    this.legend(make(live, 'div', {class: 'legend'}));
    if (spec.thinned) make(live, 'p', {class: 'note'}, spec.thinned);
    element.classList.add('alive');
    new ResizeObserver(() => this.redraw()).observe(live);
    beamid.dark.addEventListener('change', () => { this.colour(); this.redraw(); });
  }
  redraw() { this.panels.forEach((panel) => panel.later()); }
  labels() {
    const found = new Map();
    for (const panel of this.panels) for (const curve of panel.curves) if (curve.label && !found.has(curve.label)) found.set(curve.label, curve);
    return found;
  }
  legend(parent) {
    this.keys = [];
    for (const [label, curve] of this.labels()) {
      const button = make(parent, 'button', {type: 'button', 'aria-pressed': true, title: 'curve on or off'});
      this.keys.push([make(button, 'span', {class: 'sample'}), curve]);
      for (const [text, raised] of pieces(label)) make(button, raised > 0 ? 'sup' : raised < 0 ? 'sub' : 'span', {}, text);
      button.addEventListener('click', () => {
        this.off.has(label) ? this.off.delete(label) : this.off.add(label);
        button.setAttribute('aria-pressed', !this.off.has(label));
        this.redraw();
      });
    }
    this.colour();
  }
  colour() {
    for (const [key, curve] of this.keys) {
      const pen = new SvgPen();
      sample(pen, curve, 0, 6);
      key.innerHTML = pen.svg(26, 12);
    }
  }
  compose(pen) {
    const width = Math.max(...this.panels.map((panel) => panel.canvas.clientWidth)), height = this.panels[0].height;
    const rows = Math.ceil(this.panels.length / this.columns), shown = [...this.labels()].filter(([label]) => !this.off.has(label));
    const w = width * this.columns, h = rows * height + 24 * shown.length + 10;
    return {w, h, draw: (to) => {
      to.fill(0, 0, w, h, theme().ground);
      this.panels.forEach((panel, i) => panel.render(to, (i % this.columns) * width, Math.floor(i / this.columns) * height, width, height));
      shown.forEach(([label, curve], i) => {
        const y = rows * height + 16 + 24 * i;
        sample(to, curve, 20, y - 4);
        to.text(label, 60, y, {anchor: 'start', colour: theme().ink});
      });
    }};
  }
  png() {
    const picture = this.compose(), canvas = document.createElement('canvas');
    canvas.width = 2 * picture.w; canvas.height = 2 * picture.h;
    const context = canvas.getContext('2d');
    context.scale(2, 2);
    picture.draw(new CanvasPen(context));
    canvas.toBlob((blob) => beamid.save(`${this.name}.png`, blob));
  }
  svg() {
    const picture = this.compose(), pen = new SvgPen();
    picture.draw(pen);
    beamid.save(`${this.name}.svg`, new Blob([pen.svg(picture.w, picture.h)], {type: 'image/svg+xml'}));
  }
  csv() {
    const columns = [], quoted = (text) => `"${text.replace(/"/g, '""')}"`;
    for (const panel of this.panels) for (const curve of panel.curves) {
      if (this.off.has(curve.label)) continue;
      const [low, high] = [Math.min(...panel.view.x), Math.max(...panel.view.x)];
      const kept = Array.from(curve.x.keys()).filter((i) => curve.x[i] >= low && curve.x[i] <= high);
      const head = (what) => quoted([panel.title, curve.label, what].filter(Boolean).map(plain).join(' | '));
      const add = (what, values) => values && columns.push([head(what), ...kept.map((i) => Number.isFinite(values[i]) ? String(Number(values[i].toPrecision(values instanceof Float32Array ? 8 : 17))) : 'NaN')]);
      add(panel.x.label, curve.x);
      add(panel.y.label, curve.y);
      add(`lower, ${panel.y.label}`, curve.lower);
      add(`upper, ${panel.y.label}`, curve.upper);
    }
    const rows = Math.max(0, ...columns.map((c) => c.length));
    const text = Array.from({length: rows}, (_, i) => columns.map((c) => c[i] ?? '').join(',')).join('\n');
    beamid.save(`${this.name}.csv`, new Blob([text + '\n'], {type: 'text/csv'}));
  }
}

for (const element of document.querySelectorAll('figure[data-figure]')) {
  try {
    new Figure(element);
  } catch {  // data that are none: the static picture stays
    element.classList.remove('alive');
    element.querySelector(':scope > .live')?.remove();
  }
}

// Copies for the clipboard: commands and experiment files.
beamid.copy = (text) => {
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'copy';
  button.textContent = 'Copy';
  button.addEventListener('click', async () => {
    try {
      await navigator.clipboard.writeText(text.textContent);
      button.textContent = 'Copied';
    } catch {
      getSelection().selectAllChildren(text);
      button.textContent = 'Selected: Ctrl + C';
    }
    setTimeout(() => { button.textContent = 'Copy'; }, 2000);
  });
  text.before(button);
};
document.querySelectorAll('section pre').forEach(beamid.copy);
addEventListener('beforeprint', () => document.querySelectorAll('details').forEach((part) => { part.open = true; }));
})();
