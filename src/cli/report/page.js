// SPDX-License-Identifier: BSD-3-Clause
// Shows the data of a report. They are what src/cli/report.cpp and report_drawing.cpp gather:
//   title, version, epsilon, delta (or null), unit of t ("s" or ""), self, objects (how many), domain [t0, t1], errors
//   (true: lower of the profiles is that of every execution within bounds of its errors)
//   date (UTC), host, command
//   inputs    [{what, file, digest}]
//   notes     [message]
//   verdicts  [{query, id, kind, a, b, status, verdict, lower, upper, t, points [[x,y,z],[x,y,z]], nodes, microseconds, message,
//             proof, certificate}], proof and certificate where one was asked for; a number that is not finite is null
//   profiles  [{name, kind, t [n+1], lower [n], upper [n], against [n]}]
//   pairs     [as verdicts]
//   curves    [{name, radius, t [n], points [3n]}]
//   bodies, frames: see report_drawing.h
'use strict';

const data = JSON.parse(document.getElementById('data').textContent);
const PALETTE = ['#1b6ca8', '#d1495b', '#2e8b57', '#9467bd', '#c77700', '#17a2a2', '#7f5539', '#d63384', '#5c6b7a', '#6a8d00'];
// Objects, lighter than the links' colours of clearance.
const STANDING = ['#b8a88f', '#9db4c0', '#a3b18a', '#c9ada7', '#c2b280', '#8fa6a0', '#d4a373', '#a9a3c4'];
const MOST_NAMED = 12, MOST_LISTED = 60; // objects with a name in the view, and beneath it
const MOST_SHOWN = 8; // lines of the chart that are on at first

// ------------------------------------------------------------------------------------------------------------- words
function metres(x) {
  if (x === null || x === undefined) return '–';
  if (x === 0) return '0 mm';
  return Math.abs(x) < 1 ? (1000 * x).toPrecision(5) + ' mm' : x.toPrecision(6) + ' m';
}

// A round number as it was given.
function given(x) {
  return Math.abs(x) < 1 ? +(1000 * x).toPrecision(5) + ' mm' : +x.toPrecision(6) + ' m';
}

function moment(t) {
  return t === null || t === undefined ? '–' : t.toPrecision(5) + (data.unit ? ' ' + data.unit : '');
}

function element(name, text, className) {
  const out = document.createElement(name);
  if (text !== undefined) out.textContent = text;
  if (className) out.className = className;
  return out;
}

function subjectOf(row) {
  return {environment: 'robot and scene', self: 'robot and itself'}[row.kind] || row.id;
}

function questionOf(row) {
  return row.query === 'tolerance' ? 'farther than ' + metres(data.delta) + '?' : 'least distance';
}

// ------------------------------------------------------------------------------------------------------------ tables
function fillTable(table, columns, rows) {
  const head = element('tr');
  for (const column of columns) head.append(element('th', column.head, column.number ? 'number' : ''));
  table.append(head);
  return rows.map(row => {
    const line = element('tr');
    for (const column of columns) {
      const cell = element('td', undefined, column.number ? 'number' : '');
      const content = column.of(row);
      cell.append(content instanceof Node ? content : String(content));
      line.append(cell);
    }
    table.append(line);
    return line;
  });
}

function badge(row) {
  if (row.verdict) return element('span', row.verdict, 'verdict ' + row.verdict);
  return row.status === 'ok' ? '' : row.status + (row.message ? ': ' + row.message : '');
}

const INTERVAL = [
  {head: 'lower', number: true, of: row => metres(row.lower)}, {head: 'upper', number: true, of: row => metres(row.upper)},
  {head: 'at', number: true, of: row => moment(row.t)}, {head: 'between', of: row => row.a}, {head: 'and', of: row => row.b}];

function showVerdicts() {
  const columns = [{head: 'what', of: subjectOf}, {head: 'query', of: questionOf}, {head: '', of: badge}, ...INTERVAL];
  fillTable(document.getElementById('verdicts'), columns, data.verdicts);
}

function showPairs() {
  const rows = data.pairs.slice().sort((x, y) => x.upper - y.upper);
  const columns = [{head: 'what', of: subjectOf}, ...INTERVAL];
  const table = document.getElementById('pairs');
  const lines = fillTable(table, columns, rows);
  lines.forEach((line, i) => {
    const choose = () => {
      for (const other of lines) other.classList.toggle('chosen', other === line);
      choosePair(rows[i]);
    };
    line.classList.add('row');
    line.tabIndex = 0;
    line.addEventListener('click', choose);
    line.addEventListener('keydown', event => { if (event.key === 'Enter') choose(); });
  });
  if (lines.length === 0) table.append(element('caption', 'There is no pair: nothing was measured.'));
}

function showSummary() {
  const summary = document.getElementById('summary');
  const asked = data.verdicts.filter(row => row.verdict);
  for (const word of ['violated', 'undecided', 'clear']) {
    const rows = asked.filter(row => row.verdict === word);
    if (!rows.length) continue;
    summary.append(element('span', word, 'verdict ' + word), ` ${rows.map(subjectOf).join(', ')}: farther than ${metres(data.delta)}? `);
  }
  const nearest = data.verdicts.filter(row => row.query === 'distance' && row.upper !== null).sort((x, y) => x.upper - y.upper)[0];
  if (nearest)
    summary.append('Least distance ' + metres(nearest.lower) + ' to ' + metres(nearest.upper) + ' at ' + moment(nearest.t) +
      ', between ' + nearest.a + ' and ' + nearest.b + '.');
  else
    summary.append('Nothing was measured.');
}

function showBasis() {
  const list = document.getElementById('basis');
  const add = (text, code) => {
    const item = element('li', text);
    if (code) item.append(' ', element('code', code));
    list.append(item);
  };
  add('cprox ' + data.version + ' on ' + data.host + ', ' + data.date + ', intervals of at most ' + given(data.epsilon) + ' asked for.');
  add('The command:', data.command);
  add('Objects in the scene: ' + data.objects + '.');
  if (data.unit === 's' && !data.self) add('The robot was not measured against itself (--self).');
  for (const input of data.inputs)
    add(input.what + ' ' + input.file + ', BLAKE2b of it and the meshes that it names:', input.digest);
  const proven = data.verdicts.filter(row => row.certificate);
  for (const row of proven)
    add('Certificate of ' + subjectOf(row) + ', ' + questionOf(row) + ': proves ' + row.proof + '; BLAKE2b of its record:', row.certificate);
  if (!proven.length) add('No certificate was asked for (--certificate FILE).');
  for (const note of data.notes) add(note);
}

// ------------------------------------------------------------------------------------------------------------- chart
const SVG = 'http://www.w3.org/2000/svg';
const CHART = {width: 1000, height: 340, left: 70, right: 15, top: 28, bottom: 45};

function svg(name, attributes, text) {
  const out = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) out.setAttribute(key, value);
  if (text !== undefined) out.textContent = text;
  return out;
}

// Numbers a person would write on an axis, about `count` of them.
function ticks(low, high, count) {
  const rough = (high - low) / count, power = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 5, 10].map(x => x * power).find(x => x >= rough);
  const out = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) out.push(i * step);
  return out;
}

let cursor = null, timeToX = null;

function showChart() {
  document.getElementById('executions').hidden = !data.errors;
  const least = profile => Math.min(...profile.upper.filter(x => x !== null), Infinity);
  const profiles = data.profiles.filter(profile => profile.upper.some(x => x !== null)).sort((x, y) => least(x) - least(y));
  const place = document.getElementById('chart'), legend = document.getElementById('legend');
  if (!profiles.length) {
    place.append(element('p', 'There is no clearance to draw: nothing was measured.'));
    return;
  }
  const shown = profiles.slice(0, MOST_SHOWN);
  const finite = shown.flatMap(profile => profile.upper.filter(x => x !== null));
  const top = Math.max(1e-9, data.delta || 0, Math.max(...finite)) * 1.05;
  const [t0, t1] = data.domain, {width, height, left, right, top: above, bottom} = CHART;
  timeToX = t => left + (width - left - right) * (t - t0) / (t1 - t0);
  const y = d => above + (height - above - bottom) * (1 - Math.min(Math.max(d, 0), top) / top);
  const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': 'clearance over time'});

  // Axes.
  const unit = top < 1 ? ['mm', 1000] : ['m', 1];
  for (const d of ticks(0, top * unit[1], 5)) {
    const at = y(d / unit[1]);
    root.append(svg('line', {x1: left, x2: width - right, y1: at, y2: at, stroke: '#d5dbe1'}),
      svg('text', {x: left - 8, y: at + 4, 'text-anchor': 'end'}, +d.toPrecision(6)));
  }
  for (const t of ticks(t0, t1, 8))
    root.append(svg('text', {x: timeToX(t), y: height - bottom + 18, 'text-anchor': 'middle'}, +t.toPrecision(6)));
  root.append(svg('text', {x: (left + width - right) / 2, y: height - 6, 'text-anchor': 'middle'}, data.unit ? 't [s]' : 't'),
    svg('text', {x: left, y: above - 10}, `clearance [${unit[0]}]`));
  if (data.delta !== null)
    root.append(svg('line', {x1: left, x2: width - right, y1: y(data.delta), y2: y(data.delta), stroke: '#b3202c', 'stroke-dasharray': '6 4'}),
      svg('text', {x: left + 6, y: y(data.delta) - 5}, 'asked: ' + metres(data.delta)));

  // A band for each profile; an interval without anything to measure is left out.
  profiles.forEach((profile, i) => {
    const colour = PALETTE[i % PALETTE.length], on = i < MOST_SHOWN;
    const name = profile.name + (profile.kind === 'self' ? ' to the robot' : '');
    const group = svg('g', {class: 'band', 'data-name': profile.name, fill: colour, stroke: colour, 'stroke-width': 1.6,
      'stroke-dasharray': i < PALETTE.length ? 'none' : '5 3', visibility: on ? 'visible' : 'hidden'});
    for (let k = 0; k < profile.upper.length; ++k) {
      if (profile.upper[k] === null) continue;
      const x0 = timeToX(profile.t[k]), x1 = timeToX(profile.t[k + 1]), y0 = y(profile.upper[k]), y1 = y(profile.lower[k]);
      group.append(svg('rect', {x: x0, y: y0, width: x1 - x0, height: Math.max(0, y1 - y0), 'fill-opacity': 0.3, stroke: 'none'}));
    }
    let path = '';
    for (let k = 0; k < profile.upper.length; ++k) {
      if (profile.upper[k] === null) continue;
      const joined = k > 0 && profile.upper[k - 1] !== null;
      path += `${joined ? 'L' : 'M'}${timeToX(profile.t[k])} ${y(profile.upper[k])}L${timeToX(profile.t[k + 1])} ${y(profile.upper[k])}`;
    }
    group.append(svg('path', {d: path, fill: 'none'}), svg('title', {}, name));
    root.append(group);

    const label = element('label'), box = element('input'), line = element('i');
    box.type = 'checkbox';
    box.checked = on;
    const show = () => {
      group.setAttribute('visibility', box.checked ? 'visible' : 'hidden');
      label.classList.toggle('off', !box.checked);
    };
    box.addEventListener('change', show);
    show();
    line.style.background = i < PALETTE.length ? colour : `repeating-linear-gradient(90deg, ${colour} 0 5px, transparent 5px 8px)`;
    label.append(box, line, name);
    legend.append(label);
  });

  cursor = svg('line', {y1: above, y2: height - bottom, stroke: '#1d2733', 'stroke-dasharray': '2 3'});
  root.append(cursor);
  place.append(root);
  offer('chart-file', () => 'data:image/svg+xml;charset=utf-8,' + encodeURIComponent(chartFile(root)));
}

// A link to a file that is made anew when it is asked for.
function offer(id, address) {
  const link = document.getElementById(id), make = () => link.setAttribute('href', address());
  link.addEventListener('click', make);
  make();
  link.hidden = false;
}

// The chart as it is shown, with its legend, as a file that stands alone.
function chartFile(root) {
  const figure = root.cloneNode(true), {width, height, left} = CHART, each = 230, across = Math.floor((width - left) / each);
  figure.querySelectorAll('[visibility=hidden], [stroke-dasharray="2 3"]').forEach(part => part.remove());
  const bands = [...figure.querySelectorAll('.band')], rows = Math.ceil(bands.length / across);
  bands.forEach((band, i) => {
    const x = left + each * (i % across), at = height + 8 + 20 * Math.floor(i / across);
    figure.append(svg('rect', {x, y: at - 8, width: 22, height: 6, fill: band.getAttribute('fill')}),
      svg('text', {x: x + 28, y: at}, band.querySelector('title').textContent));
  });
  const whole = height + 20 * rows;
  for (const [key, value] of Object.entries({xmlns: SVG, width, height: whole, viewBox: `0 0 ${width} ${whole}`})) figure.setAttribute(key, value);
  figure.prepend(svg('title', {}, document.title), svg('style', {}, 'text { font: 12px sans-serif; fill: #5b6875; }'),
    svg('rect', {width: '100%', height: '100%', fill: '#fff'}));
  return new XMLSerializer().serializeToString(figure);
}

// ---------------------------------------------------------------------------------------------------------- 3-D view
// Red at a touch, amber between, teal with 0.3 m to spare: as the markers of the node.
const STOPS = [[0.78, 0.10, 0.16], [0.96, 0.62, 0.20], [0.35, 0.72, 0.62], [0.10, 0.46, 0.56]];
function clearanceColour(d) {
  const s = 3 * Math.sqrt(Math.min(Math.max(d / 0.3, 0), 1)), i = Math.min(2, Math.floor(s));
  const [r, g, b] = STOPS[i].map((x, k) => x + (s - i) * (STOPS[i + 1][k] - x));
  return new THREE.Color(r, g, b);
}

const times = data.frames ? data.frames.times : [];
const view = {links: [], ghosts: [], marks: null, dots: [], render: () => {}};

// The least lower bound of a link's profiles around t; null where it is not measured.
function clearanceOf(link, t) {
  let least = null;
  for (const profile of data.profiles) {
    if (profile.name !== link) continue;
    let k = profile.t.findIndex(end => end > t) - 1;
    if (k < 0) k = t < profile.t[0] ? 0 : profile.lower.length - 1;
    const d = profile.upper[k] === null ? null : profile.lower[k];
    if (d !== null && (least === null || d < least)) least = d;
  }
  return least;
}

function meshOf(body, material) {
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(body.triangles);
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(body.vertices), 3));
  const faceted = geometry.toNonIndexed();
  faceted.computeVertexNormals();
  return new THREE.Mesh(faceted, material);
}

// Edges where faces meet at more than this: of a board on a floor one sees where it ends.
const CREASE = 30, EDGE = new THREE.LineBasicMaterial({color: '#3b4652', transparent: true, opacity: 0.55});
function withEdges(mesh) {
  mesh.add(new THREE.LineSegments(new THREE.EdgesGeometry(mesh.geometry, CREASE), EDGE));
  return mesh;
}

// A name that always faces the eye.
function nameTag(text, height) {
  const canvas = document.createElement('canvas'), size = 48, pen = canvas.getContext('2d');
  pen.font = `${size}px sans-serif`;
  canvas.width = Math.ceil(pen.measureText(text).width) + 8;
  canvas.height = size + 16;
  pen.font = `${size}px sans-serif`;
  pen.fillStyle = '#1d2733';
  pen.fillText(text, 4, size);
  const tag = new THREE.Sprite(new THREE.SpriteMaterial({map: new THREE.CanvasTexture(canvas), depthTest: false, transparent: true}));
  tag.scale.set(height * canvas.width / canvas.height, height, 1);
  tag.renderOrder = 1;
  return tag;
}

function place(mesh, link, index) {
  const poses = data.frames.poses[link];
  const pose = poses && poses[Math.min(index, poses.length - 1)];
  if (!pose) return;
  mesh.position.set(pose[0], pose[1], pose[2]);
  mesh.quaternion.set(pose[3], pose[4], pose[5], pose[6]).normalize();
}

function makeView() {
  const holder = document.getElementById('view');
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
  } catch (error) {
    document.getElementById('view-note').textContent = 'This browser shows no 3-D view: it has no WebGL.';
    holder.style.height = 'auto';
    return;
  }
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(35, 1, 0.01, 1000);
  scene.background = new THREE.Color('#f4f6f8');
  camera.up.set(0, 0, 1);
  scene.add(new THREE.HemisphereLight('#ffffff', '#a8aeb5', 1.0));
  const lamp = new THREE.DirectionalLight('#ffffff', 0.35);
  lamp.position.set(2, -3, 5);
  scene.add(lamp);

  // What stands.
  const box = new THREE.Box3(), travelled = new THREE.Box3(), standing = new Map(), around = new Map();
  for (const body of data.bodies.filter(body => body.kind === 'object')) {
    if (!standing.has(body.name)) standing.set(body.name, STANDING[standing.size % STANDING.length]);
    const mesh = withEdges(meshOf(body, new THREE.MeshLambertMaterial({color: standing.get(body.name), side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1})));
    mesh.name = body.name;
    scene.add(mesh);
    box.expandByObject(mesh);
    around.set(body.name, (around.get(body.name) || new THREE.Box3()).expandByObject(mesh));
  }
  const list = document.getElementById('objects');
  for (const [name, colour] of [...standing].slice(0, MOST_LISTED)) {
    const item = element('span'), swatch = element('i');
    swatch.style.background = colour;
    item.append(swatch, name);
    list.append(item);
  }
  if (standing.size > MOST_LISTED) list.append(element('span', `and ${standing.size - MOST_LISTED} more`));

  // What moves: at the moment shown, and faintly on its way.
  const ghosts = [0, 0.2, 0.4, 0.6, 0.8, 1].map(share => Math.round(share * (times.length - 1)));
  for (const body of data.bodies.filter(body => body.kind !== 'object')) {
    const plain = body.kind === 'link' ? '#e9e9e4' : '#b8a88f';
    const mesh = meshOf(body, new THREE.MeshLambertMaterial({color: plain, side: THREE.DoubleSide}));
    mesh.name = body.name;
    mesh.userData = {on: body.on, plain};
    scene.add(mesh);
    view.links.push(mesh);
    for (const index of times.length > 1 ? new Set(ghosts) : []) {
      const ghost = new THREE.Mesh(mesh.geometry,
        new THREE.MeshBasicMaterial({color: '#8fa3b8', transparent: true, opacity: 0.06, depthWrite: false}));
      place(ghost, body.on, index);
      ghost.updateMatrixWorld();
      scene.add(ghost);
      travelled.expandByObject(ghost);
    }
    place(mesh, body.on, 0);
    mesh.updateMatrixWorld();
    travelled.expandByObject(mesh);
  }
  data.curves.forEach((curve, i) => {
    const points = [];
    for (let k = 0; k + 2 < curve.points.length; k += 3) points.push(new THREE.Vector3(curve.points[k], curve.points[k + 1], curve.points[k + 2]));
    const colour = PALETTE[i % PALETTE.length];
    scene.add(new THREE.Line(new THREE.BufferGeometry().setFromPoints(points), new THREE.LineBasicMaterial({color: colour})));
    for (const point of points) travelled.expandByPoint(point);
    const ball = new THREE.Mesh(new THREE.SphereBufferGeometry(Math.max(curve.radius, 0.004), 24, 16),
      new THREE.MeshLambertMaterial({color: colour}));
    scene.add(ball);
    view.dots.push({ball, curve, points});
  });

  // The pair that is looked at.
  const marks = new THREE.Group();
  scene.add(marks);
  view.marks = marks;
  view.showPair = pair => {
    while (marks.children.length) marks.remove(marks.children[0]);
    if (!pair || !pair.points) return;
    const [a, b] = pair.points.map(p => new THREE.Vector3(...p));
    const red = new THREE.Color('#c81426'), size = 0.006 * radius;
    for (const p of [a, b]) {
      const dot = new THREE.Mesh(new THREE.SphereBufferGeometry(size, 16, 12), new THREE.MeshBasicMaterial({color: red, depthTest: false}));
      dot.position.copy(p);
      dot.renderOrder = 2;
      marks.add(dot);
    }
    const line = new THREE.Line(new THREE.BufferGeometry().setFromPoints([a, b]), new THREE.LineBasicMaterial({color: red, depthTest: false}));
    line.renderOrder = 2;
    marks.add(line);
  };

  // What moves fills the view: a large floor is shown as far as twice its size reaches.
  if (!travelled.isEmpty()) {
    const reach = travelled.getSize(new THREE.Vector3()).length();
    box.intersect(travelled.clone().expandByScalar(0.5 * reach)).union(travelled);
  }

  // From above and the side on which the robot stands.
  if (box.isEmpty()) box.expandByPoint(new THREE.Vector3()).expandByScalar(1);
  const middle = box.getCenter(new THREE.Vector3()), radius = Math.max(0.1, box.getSize(new THREE.Vector3()).length() / 2);
  if (standing.size <= MOST_NAMED) {
    for (const [name, its] of around) {
      const tag = nameTag(name, 0.06 * radius), seen = its.clone().intersect(box);
      (seen.isEmpty() ? its : seen).getCenter(tag.position);
      tag.position.z = Math.min(its.max.z, box.max.z);
      scene.add(tag);
    }
  }
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  camera.near = radius / 200;
  camera.far = radius * 40;
  const moving = new THREE.Box3();
  for (const mesh of view.links) moving.expandByObject(mesh);
  const side = moving.isEmpty() ? new THREE.Vector3(1, 0, 0) : moving.getCenter(new THREE.Vector3()).sub(middle);
  side.z = 0;
  if (side.length() < 0.05 * radius) side.set(1, 0, 0);
  side.normalize().applyAxisAngle(camera.up, 0.9).add(new THREE.Vector3(0, 0, 0.5)).normalize();
  camera.position.copy(middle).addScaledVector(side, 2.6 * radius);
  controls.target.copy(middle);
  controls.update();
  holder.append(renderer.domElement);

  view.render = () => renderer.render(scene, camera);
  view.picture = () => {
    view.render();
    return renderer.domElement.toDataURL('image/png');
  };
  const resize = () => {
    const width = holder.clientWidth, height = holder.clientHeight;
    renderer.setPixelRatio(window.devicePixelRatio || 1);
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    view.render();
  };
  controls.addEventListener('change', view.render);
  window.addEventListener('resize', resize);
  document.getElementById('view-note').textContent = (data.unit === 's' ?
    'Links have the colour of their clearance: red at a touch, teal with 0.3 m to spare, white where nothing is measured. Grey: the way. ' : '') +
    'Drag to turn, scroll to come nearer. Surfaces are drawn coarser than they are measured.';
  resize();
  offer('view-file', view.picture);

  // Paper has no WebGL: it gets a picture of what was last seen.
  window.addEventListener('beforeprint', () => {
    const picture = element('img');
    picture.src = view.picture();
    renderer.domElement.style.display = 'none';
    holder.append(picture);
  });
  window.addEventListener('afterprint', () => {
    holder.querySelectorAll('img').forEach(picture => picture.remove());
    renderer.domElement.style.display = '';
  });
}

// ------------------------------------------------------------------------------------------------------------ moment
const slider = document.getElementById('slider');
const moments = times.length > 1 ? times : Array.from({length: 201}, (_, i) => data.domain[0] + (data.domain[1] - data.domain[0]) * i / 200);

function showMoment(index) {
  const t = moments[index];
  document.getElementById('moment').textContent = 't = ' + moment(t);
  if (cursor) {
    cursor.setAttribute('x1', timeToX(t));
    cursor.setAttribute('x2', timeToX(t));
  }
  for (const mesh of view.links) {
    place(mesh, mesh.userData.on, times.length > 1 ? index : 0);
    const d = clearanceOf(mesh.name, t);
    mesh.material.color = d === null ? new THREE.Color(mesh.userData.plain) : clearanceColour(d);
  }
  for (const {ball, curve, points} of view.dots) {
    const k = curve.t.findIndex(x => x >= t);
    ball.position.copy(points[k < 0 ? points.length - 1 : k]);
  }
  view.render();
}

// The moment of a pair, and its line.
function choosePair(pair) {
  if (view.showPair) view.showPair(pair);
  if (pair.t === null) return view.render();
  let best = 0;
  moments.forEach((t, i) => { if (Math.abs(t - pair.t) < Math.abs(moments[best] - pair.t)) best = i; });
  slider.value = best;
  showMoment(best);
}

showSummary();
showVerdicts();
showPairs();
showBasis();
showChart();
makeView();
slider.max = moments.length - 1;
slider.addEventListener('input', () => showMoment(+slider.value));
showMoment(0);
const first = document.querySelector('#pairs tr.row');
if (first) first.click();
