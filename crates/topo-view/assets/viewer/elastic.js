// Knotted fibres: `#7_4,+0.5` is a state, `#7_4,+0.5,6` one of its shapes.

function elastic(box) {
  const d = index.elastic, stage = Stage(box.querySelector('.stage'), '<i>h</i>');
  const said = box.querySelector('.said'), table = box.querySelector('table.states'), bar = box.querySelector('.bar');
  let now = null;
  function frame(k) {
    const c = now.data, n = c.n.reduce((a, b) => a + b);
    stage.clear();
    const points = floats(now.xyz, 3 * n * k, 3 * n, c.scale), colors = [];
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < n; i++) {
      colors.push(shade(now.w[n * k + i]));
      for (let j = 0; j < 3; j++) {
        low[j] = Math.min(low[j], points[3 * i + j]);
        high[j] = Math.max(high[j], points[3 * i + j]);
      }
    }
    const center = new T.Vector3(...low.map((v, j) => (v + high[j]) / 2));
    let radius = 0;
    for (let i = 0; i < n; i++) radius = Math.max(radius, Math.hypot(...[0, 1, 2].map((j) => points[3 * i + j] - center.getComponent(j))));
    // of a link, each component
    let from = 0;
    c.n.forEach((m, j) => {
      stage.group.add(tube(points.subarray(3 * from, 3 * (from + m)), colors.slice(from, from + m), c.closed[k][j], c.radius, 14));
      from += m;
    });
    stage.fit(center, radius + c.radius, now.fresh ? 0 : undefined);
    now.fresh = false;
    stage.draw();
  }
  const line = timeline(box, () => now.data.times.map((t, k) => (k ? 't = ' + t + ' T₀' : 'charged, closed')), frame);
  const hash = (i, j) => '#' + d.names[i] + ',' + d.values[j];
  let wanted = 0;
  function select(i, j, options) {
    const c = d.cases[i][j], turn = ++wanted;
    if (!c) return Promise.resolve();
    table.querySelectorAll('button').forEach((b) => {
      const on = +b.dataset.i === i && +b.dataset.j === j;
      b.setAttribute('aria-pressed', on);
      b.tabIndex = on ? 0 : -1;
      if (on && options.focus) b.focus();
    });
    if (options.address) link(box, hash(i, j));
    return load('elastic/' + d.names[i]).then((states) => {
      // another state was chosen while this one was loaded
      if (turn !== wanted) return;
      const data = states[j];
      now = { data, xyz: shorts(data.xyz), w: bytes(data.w), fresh: true };
      said.textContent = d.knots[i] + ', θ′h = ' + d.twists[j] + ', E = ' + c.energy + ' E₀' + (c.t99 ? ', t₉₉ = ' + c.t99 + ' T₀' : '');
      colorBar(bar, 'Energy density <i>w</i> / <i>E</i><sub>b</sub><i>h</i>²', viridis, [[0, '0'], [0.5, data.ticks[0]], [1, data.ticks[1]]]);
      line.reset(data.times.length, Math.min(options.frame || 0, data.times.length - 1));
      box.querySelector('a.state').href = hash(i, j);
      box.dataset.state = i + ',' + j;
    }).catch((e) => { said.textContent = e.message; });
  }
  function fill() {
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
        b.style.background = css(index.viridis[c.shade]);
        b.addEventListener('click', () => select(i, j, { address: true }));
        cell.appendChild(b);
      });
    });
    colorBar(box.querySelector('.bar.states'), 'States: stored energy <i>E</i> / <i>E</i>₀', viridis, [[0, '0'], [0.5, d.ticks[0]], [1, d.ticks[1]]]);
  }
  table.addEventListener('keydown', (e) => {
    const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[e.key];
    if (!step || e.target.dataset.i === undefined) return;
    e.preventDefault();
    const i = Math.min(d.knots.length - 1, Math.max(0, +e.target.dataset.i + step[0]));
    const j = Math.min(d.twists.length - 1, Math.max(0, +e.target.dataset.j + step[1]));
    select(i, j, { address: true, focus: true });
  });
  fill();
  return {
    first: () => select(d.first[0], d.first[1], {}),
    // the state that an address names; null if it names none
    state(text) {
      const [name, twist, shape] = text.split(',');
      const i = d.names.indexOf(name), j = d.values.findIndex((v) => twist !== undefined && +v === +twist);
      return i < 0 || j < 0 || !d.cases[i][j] ? null : () => select(i, j, { frame: +shape || 0 });
    },
  };
}
