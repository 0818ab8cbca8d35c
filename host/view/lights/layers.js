// A picture whose lights are turned up and down: it is the sum of its layers, which are unpacked when the page opens.
const data = JSON.parse(document.getElementById('lights-data').textContent);
const lamps = data.lamps.map((lamp) => ({ name: lamp.name, values: decodeFloats(lamp.values) }));
const film = { bands: data.bands, weights: decodeFloats(data.weights) };
const PIXELS = data.width * data.height,
  BANDS = data.bands.count;
const view = { exposure: data.exposure, x: data.width >> 1, y: data.height >> 1 };
// gain: of the slider; lamp: index into `lamps` in place of the render's own, or -1; shown: linear sRGB, unexposed.
let layers = [];

// Numbers from their differences: high bytes, then low bytes, with the sign in the lowest bit.
function numbersFrom(bytes, at, count, Type) {
  const numbers = new Type(count);
  for (let i = 0, before = 0; i < count; ++i) {
    const folded = (bytes[at + i] << 8) | bytes[at + count + i];
    before += (folded >> 1) ^ -(folded & 1);
    numbers[i] = before;
    before = numbers[i]; // as 16 bits hold it
  }
  return numbers;
}
async function unpackCode(code) {
  const bytes = await inflated(code.packed);
  code.packed = null;
  code.basis = decodeFloats(code.basis);
  const codes = numbersFrom(bytes, 0, PIXELS, Uint16Array);
  code.lengths = Float32Array.from(codes, (c) =>
    c === 0 ? 0 : Math.exp(code.low + (c - 1) * data.lengthStep) * data.directionStep,
  );
  code.directions = Array.from({ length: code.rank }, (_, k) =>
    numbersFrom(bytes, 2 * (k + 1) * PIXELS, PIXELS, Int16Array),
  );
}
async function unpackLayers() {
  for (const layer of data.layers) {
    for (const code of layer.codes) await unpackCode(code);
    const values = decodeFloats(layer.lamp);
    Object.assign(layer, { gain: 1, lamp: -1, own: values.length ? { name: '', values } : null, shown: null });
  }
  layers = data.layers;
}

const bandNm = (b) => data.bands.from + b * data.bands.step;
// Power of a lamp between two wavelengths, by its cells of 1 nm.
function powerBetween(lamp, from, to) {
  let sum = 0;
  lamp.values.forEach((value, k) => {
    if (LAMP_FROM + k >= from && LAMP_FROM + k < to) sum += value;
  });
  return sum;
}
// The lamp's means over bands, and its cells, at the level that both lamps of a group have.
function levelled(lamp) {
  const values = lampOnBands(lamp, data.bands),
    level = lampLevel(values, film);
  return { bands: values.map((value) => value / level), level };
}
// By what each band of a layer is multiplied under its lamp. Bands within the light that the layer is of follow the
// lamp band by band; others hold what fluoresces, which follows the lamp's power.
function bandFactors(layer) {
  if (layer.lamp < 0) return new Float64Array(BANDS).fill(1);
  const lamp = lamps[layer.lamp],
    now = levelled(lamp),
    before = levelled(layer.own);
  const power =
    powerBetween(lamp, layer.from, layer.to) / now.level / (powerBetween(layer.own, layer.from, layer.to) / before.level);
  return Float64Array.from({ length: BANDS }, (_, b) => {
    const isItsOwn = bandNm(b) >= layer.from && bandNm(b) < layer.to;
    if (!isItsOwn) return layer.part === 'whole' ? 1 : power;
    return before.bands[b] > 0 ? now.bands[b] / before.bands[b] : 0;
  });
}
// The part of a lamp's light that falls where the render's lamp sends none, so that nothing is known of it.
function shareUnknown(layer) {
  const now = lampOnBands(lamps[layer.lamp], data.bands),
    before = lampOnBands(layer.own, data.bands);
  const lost = now.reduce((sum, value, b) => sum + (before[b] > 0 ? 0 : value), 0);
  return lost / now.reduce((sum, value) => sum + value, 1e-300);
}

// Radiance of a layer at a pixel, as its slider and its lamp have it.
function layerSpectrum(layer, pixel) {
  const factors = bandFactors(layer),
    spectrum = new Float64Array(BANDS);
  for (const { first, bands, rank, basis, lengths, directions } of layer.codes)
    for (let k = 0; k < rank; ++k)
      for (let b = 0; b < bands; ++b)
        spectrum[first + b] += lengths[pixel] * directions[k][pixel] * basis[k * bands + b];
  return spectrum.map((value, b) => layer.gain * factors[b] * value);
}
