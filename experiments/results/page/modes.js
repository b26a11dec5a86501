// Mode shapes that swing, from the glTF model in the page (results/mode_model.hpp): orbit, speed, amplitude.
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
  const mesh = json.meshes[0];
  return {modes: mesh.extras.modes, unit: mesh.extras.moves_m, primitives: mesh.primitives.map((primitive) => ({
    kind: primitive.mode, points: array(primitive.attributes.POSITION), indices: array(primitive.indices),
    targets: primitive.targets.map((target) => array(target.POSITION))}))};
}

class Swing {
  constructor(element) {
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
    const bar = make(live, 'div', {class: 'bar', role: 'toolbar', 'aria-label': 'mode shapes'});
    this.choice = make(make(bar, 'label', {}, 'Mode '), 'select');
    this.model.modes.forEach((mode, i) => make(this.choice, 'option', {value: i}, mode.name));
    this.choice.addEventListener('change', () => { this.mode = Number(this.choice.value); this.draw(); });
    this.running = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.play = make(bar, 'button', {type: 'button'}, this.running ? 'Pause' : 'Swing');
    this.play.addEventListener('click', () => { this.running = !this.running; this.play.textContent = this.running ? 'Pause' : 'Swing'; this.start(); });
    const slider = (name, from, to, at, action) => {
      const made = make(make(bar, 'label', {}, `${name} `), 'input', {type: 'range', min: from, max: to, step: (to - from) / 100, value: at});
      made.addEventListener('input', () => { action(Number(made.value)); this.draw(); });
      action(at);
    };
    slider('speed', 0.1, 2, 0.6, (v) => { this.speed = v; });
    slider('amplitude', 0, 0.4, 0.12, (v) => { this.amplitude = v; });
    const box = make(make(bar, 'label', {}, 'undeformed '), 'input', {type: 'checkbox', checked: ''});
    this.still = true;
    box.addEventListener('change', () => { this.still = box.checked; this.draw(); });
    const button = (text, action) => make(bar, 'button', {type: 'button'}, text).addEventListener('click', action);
    button('Reset', () => { this.turn = [...this.home]; this.nearness = 1; this.draw(); });
    button('PNG', () => this.canvas.toBlob((blob) => beamid.save('mode.png', blob)));
    button('glTF', () => beamid.save(`${element.dataset.name}.glb`, new Blob([data], {type: 'model/gltf-binary'})));
    make(bar, 'span', {class: 'help'}, 'drag: turn · Ctrl + wheel: nearer · arrow keys: turn · space: stop');
    this.canvas = make(live, 'canvas', {tabindex: 0, role: 'img', class: 'swing', 'aria-label': 'mode shape that swings; arrow keys turn it, space stops it'});
    this.caption = make(live, 'div', {class: 'reading still', role: 'status'});
    this.listen();
    new ResizeObserver(() => this.draw()).observe(live);
    new IntersectionObserver((entries) => { this.seen = entries.some((entry) => entry.isIntersecting); this.start(); }).observe(this.canvas);
    beamid.dark.addEventListener('change', () => this.draw());
    this.draw();
  }
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
      this.phase += 2 * Math.PI * this.speed * Math.min(0.2, (now - before) / 1000);
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
    const mode = this.model.modes[this.mode], [yaw, pitch] = this.turn, a = this.amplitude * this.size / this.model.unit;
    const cy = Math.cos(yaw), sy = Math.sin(yaw), cp = Math.cos(pitch), sp = Math.sin(pitch);
    const need = [Math.abs(cy) * this.span[0] + Math.abs(sy) * this.span[2], Math.abs(cp) * this.span[1] + Math.abs(sp) * Math.max(this.span[0], this.span[2])];
    const zoom = this.nearness * Math.min(0.9 * w / (need[0] + 0.2 * this.size), 0.9 * h / (need[1] + 0.3 * this.size));
    // glTF: y upwards; the eye looks along -z.
    const seen = (x, y, z) => {
      const u = x - this.centre[0], v = y - this.centre[1], s = z - this.centre[2];
      const side = cy * u + sy * s, deep = -sy * u + cy * s;
      return [w / 2 + zoom * side, h / 2 - zoom * (cp * v - sp * deep), sp * v + cp * deep];
    };
    const cos = Math.cos(this.phase), sin = Math.sin(this.phase);
    const dark = beamid.dark.matches;
    for (const {kind, points, indices, targets} of this.model.primitives) {
      const real = targets[mode.targets[0]], imaginary = mode.targets.length > 1 ? targets[mode.targets[1]] : null;
      const count = points.length / 3, moved = new Array(count), rest = new Array(count), far = new Float32Array(count);
      for (let i = 0; i < count; ++i) {
        const d = [0, 1, 2].map((k) => cos * real[3 * i + k] - (imaginary ? sin * imaginary[3 * i + k] : 0));
        const most = [0, 1, 2].map((k) => Math.hypot(real[3 * i + k], imaginary ? imaginary[3 * i + k] : 0));
        far[i] = Math.hypot(...most) / this.model.unit;
        moved[i] = seen(points[3 * i] + a * d[0], points[3 * i + 1] + a * d[1], points[3 * i + 2] + a * d[2]);
        if (this.still) rest[i] = seen(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
      }
      if (kind === 1) {
        c.lineCap = 'round';
        if (this.still) {
          c.beginPath();
          for (let i = 0; i < indices.length; i += 2) { c.moveTo(...rest[indices[i]].slice(0, 2)); c.lineTo(...rest[indices[i + 1]].slice(0, 2)); }
          c.strokeStyle = dark ? '#888' : '#999'; c.lineWidth = 1; c.setLineDash([4, 4]); c.stroke(); c.setLineDash([]);
        }
        c.lineWidth = 3;
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
    const damping = 'damping_ratio' in mode ? `, damping ratio ${Number((100 * mode.damping_ratio).toPrecision(4))} %` : '';
    this.caption.textContent = `${mode.name}${damping}`;
    canvas.dataset.mode = this.mode;
  }
  listen() {
    const canvas = this.canvas;
    canvas.addEventListener('pointerdown', (event) => { canvas.setPointerCapture(event.pointerId); this.drag = [event.clientX, event.clientY]; });
    canvas.addEventListener('pointermove', (event) => {
      if (!this.drag) return;
      this.turnBy((event.clientX - this.drag[0]) / 150, (event.clientY - this.drag[1]) / 150);
      this.drag = [event.clientX, event.clientY];
    });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, () => { this.drag = null; });
    canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      this.nearer(event.deltaY > 0 ? 0.85 : 1.18);
    }, {passive: false});
    canvas.addEventListener('keydown', (event) => {
      const turns = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]};
      if (event.key in turns) this.turnBy(...turns[event.key]);
      else if (event.key === ' ') this.play.click();
      else if (event.key === '+' || event.key === '-') this.nearer(event.key === '+' ? 1.18 : 0.85);
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
