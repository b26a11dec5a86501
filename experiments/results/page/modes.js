// Mode shapes that swing and motions that play, from the glTF model in the page (results/page/swing_model.hpp): orbit,
// speed, amplitude, and of a motion the time.
(() => {
const {make, bytes} = beamid;
// Dark blue over green to yellow: read by colour-blind readers, in grey as well.
const dim = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 200, 37]];
const bright = [[120, 120, 220], [70, 150, 210], [40, 185, 170], [120, 215, 100], [253, 220, 60]];  // on a dark ground
const shade = (part) => {
  const ramp = beamid.dark.matches ? bright : dim;
  const at = Math.max(0, Math.min(0.9999, part)) * (ramp.length - 1), i = Math.floor(at), rest = at - i;
  return `rgb(${ramp[i].map((c, k) => Math.round(c + rest * (ramp[i + 1][k] - c))).join(',')})`;
};

// The chunks of a binary glTF: its primitives with their targets, and the modes that name them.
function model(data) {
  const view = new DataView(data.buffer, data.byteOffset), length = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(data.subarray(20, 20 + length))), start = 28 + length;
  const array = (index) => {
    const accessor = json.accessors[index], part = json.bufferViews[accessor.bufferView];
    const at = data.byteOffset + start + (part.byteOffset || 0), kind = {5126: Float32Array, 5125: Uint32Array}[accessor.componentType];
    return new kind(data.buffer.slice(at, at + accessor.count * (accessor.type === 'VEC3' ? 12 : 4)));
  };
  const mesh = json.meshes[0], {sampler} = json.animations[0].channels[0], {input, output} = json.animations[0].samplers[sampler];
  const motion = mesh.extras.motion && {...mesh.extras.motion, time: array(input), weights: array(output)};
  return {modes: mesh.extras.modes, motion, unit: mesh.extras.moves_m, primitives: mesh.primitives.map((primitive) => ({
    kind: primitive.mode, points: array(primitive.attributes.POSITION), indices: array(primitive.indices),
    targets: primitive.targets.map((target) => array(target.POSITION))}))};
}

// How often a motion goes to and fro [Hz]: sign changes of its strongest shape's weight.
function frequency({time, weights}) {
  const count = time.length, shapes = weights.length / count, span = time[count - 1] - time[0];
  let changes = 0;
  for (let i = 1; i < count; ++i) if ((weights[i * shapes] > 0) !== (weights[(i - 1) * shapes] > 0)) ++changes;
  return span > 0 ? Math.max(changes / 2, 0.5) / span : 1;
}
const brief = (value) => String(Number(value.toPrecision(3)));

beamid.swings = [];
class Swing {
  constructor(element) {
    this.section = element.closest('section');
    const data = bytes(element.dataset.model);
    this.model = model(data);
    this.mode = 0; this.nearness = 1; this.phase = 0;
    this.bounds();
    this.turn = this.span[2] < 0.05 * this.size ? [0, 0] : this.span[2] < 0.2 * this.size ? [-0.3, 0.25] : [-0.6, 0.35];
    this.home = [...this.turn];
    element.classList.add('alive');
    const live = document.createElement('div');
    live.className = 'live';
    element.prepend(live);
    const {motion} = this.model, what = motion ? 'motion' : 'mode shape';
    const bar = make(live, 'div', {class: 'bar', role: 'toolbar', 'aria-label': what});
    if (!motion) {
      this.choice = make(make(bar, 'label', {}, 'Mode '), 'select');
      this.model.modes.forEach((mode, i) => make(this.choice, 'option', {value: i}, mode.name));
      this.choice.addEventListener('change', () => this.choose(Number(this.choice.value)));
      this.beside = make(make(bar, 'label', {}, 'beside it '), 'select');
      make(this.beside, 'option', {value: ''}, 'none');
      this.model.modes.forEach((mode, i) => make(this.beside, 'option', {value: i}, mode.name));
      this.beside.addEventListener('change', () => this.draw());
    }
    this.go = motion ? 'Play' : 'Swing';
    this.running = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.play = make(bar, 'button', {type: 'button'}, this.running ? 'Pause' : this.go);
    this.play.addEventListener('click', () => { this.running = !this.running; this.play.textContent = this.running ? 'Pause' : this.go; this.start(); });
    const slider = (name, from, to, at, action) => {
      const made = make(make(bar, 'label', {}, `${name} `), 'input', {type: 'range', min: from, max: to, step: (to - from) / 100, value: at});
      made.addEventListener('input', () => { action(Number(made.value)); this.draw(); });
      action(at);
    };
    if (motion) {
      // The usual cycle takes a second and a half at first; the slider goes from a tenth of that speed to ten times it.
      const usual = Number((0.67 / frequency(motion)).toPrecision(1)), {time} = motion;
      slider('speed', -1, 1, 0, (v) => { this.speed = usual * 10 ** v; });
      this.from = time[0]; this.until = time[time.length - 1]; this.time = this.from;
      this.clock = make(make(make(live, 'div', {class: 'bar time'}), 'label', {}, 'time '), 'input',
        {type: 'range', min: this.from, max: this.until, step: (this.until - this.from) / (time.length - 1), value: this.from});
      this.clock.addEventListener('input', () => { this.time = Number(this.clock.value); this.draw(); });
    } else slider('speed', 0.1, 2, 0.6, (v) => { this.speed = v; });
    slider('amplitude', 0, 0.4, 0.12, (v) => { this.amplitude = v; });
    const box = make(make(bar, 'label', {}, 'undeformed '), 'input', {type: 'checkbox', checked: ''});
    this.still = true;
    box.addEventListener('change', () => { this.still = box.checked; this.draw(); });
    const button = (text, action) => make(bar, 'button', {type: 'button'}, text).addEventListener('click', action);
    button('Reset', () => { this.turn = [...this.home]; this.nearness = 1; this.draw(); });
    button('PNG', () => this.canvas.toBlob((blob) => beamid.save(`${motion ? 'motion' : 'mode'}.png`, blob)));
    button('glTF', () => beamid.save(`${element.dataset.name}.glb`, new Blob([data], {type: 'model/gltf-binary'})));
    make(bar, 'span', {class: 'help'}, `drag: turn · Ctrl + wheel, two fingers: nearer · arrow keys: turn · space: stop${motion ? ' · comma, point: by one picture' : ''}`);
    this.canvas = make(live, 'canvas', {tabindex: 0, role: 'img', class: 'swing', 'aria-label': `${what} that moves; arrow keys turn it, space stops it`});
    this.caption = make(live, 'div', {class: 'reading still', role: 'status'});
    this.listen();
    new ResizeObserver(() => this.draw()).observe(live);
    new IntersectionObserver((entries) => { this.seen = entries.some((entry) => entry.isIntersecting); this.start(); }).observe(this.canvas);
    beamid.dark.addEventListener('change', () => this.draw());
    if (!motion) this.choose(0);
    this.draw();
    beamid.swings.push(this);
  }
  // A mode, and beside it what its file states, as the structure as described beside the updated one.
  choose(index) {
    this.mode = index;
    this.choice.value = index;
    const {beside} = this.model.modes[index];
    if (beside !== undefined) this.beside.value = beside;
    this.draw();
  }
  has(name) { return this.model.modes.some((mode) => mode.name === name); }
  show(name) { this.choose(this.model.modes.findIndex((mode) => mode.name === name)); }
  bounds() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const {points} of this.model.primitives) points.forEach((v, i) => { low[i % 3] = Math.min(low[i % 3], v); high[i % 3] = Math.max(high[i % 3], v); });
    this.centre = low.map((v, i) => 0.5 * (v + high[i]));
    this.span = low.map((v, i) => high[i] - v);
    this.size = Math.max(...this.span) || 1;
  }
  start() {
    if (this.frame || !this.running || !this.seen) return;
    let before = performance.now();
    const step = (now) => {
      this.frame = 0;
      const passed = this.speed * Math.min(0.2, (now - before) / 1000);
      this.phase += 2 * Math.PI * passed;
      if (this.clock) {
        this.time += passed;
        if (this.time > this.until) this.time = this.from;
      }
      before = now;
      this.draw();
      if (this.running && this.seen) this.frame = requestAnimationFrame(step);
    };
    this.frame = requestAnimationFrame(step);
  }
  draw() {
    const canvas = this.canvas, w = canvas.clientWidth, h = canvas.clientHeight, scale = window.devicePixelRatio || 1;
    if (!w) return;
    if (canvas.width !== Math.round(w * scale)) { canvas.width = Math.round(w * scale); canvas.height = Math.round(h * scale); }
    const c = canvas.getContext('2d');
    c.setTransform(scale, 0, 0, scale, 0, 0);
    c.clearRect(0, 0, w, h);
    const {motion} = this.model, mode = this.model.modes[this.mode], [yaw, pitch] = this.turn, a = this.amplitude * this.size / this.model.unit;
    const cy = Math.cos(yaw), sy = Math.sin(yaw), cp = Math.cos(pitch), sp = Math.sin(pitch);
    const need = [Math.abs(cy) * this.span[0] + Math.abs(sy) * this.span[2], Math.abs(cp) * this.span[1] + Math.abs(sp) * Math.max(this.span[0], this.span[2])];
    // Room for what moves out of a structure that lies; one that stands moves sideways. Below is the scale of colours.
    const across = Math.max(0.05 * this.size, 0.3 * this.size - 0.25 * need[1]);
    const zoom = this.nearness * Math.min(0.9 * w / (need[0] + 0.2 * this.size), 0.9 * (h - 30) / (need[1] + across));
    // glTF: y upwards; the eye looks along -z.
    const seen = (x, y, z) => {
      const u = x - this.centre[0], v = y - this.centre[1], s = z - this.centre[2];
      const side = cy * u + sy * s, deep = -sy * u + cy * s;
      return [w / 2 + zoom * side, h / 2 - 12 - zoom * (cp * v - sp * deep), sp * v + cp * deep];
    };
    const shares = motion ? this.weights() : this.shares(mode);
    const other = this.beside && this.beside.value !== '' ? this.shares(this.model.modes[Number(this.beside.value)]) : null;
    const dark = beamid.dark.matches;
    let farthest = 0;
    for (const {kind, points, indices, targets} of this.model.primitives) {
      const count = points.length / 3, moved = new Array(count), rest = new Array(count), far = new Float32Array(count);
      for (let i = 0; i < count; ++i) {
        const d = [0, 0, 0], most = [0, 0, 0];
        for (const [target, share] of shares)
          for (let k = 0; k < 3; ++k) {
            const by = targets[target][3 * i + k];
            d[k] += share * by;
            most[k] = Math.hypot(most[k], by);
          }
        far[i] = Math.hypot(...(motion ? d : most)) / this.model.unit;
        farthest = Math.max(farthest, far[i]);
        moved[i] = seen(points[3 * i] + a * d[0], points[3 * i + 1] + a * d[1], points[3 * i + 2] + a * d[2]);
        if (this.still) rest[i] = seen(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
      }
      if (kind === 1) {
        // One path through segments that follow each other, or dashes would begin anew at each.
        const trace = (at) => {
          c.beginPath();
          for (let i = 0, last = [NaN, NaN]; i < indices.length; i += 2) {
            const [x, y] = at(indices[i]);
            if (!(Math.abs(x - last[0]) + Math.abs(y - last[1]) < 0.01)) c.moveTo(x, y);
            last = at(indices[i + 1]);
            c.lineTo(last[0], last[1]);
          }
        };
        c.lineCap = 'butt';
        if (this.still) {
          trace((i) => rest[i]);
          c.strokeStyle = dark ? '#888' : '#999'; c.lineWidth = 1; c.setLineDash([4, 4]); c.stroke(); c.setLineDash([]);
        }
        if (other) {  // the lines of a second shape
          const place = (i) => seen(...[0, 1, 2].map((k) => points[3 * i + k] + a * other.reduce((sum, [target, share]) => sum + share * targets[target][3 * i + k], 0)));
          trace(place);
          c.strokeStyle = dark ? '#ff8a4c' : '#d55e00'; c.lineWidth = 2; c.setLineDash([9, 5]); c.stroke(); c.setLineDash([]);
        }
        c.lineWidth = 3; c.lineCap = 'round';
        for (let i = 0; i < indices.length; i += 2) {
          c.beginPath(); c.moveTo(...moved[indices[i]].slice(0, 2)); c.lineTo(...moved[indices[i + 1]].slice(0, 2));
          c.strokeStyle = shade(0.5 * (far[indices[i]] + far[indices[i + 1]])); c.stroke();
        }
      } else if (kind === 4) {
        const faces = [];
        for (let i = 0; i < indices.length; i += 3) {
          const corners = [moved[indices[i]], moved[indices[i + 1]], moved[indices[i + 2]]];
          faces.push([corners[0][2] + corners[1][2] + corners[2][2], corners, far[indices[i]]]);
        }
        faces.sort((p, q) => p[0] - q[0]);
        for (const [, corners, part] of faces) {
          c.beginPath();
          corners.forEach((corner, i) => i ? c.lineTo(corner[0], corner[1]) : c.moveTo(corner[0], corner[1]));
          c.closePath();
          c.fillStyle = c.strokeStyle = shade(part); c.lineWidth = 0.5; c.fill(); c.stroke();
        }
      } else {
        for (const i of indices) {
          c.beginPath(); c.arc(moved[i][0], moved[i][1], 6, 0, 7); c.fillStyle = shade(far[i]); c.fill();
          c.strokeStyle = dark ? '#ddd' : '#222'; c.lineWidth = 1; c.stroke();
        }
      }
    }
    // The scale of colours.
    const bar = Math.min(160, w / 3);
    for (let i = 0; i < bar; ++i) { c.fillStyle = shade(i / bar); c.fillRect(12 + i, h - 22, 1.5, 8); }
    c.fillStyle = dark ? '#ddd' : '#222';
    c.font = '12px "DejaVu Sans", Verdana, sans-serif';
    c.fillText('colour: displacement, 0 to the largest', 12, h - 27);
    canvas.dataset.mode = this.mode;
    if (motion) {
      this.clock.value = this.time;
      canvas.dataset.time = this.time;
      const digits = Math.max(0, Math.ceil(-Math.log10((this.until - this.from) / (motion.time.length - 1))));
      this.caption.textContent = `${this.time.toFixed(Math.min(digits, 9))} s: largest displacement ${brief(farthest * motion.largest_m)} m of ` +
        `${brief(motion.largest_m)} m; drawn ${brief(a * this.model.unit / motion.largest_m)} times as large, at ${brief(this.speed)} times the speed`;
      return;
    }
    const damping = 'damping_ratio' in mode ? `, damping ratio ${Number((100 * mode.damping_ratio).toPrecision(4))} %` : '';
    this.caption.textContent = `${mode.name}${damping}${other ? `; dashed: ${this.model.modes[Number(this.beside.value)].name}` : ''}`;
  }
  // Targets and their shares at the present phase: cos in phase, -sin in quadrature.
  shares(mode) {
    const share = [Math.cos(this.phase), -Math.sin(this.phase)];
    return mode.targets.map((target, i) => [target, share[i]]);
  }
  // The same of a motion at the present time, linear between its samples.
  weights() {
    const {time, weights} = this.model.motion, count = time.length, shapes = weights.length / count;
    const place = Math.max(0, Math.min(count - 1, (this.time - this.from) / (this.until - this.from) * (count - 1)));
    const i = Math.min(count - 2, Math.floor(place)), rest = place - i;
    return Array.from({length: shapes}, (_, k) => [k, (1 - rest) * weights[i * shapes + k] + rest * weights[(i + 1) * shapes + k]]);
  }
  listen() {
    const canvas = this.canvas;
    const held = new Map();  // pointers that are down
    const span = () => { const [[x, y], [u, v]] = [...held.values()]; return Math.max(20, Math.hypot(x - u, y - v)); };
    canvas.addEventListener('pointerdown', (event) => { canvas.setPointerCapture(event.pointerId); held.set(event.pointerId, [event.clientX, event.clientY]); });
    canvas.addEventListener('pointermove', (event) => {
      if (!held.has(event.pointerId)) return;
      const [x, y] = held.get(event.pointerId), before = held.size === 2 && span();
      held.set(event.pointerId, [event.clientX, event.clientY]);
      if (before) this.nearer(span() / before);
      else this.turnBy((event.clientX - x) / 150, (event.clientY - y) / 150);
    });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => held.delete(event.pointerId));
    canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      this.nearer(event.deltaY > 0 ? 0.85 : 1.18);
    }, {passive: false});
    canvas.addEventListener('keydown', (event) => {
      const turns = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]};
      if (event.key in turns) this.turnBy(...turns[event.key]);
      else if (event.key === ' ') this.play.click();
      else if (this.clock && (event.key === ',' || event.key === '.')) {
        this.time = Math.max(this.from, Math.min(this.until, this.time + (event.key === ',' ? -1 : 1) * Number(this.clock.step)));
        this.draw();
      } else if (event.key === '+' || event.key === '-') this.nearer(event.key === '+' ? 1.18 : 0.85);
      else return;
      event.preventDefault();
    });
  }
  turnBy(yaw, pitch) {
    this.turn = [this.turn[0] + yaw, Math.max(-1.5, Math.min(1.5, this.turn[1] + pitch))];
    this.draw();
  }
  nearer(factor) { this.nearness = Math.max(0.2, Math.min(20, this.nearness * factor)); this.draw(); }
}

for (const element of document.querySelectorAll('figure[data-model]')) {
  try {
    new Swing(element);
  } catch {  // data that are none: the static picture stays
    element.classList.remove('alive');
    element.querySelector(':scope > .live')?.remove();
  }
}
})();
