// Lamps on the bands, and colours.
const LAMP_FROM = 280,
  LAMP_COUNT = 561; // lamps are means over cells of 1 nm

// Mean of a lamp over each band.
function lampOnBands(lamp, bands) {
  return Array.from({ length: bands.count }, (_, b) => {
    const low = bands.from + (b - 0.5) * bands.step,
      high = low + bands.step;
    let sum = 0;
    for (let nm = Math.floor(low); nm <= Math.ceil(high); ++nm) {
      const shared = Math.min(high, nm + 0.5) - Math.max(low, nm - 0.5),
        k = nm - LAMP_FROM;
      if (shared > 0 && k >= 0 && k < LAMP_COUNT) sum += shared * lamp.values[k];
    }
    return sum / bands.step;
  });
}
// A spectrum that was pasted or dropped: two numbers a line, dark outside. Throws what is wrong with it.
function lampFromText(text, name) {
  const rows = [];
  text.split(/\r\n|\r|\n/).forEach((line, index) => {
    const words = line
      .replace(/#.*/, '')
      .trim()
      .split(/[\s,;]+/)
      .filter(Boolean);
    if (words.length === 0) return;
    const numbers = words.slice(0, 2).map(Number);
    if (words.length < 2 || !numbers.every(isFinite)) {
      if (rows.length === 0) return; // a heading
      throw new Error('line ' + (index + 1) + ' has no two numbers; write a wavelength in nm and a value a line');
    }
    if (rows.length && numbers[0] <= rows.at(-1)[0])
      throw new Error('line ' + (index + 1) + ': wavelengths must ascend');
    if (numbers[1] < 0) throw new Error('line ' + (index + 1) + ': a lamp sends out no negative light');
    rows.push(numbers);
  });
  if (rows.length < 2) throw new Error('a lamp needs two lines of a wavelength in nm and a value, or more');
  const values = new Float64Array(LAMP_COUNT);
  let right = 1;
  for (let k = 0; k < LAMP_COUNT; ++k) {
    const nm = LAMP_FROM + k;
    if (nm < rows[0][0] || nm > rows.at(-1)[0]) continue;
    while (rows[right][0] < nm) ++right;
    const [a, b] = [rows[right - 1], rows[right]],
      t = (nm - a[0]) / (b[0] - a[0]);
    values[k] = a[1] + t * (b[1] - a[1]);
  }
  if (!values.some((value) => value > 0)) throw new Error('this lamp is dark from 280 to 840 nm');
  return { name, values };
}
// Y of the lamp is 1, or of a lamp that the eye hardly sees, its mean from 300 to 780 nm.
function lampLevel(values, material) {
  const bands = material.bands;
  const y = values.reduce((sum, value, b) => sum + value * material.weights[3 * b + 1], 0);
  const energy = (values.reduce((sum, value) => sum + value, 0) * bands.step) / 480;
  return Math.max(y, 0.5 * energy, 1e-30);
}

const xyzOf = (radiance, weights) =>
  [0, 1, 2].map((channel) => radiance.reduce((sum, value, b) => sum + value * weights[3 * b + channel], 0));
const XYZ_TO_SRGB = [
  [3.2404541621141054, -1.5371385127977166, -0.4985314095560162],
  [-0.969266030505187, 1.8760108454466942, 0.04155601753034984],
  [0.05564343095911469, -0.20402591351675387, 1.0572251882231791],
];
const linearSrgb = (xyz) => XYZ_TO_SRGB.map((row) => row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2]);
const encodedSrgb = (rgb) =>
  rgb.map((value) => {
    const c = clamp(value, 0, 1);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * Math.pow(c, 1 / 2.4) - 0.055;
  });
// CIE 1976 against a white.
function labOf(xyz, white) {
  const [x, y, z] = xyz.map((value, k) => {
    const t = value / white[k];
    return t > 216 / 24389 ? Math.cbrt(t) : ((24389 / 27) * t + 16) / 116;
  });
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}
