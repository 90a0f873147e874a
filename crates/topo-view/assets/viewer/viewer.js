// The gallery's viewer: charged knots and colloids, turned by hand, their discharge on a slider.
// Data come as JSON in <script type="application/json" id="viewer-data">, arrays of numbers as base64.
(function () {
  'use strict';
  const data = JSON.parse(document.getElementById('viewer-data').textContent);
  const T = window.THREE;

  function bytes(text) {
    const raw = atob(text);
    const out = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
    return out;
  }
  const shorts = (text) => new Int16Array(bytes(text).buffer);
  const viridis = data.viridis.map((c) => new T.Color().setRGB(c[0] / 255, c[1] / 255, c[2] / 255, T.SRGBColorSpace));

  // ---- one stage: camera, light, turning by mouse, finger or arrow keys
  function Stage(element) {
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
    controls.enableZoom = true;
    const group = new T.Group();
    scene.add(group);
    const draw = () => renderer.render(scene, camera);
    function resize() {
      const w = element.clientWidth, h = element.clientHeight;
      if (!w || !h) return;
      renderer.setSize(w, h, false);
      camera.aspect = w / h;
      camera.updateProjectionMatrix();
      draw();
    }
    new ResizeObserver(resize).observe(element);
    controls.addEventListener('change', draw);
    element.addEventListener('keydown', (e) => {
      const turn = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12] }[e.key];
      if (!turn) return;
      e.preventDefault();
      const p = camera.position, r = p.length();
      const phi = Math.atan2(p.x, p.z) + turn[0];
      const theta = Math.min(2.9, Math.max(0.2, Math.acos(p.y / r) + turn[1]));
      p.set(r * Math.sin(theta) * Math.sin(phi), r * Math.cos(theta), r * Math.sin(theta) * Math.cos(phi));
      controls.update();
      draw();
    });
    return {
      group,
      look(distance, height) {
        camera.position.set(0, height * distance, distance);
        camera.near = distance / 50;
        camera.far = distance * 20;
        camera.updateProjectionMatrix();
        controls.target.set(0, 0, 0);
        controls.update();
      },
      clear() {
        group.traverse((o) => {
          if (o.geometry) o.geometry.dispose();
          if (o.material) o.material.dispose();
        });
        group.clear();
      },
      draw,
      resize,
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
    const index = [];
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
          index.push(m, m + sides + 1, m + 1, m + sides + 1, m + sides + 2, m + 1);
        }
      }
    }
    const geometry = new T.BufferGeometry();
    geometry.setAttribute('position', new T.BufferAttribute(position, 3));
    geometry.setAttribute('normal', new T.BufferAttribute(normal, 3));
    geometry.setAttribute('color', new T.BufferAttribute(color, 3));
    geometry.setIndex(index);
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

  const floats = (values, from, count, scale) => {
    const out = new Float32Array(count);
    for (let i = 0; i < count; i++) out[i] = (values[from + i] / 32767) * scale;
    return out;
  };

  // ---- slider and play button shared by both
  function timeline(box, times, show) {
    const slider = box.querySelector('input[type=range]'), play = box.querySelector('button.play'), out = box.querySelector('output');
    let timer = null;
    const stop = () => { clearInterval(timer); timer = null; play.textContent = 'Play'; };
    const set = () => { out.textContent = times()[+slider.value]; show(+slider.value); };
    slider.addEventListener('input', () => { stop(); set(); });
    play.addEventListener('click', () => {
      if (timer) return stop();
      if (+slider.value >= +slider.max) slider.value = 0;
      play.textContent = 'Pause';
      timer = setInterval(() => {
        if (+slider.value >= +slider.max) return stop();
        slider.value = +slider.value + 1;
        set();
      }, 450);
    });
    return { reset(n) { stop(); slider.max = n - 1; slider.value = 0; set(); } };
  }

  // ---- knotted fibres
  function elastic(box) {
    const d = data.elastic, stage = Stage(box.querySelector('.stage'));
    const told = box.querySelector('.told'), table = box.querySelector('table.states');
    let now = null;
    function frame(k) {
      const c = now.case, n = c.n;
      stage.clear();
      const points = floats(now.xyz, 3 * n * k, 3 * n, c.scale);
      const colors = [];
      for (let i = 0; i < n; i++) colors.push(viridis[now.w[n * k + i]]);
      stage.group.add(tube(points, colors, k === 0, c.radius, 14));
      stage.draw();
    }
    const line = timeline(box, () => now.case.times.map((t, k) => (k ? 't = ' + t + ' T₀' : 'charged, closed')), frame);
    function select(i, j, focus) {
      const c = d.cases[i][j];
      if (!c) return;
      now = { case: c, xyz: shorts(c.xyz), w: bytes(c.w) };
      table.querySelectorAll('button').forEach((b) => {
        const on = +b.dataset.i === i && +b.dataset.j === j;
        b.setAttribute('aria-pressed', on);
        b.tabIndex = on ? 0 : -1;
        if (on && focus) b.focus();
      });
      told.textContent = d.knots[i] + ', θ′h = ' + d.twists[j] + ', E = ' + c.energy + ' E₀' + (c.t99 ? ', t₉₉ = ' + c.t99 + ' T₀' : '');
      stage.look(4.2 * c.extent, 0);
      line.reset(c.times.length);
      box.dataset.state = i + ',' + j;
    }
    const head = table.createTHead().insertRow();
    head.appendChild(document.createElement('th'));
    d.twists.forEach((t) => { const th = document.createElement('th'); th.scope = 'col'; th.textContent = t; head.appendChild(th); });
    const body = table.createTBody();
    d.knots.forEach((name, i) => {
      const row = body.insertRow(), th = document.createElement('th');
      th.scope = 'row'; th.textContent = name; row.appendChild(th);
      d.twists.forEach((t, j) => {
        const cell = row.insertCell(), c = d.cases[i][j];
        if (!c) return;
        const b = document.createElement('button');
        b.type = 'button'; b.dataset.i = i; b.dataset.j = j; b.tabIndex = -1;
        b.setAttribute('aria-label', name + ', twist ' + t);
        b.title = name + ', θ′h = ' + t + ': E = ' + c.energy + ' E₀';
        b.style.background = '#' + viridis[c.shade].getHexString(T.SRGBColorSpace);
        b.addEventListener('click', () => select(i, j, false));
        cell.appendChild(b);
      });
    });
    table.addEventListener('keydown', (e) => {
      const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[e.key];
      if (!step || e.target.dataset.i === undefined) return;
      e.preventDefault();
      const i = Math.min(d.knots.length - 1, Math.max(0, +e.target.dataset.i + step[0]));
      const j = Math.min(d.twists.length - 1, Math.max(0, +e.target.dataset.j + step[1]));
      select(i, j, true);
    });
    const [i, j] = d.first;
    select(i, j, false);
  }

  // ---- colloids
  function nematic(box) {
    const d = data.nematic, stage = Stage(box.querySelector('.stage'));
    const told = box.querySelector('.told'), pick = box.querySelector('select');
    let now = null;
    const up = new T.Vector3(0, 1, 0);
    function sphere(c) {
      const g = new T.SphereGeometry(c.radius, 96, 64), p = g.getAttribute('position');
      const color = new Float32Array(p.count * 3), low = new T.Color().setRGB(30 / 255, 70 / 255, 170 / 255, T.SRGBColorSpace), high = new T.Color().setRGB(250 / 255, 220 / 255, 60 / 255, T.SRGBColorSpace);
      for (let i = 0; i < p.count; i++) {
        // the page's x, y, z are the cell's x, z, −y
        const x = p.getX(i) / c.radius, y = -p.getZ(i) / c.radius;
        const v = 0.5 + 0.5 * Math.hypot(x, y) * Math.cos(c.q * Math.atan2(y, x));
        color[3 * i] = low.r + (high.r - low.r) * v; color[3 * i + 1] = low.g + (high.g - low.g) * v; color[3 * i + 2] = low.b + (high.b - low.b) * v;
      }
      g.setAttribute('color', new T.BufferAttribute(color, 3));
      return new T.Mesh(g, new T.MeshStandardMaterial({ vertexColors: true, roughness: 0.5 }));
    }
    function rods(f, c) {
      const v = shorts(f.rods), n = v.length / 5, long = c.rod;
      const mesh = new T.InstancedMesh(new T.CylinderGeometry(0.09 * long, 0.09 * long, long, 6), new T.MeshStandardMaterial({ color: 0x5f9a52, roughness: 0.6 }), n);
      const m = new T.Matrix4(), q = new T.Quaternion(), e = new T.Vector3(), one = new T.Vector3(1, 1, 1), at = new T.Vector3();
      for (let i = 0; i < n; i++) {
        const k = 5 * i, s = c.scale / 32767;
        at.set(v[k] * s, v[k + 1] * s, 0);
        e.set(v[k + 2], v[k + 4], -v[k + 3]).normalize();
        m.compose(at, q.setFromUnitVectors(up, e), one);
        mesh.setMatrixAt(i, m);
      }
      return mesh;
    }
    function frame(k) {
      const c = now, f = c.frames[k];
      stage.clear();
      stage.group.add(sphere({ radius: c.radius, q: k === 0 ? c.q : 0 }));
      stage.group.add(rods(f, c));
      f.lines.forEach((l) => {
        const raw = floats(shorts(l.xyz), 0, shorts(l.xyz).length, c.scale), w = bytes(l.w);
        for (let i = 0; i < raw.length; i += 3) { const y = raw[i + 1]; raw[i + 1] = raw[i + 2]; raw[i + 2] = -y; }
        stage.group.add(tube(raw, Array.from(w, (b) => viridis[b]), l.closed, 0.055 * c.radius, 12));
      });
      stage.draw();
    }
    const line = timeline(box, () => now.frames.map((f, k) => (k ? 't = ' + f.t + ' R²/ΓL' : 'charged')), frame);
    function select(k) {
      now = d.cases[k];
      told.textContent = 'q = ' + now.q + ', F = ' + now.energy + ' Lξ_N' + (now.buckled ? ', ring buckled' : '');
      stage.look(3.6 * now.extent, 0.28);
      line.reset(now.frames.length);
      box.dataset.state = k;
    }
    d.cases.forEach((c, k) => { const o = document.createElement('option'); o.value = k; o.textContent = 'q = ' + c.q + (c.flow ? ', with flow' : ''); pick.appendChild(o); });
    pick.addEventListener('change', () => select(+pick.value));
    pick.value = d.first;
    select(d.first);
  }

  function start(id, build, has) {
    const box = document.getElementById(id);
    if (!box || !has) return;
    try {
      build(box);
      box.dataset.ready = 'yes';
    } catch (error) {
      box.querySelector('.told').textContent = 'No 3D view here: ' + error.message;
      box.dataset.ready = 'no';
    }
  }
  start('viewer-elastic', elastic, data.elastic);
  start('viewer-nematic', nematic, data.nematic);
})();
