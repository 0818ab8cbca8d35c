// The picture by WebGL 2: tables and bands go into textures of floats, which a pixel reads.
const FINE_NODES = 129; // linear in between, where NODES are cubic

function fineTable(values) {
  return Float32Array.from({ length: FINE_NODES }, (_, k) => {
    const x = k / (FINE_NODES - 1);
    return lookUp(values, x * x);
  });
}
function compiled(gl, type, source) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, source);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
    throw new Error('the shader does not compile: ' + gl.getShaderInfoLog(shader));
  return shader;
}
function linkedProgram(gl, fragment) {
  const program = gl.createProgram(),
    head = '#version 300 es\nprecision highp float;\nprecision highp int;\n';
  gl.attachShader(program, compiled(gl, gl.VERTEX_SHADER, head + shaderParts.vertex));
  gl.attachShader(program, compiled(gl, gl.FRAGMENT_SHADER, head + fragment));
  gl.bindAttribLocation(program, 0, 'rr_position');
  gl.bindAttribLocation(program, 1, 'rr_vertex_normal');
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
    throw new Error('the shader does not link: ' + gl.getProgramInfoLog(program));
  return program;
}

// Textures by rows of texels; four bands of a quantity are a texel.
function texture(gl, width, height, values, kinds) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl[kinds[0]], width, height, 0, gl[kinds[1]], gl.FLOAT, values);
  for (const [name, value] of [
    ['MIN_FILTER', 'NEAREST'],
    ['MAG_FILTER', 'NEAREST'],
    ['WRAP_S', 'CLAMP_TO_EDGE'],
    ['WRAP_T', 'CLAMP_TO_EDGE'],
  ])
    gl.texParameteri(gl.TEXTURE_2D, gl['TEXTURE_' + name], gl[value]);
  return made;
}
const chunksOf = (bands) => Math.ceil(bands / 4);
function bandTexture(gl, rows, bands) {
  const chunks = chunksOf(bands),
    values = new Float32Array(4 * chunks * rows.length);
  rows.forEach((row, k) => values.set(row, 4 * chunks * k));
  return texture(gl, chunks, rows.length, values, ['RGBA32F', 'RGBA']);
}
function nodeTexture(gl, tables, bands) {
  const chunks = chunksOf(bands),
    values = new Float32Array(4 * FINE_NODES * chunks * tables.length),
    known = new Map();
  tables.forEach((byBand, t) =>
    byBand.forEach((one, b) => {
      if (!known.has(one)) known.set(one, fineTable(one));
      const fine = known.get(one),
        row = t * chunks + (b >> 2);
      for (let node = 0; node < FINE_NODES; ++node) values[4 * (row * FINE_NODES + node) + (b & 3)] = fine[node];
    }),
  );
  return texture(gl, FINE_NODES, chunks * tables.length, values, ['RGBA32F', 'RGBA']);
}

// Layout of a material under a model: defines and uniforms of the shader, and what the textures hold.
function operatorRows(operators) {
  return operators.flatMap((one) => [
    one.diagonal,
    ...one.emission.flatMap((emission, k) => [one.excitation[k], emission]),
  ]);
}
// Tables of what comes back from deeper interfaces, one lobe after the other; null where no lobe has one.
function returnedTables(lobes) {
  const size = 32 * 28 * 9,
    values = new Float32Array(size * lobes.length);
  lobes.forEach((lobe, l) => lobe.returned && values.set(lobe.returned, l * size));
  return lobes.some((lobe) => lobe.returned) ? values : null;
}
function addingLayout(state) {
  const passages = Math.max(1, ...state.lobes.map((lobe) => lobe.passages.length)),
    lobes = state.lobes;
  const padded = [...lobes, { distribution: 2, alpha: 1, ior: 0, passages: [] }];
  const ratio = lobes[0] && lobes[0].ratio,
    returned = returnedTables(lobes),
    spreads = state.orenNayar && state.orenNayar.spread.length > 0;
  return {
    rows: { SCALE: [state.scale], IOR: [state.topIor] },
    tables: [state.transmission, state.delta, state.residual, ...state.amplitudes],
    defines: {
      RR_LOBES: lobes.length,
      RR_PASSAGES: passages,
      RR_HAS_RATIO: Number(Boolean(ratio)),
      RR_HAS_RETURNED: Number(Boolean(returned)),
      RR_SPREADS: Number(Boolean(spreads)),
      RR_DISPERSIVE: 0,
    },
    shapes: [ratio || null, spreads ? state.orenNayar.spread : null, state.orenNayar ? state.orenNayar.albedo : null, returned],
    uniforms: {
      'int rr_lobe_distribution[]': padded.map((lobe) => lobe.distribution),
      'float rr_lobe_alpha[]': padded.map((lobe) => lobe.alpha),
      'float rr_lobe_ior[]': padded.map((lobe) => lobe.ior),
      'float rr_lobe_returned[]': padded.map((lobe) => lobe.returnedWidth || 0),
      'vec3 rr_passage[]': padded
        .flatMap((lobe) => Array.from({ length: passages }, (_, p) => lobe.passages[p] || [0, 1, 1]))
        .flat(),
      'int rr_top_distribution': state.topDistribution,
      'float rr_top_alpha': state.topAlpha,
      'float rr_sigma': state.sigma || 0,
      'float rr_lowest_ior': state.lowestIor,
      'float rr_mean_albedo': state.mean,
    },
  };
}
function weidlichWilkieLayout(state) {
  const tables = [state.residual],
    bands = state.residual.length,
    extra = (part) => {
      if (!part || !part.reflectance) return -1;
      tables.push(Array.from({ length: bands }, (_, b) => part.reflectance.subarray(b * NODES, (b + 1) * NODES)));
      return tables.length - 1;
    };
  const layers = state.layers,
    none = { distribution: 2, alpha: 0, coverage: 0 },
    padded = [...layers, none];
  const flakes = padded.map((layer) => layer.flakes || none);
  const uniforms = {
    'int rr_layer_distribution[]': padded.map((layer) => layer.distribution),
    'float rr_layer_alpha[]': padded.map((layer) => layer.alpha),
    'int rr_layer_table[]': padded.map(extra),
    'float rr_layer_anisotropy[]': padded.map((layer) => layer.anisotropy || 0),
    'bool rr_layer_is_cloudy[]': padded.map((layer) => Number(Boolean(layer.scattering))),
    'float rr_flake_coverage[]': flakes.map((one) => one.coverage),
    'float rr_flake_alpha[]': flakes.map((one) => one.alpha),
    'int rr_flake_distribution[]': flakes.map((one) => one.distribution),
    'int rr_flake_table[]': flakes.map(extra),
    'int rr_base_table': extra(state.base),
    'float rr_base_alpha': state.base ? state.base.alpha : 0,
    'int rr_base_distribution': state.base ? state.base.distribution : 2,
    'float rr_sigma': state.sigma,
  };
  return {
    rows: { IOR: layers.map((layer) => layer.ior), DEPTH: layers.flatMap((layer) => [layer.depths, layer.clouds]) },
    tables,
    uniforms,
    defines: { RR_LAYERS: layers.length, RR_DISPERSIVE: Number(state.isDispersive) },
    shapes: [null, null, null, null],
  };
}
