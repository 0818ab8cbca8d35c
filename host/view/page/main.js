// The page: picture, readings, dragging and keys.
const canvas = place('picture');
const gl = canvas.getContext('webgl2', { antialias: false, preserveDrawingBuffer: true });
let pictures = [],
  states = {},
  isStale = true,
  arePicturesStale = true,
  isAsked = false;

// A change of material or light makes tables anew; one of the view only draws.
function changed() {
  isStale = true;
  redraw();
}
function redraw() {
  if (isAsked) return;
  isAsked = true;
  requestAnimationFrame(() => {
    isAsked = false;
    attempt(drawNow);
  });
}
function refresh() {
  if (!isStale) return;
  isStale = false;
  states = {};
  for (const model of modelsShown()) states[model] = stateOf(model);
  arePicturesStale = true;
  if (place('toml')) place('toml').textContent = materialToml(materialNow(), view.sliders);
}
function drawPictures() {
  if (!gl || gl.isContextLost()) return;
  const shown = modelsShown(),
    middle = shown.length > 1 ? Math.round(view.divider * SIZE) : SIZE;
  if (arePicturesStale)
    shown.forEach((model, k) => {
      pictures[k] = pictures[k] || new Picture(gl);
      pictures[k].prepare(states[model], lampNow(), aroundNow(), screenRows());
    });
  arePicturesStale = false;
  pictures[0].draw(view, mesh, SIZE, 0, middle);
  if (middle < SIZE) pictures[1].draw(view, mesh, SIZE, middle, SIZE);
}
// Values are written where the graphics card fails, too.
function drawNow() {
  refresh();
  place('divider-line').hidden = view.model !== 'both';
  place('divider-line').style.left = 100 * view.divider + '%';
  place('left-model').textContent = view.model === 'both' ? materialNow().models[0] : '';
  place('right-model').textContent = view.model === 'both' ? materialNow().models[1] : '';
  showReading();
  drawPictures();
}

const three = (values, digits) => values.map((value) => value.toFixed(digits)).join(', ');
function showReading() {
  refresh();
  const found = readingAt(states[modelAt(view.x)], view.x, view.y),
    { bands, name } = materialNow();
  place('cross').style.left = (100 * view.x) / SIZE + '%';
  place('cross').style.top = (100 * view.y) / SIZE + '%';
  const spectrum = (label, values) => ({ label, from: bands.from, step: bands.step, values: Array.from(values) });
  const lamp = [spectrum(lamps[view.lamp].name, lampNow())];
  drawChart(place('lamp-chart'), lamp, null);
  place('lamp-value').textContent = lamps[view.lamp].name + ', irradiance per nm' + (isFaintLamp() ? '' : ', Y = 1');
  drawChart(place('chart'), found ? [spectrum('radiance', found.radiance)] : [], null);
  const rows = !found
    ? [['', 'beside the object']]
    : [
        ['Directions', 'lamp ' + found.thetaI.toFixed(1) + '°, eye ' + found.thetaO.toFixed(1) + '° from the normal'],
        [
          'X, Y, Z',
          found.xyz
            ? three(found.xyz, 2)
            : found.wi[2] > 0
              ? 'the eye hardly sees this lamp: no white to compare with'
              : 'the lamp does not reach here',
        ],
        ['L*, a*, b*', found.lab ? three(found.lab, 2) : '-'],
        [
          'Shown as sRGB',
          three(
            found.rgb.map((value) => 255 * value),
            0,
          ) + (found.isClipped ? ' (clipped)' : ''),
        ],
      ];
  place('reading').replaceChildren(
    ...rows.map(([key, text]) => make('tr', {}, make('th', { textContent: key }), make('td', { textContent: text }))),
  );
  canvas.setAttribute(
    'aria-label',
    'Picture of ' + name + ' under ' + lamps[view.lamp].name + ', ' + SHAPES[view.shape],
  );
}

function turn(across, up) {
  if (view.drag === 'lamp') {
    view.lampAcross = clamp(view.lampAcross + across, -180, 180);
    view.lampUp = clamp(view.lampUp + up, -89, 89);
  } else {
    view.turnAcross += across;
    view.turnUp -= up;
  }
  redraw();
}
function readAt(event) {
  const box = canvas.getBoundingClientRect();
  view.x = clamp(Math.floor(((event.clientX - box.left) / box.width) * SIZE), 0, SIZE - 1) + 0.5;
  view.y = clamp(Math.floor(((event.clientY - box.top) / box.height) * SIZE), 0, SIZE - 1) + 0.5;
  showReading();
}
let held = null;
canvas.onpointerdown = (event) => {
  held = event;
  if (canvas.setPointerCapture && event.isTrusted) canvas.setPointerCapture(event.pointerId);
  readAt(event);
};
canvas.onpointerup = canvas.onpointercancel = () => {
  held = null;
};
canvas.onpointermove = (event) => {
  if (!held || !(event.buttons & 1)) return readAt(event);
  const box = canvas.getBoundingClientRect();
  turn(((event.clientX - held.clientX) / box.width) * 180, ((held.clientY - event.clientY) / box.height) * 180);
  held = event;
};
canvas.onkeydown = (event) => {
  const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] },
    way = ways[event.key];
  if (!way) return;
  event.preventDefault();
  if (!event.shiftKey) return turn(5 * way[0], 5 * way[1]);
  view.x = clamp(view.x + 8 * way[0], 0.5, SIZE - 0.5);
  view.y = clamp(view.y - 8 * way[1], 0.5, SIZE - 0.5);
  showReading();
};
document.ondragover = (event) => event.preventDefault();
document.ondrop = (event) => {
  event.preventDefault();
  const file = event.dataTransfer.files[0];
  if (file) attempt(async () => (/\.(obj|ply)$/i.test(file.name) ? takeMesh : addLamp)(await file.text(), file.name));
};

// Tiles of a gallery are pictures of this canvas, each made when the page has time.
function buildGallery() {
  if (!viewData.gallery) return;
  const tiles = materials.map((material, k) => {
    const small = make('canvas', { width: 96, height: 96 });
    small.setAttribute('aria-hidden', 'true');
    const button = make(
      'button',
      { type: 'button', onclick: () => chooseMaterial(k) },
      small,
      make('span', { textContent: material.name }),
    );
    button.dataset.material = k;
    return button;
  });
  place('gallery').append(...tiles);
  if (!gl) return;
  const next = (k) => {
    if (k >= materials.length) return chooseMaterial(0);
    chooseMaterial(k);
    drawNow();
    tiles[k].firstChild.getContext('2d').drawImage(canvas, 0, 0, 96, 96);
    setTimeout(() => next(k + 1));
  };
  next(0);
}
if (!gl) {
  place('no-webgl').hidden = false;
  place('stage').hidden = true;
}
if (gl)
  canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault();
    pictures = [];
    isStale = true;
  });
if (gl) canvas.addEventListener('webglcontextrestored', changed);
addEventListener('resize', redraw);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
buildLightControls();
buildShapeControls();
chooseMaterial(0);
buildGallery();
