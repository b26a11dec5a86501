// What stands behind a point that is clicked: its numbers, its runs and what repeats them, its mode shape.
(() => {
const {make, named, unit, number, theme, textWidth, font} = beamid;
const brief = (value) => number(Number(value.toPrecision(6)));

// A shape of channels: one line that swings where all of them measure the same, else bars with their phases.
class Sketch {
  constructor(parent, channels, places, real, imaginary) {
    Object.assign(this, {channels, places, real, imaginary, phase: 0});
    const what = channels.map((name, k) => `${name} ${brief(this.size(k))} at ${this.degrees(k)} degrees`).join(', ');
    this.canvas = make(parent, 'canvas', {class: 'sketch', role: 'img', 'aria-label': `mode shape: ${what}`});
    this.running = places && !matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (places) {
      const button = make(parent, 'button', {type: 'button'}, this.running ? 'Pause' : 'Swing');
      button.addEventListener('click', () => {
        this.running = !this.running;
        button.textContent = this.running ? 'Pause' : 'Swing';
        if (this.running) this.step();
      });
    }
    const spacing = 600 / channels.length;
    this.named = channels.every((name) => textWidth(name, 11) < spacing);
    if (!this.named) make(parent, 'p', {class: 'note'}, channels.map((name, k) => `${k + 1}: ${name}`).join('; '));
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    this.step();
  }
  size(k) { return Math.hypot(this.real[k], this.imaginary[k]); }
  degrees(k) { return this.size(k) < 0.005 ? 0 : Math.round(Math.atan2(this.imaginary[k], this.real[k]) * 180 / Math.PI); }
  step() {
    let before = performance.now();
    const next = (now) => {
      if (!this.canvas.isConnected) return;
      this.phase += 2 * Math.PI * 0.6 * Math.min(0.2, (now - before) / 1000);
      before = now;
      this.draw();
      if (this.running) requestAnimationFrame(next);
    };
    this.running ? requestAnimationFrame(next) : this.draw();
  }
  draw() {
    const canvas = this.canvas, w = canvas.clientWidth, h = canvas.clientHeight, scale = window.devicePixelRatio || 1;
    if (!w) return;
    canvas.width = w * scale; canvas.height = h * scale;
    const c = canvas.getContext('2d'), colours = theme(), count = this.channels.length;
    c.scale(scale, scale);
    c.font = `11px ${font}`; c.textAlign = 'center';
    const label = (k, x) => { c.fillStyle = colours.ink; c.fillText(this.named ? this.channels[k] : k + 1, Math.max(20, Math.min(w - 20, x)), h - 6); };
    const line = (points, colour, width, dash) => {
      c.beginPath();
      points.forEach(([x, y], i) => i ? c.lineTo(x, y) : c.moveTo(x, y));
      c.strokeStyle = colour; c.lineWidth = width; c.setLineDash(dash); c.stroke();
    };
    if (this.places) {
      const middle = (h - 20) / 2, high = middle - 10, x = (k) => 40 + (w - 80) * this.places[k];
      const y = (k) => middle - high * (this.real[k] * Math.cos(this.phase) - this.imaginary[k] * Math.sin(this.phase));
      const order = [...this.channels.keys()].sort((a, b) => this.places[a] - this.places[b]);
      line([[30, middle], [w - 30, middle]], colours.grey, 1, [4, 4]);
      for (const k of order) line([[x(k), middle], [x(k), y(k)]], colours.grey, 1, []);
      line(order.map((k) => [x(k), y(k)]), colours.blue, 2.5, []);
      for (const k of order) { c.beginPath(); c.arc(x(k), y(k), 4.5, 0, 7); c.fillStyle = colours.blue; c.fill(); }
      let free = -Infinity;
      for (const k of order) {
        const half = 0.5 * c.measureText(this.named ? this.channels[k] : k + 1).width;
        if (x(k) - half >= free) { label(k, x(k)); free = x(k) + half + 6; }
      }
    } else {
      const bottom = h - 22, high = bottom - 20, wide = Math.min(60, 0.6 * w / count), x = (k) => w * (k + 0.5) / count;
      line([[10, bottom], [w - 10, bottom]], colours.grey, 1, []);
      for (let k = 0; k < count; ++k) {
        c.fillStyle = colours.blue;
        c.fillRect(x(k) - wide / 2, bottom - high * this.size(k), wide, high * this.size(k));
        c.fillStyle = colours.ink;
        c.fillText(`${this.degrees(k)}°`, x(k), bottom - high * this.size(k) - 4);
        label(k, x(k));
      }
    }
    canvas.dataset.phase = this.phase;
  }
}

function table(parent, rows, head) {
  const made = make(make(parent, 'div', {class: 'scroll'}), 'table');
  const numbers = (k) => head && rows.slice(1).every((cells) => /^[-+]?[0-9.]*(e[-+]?[0-9]+)?$/.test(cells[k]));
  const part = (kind, tag, some) => {
    const rest = make(made, kind);
    for (const cells of some) {
      const row = make(rest, 'tr');
      cells.forEach((cell, k) => make(row, tag, numbers(k) ? {class: 'number'} : {}, cell));
    }
  };
  if (head) part('thead', 'th', rows.slice(0, 1));
  part('tbody', 'td', head ? rows.slice(1) : rows);
}

// Shows what stands behind point i of a curve, in place of what was shown before.
beamid.answer = (panel, {curve, i}, close) => {
  const {figure} = panel, parent = figure.answers;
  parent.textContent = '';
  const element = make(parent, 'div', {class: 'answer', role: 'region', 'aria-label': 'the point that was chosen'});
  const detail = curve.details && figure.details[curve.details.length === 1 ? curve.details[0] : curve.details[i]];
  if (detail) {
    make(element, 'b', {}, detail.title);
    table(element, detail.rows, true);
    if (detail.note) make(element, 'p', {class: 'note'}, detail.note);
    if (detail.command) {
      make(element, 'p', {class: 'note'}, 'This command repeats it:');
      beamid.copy(make(element, 'pre', {}, detail.command));
    }
    const swing = detail.mode && beamid.swings.find((one) => one.section === figure.section && one.has(detail.mode));
    if (swing) {
      swing.show(detail.mode);
      const line = make(element, 'p', {class: 'note'}, `Its ${detail.mode} swings in the picture of modes. `);
      make(line, 'button', {type: 'button'}, 'Go there').addEventListener('click', () => swing.canvas.scrollIntoView({block: 'center'}));
    }
  } else {
    make(element, 'b', {}, `${named(panel.y.label)} ${number(curve.y[i])}: ${curve.label}`);
    const fact = (label, value) => Number.isFinite(value) ? [[named(label), `${brief(value)}${unit(label) ? ` ${unit(label)}` : ''}`]] : [];
    table(element, [...fact(panel.x.label, curve.x[i]),
      ...curve.facts.flatMap(({label, values}) => fact(label, values[i]))], false);
    const count = (panel.channels || []).length;
    if (curve.shapes && count > 1) {
      const [real, imaginary] = curve.shapes.map((part) => part.slice(i * count, (i + 1) * count));
      new Sketch(element, panel.channels, panel.places, real, imaginary);
    } else make(element, 'p', {class: 'note'}, count > 1 ? 'The page does not hold the shapes of these poles: there are too many.' : 'One channel: no shape.');
  }
  make(element, 'button', {type: 'button', class: 'close', 'aria-label': 'close'}, '×').addEventListener('click', close);
  element.scrollIntoView({block: 'nearest'});
};
})();
