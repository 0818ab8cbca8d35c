// What a material is as the sliders have it, and what it sends towards the eye, in double.

// M (I - diag(r) M)^-1 of a diagonal and masked factors, which keeps that form: one recursion over the bands.
function effectiveFactors(operator, r) {
  const terms = operator.emission.length,
    n = operator.diagonal.length;
  const identity = () =>
    Array.from({ length: terms }, (_, i) => Array.from({ length: terms }, (_, j) => Number(i === j)));
  const product = identity(),
    inverse = identity();
  const result = {
    diagonal: new Float64Array(n),
    emission: operator.emission.map(() => new Float64Array(n)),
    excitation: operator.emission.map(() => new Float64Array(n)),
  };
  const row = (v, matrix) => v.map((_, j) => v.reduce((sum, x, i) => sum + x * matrix[i][j], 0));
  const column = (matrix, v) => matrix.map((line) => line.reduce((sum, x, j) => sum + x * v[j], 0));
  for (let o = 0; o < n; ++o) {
    const gain = 1 / (1 - r[o] * operator.diagonal[o]),
      echo = r[o] * gain;
    const e = operator.emission.map((one) => one[o]),
      x = operator.excitation.map((one) => one[o]);
    const along = row(e, product),
      self = e.reduce((sum, value, k) => sum + value * x[k], 0);
    result.diagonal[o] = gain * operator.diagonal[o];
    along.forEach((value, k) => {
      result.emission[k][o] = gain * value;
    });
    for (let i = 0; i < terms; ++i) for (let j = 0; j < terms; ++j) product[i][j] += echo * x[i] * along[j];
    const back = column(inverse, x),
      share = echo / (1 + echo * self);
    for (let i = 0; i < terms; ++i) for (let j = 0; j < terms; ++j) inverse[i][j] -= share * back[i] * e[j];
    column(inverse, x).forEach((value, k) => {
      result.excitation[k][o] = gain * value;
    });
  }
  return result;
}
// The same of a matrix that does not factor: columns of x solve x (I - diag(r) M) = M, by elimination.
function effectiveDense(operator, r) {
  const n = r.length,
    m = (o, i) => operator.dense[o * n + i] + (o === i ? operator.diagonal[o] : 0);
  const system = Array.from({ length: n }, (_, i) =>
    Float64Array.from({ length: 2 * n }, (_, j) => (j < n ? Number(i === j) - r[j] * m(j, i) : m(j - n, i))),
  );
  for (let k = 0; k < n; ++k) {
    let pivot = k;
    for (let i = k + 1; i < n; ++i) if (Math.abs(system[i][k]) > Math.abs(system[pivot][k])) pivot = i;
    [system[k], system[pivot]] = [system[pivot], system[k]];
    for (let i = 0; i < n; ++i) {
      const factor = i === k ? 0 : system[i][k] / system[k][k];
      if (factor) for (let j = k; j < 2 * n; ++j) system[i][j] -= factor * system[k][j];
    }
  }
  const dense = new Float64Array(n * n),
    diagonal = new Float64Array(n);
  for (let o = 0; o < n; ++o)
    for (let i = 0; i < n; ++i) {
      const value = system[i][n + o] / system[i][i];
      if (o === i) diagonal[o] = value;
      else dense[o * n + i] = value;
    }
  return { diagonal, dense, emission: [], excitation: [] };
}
const effective = (operator, r) => (operator.dense ? effectiveDense(operator, r) : effectiveFactors(operator, r));

// The substrate's own operator; `dye` is the share of its re-radiation that is left.
function substrateOperator(material, dye, scale) {
  const n = material.bands.count,
    shifted = material.substrate.reradiation;
  const operator = {
    diagonal: Float64Array.from({ length: n }, (_, b) => scale * (material.substrate.reflectance || [])[b] || 0),
    emission: [],
    excitation: [],
  };
  if (shifted && shifted.dense) operator.dense = Float64Array.from(shifted.dense, (value) => scale * dye * value);
  else if (shifted)
    for (let k = 0; k < shifted.terms; ++k) {
      operator.emission.push(Float64Array.from(shifted.emission.subarray(k * n, (k + 1) * n), (v) => scale * dye * v));
      operator.excitation.push(Float64Array.from(shifted.excitation.subarray(k * n, (k + 1) * n)));
    }
  return operator;
}
function applied(operator, light) {
  const n = light.length,
    sent = light.map((value, b) => operator.diagonal[b] * value);
  if (operator.dense)
    for (let o = 0; o < n; ++o) for (let i = 0; i < n; ++i) sent[o] += operator.dense[o * n + i] * light[i];
  operator.emission.forEach((emission, k) => {
    for (let b = 0, sum = 0; b < n; ++b) {
      sent[b] += emission[b] * sum;
      sum += operator.excitation[k][b] * light[b];
    }
  });
  return sent;
}

// A share whose logarithm is tabulated; none at all counts as 1e-12 there.
const share = (logarithm) => (logarithm < -27 ? 0 : Math.exp(logarithm));

function addingState(material, sliders) {
  const grid = material.adding,
    numbers = bandNumbers(grid, sliders),
    last = material.layers.at(-1);
  const place = linear(grid.alphas, grid.alphas.length > 1 ? sliders.alpha : grid.alphas[0]);
  const shape = grid.shapes[place.high],
    top = material.layers[0],
    r = numbers.map((one) => share(one[0]));
  const sigma = grid.orenNayar ? material.substrate.sigma : 0,
    mean = meanOrenNayar(sigma);
  const ior = numbers.map((_, b) => (last ? last.ior[b] : 1));
  const alpha = grid.alphas.length > 1 ? sliders.alpha : grid.alphas[0];
  const state = {
    model: 'adding',
    sigma: material.substrate.sigma,
    mean,
    lowestIor: ior[ior.length >> 1],
    transmission: numbers.map((one) => table(one, 0).map(share)),
    delta: numbers.map((one) => table(one, 1)),
    residual: numbers.map((one) => residualTable(one, 2)),
    albedo: numbers.map((one) => table(one, 3)),
    r,
    scale: ior.map((n) => 1 / (Math.PI * n * n)),
    ior: ior,
    topIor: numbers.map((_, b) => (top ? top.ior[b] : 1)),
    topDistribution: top ? top.distribution : 2,
    topAlpha: shape.top ? alpha : 0,
    lobes: shape.lobes.map((lobe) => (lobe.ratio ? { ...lobe, alpha } : lobe)),
  };
  state.amplitudes = state.lobes.map((_, l) => numbers.map((one) => table(one, 4 + l)));
  const full = effective(substrateOperator(material, sliders.dye, mean), r);
  state.operators = sigma > 0 ? [substrateOperator(material, sliders.dye, 1), full] : [full];
  state.orenNayar = sigma > 0 ? grid.orenNayar : null;
  if (material.dyed) {
    state.dyed = dyedState(material);
    state.transmission = state.dyed.through;
  }
  return state;
}
// Weights of the substrate's operators: of the first bounce and of what came back, or of both at once.
function substrateWeights(state, wi, wo) {
  if (!state.orenNayar) return [orenNayar(state.sigma || 0, wi, wo)];
  const at = (c) => Math.sqrt(Math.max(1 - c, 0)) * 15,
    tables = state.orenNayar;
  const separable = (c) => {
    const place = clamp(at(c), 0, 15),
      node = Math.min(Math.floor(place), 14);
    return tables.albedo[node] + (place - node) * (tables.albedo[node + 1] - tables.albedo[node]);
  };
  const azimuth = (wi[0] * wo[0] + wi[1] * wo[1]) / Math.max(sine(wi) * sine(wo), 1e-30);
  const seen = tables.spread.length
    ? shapeValue(tables.spread, clamp(at(wi[2]), 0, 15), clamp(at(wo[2]), 0, 15), clamp((azimuth + 1) * 8, 0, 16))
    : orenNayar(state.sigma, refracted(wi, state.lowestIor), refracted(wo, state.lowestIor));
  const both = separable(wi[2]) * separable(wo[2]);
  return [seen - both / state.mean, both / square(state.mean)];
}
// What substrate and dyes send out again.
function bodyRadiance(state, wi, wo, light) {
  if (state.dyed) return dyedSeen(state.dyed, dyedSent(state.dyed, wi[2], light), wo[2]).map((value) => value * wi[2]);
  const arrives = light.map((value, b) => value * wi[2] * lookUp(state.transmission[b], wi[2]));
  const sent = substrateWeights(state, wi, wo).map((weight, p) =>
    applied(state.operators[p], arrives).map((value) => weight * value),
  );
  return light.map(
    (_, b) => lookUp(state.transmission[b], wo[2]) * state.scale[b] * sent.reduce((sum, one) => sum + one[b], 0),
  );
}
// Radiance towards wo of light with this irradiance at normal incidence, by band.
function addingRadiance(state, wi, wo, light, lampSine) {
  const lit = nearestOfDisc(wi, wo, lampSine),
    h = unit(added(lit, wo)),
    cosH = dot(lit, h);
  const top =
    state.topAlpha > 0
      ? facetLobe(state.topDistribution, state.topAlpha, lit, wo) * spread(state.topAlpha, lampSine)
      : 0;
  const returned = (lobe) =>
    returnedRatio(lobe.returned, lobe.returnedWidth, lit, wo) + returnedRatio(lobe.returned, lobe.returnedWidth, wo, lit);
  const lobes = state.lobes.map((lobe) => {
    const width = lobeWidth(lobe, lit[2], wo[2]);
    return (
      facetLobe(lobe.distribution, width, lit, wo) *
      spread(width, lampSine) *
      (lobe.ratio ? facetRatio(lobe.ratio, lobe.alpha, lit, wo) : lobe.returned ? returned(lobe) : 1)
    );
  });
  const body = bodyRadiance(state, wi, wo, light);
  return light.map((value, b) => {
    let mirrored = lookUp(state.residual[b], wi[2]) * lookUp(state.residual[b], wo[2]);
    if (top > 0) mirrored += top * fresnel(cosH, state.topIor[b]);
    lobes.forEach((lobe, l) => {
      mirrored += lobe * lookUp(state.amplitudes[l][b], wi[2]) * lookUp(state.amplitudes[l][b], wo[2]);
    });
    return body[b] + mirrored * value * wi[2];
  });
}
const addingMirror = (state, cosine) => state.delta.map((one) => lookUp(one, cosine));
// The same of light from all around, as a function of band and cosine.
function bodyAround(state, radiance) {
  if (state.dyed) {
    const sent = dyedSentAround(state.dyed, radiance);
    return (band, cosine) => dyedSeenAt(state.dyed, sent, nodeWeights(state.dyed.nodes, cosine), band, cosine);
  }
  const arrives = radiance.map((value, b) => value * square(state.ior[b]) * (1 - state.r[b]));
  const sent = applied(state.operators.at(-1), arrives);
  return (band, cosine) => (lookUp(state.transmission[band], cosine) * sent[band]) / square(state.ior[band]);
}
// Radiance of light from all around.
function addingAround(state, cosine, radiance) {
  const body = bodyAround(state, radiance);
  return radiance.map((value, b) => value * lookUp(state.albedo[b], cosine) + body(b, cosine));
}
