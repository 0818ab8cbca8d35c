// Unpacks materials, and makes the tables of a material as the sliders have it. All numbers are double.
const NODES = 65; // of a table, uniform in the square root of the cosine

function unpackLayer(layer) {
  for (const key of ['ior', 'absorption', 'scattering', 'reflectance'])
    if (layer[key]) layer[key] = decodeFloats(layer[key]);
  if (layer.film) layer.film.ior = decodeFloats(layer.film.ior);
  if (layer.flakes) unpackConductor(layer.flakes);
}
function unpackConductor(conductor) {
  for (const key of ['ior', 'kappa', 'reflectance']) conductor[key] = decodeFloats(conductor[key]);
  if (conductor.film) conductor.film.ior = decodeFloats(conductor.film.ior);
}
function unpackGrid(grid) {
  grid.numbers = decodeFloats(grid.numbers);
  grid.stride = 2 + grid.tables * NODES;
  for (const shape of grid.shapes || [])
    for (const lobe of shape.lobes)
      for (const key of ['ratio', 'returned']) if (lobe[key]) lobe[key] = decodeFloats(lobe[key]);
  if (grid.orenNayar)
    for (const key of ['albedo', 'spread']) grid.orenNayar[key] = decodeFloats(grid.orenNayar[key]);
}
function unpackMaterial(material) {
  material.layers.forEach(unpackLayer);
  const substrate = material.substrate;
  if (substrate.type === 'conductor') unpackConductor(substrate);
  else substrate.reflectance = decodeFloats(substrate.reflectance);
  const shifted = substrate.reradiation;
  for (const key of ['emission', 'excitation', 'dense'])
    if (shifted && shifted[key]) shifted[key] = decodeFloats(shifted[key]);
  for (const model of material.models) unpackGrid(material[model]);
  for (const key of ['numbers', 'through'])
    if (material.dyed) material.dyed[key] = decodeFloats(material.dyed[key]);
  material.weights = decodeFloats(material.weights);
  return material;
}

// Nodes and weights of a place among ascending nodes: cubic (Lagrange) in between, held at the ends.
function lagrange(nodes, place) {
  const count = nodes.length,
    x = clamp(place, nodes[0], nodes[count - 1]);
  const exact = nodes.findIndex((node) => Math.abs(node - x) <= 1e-7 * (node || 1));
  if (exact >= 0) return [[exact, 1]];
  const right = nodes.findIndex((node) => node > x);
  const first = clamp(right - 2, 0, Math.max(0, count - 4)),
    used = nodes.slice(first, first + 4);
  return used.map((own, k) => [
    first + k,
    used.reduce((weight, other, j) => (j === k ? weight : (weight * (x - other)) / (own - other)), 1),
  ]);
}
function linear(nodes, place) {
  const right = nodes.findIndex((node) => node >= place - 1e-9);
  if (right < 0) return { low: nodes.length - 1, high: nodes.length - 1, t: 0 };
  if (right === 0 || Math.abs(nodes[right] - place) <= 1e-7) return { low: right, high: right, t: 0 };
  return { low: right - 1, high: right, t: (place - nodes[right - 1]) / (nodes[right] - nodes[right - 1]) };
}

// Numbers of one width and class at a depth.
function atDepth(grid, alpha, cls, depth) {
  const sum = new Float64Array(grid.stride);
  for (const [node, weight] of lagrange(grid.nodes, depth)) {
    const from = ((alpha * grid.classes + cls) * grid.nodes.length + node) * grid.stride;
    for (let i = 0; i < grid.stride; ++i) sum[i] += weight * grid.numbers[from + i];
  }
  return sum;
}
// What lies between two widths. From a smooth surface to a rough one the mirror is gone at once, and lobes
// are there at once, but for the light of several facets, which grows with the width.
function between(grid, place, cls, depth) {
  const high = atDepth(grid, place.high, cls, depth);
  if (place.low === place.high) return high;
  const low = atDepth(grid, place.low, cls, depth),
    fromSmooth = grid.alphas[place.low] === 0;
  const lobes = grid.shapes ? grid.shapes[place.high].lobes : [];
  const sum = low.map((value, i) => value + place.t * (high[i] - value));
  if (fromSmooth && grid.shapes) {
    sum.set(high.subarray(2 + NODES, 2 + 2 * NODES), 2 + NODES);
    for (let i = 2 + 4 * NODES; i < grid.stride; ++i) {
      const lobe = lobes[Math.floor((i - 2) / NODES) - 4];
      sum[i] = lobe && lobe.ratio ? high[i] * Math.sqrt(place.t) : high[i];
    }
  }
  return sum;
}
// One set of numbers a band; bands of one class and depth share theirs.
function bandNumbers(grid, sliders) {
  const place = linear(grid.alphas, grid.alphas.length > 1 ? sliders.alpha : grid.alphas[0]);
  const known = new Map();
  return grid.classOf.map((cls, band) => {
    const factor = grid.nodes.length > 1 ? sliders.thickness * sliders.absorption : 1;
    const depth = grid.depths[band] * factor,
      key = cls + ' ' + depth;
    if (!known.has(key)) known.set(key, between(grid, place, cls, depth));
    return known.get(key);
  });
}

const table = (numbers, index) => numbers.subarray(2 + index * NODES, 2 + (index + 1) * NODES);
const scaledTable = (values, factor) => values.map((value) => value * factor);
// Catmull-Rom between the nodes, as `measure` looks its tables up.
function lookUp(values, cosine) {
  const x = Math.sqrt(clamp(cosine, 0, 1)) * (NODES - 1),
    i = Math.min(Math.floor(x), NODES - 2),
    t = x - i;
  const low = i > 0 ? 0.5 * (values[i + 1] - values[i - 1]) : values[1] - values[0];
  const high = i + 2 < NODES ? 0.5 * (values[i + 2] - values[i]) : values[i + 1] - values[i];
  const rise = values[i + 1] - values[i];
  // beside a kink a cubic dips below zero
  return Math.max(values[i] + t * (low + t * (3 * rise - 2 * low - high + t * (low + high - 2 * rise))), 0);
}
// The residual over sqrt(pi times its mean): the product of two is its value.
function residualTable(numbers, index) {
  return scaledTable(table(numbers, index), numbers[1] > 0 ? 1 / Math.sqrt(Math.PI * numbers[1]) : 0);
}
