// The page of a study. State is one object; every change redraws the chosen cells.
const study = JSON.parse(document.getElementById('study-data').textContent);
const state = { chosen: [], nm: 550, excitation: 400, single: false };

// What is encoded is unpacked once.
for (const cell of study.cells) {
  if (cell.image) cell.image.codes = decode(cell.image.codes, Uint16Array);
  if (cell.measured) {
    const m = cell.measured;
    m.grid = { from: m.bands.from_nm, step: m.bands.step_nm, count: m.bands.count };
    m.matrix = decode(m.matrix, Float32Array);
    if (m.transmitted) m.transmitted = decode(m.transmitted, Float32Array);
  }
}
function radiance(image, pixel, band) {
  const share = image.codes[pixel * image.count + band] / 65535;
  return image.largest * share * share;
}
function grids() {
  return study.cells.flatMap((c) => [c.image, c.measured && c.measured.grid]).filter(Boolean);
}

// The cell that stands at a row and column, and the labels beside them.
function labelsOf(sweeps, index) {
  const labels = [];
  for (const sweep of [...sweeps].reverse()) {
    const value = sweep.values[index % sweep.values.length];
    labels.unshift(sweep.label + ' ' + value.replaceAll(' ', '\u00a0')); // a unit stays beside it
    index = Math.floor(index / sweep.values.length);
  }
  return labels.join(', ');
}
function cellButton(cell) {
  const button = make('button', { type: 'button', title: cell.name });
  button.dataset.cell = cell.index;
  button.setAttribute('aria-pressed', 'false');
  if (cell.error) button.classList.add('failed');
  button.append(cell.error ? 'failed'
    : cell.image ? make('img', { src: cell.image.picture, alt: cell.name }) : '#' + cell.index);
  button.onclick = () => {
    const at = state.chosen.indexOf(cell.index);
    if (at >= 0) state.chosen.splice(at, 1); else state.chosen.push(cell.index);
    choose();
  };
  return button;
}
function buildSheet() {
  const down = study.sweeps.slice(0, study.rowSweeps), across = study.sweeps.slice(study.rowSweeps);
  const head = make('tr', {}, make('th'));
  for (let c = 0; c < study.columns; ++c)
    head.append(make('th', { textContent: labelsOf(across, c) }));
  const table = make('table', {}, head);
  for (let first = 0; first < study.cells.length; first += study.columns) {
    const row = make('tr', {}, make('th', { textContent: labelsOf(down, first / study.columns) }));
    for (const cell of study.cells.slice(first, first + study.columns))
      row.append(make('td', {}, cellButton(cell)));
    table.append(row);
  }
  document.getElementById('sheet').append(table);
}

function slider(label, key) {
  const all = grids();
  const low = Math.min(...all.map((g) => g.from));
  const high = Math.max(...all.map((g) => g.from + (g.count - 1) * g.step));
  const step = Math.min(...all.map((g) => g.step));
  state[key] = clamp(state[key], low, high);
  const input = make('input', { type: 'range', min: low, max: high, step, value: state[key] });
  input.id = key;
  const shown = make('output', {});
  input.oninput = () => { state[key] = Number(input.value); redraw(); };
  input.show = () => { input.value = state[key]; shown.textContent = ' ' + state[key] + ' nm'; };
  document.getElementById('controls').append(make('label', {}, label + ' ', input, shown));
}
function buildControls() {
  if (grids().length === 0) return;
  slider('Wavelength', 'nm');
  if (study.cells.some((c) => c.measured)) slider('Excitation', 'excitation');
  if (study.cells.some((c) => c.image)) {
    const box = make('input', { type: 'checkbox', id: 'single' });
    box.onchange = () => { state.single = box.checked; redraw(); };
    document.getElementById('controls').append(make('label', {}, box, ' one wavelength alone'));
  }
}

// A line chart of series over nm, read under the pointer. Dragging moves `key`.
function chart(panel, caption, key, series) {
  const canvas = make('canvas', { width: 800, height: 300 }), value = make('div', { className: 'value' });
  panel.append(make('div', { className: 'caption', textContent: caption }), canvas, value);
  let pointer = null;
  canvas.onpointermove = canvas.onpointerdown = (event) => {
    const s = series(), grid = s[0];
    pointer = chartNm(canvas, s, event);
    if (event.buttons & 1) {
      state[key] = grid.from + Math.round((pointer - grid.from) / grid.step) * grid.step;
      redraw();
    } else draw();
  };
  canvas.onpointerleave = () => { pointer = null; draw(); };
  function draw() {
    const s = series(), nm = pointer === null ? state[key] : pointer;
    drawChart(canvas, s, state[key]);
    value.textContent = s.map((one) => {
      const i = clamp(Math.round((nm - one.from) / one.step), 0, one.values.length - 1);
      return one.label + ' ' + number(one.values[i]) + ' at ' + (one.from + i * one.step) + ' nm';
    }).join('; ');
  }
  return draw;
}

function imagePart(panel, image) {
  const canvas = make('canvas', { width: image.width, height: image.height, className: 'image' });
  const value = make('div', { className: 'value' });
  panel.append(canvas, value);
  const picture = make('img', { src: image.picture });
  picture.onload = () => redraw();
  let pixel = Math.floor(image.height / 2) * image.width + Math.floor(image.width / 2);
  const spectrum = chart(panel, 'Radiance at the pixel, W m^-2 sr^-1 per nm', 'nm', () => [{ label: 'radiance',
    from: image.from, step: image.step,
    values: Array.from({ length: image.count }, (_, b) => radiance(image, pixel, b)) }]);
  canvas.onpointermove = canvas.onpointerdown = (event) => {
    const box = canvas.getBoundingClientRect();
    const x = clamp(Math.floor((event.clientX - box.left) / box.width * image.width), 0, image.width - 1);
    const y = clamp(Math.floor((event.clientY - box.top) / box.height * image.height), 0, image.height - 1);
    pixel = y * image.width + x;
    draw(); spectrum();
  };
  function draw() {
    const g = canvas.getContext('2d'), band = bandAt(image, state.nm);
    if (!state.single && picture.complete) {
      g.drawImage(picture, 0, 0, image.width, image.height);
    } else {
      // One scale for all chosen cells, so that they can be compared.
      let top = 1e-30;
      for (const index of state.chosen) {
        const other = study.cells[index].image;
        if (!other) continue;
        const b = bandAt(other, state.nm);
        for (let p = 0; p < other.width * other.height; ++p) top = Math.max(top, radiance(other, p, b));
      }
      const data = g.createImageData(image.width, image.height);
      for (let p = 0; p < image.width * image.height; ++p) {
        const grey = 255 * Math.pow(radiance(image, p, band) / top, 1 / 2.2);
        data.data.set([grey, grey, grey, 255], 4 * p);
      }
      g.putImageData(data, 0, 0);
    }
    value.textContent = 'pixel ' + (pixel % image.width) * image.block + ', ' +
      Math.floor(pixel / image.width) * image.block + ': ' + number(radiance(image, pixel, band)) +
      ' at ' + (image.from + band * image.step) + ' nm';
  }
  return [draw, spectrum];
}

function matrixPart(panel, m, entries, where) {
  const n = m.grid.count, nm = (band) => m.grid.from + band * m.grid.step;
  const canvas = make('canvas', { width: n, height: n, className: 'image' });
  const value = make('div', { className: 'value' });
  panel.append(make('div', { className: 'caption',
    textContent: 'Re-radiation' + where + ', hemispherical, per band, square root: excitation across, emission upwards' }),
    canvas, value);
  const entry = (o, i) => entries[i * n + o]; // column after column
  const top = Math.max(1e-30, ...Array.from(entries));
  const emission = chart(panel, 'Emission at the excitation' + where, 'nm', () => {
    const i = bandAt(m.grid, state.excitation);
    return [{ label: 'excited at ' + nm(i) + ' nm:', from: m.grid.from, step: m.grid.step,
      values: Array.from({ length: n }, (_, o) => o === i ? null : entry(o, i)) }];
  });
  let at = null;
  canvas.onpointermove = canvas.onpointerdown = (event) => {
    const box = canvas.getBoundingClientRect();
    at = { i: clamp(Math.floor((event.clientX - box.left) / box.width * n), 0, n - 1),
      o: clamp(n - 1 - Math.floor((event.clientY - box.top) / box.height * n), 0, n - 1) };
    if (event.buttons & 1) { state.excitation = nm(at.i); state.nm = nm(at.o); redraw(); }
    else draw();
  };
  function draw() {
    const g = canvas.getContext('2d'), data = g.createImageData(n, n);
    const marked = bandAt(m.grid, state.excitation);
    for (let o = 0; o < n; ++o)
      for (let i = 0; i < n; ++i) {
        const share = Math.sqrt(Math.max(0, entry(o, i)) / top);
        const hex = parseInt(study.colours[Math.min(255, Math.floor(256 * share))].slice(1), 16);
        const lift = i === marked ? 60 : 0;
        data.data.set([(hex >> 16) + lift, (hex >> 8 & 255) + lift, (hex & 255) + lift, 255],
          4 * ((n - 1 - o) * n + i));
      }
    g.putImageData(data, 0, 0);
    const p = at || { i: marked, o: bandAt(m.grid, state.nm) };
    value.textContent = nm(p.i) + ' nm to ' + nm(p.o) + ' nm: ' + number(entry(p.o, p.i));
  }
  return [draw, emission];
}

function colourTable(panel, colours_) {
  const table = make('table', {}, make('tr', {},
    ...['light', 'in/out/phi, deg', 'X', 'Y', 'Z', 'L*', 'a*', 'b*', 'photons out / absorbed',
      'Y of all reflected', 'transmitted', 'guided'].map((t) => make('th', { textContent: t }))));
  for (const c of colours_)
    table.append(make('tr', {}, ...[c.illuminant, c.theta_i_deg + '/' + c.theta_o_deg + '/' + c.phi_deg,
      ...c.XYZ.map(number), ...c.Lab.map(number), ...[c.quantum_yield, c.reflected, c.transmitted, c.guided]
        .map(number)].map((t) => make('td', { textContent: t }))));
  panel.append(table);
}
function measuredPart(panel, m) {
  colourTable(panel, m.colours);
  const total = chart(panel, 'Total radiance factor', 'nm', () => m.colours.map((c) => ({
    label: c.illuminant + ' ' + c.theta_i_deg + '/' + c.theta_o_deg, from: m.grid.from,
    step: m.grid.step, values: c.beta_T })));
  const draws = [total, ...matrixPart(panel, m, m.matrix, m.transmitted ? ', sent back' : '')];
  if (m.transmitted) draws.push(...matrixPart(panel, m, m.transmitted, ', sent through'));
  for (const svg of m.polar) { const box = make('div', {}); box.innerHTML = svg; panel.append(box); }
  return draws;
}

let draws = [];
function redraw() {
  for (const key of ['nm', 'excitation']) { const s = document.getElementById(key); if (s) s.show(); }
  for (const draw of draws) draw();
}
function choose() {
  for (const button of document.querySelectorAll('#sheet button')) {
    const chosen = state.chosen.includes(Number(button.dataset.cell));
    button.classList.toggle('chosen', chosen);
    button.setAttribute('aria-pressed', String(chosen));
  }
  const panels = document.getElementById('panels');
  panels.replaceChildren();
  draws = [];
  for (const index of state.chosen) {
    const cell = study.cells[index];
    const panel = make('div', { className: 'panel' }, make('h2', { textContent: cell.name }));
    panels.append(panel);
    if (cell.error) panel.append(make('p', { className: 'error', textContent: cell.error }));
    if (cell.image) draws.push(...imagePart(panel, cell.image));
    if (cell.measured) draws.push(...measuredPart(panel, cell.measured));
  }
  redraw();
}
buildSheet();
buildControls();
state.chosen = study.cells.filter((c) => !c.error).slice(0, 1).map((c) => c.index);
choose();
