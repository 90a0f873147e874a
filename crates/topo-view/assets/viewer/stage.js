// One stage: camera, light, turning by mouse, finger or arrow keys, and what is drawn on it.
// Everything in this folder is one function of the page; `index` holds what is small, `T` is three.js once it is loaded.

const index = JSON.parse(document.getElementById('viewer-index').textContent);
let T = null;

// ---- files beside the page, loaded by script tags, as pages that were opened from disk may not read files otherwise
const waiting = {};
window.topoView = (name, data) => waiting[name].resolve(data);

function load(name) {
  if (!waiting[name]) {
    const w = (waiting[name] = {});
    w.promise = new Promise((resolve, reject) => {
      w.resolve = resolve;
      const script = document.createElement('script');
      script.src = 'viewer/' + name.split('/').map(encodeURIComponent).join('/') + '.js';
      script.onerror = () => {
        delete waiting[name];
        reject(new Error(script.src.split('/').slice(-3).join('/') + ' is not beside this page'));
      };
      if (name === 'three') script.onload = () => resolve((T = window.THREE));
      document.head.appendChild(script);
    });
  }
  return waiting[name].promise;
}

function bytes(text) {
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out;
}
const shorts = (text) => new Int16Array(bytes(text).buffer);
const floats = (values, from, count, scale) => {
  const out = new Float32Array(count);
  for (let i = 0; i < count; i++) out[i] = (values[from + i] / 32767) * scale;
  return out;
};
const css = (c) => 'rgb(' + c.join(',') + ')';
const shade = (k) => new T.Color().setRGB(index.viridis[k][0] / 255, index.viridis[k][1] / 255, index.viridis[k][2] / 255, T.SRGBColorSpace);

// ---- a colour bar: label, colours from left to right, [fraction, text] of each tick
function colorBar(element, label, colors, ticks) {
  element.innerHTML = '';
  const add = (parent, kind, html) => {
    const e = document.createElement(kind);
    if (html !== undefined) e.innerHTML = html;
    return parent.appendChild(e);
  };
  add(element, 'b', label);
  const bar = add(element, 'i');
  bar.style.background = 'linear-gradient(90deg,' + colors.map(css).join(',') + ')';
  ticks.forEach(([at, text]) => { add(bar, 'span', text).style.left = 100 * at + '%'; });
}
const viridis = index.viridis.filter((c, k) => k % 15 === 0);

function Stage(element, unit) {
  const renderer = new T.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
  element.insertBefore(renderer.domElement, element.firstChild);
  const scene = new T.Scene();
  const camera = new T.PerspectiveCamera(32, 1.6, 0.1, 4000);
  scene.add(new T.HemisphereLight(0xffffff, 0x9aa4b0, 1.7));
  const key = new T.DirectionalLight(0xffffff, 2.0);
  key.position.set(-0.5, 0.8, 1);
  camera.add(key);
  scene.add(camera);
  const controls = new T.OrbitControls(camera, renderer.domElement);
  controls.enablePan = false;
  // the wheel scrolls the page, as fingers do upwards and downwards, until the stage has been chosen
  controls.enableZoom = false;
  renderer.domElement.style.touchAction = 'pan-y';
  element.addEventListener('focus', () => { controls.enableZoom = true; });
  element.addEventListener('blur', () => { controls.enableZoom = false; });
  const group = new T.Group();
  scene.add(group);
  const ruler = element.querySelector('.ruler');
  // what is in view, and the distance at which all of it is
  const seen = { center: new T.Vector3(), reach: 1, distance: 0 };
  function draw() {
    renderer.render(scene, camera);
    const away = camera.position.distanceTo(controls.target);
    const pixels = element.clientHeight / (2 * away * Math.tan((camera.fov * Math.PI) / 360));
    const raw = 90 / pixels, power = Math.pow(10, Math.floor(Math.log10(raw)));
    const round = [5, 2, 1].find((m) => m * power <= raw) * power;
    ruler.style.width = round * pixels + 'px';
    ruler.innerHTML = +round.toPrecision(1) + ' ' + unit;
  }
  // moves the eye so that a sphere of radius `reach`, or an upright plane of half sides `reach`, is in view; turning and zooming by
  // hand are kept
  function fit(center, reach, height) {
    const up = (camera.fov * Math.PI) / 360, across = Math.atan(Math.tan(up) * camera.aspect);
    const distance = 1.05 * (reach.length ? Math.max(reach[0] / Math.tan(across), reach[1] / Math.tan(up)) : reach / Math.sin(Math.min(up, across)));
    const away = camera.position.clone().sub(controls.target);
    const zoom = height === undefined && seen.distance ? away.length() / seen.distance : 1;
    if (height !== undefined) away.set(0, height, 1);
    camera.position.copy(center).add(away.setLength(distance * zoom));
    camera.near = distance / 50;
    camera.far = distance * 20;
    camera.updateProjectionMatrix();
    controls.target.copy(center);
    Object.assign(seen, { center: center.clone(), reach, distance });
    controls.update();
  }
  function resize() {
    const w = element.clientWidth, h = element.clientHeight;
    if (!w || !h) return;
    renderer.setSize(w, h, false);
    camera.aspect = w / h;
    camera.updateProjectionMatrix();
    if (seen.distance) fit(seen.center, seen.reach);
    draw();
  }
  new ResizeObserver(resize).observe(element);
  resize();
  controls.addEventListener('change', draw);
  element.addEventListener('keydown', (e) => {
    const turn = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12] }[e.key];
    if (!turn) return;
    e.preventDefault();
    const p = camera.position.clone().sub(controls.target), r = p.length();
    const phi = Math.atan2(p.x, p.z) + turn[0];
    const theta = Math.min(2.9, Math.max(0.2, Math.acos(p.y / r) + turn[1]));
    p.set(r * Math.sin(theta) * Math.sin(phi), r * Math.cos(theta), r * Math.sin(theta) * Math.cos(phi));
    camera.position.copy(controls.target).add(p);
    controls.update();
    draw();
  });
  return {
    group,
    fit,
    clear() {
      group.traverse((o) => {
        if (o.geometry) o.geometry.dispose();
        if (o.material) o.material.dispose();
      });
      group.clear();
    },
    draw,
  };
}

// ---- a tube of given radius along points (Float32, xyz), a colour each
function tube(points, colors, closed, radius, sides) {
  const knots = [];
  for (let i = 0; i < points.length; i += 3) knots.push(new T.Vector3(points[i], points[i + 1], points[i + 2]));
  const n = knots.length;
  const curve = new T.CatmullRomCurve3(knots, closed, 'centripetal');
  const rows = Math.max(2 * n, 8);
  const frames = curve.computeFrenetFrames(rows, closed);
  const position = new Float32Array((rows + 1) * (sides + 1) * 3);
  const normal = new Float32Array(position.length);
  const color = new Float32Array(position.length);
  const corners = [];
  const p = new T.Vector3();
  for (let i = 0; i <= rows; i++) {
    curve.getPointAt(i / rows, p);
    const u = (i / rows) * (closed ? n : n - 1);
    const a = Math.floor(u) % n, b = (a + 1) % n, f = u - Math.floor(u);
    const last = !closed && a === n - 1;
    const ca = colors[a], cb = last ? ca : colors[b];
    for (let j = 0; j <= sides; j++) {
      const v = (j / sides) * Math.PI * 2, s = Math.sin(v), c = -Math.cos(v);
      const N = frames.normals[i], B = frames.binormals[i];
      const k = 3 * (i * (sides + 1) + j);
      normal[k] = c * N.x + s * B.x; normal[k + 1] = c * N.y + s * B.y; normal[k + 2] = c * N.z + s * B.z;
      position[k] = p.x + radius * normal[k]; position[k + 1] = p.y + radius * normal[k + 1]; position[k + 2] = p.z + radius * normal[k + 2];
      color[k] = ca.r + (cb.r - ca.r) * f; color[k + 1] = ca.g + (cb.g - ca.g) * f; color[k + 2] = ca.b + (cb.b - ca.b) * f;
      if (i < rows && j < sides) {
        const m = i * (sides + 1) + j;
        corners.push(m, m + sides + 1, m + 1, m + sides + 1, m + sides + 2, m + 1);
      }
    }
  }
  const geometry = new T.BufferGeometry();
  geometry.setAttribute('position', new T.BufferAttribute(position, 3));
  geometry.setAttribute('normal', new T.BufferAttribute(normal, 3));
  geometry.setAttribute('color', new T.BufferAttribute(color, 3));
  geometry.setIndex(corners);
  const material = new T.MeshStandardMaterial({ vertexColors: true, roughness: 0.42, metalness: 0.05 });
  const mesh = new T.Group();
  mesh.add(new T.Mesh(geometry, material));
  if (!closed) {
    [[knots[0], colors[0]], [knots[n - 1], colors[n - 1]]].forEach(([at, c]) => {
      const cap = new T.Mesh(new T.SphereGeometry(radius, 20, 14), new T.MeshStandardMaterial({ color: c, roughness: 0.42 }));
      cap.position.copy(at);
      mesh.add(cap);
    });
  }
  return mesh;
}

// ---- slider and play button shared by both
function timeline(box, times, show) {
  const slider = box.querySelector('input[type=range]'), play = box.querySelector('button.play'), out = box.querySelector('output');
  let timer = null;
  const label = (text) => { play.textContent = text; play.setAttribute('aria-pressed', text === 'Pause'); };
  const stop = () => { clearInterval(timer); timer = null; label('Play'); };
  const set = () => { out.textContent = times()[+slider.value]; show(+slider.value); };
  slider.addEventListener('input', () => { stop(); set(); });
  play.addEventListener('click', () => {
    if (timer) return stop();
    if (+slider.value >= +slider.max) { slider.value = 0; set(); }
    label('Pause');
    timer = setInterval(() => {
      if (+slider.value >= +slider.max) return stop();
      slider.value = +slider.value + 1;
      set();
    }, 450);
  });
  return { reset(n, k) { stop(); slider.max = n - 1; slider.value = k || 0; set(); } };
}

// ---- the address of a state, shown as a link and in the address line
function link(box, hash) {
  box.querySelector('a.state').href = hash;
  try { history.replaceState(null, '', hash); } catch (e) { /* some browsers keep the address of a file */ }
}
