// The material as it stands, as a file that every command of the program takes.
const tomlNumber = (value) => {
  const text = String(Number(Number(value).toPrecision(9)));
  return /^-?\d+$/.test(text) ? text + '.0' : text;
};
const tomlText = (text) => JSON.stringify(String(text)).replace(/\u007f/g, '\\u007f');
const tomlList = (values) => '[' + Array.from(values, tomlNumber).join(', ') + ']';
const DISTRIBUTIONS = ['blinn', 'beckmann', 'ggx'];

function tomlSpectrum(values, bands) {
  if (values.every((value) => value === values[0])) return tomlNumber(values[0]);
  return (
    '{ nm = ' +
    tomlList(Array.from(values, (_, b) => bands.from + b * bands.step)) +
    ', value = ' +
    tomlList(values) +
    ' }'
  );
}
const filmText = (film, bands) =>
  '{ thickness_nm = ' + tomlNumber(film.thicknessNm) + ', ior = ' + tomlSpectrum(film.ior, bands) + ' }';
function surfaceLines(surface, bands) {
  return [
    'alpha = ' + tomlNumber(surface.alpha),
    'distribution = "' + DISTRIBUTIONS[surface.distribution] + '"',
    'scattering = "' + (surface.multiple ? 'multiple' : 'single') + '"',
    ...(surface.film ? ['film = ' + filmText(surface.film, bands)] : []),
  ];
}
const metalLines = (metal, bands) => [
  'ior = ' + tomlSpectrum(metal.ior, bands),
  'kappa = ' + tomlSpectrum(metal.kappa, bands),
  ...surfaceLines(metal, bands),
];
function layerLines(layer, bands, sliders) {
  const lines = [
    'ior = ' + tomlSpectrum(layer.ior, bands),
    ...surfaceLines(layer, bands),
    'thickness = ' + tomlNumber(layer.thickness * sliders.thickness),
    'absorption = ' +
      tomlSpectrum(
        Array.from(layer.absorption, (value) => value * sliders.absorption),
        bands,
      ),
  ];
  if (layer.scattering)
    lines.push(
      'scattering_coefficient = ' + tomlSpectrum(layer.scattering, bands),
      'anisotropy = ' + tomlNumber(layer.anisotropy),
    );
  if (layer.flakes)
    lines.push(
      'flakes = { coverage = ' +
        tomlNumber(layer.flakes.coverage) +
        ', ' +
        metalLines(layer.flakes, bands).join(', ') +
        ' }',
    );
  return lines;
}
const matrixFileName = (material) => material.name.replace(/[^\w.-]+/g, '-') + '-reradiation.csv';
function substrateLines(material) {
  const { substrate, bands } = material;
  if (substrate.type === 'conductor') return ['type = "conductor"', ...metalLines(substrate, bands)];
  const lines = ['type = "' + substrate.type + '"'];
  if (substrate.type === 'oren-nayar') lines.push('sigma = ' + tomlNumber(substrate.sigma));
  lines.push(
    substrate.reradiation
      ? 'reradiation = { file = ' + tomlText(matrixFileName(material)) + ' }'
      : 'reflectance = ' + tomlSpectrum(substrate.reflectance, bands),
  );
  return lines;
}
// The material with its first surface as wide as the slider says.
function withRoughness(material, sliders) {
  const copy = {
    ...material,
    layers: material.layers.map((layer) => ({ ...layer })),
    substrate: { ...material.substrate },
  };
  const first = copy.layers[0] || copy.substrate;
  if (isRoughnessFree(material)) first.alpha = sliders.alpha;
  return copy;
}
function materialToml(material, sliders) {
  const now = withRoughness(material, sliders),
    indented = (lines) => lines.map((line) => '  ' + line + '\n').join('');
  return (
    (material.substrate.reradiation
      ? '# The re-radiation matrix stands in ' + matrixFileName(material) + ', which the page saves.\n'
      : '') +
    '[material]\nname = ' +
    tomlText(material.name) +
    '\n' +
    now.layers
      .map((layer) => '  [[material.layer]]\n' + indented(layerLines(layer, material.bands, sliders)))
      .join('') +
    '  [material.substrate]\n' +
    indented(substrateLines(now))
  );
}
// The substrate's matrix as it stands, in the program's form.
function matrixCsv(material, sliders) {
  const operator = substrateOperator(material, sliders.dye, 1),
    n = material.bands.count;
  const centre = (b) => material.bands.from + b * material.bands.step,
    columns = [];
  for (let i = 0; i < n; ++i)
    columns.push(
      applied(
        operator,
        Float64Array.from({ length: n }, (_, b) => Number(b === i)),
      ),
    );
  const allows = operator.dense && columns.some((column, i) => column.subarray(0, i).some((value) => value > 0));
  return (
    '# reradiation\n# quantity: per-band\n# orientation: rows-emission\n' +
    (allows ? '# anti-stokes: allowed\n' : '') +
    'nm,' +
    Array.from({ length: n }, (_, b) => centre(b)).join(',') +
    '\n' +
    Array.from(
      { length: n },
      (_, o) => centre(o) + ',' + columns.map((column) => Number(column[o].toPrecision(9))).join(',') + '\n',
    ).join('')
  );
}
