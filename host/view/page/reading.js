// What the page shows now, and what a pixel reads.
const viewData = JSON.parse(document.getElementById('view-data').textContent);
const materials = unpacked,
  shaderParts = viewData.shaders;
const lamps = viewData.lamps.map((lamp) => ({ name: lamp.name, values: decodeFloats(lamp.values) }));
const SIZE = 512; // pixels of the picture's side
const view = {
  material: 0,
  model: '',
  asked: '',
  lamp: 0,
  shape: 'sphere',
  lampAcross: -35,
  lampUp: 35,
  lampRadius: 4,
  turnAcross: 0,
  turnUp: 0,
  drag: 'lamp',
  uv: 1,
  around: 0.15,
  exposure: 0,
  divider: 0.5,
  x: 240.5,
  y: 260.5,
  sliders: {},
};
let mesh = null;

function materialNow() {
  const material = materials[view.material];
  if (!material.weights.byteLength) unpackMaterial(material);
  return material;
}
const isRoughnessFree = (material) => material.models.every((model) => material[model].alphas.length > 1);
const ownAlpha = (material) => (material.layers[0] || material.substrate).alpha || 0;
const hasDye = (material) => Boolean(material.substrate.reradiation) && !material.dyed;
// Thickness and absorption slide where every model on the page can follow them.
const canDeepen = (material) =>
  material.models.every((model) => material[model].absorbs && (model !== 'adding' || material[model].nodes.length > 1));
function resetSliders() {
  view.sliders = { alpha: ownAlpha(materialNow()), thickness: 1, absorption: 1, dye: 1 };
}
function stateOf(model) {
  return model === 'adding'
    ? addingState(materialNow(), view.sliders)
    : weidlichWilkieState(materialNow(), view.sliders);
}
// Irradiance on a surface that faces the lamp, by band; Y of the whole lamp is 1.
function lampNow() {
  const material = materialNow(),
    values = lampOnBands(lamps[view.lamp], material.bands),
    level = lampLevel(values, material);
  return values.map(
    (value, b) => (value / level) * (material.bands.from + b * material.bands.step < 400 ? view.uv : 1),
  );
}
const aroundNow = () => lampNow().map((value) => (view.around * value) / Math.PI);
const exposureNow = () => 0.8 * Math.PI * Math.pow(2, view.exposure);
// Weights of the bands in linear sRGB, exposed.
function screenRows() {
  const { weights, bands } = materialNow(),
    exposure = exposureNow();
  return XYZ_TO_SRGB.map((row) =>
    Array.from(
      { length: bands.count },
      (_, b) => exposure * (row[0] * weights[3 * b] + row[1] * weights[3 * b + 1] + row[2] * weights[3 * b + 2]),
    ),
  );
}
const modelsShown = () => (view.model === 'both' ? materialNow().models : [view.model]);
const modelAt = (x) => (view.model === 'both' ? materialNow().models[x < view.divider * SIZE ? 0 : 1] : view.model);

// Radiance by band of a pixel (centres at halves, from the top left) by a state; null beside the object.
function radianceAt(state, x, y) {
  const directions = directionsAt(view, mesh, x, y, SIZE, SIZE),
    bands = materialNow().bands.count;
  if (!directions) return null;
  const { wi, wo } = directions,
    lamp = lampNow(),
    around = aroundNow(),
    lampSine = Math.sin(radians(view.lampRadius));
  const isAdding = state.model === 'adding',
    isLit = wi[2] > 0;
  const lit = isLit
    ? (isAdding ? addingRadiance : weidlichWilkieRadiance)(state, wi, wo, lamp, lampSine)
    : lamp.map(() => 0);
  const disc = isLit ? discShare(wi, wo, lampSine) / (Math.PI * Math.max(lampSine * lampSine, 1e-12)) : 0;
  const mirror = disc > 0 ? (isAdding ? addingMirror(state, wi[2]) : weidlichWilkieMirror(state, wi[2], bands)) : null;
  const rest = view.around > 0 ? (isAdding ? addingAround : weidlichWilkieAround)(state, wo[2], around) : null;
  return {
    wi,
    wo,
    lamp,
    radiance: lit.map((value, b) => value + (mirror ? disc * lamp[b] * mirror[b] : 0) + (rest ? rest[b] : 0)),
  };
}
// The eye hardly sees an ultraviolet lamp: nothing is compared with a white that it lights.
const isFaint = (white) => white[1] < 0.1 || Math.min(...white) <= 0;
const isFaintLamp = () => isFaint(xyzOf(lampNow(), materialNow().weights));
// A reading: radiance, and X, Y, Z and L*, a*, b* against a perfect white that lies there and is lit by the lamp.
function readingAt(state, x, y) {
  const found = radianceAt(state, x, y);
  if (!found) return null;
  const { weights } = materialNow(),
    seen = xyzOf(found.radiance, weights),
    white = xyzOf(found.lamp, weights);
  const level = (white[1] * Math.max(found.wi[2], 0)) / Math.PI,
    isWhite = level > 1e-9 && !isFaint(white);
  const angle = (w) => (Math.acos(clamp(w[2], -1, 1)) * 180) / Math.PI;
  const exposed = linearSrgb(seen.map((value) => value * exposureNow()));
  return {
    ...found,
    thetaI: angle(found.wi),
    thetaO: angle(found.wo),
    rgb: encodedSrgb(exposed),
    isClipped: exposed.some((value) => value > 1 || value < 0),
    xyz: isWhite ? seen.map((value) => (100 * value) / level) : null,
    lab: isWhite
      ? labOf(
          seen.map((value) => value / level),
          white.map((value) => value / white[1]),
        )
      : null,
  };
}
