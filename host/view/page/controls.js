// What the reader sets.
function materialSliders() {
  const material = materialNow(),
    set = (key) => (value) => {
      view.sliders[key] = value;
      changed();
    };
  const rows = [],
    sliders = view.sliders;
  if (isRoughnessFree(material))
    rows.push(
      slid('alpha', 'Roughness', [0, 0.6, 0.005], sliders.alpha, set('alpha'), (v) => 'alpha ' + Number(v).toFixed(3)),
    );
  if (canDeepen(material))
    rows.push(
      slid('thickness', 'Thickness', [0, 4, 0.05], 1, set('thickness'), times),
      slid('absorption', 'Absorption', [0, 4, 0.05], 1, set('absorption'), times),
    );
  if (hasDye(material))
    rows.push(slid('dye', 'Dye (re-radiation)', [0, 1, 0.01], 1, set('dye'), (v) => Math.round(100 * v) + ' %'));
  if (rows.length === 0)
    rows.push(
      make('p', {
        className: 'caption',
        textContent: viewData.gallery
          ? 'Pages of one material (view --preset ' + material.name + ') have sliders.'
          : 'Nothing of this material slides here.',
      }),
    );
  return rows;
}
function modelNames(material) {
  const names = material.models.map((model) => [model, model]);
  return material.models.length > 1 ? [...names, ['both', 'side by side']] : names;
}
function buildMaterialControls() {
  const material = materialNow();
  place('material-controls').replaceChildren(
    ...(materials.length > 1
      ? [
          picked(
            'material',
            'Material',
            materials.map((one, k) => [String(k), one.name]),
            String(view.material),
            chooseMaterial,
          ),
        ]
      : []),
    picked('model', 'Model', modelNames(material), view.model, (value) => {
      view.model = view.asked = value;
      showDivider();
      changed();
    }),
    make(
      'div',
      { id: 'divider-row' },
      slid(
        'divider',
        'Divider',
        [0, 1, 0.01],
        view.divider,
        (value) => {
          view.divider = value;
          redraw();
        },
        (v) => Math.round(100 * v) + ' %',
      ),
    ),
    ...materialSliders(),
    make(
      'div',
      { className: 'buttons' },
      ...(material.dyed
        ? []
        : [make('button', { type: 'button', id: 'copy-toml', textContent: 'Copy as TOML', onclick: copyToml })]),
      ...(hasDye(material)
        ? [make('button', { type: 'button', id: 'save-matrix', textContent: 'Save its matrix', onclick: saveMatrix })]
        : []),
      make('button', {
        type: 'button',
        id: 'reset',
        textContent: 'Reset',
        onclick: () => chooseMaterial(view.material),
      }),
    ),
    ...(material.dyed ? [] : [fold('toml-text', 'The file as text', make('pre', { id: 'toml' }))]),
  );
  place('notes').replaceChildren(...material.notes.map((text) => make('p', { className: 'note', textContent: text })));
  showDivider();
}
function showDivider() {
  place('divider-row').hidden = view.model !== 'both';
}
function buildLightControls() {
  const pasted = make('textarea', { id: 'lamp-text', rows: 4, placeholder: '380, 0.1\n390, 0.4\n...' });
  place('light-controls').replaceChildren(
    picked(
      'lamp',
      'Lamp',
      lamps.map((lamp, k) => [String(k), lamp.name]),
      String(view.lamp),
      (value) => {
        view.lamp = Number(value);
        changed();
      },
    ),
    slid(
      'uv',
      'Ultraviolet, below 400 nm',
      [0, 3, 0.05],
      view.uv,
      (value) => {
        view.uv = value;
        changed();
      },
      times,
    ),
    slid(
      'radius',
      "Lamp's radius",
      [0, 20, 0.5],
      view.lampRadius,
      (value) => {
        view.lampRadius = value;
        redraw();
      },
      (v) => Number(v).toFixed(1) + '°',
    ),
    slid(
      'around',
      'Light from all around',
      [0, 1, 0.05],
      view.around,
      (value) => {
        view.around = value;
        changed();
      },
      (v) => Math.round(100 * v) + ' %',
    ),
    slid(
      'exposure',
      'Exposure',
      [-4, 4, 0.25],
      view.exposure,
      (value) => {
        view.exposure = value;
        changed();
      },
      (v) => (v > 0 ? '+' : '') + v + ' EV',
    ),
    fold(
      'own-lamp',
      'A lamp of my own',
      make('label', {}, make('span', { textContent: 'Wavelength in nm and value, a pair a line' }), pasted),
      make(
        'div',
        { className: 'buttons' },
        make('button', {
          type: 'button',
          id: 'take-lamp',
          textContent: 'Take it',
          onclick: () => attempt(() => addLamp(pasted.value, 'my lamp')),
        }),
      ),
      fileRow('lamp-file', 'or a file (SPD, CSV)', '.spd,.csv,.txt', (file) =>
        attempt(async () => addLamp(await file.text(), file.name)),
      ),
    ),
  );
}
function buildShapeControls() {
  place('shape-controls').replaceChildren(
    picked('shape', 'Shape', Object.entries(SHAPES), view.shape, chooseShape),
    picked(
      'drag',
      'Dragging turns',
      [
        ['lamp', 'the lamp'],
        ['object', 'the object'],
      ],
      view.drag,
      (value) => {
        view.drag = value;
      },
    ),
    fileRow('mesh-file', 'My own shape (OBJ, PLY)', '.obj,.ply', (file) =>
      attempt(async () => takeMesh(await file.text(), file.name)),
    ),
  );
}
function addLamp(text, name) {
  lamps.push(lampFromText(text, name));
  view.lamp = lamps.length - 1;
  buildLightControls();
  said(name + ' is lit');
  changed();
}
function takeMesh(text, name) {
  mesh = meshFromText(text, name);
  said(name + ': ' + mesh.positions.length / 9 + ' triangles');
  chooseShape('mesh');
}
function chooseShape(shape) {
  if (shape === 'mesh' && !mesh) {
    place('shape').value = view.shape;
    return said('Choose an OBJ or PLY file below, or drop one on the page.');
  }
  Object.assign(view, { shape, drag: shape === 'sphere' ? 'lamp' : 'object', turnAcross: 0, turnUp: 0 });
  buildShapeControls();
  redraw();
}
function chooseMaterial(index) {
  view.material = Number(index);
  const { models } = materialNow();
  view.model = models.includes(view.asked) || (view.asked === 'both' && models.length > 1) ? view.asked : models[0];
  resetSliders();
  buildMaterialControls();
  for (const button of document.querySelectorAll('#gallery button'))
    button.setAttribute('aria-pressed', String(button.dataset.material === String(view.material)));
  changed();
}
function copyToml() {
  const text = materialToml(materialNow(), view.sliders),
    by = navigator.clipboard && navigator.clipboard.writeText(text);
  place('toml-text').open = true;
  if (!by) return said('Mark the text below and copy it.');
  by.then(
    () => said('Copied.'),
    () => said('Mark the text below and copy it.'),
  );
}
function saveMatrix() {
  const link = make('a', {
    download: matrixFileName(materialNow()),
    href: URL.createObjectURL(new Blob([matrixCsv(materialNow(), view.sliders)], { type: 'text/csv' })),
  });
  link.click();
}
