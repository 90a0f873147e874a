// Colloids: `#q=4` is a charged state, `#q=4,flow` the one with flow.

function nematic(box) {
  const d = index.nematic, stage = Stage(box.querySelector('.stage'), 'ξ<sub>N</sub>');
  const said = box.querySelector('.said'), pick = box.querySelector('select');
  const low = [30, 70, 170], high = [250, 220, 60];
  let now = null;
  const up = new T.Vector3(0, 1, 0);
  function sphere(c) {
    const g = new T.SphereGeometry(c.radius, 96, 64), p = g.getAttribute('position');
    const color = new Float32Array(p.count * 3);
    const [from, to] = [low, high].map((e) => new T.Color().setRGB(e[0] / 255, e[1] / 255, e[2] / 255, T.SRGBColorSpace));
    for (let i = 0; i < p.count; i++) {
      // the page's x, y, z are the cell's x, z, −y
      const x = p.getX(i) / c.radius, y = -p.getZ(i) / c.radius;
      const v = 0.5 + 0.5 * Math.hypot(x, y) * Math.cos(c.q * Math.atan2(y, x));
      color[3 * i] = from.r + (to.r - from.r) * v; color[3 * i + 1] = from.g + (to.g - from.g) * v; color[3 * i + 2] = from.b + (to.b - from.b) * v;
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
      const values = shorts(l.xyz), raw = floats(values, 0, values.length, c.scale), w = bytes(l.w);
      for (let i = 0; i < raw.length; i += 3) { const y = raw[i + 1]; raw[i + 1] = raw[i + 2]; raw[i + 2] = -y; }
      stage.group.add(tube(raw, Array.from(w, shade), l.closed, 0.055 * c.radius, 12));
    });
    stage.draw();
  }
  const line = timeline(box, () => now.frames.map((f, k) => (k ? 't = ' + f.t + ' R²/ΓL' : 'charged')), frame);
  const hash = (k) => '#q=' + d.cases[k].q + (d.cases[k].flow ? ',flow' : '');
  let wanted = 0;
  function select(k, options) {
    const c = d.cases[k], turn = ++wanted;
    pick.value = k;
    if (options.address) link(box, hash(k));
    return load('nematic/' + c.file).then((data) => {
      if (turn !== wanted) return;
      now = data;
      said.innerHTML = 'q = ' + c.q + ', F = ' + c.energy + ' Lξ<sub>N</sub>' + (c.buckled ? ', ring buckled' : '');
      stage.fit(new T.Vector3(), now.half, 0.28);
      line.reset(now.frames.length, 0);
      box.querySelector('a.state').href = hash(k);
      box.dataset.state = k;
    }).catch((e) => { said.textContent = e.message; });
  }
  d.cases.forEach((c, k) => { const o = document.createElement('option'); o.value = k; o.textContent = 'q = ' + c.q + (c.flow ? ', with flow' : ''); pick.appendChild(o); });
  pick.addEventListener('change', () => select(+pick.value, { address: true }));
  const bars = box.querySelectorAll('.bar');
  colorBar(bars[0], 'Ring: cross-section', viridis, [[0, '+½'], [0.5, 'twisted'], [1, '−½']]);
  colorBar(bars[1], 'Particle: surface director, <i>x</i>', [low, high], [[0, '−1'], [1, '1']]);
  return {
    first: () => select(d.first, {}),
    state(text) {
      const k = d.cases.findIndex((c, k) => hash(k) === '#' + text);
      return k < 0 ? null : () => select(k, {});
    },
  };
}
