// The picture as its lights are set, what is read off it, and the controls.
// Linear sRGB of a layer: for each basis spectrum three numbers, then sums over them by pixel.
function showLayer(layer) {
  const factors = bandFactors(layer),
    shown = new Float32Array(3 * PIXELS);
  for (const { first, bands, rank, basis, lengths, directions } of layer.codes) {
    const columns = Array.from({ length: rank }, (_, k) => {
      const spectrum = new Float64Array(BANDS);
      for (let b = 0; b < bands; ++b) spectrum[first + b] = basis[k * bands + b] * factors[first + b];
      return linearSrgb(xyzOf(spectrum, film.weights));
    });
    for (let p = 0; p < PIXELS; ++p) {
      if (lengths[p] === 0) continue;
      let r = 0,
        g = 0,
        b = 0;
      for (let k = 0; k < rank; ++k) {
        const d = directions[k][p],
          column = columns[k];
        r += d * column[0];
        g += d * column[1];
        b += d * column[2];
      }
      shown[3 * p] += lengths[p] * r;
      shown[3 * p + 1] += lengths[p] * g;
      shown[3 * p + 2] += lengths[p] * b;
    }
  }
  layer.shown = shown;
}
// 8 bit codes of linear values in steps of 1 / 16384, rounded as develop rounds them.
const CODES = Uint8Array.from({ length: 16385 }, (_, i) => {
  const v = i / 16384;
  return Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * Math.pow(v, 1 / 2.4) - 0.055));
});
const codeOf = (value) => CODES[value <= 0 ? 0 : value >= 1 ? 16384 : (value * 16384 + 0.5) | 0];
const canvas = place('picture');
canvas.width = data.width;
canvas.height = data.height;
const pen = canvas.getContext('2d');
const frame = pen.createImageData(data.width, data.height);
function drawPicture() {
  for (const layer of layers) if (!layer.shown) showLayer(layer);
  const exposure = Math.pow(2, view.exposure),
    lit = layers.filter((layer) => layer.gain > 0),
    gains = lit.map((layer) => layer.gain * exposure),
    pixels = frame.data;
  for (let p = 0, i = 0, at = 0; p < PIXELS; ++p, at += 4)
    for (let c = 0; c < 3; ++c, ++i) {
      let sum = 0;
      for (let k = 0; k < lit.length; ++k) sum += gains[k] * lit[k].shown[i];
      pixels[at + c] = codeOf(sum);
    }
  for (let at = 3; at < pixels.length; at += 4) pixels[at] = 255;
  pen.putImageData(frame, 0, 0);
}

// Radiance, X, Y, Z, and L*, a*, b* against the white of the screen: D65 at the luminance that is shown as white.
function readingAt(x, y) {
  const parts = layers.map((layer) => layerSpectrum(layer, y * data.width + x)),
    radiance = Float64Array.from({ length: BANDS }, (_, b) => parts.reduce((sum, part) => sum + part[b], 0)),
    xyz = xyzOf(radiance, film.weights),
    exposure = Math.pow(2, view.exposure);
  const exposed = linearSrgb(xyz.map((value) => value * exposure));
  return {
    parts,
    radiance,
    xyz,
    lab: labOf(
      xyz.map((value) => value * exposure),
      [0.95047, 1, 1.08883],
    ),
    rgb: encodedSrgb(exposed),
    isClipped: exposed.some((value) => value > 1 || value < 0),
  };
}
const three = (values, digits) => values.map((value) => value.toFixed(digits)).join(', ');
function showReading() {
  const found = readingAt(view.x, view.y),
    series = [{ label: 'all', values: found.radiance }, ...layers.map((layer, k) => ({ label: layer.name, values: found.parts[k] }))];
  place('cross').style.left = (100 * (view.x + 0.5)) / data.width + '%';
  place('cross').style.top = (100 * (view.y + 0.5)) / data.height + '%';
  drawChart(
    place('chart'),
    series.map((one) => ({ ...one, from: data.bands.from, step: data.bands.step, values: Array.from(one.values) })),
    null,
  );
  place('legend').replaceChildren(
    ...series.map((one, k) => {
      const text = make('span', { textContent: one.label });
      text.style.color = seriesColours[k % seriesColours.length];
      return text;
    }),
  );
  const rows = [
    ['Pixel', view.x * data.block + ', ' + view.y * data.block],
    ['X, Y, Z', three(found.xyz, 4)],
    ['L*, a*, b*', three(found.lab, 2)],
    ['Shown as sRGB', three(found.rgb.map((value) => 255 * value), 0) + (found.isClipped ? ' (clipped)' : '')],
  ];
  place('reading').replaceChildren(
    ...rows.map(([key, text]) => make('tr', {}, make('th', { textContent: key }), make('td', { textContent: text }))),
  );
}
// The command that develops the picture as it is shown, as far as commands can.
function showCommand() {
  const factors = layers.filter((layer) => layer.gain !== 1).map((layer) => layer.name + '=' + layer.gain);
  const others = layers.filter((layer) => layer.lamp >= 0);
  place('command').textContent =
    'reradiant develop ' + data.name + ' -o picture.png' +
    (factors.length ? ' --groups ' + factors.join(',') : '') +
    (view.exposure ? ' --exposure ' + view.exposure : '') +
    (others.length ? '\n# with the lamps of the render: others are put in on this page alone' : '');
}
let isAsked = false;
function redraw() {
  if (isAsked) return;
  isAsked = true;
  requestAnimationFrame(() => {
    isAsked = false;
    drawNow();
  });
}
function drawNow() {
  drawPicture();
  showReading();
  showCommand();
}

// Sliders go from 0 over 1 in their middle to 64, finer where there is less light.
const gainAt = (place) => Number((place <= 0 ? 0 : place <= 1 ? place : Math.pow(64, place - 1)).toPrecision(3));
function gainSlider(layer, k) {
  const name = { whole: 'Light', uv: 'Its ultraviolet', visible: 'Its visible light' }[layer.part];
  const set = (value) => {
    layer.gain = gainAt(value);
    redraw();
  };
  return slid('gain-' + k, name, [0, 2, 0.01], 1, set, (value) => times(gainAt(value)));
}
function takeLamp(group, index) {
  for (const layer of layers)
    if (layer.group === group) Object.assign(layer, { lamp: index, shown: null });
  const changed = layers.filter((layer) => layer.group === group && index >= 0),
    unknown = changed.length ? shareUnknown(changed[0]) : 0;
  said(
    unknown > 0.001
      ? Math.max(1, Math.round(100 * unknown)) + ' % of the light of ' + lamps[index].name + ' falls in bands where ' + group +
          ' is dark in this render: it is missing.'
      : '',
  );
  redraw();
}
function groupField(group) {
  const own = layers.filter((layer) => layer.group === group);
  const rows = own.map((layer) => gainSlider(layer, layers.indexOf(layer)));
  const choices = [['-1', 'as rendered'], ...lamps.map((lamp, k) => [String(k), lamp.name])];
  if (own[0].own) {
    const select = picked('lamp-' + group, 'Lamp', choices, '-1', (value) => takeLamp(group, Number(value)));
    rows.push(select);
  } else if (data.layers.length > 1 || group !== 'picture')
    rows.push(make('p', { className: 'caption', textContent: 'Its lights differ in their spectra, so that no other lamp stands for them.' }));
  return make('fieldset', {}, make('legend', { textContent: group }), ...rows);
}
function buildControls() {
  const pasted = make('textarea', { id: 'lamp-text', rows: 4, placeholder: '380, 0.1\n390, 0.4\n...' });
  place('picture-controls').replaceChildren(
    slid('exposure', 'Exposure', [-8, 8, 0.1], view.exposure, (value) => {
      view.exposure = value;
      redraw();
    }, (v) => (v > 0 ? '+' : '') + v + ' EV'),
    fold('own-lamp', 'A lamp of my own',
      make('label', {}, make('span', { textContent: 'Wavelength in nm and value, a pair a line' }), pasted),
      make('div', { className: 'buttons' },
        make('button', { type: 'button', id: 'take-lamp', textContent: 'Add it to the lists',
          onclick: () => attempt(() => addLamp(pasted.value, 'my lamp')) })),
      fileRow('lamp-file', 'or a file (SPD, CSV)', '.spd,.csv,.txt', (file) =>
        attempt(async () => addLamp(await file.text(), file.name)))),
  );
  place('groups').replaceChildren(...[...new Set(layers.map((layer) => layer.group))].map(groupField));
}
function addLamp(text, name) {
  lamps.push(lampFromText(text, name));
  for (const select of document.querySelectorAll('#groups select'))
    select.append(make('option', { value: String(lamps.length - 1), textContent: name }));
  said(name + ' is in the lists of lamps');
}
function tell() {
  const codes = layers.flatMap((layer) => layer.codes),
    percent = (value) => Number((100 * value).toPrecision(2)) + ' %';
  const texts = [
    'Spectra of each light are held to ' + percent(Math.max(...codes.map((code) => code.rms))) +
      ' (root mean square over pixels; at worst ' + percent(Math.max(...codes.map((code) => code.worst))) +
      ') of their length, below and above 400 nm by themselves.',
  ];
  if (data.block > 1) texts.push('The page shows means of ' + data.block + ' x ' + data.block + ' pixels of the file.');
  if (layers.some((layer) => layer.own))
    texts.push(
      'Another lamp has the luminance of the one that it stands for (a lamp that the eye hardly sees: its power). ' +
        'Where nothing fluoresces it is exact, band by band.',
    );
  if (layers.some((layer) => layer.part !== 'whole'))
    texts.push(
      'Of what fluoresces, the part that ultraviolet light excites follows the new lamp\u2019s power below 400 nm, as if ' +
        'its spectrum there had the shape of the old one. What visible light excites cannot be told from what is reflected ' +
        'and is taken as reflected. Sliders are exact.',
    );
  place('told').replaceChildren(...texts.map((textContent) => make('p', { textContent })));
}

function readTo(x, y) {
  view.x = clamp(Math.floor(x), 0, data.width - 1);
  view.y = clamp(Math.floor(y), 0, data.height - 1);
  showReading();
}
canvas.onpointermove = canvas.onpointerdown = (event) => {
  const box = canvas.getBoundingClientRect();
  readTo(((event.clientX - box.left) / box.width) * data.width, ((event.clientY - box.top) / box.height) * data.height);
};
canvas.onkeydown = (event) => {
  const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] },
    way = ways[event.key],
    step = event.shiftKey ? 8 : 1;
  if (!way) return;
  event.preventDefault();
  readTo(view.x + step * way[0], view.y + step * way[1]);
};
canvas.setAttribute('aria-label', 'Picture of ' + data.name);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
said('unpacking');
window.ready = attempt(async () => {
  await unpackLayers();
  buildControls();
  tell();
  drawNow();
  said('');
});
