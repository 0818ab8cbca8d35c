// The model of Weidlich and Wilkie (2007) in double, as weidlich_wilkie.glsl has it.
function weidlichWilkieState(material, sliders) {
  const grid = material['weidlich-wilkie'],
    substrate = material.substrate;
  const layers = material.layers.map((layer, k) => {
    const depths = Float64Array.from(
      layer.ior,
      (_, b) =>
        layer.thickness *
        sliders.thickness *
        (layer.absorption[b] * sliders.absorption + (layer.scattering ? layer.scattering[b] : 0)),
    );
    return {
      ...layer,
      alpha: k === 0 && isRoughnessFree(material) ? sliders.alpha : layer.alpha,
      depths,
      clouds: depths.map((depth, b) =>
        layer.scattering && depth > 0 ? (layer.thickness * sliders.thickness * layer.scattering[b]) / depth : 0,
      ),
    };
  });
  const base =
    substrate.type === 'conductor'
      ? { ...substrate, alpha: layers.length === 0 && isRoughnessFree(material) ? sliders.alpha : substrate.alpha }
      : null;
  return {
    model: 'weidlich-wilkie',
    layers,
    base,
    sigma: substrate.sigma || 0,
    residual: bandNumbers(grid, sliders).map((one) => residualTable(one, 0)),
    operators: [substrateOperator(material, sliders.dye, 1)],
    isDispersive: layers.some((layer) => layer.ior.some((n) => n !== layer.ior[0])),
  };
}
const reflectanceAt = (part, band, cosine, eta) =>
  part.reflectance ? lookUp(part.reflectance.subarray(band * NODES, (band + 1) * NODES), cosine) : fresnel(cosine, eta);
const litLobe = (distribution, alpha, lit, wo, lampSine) =>
  alpha > 0 ? facetLobe(distribution, alpha, lit, wo) * spread(alpha, lampSine) : 0;

// Both directions on their way down at one band: what passes each way, what is mirrored on the way.
function descend(state, band, wi, wo, lit, lampSine) {
  const way = { wi, wo, lit, above: 1, in: 1, out: 1, mirrored: 0 };
  for (const layer of state.layers) {
    meetInterface(layer, band, way, lampSine);
    passSlab(layer, band, way);
    if (layer.flakes) {
      const { coverage, distribution, alpha } = layer.flakes;
      way.mirrored +=
        way.in *
        way.out *
        coverage *
        litLobe(distribution, alpha, way.lit, way.wo, lampSine) *
        reflectanceAt(layer.flakes, band, dot(way.lit, unit(added(way.lit, way.wo))), 1);
      way.in *= 1 - coverage;
      way.out *= 1 - coverage;
    }
    way.above = layer.ior[band];
  }
  if (!(way.wi[2] > 0 && way.wo[2] > 0)) way.in = 0;
  return way;
}
function meetInterface(layer, band, way, lampSine) {
  const eta = layer.ior[band] / way.above,
    h = unit(added(way.wi, way.wo));
  const isRough = layer.alpha > 0 && !layer.reflectance;
  const cosI = isRough ? Math.max(dot(way.wi, h), 0) : way.wi[2],
    cosO = isRough ? cosI : way.wo[2];
  const facets = isRough ? shadowing(layer.distribution, layer.alpha, way.wi, way.wo, h) * way.wi[2] * way.wo[2] : 1;
  const lobe = litLobe(layer.distribution, layer.alpha, way.lit, way.wo, lampSine);
  if (lobe > 0)
    way.mirrored +=
      way.in * way.out * lobe * reflectanceAt(layer, band, dot(way.lit, unit(added(way.lit, way.wo))), eta);
  way.in *= 1 - reflectanceAt(layer, band, cosI, eta);
  way.out *= 1 - facets * reflectanceAt(layer, band, cosO, eta);
  for (const key of ['wi', 'wo', 'lit']) way[key] = refracted(way[key], eta);
}
function passSlab(layer, band, way) {
  const depth = layer.depths[band],
    inverse = (w) => 1 / Math.max(w[2], 1e-6);
  if (layer.clouds[band] > 0)
    way.mirrored +=
      ((way.in * way.out * phaseFunction(layer.anisotropy, -dot(way.wi, way.wo))) / (way.wi[2] + way.wo[2])) *
      layer.clouds[band] *
      -Math.expm1(-depth * (inverse(way.wi) + inverse(way.wo)));
  way.in *= Math.exp(-depth * inverse(way.wi));
  way.out *= Math.exp(-depth * inverse(way.wo));
}

function weidlichWilkieRadiance(state, wi, wo, light, lampSine) {
  const lit = nearestOfDisc(wi, wo, lampSine),
    ways = light.map((_, b) => descend(state, b, wi, wo, lit, lampSine));
  const mirrored = ways.map((way, b) => {
    const lobe = state.base ? litLobe(state.base.distribution, state.base.alpha, way.lit, way.wo, lampSine) : 0;
    return (
      way.mirrored +
      lookUp(state.residual[b], wi[2]) * lookUp(state.residual[b], wo[2]) +
      (lobe > 0
        ? way.in * way.out * lobe * reflectanceAt(state.base, b, dot(way.lit, unit(added(way.lit, way.wo))), 1)
        : 0)
    );
  });
  const sent = state.base
    ? null
    : applied(
        state.operators[0],
        light.map((value, b) => value * wi[2] * ways[b].in),
      );
  return light.map(
    (value, b) =>
      mirrored[b] * value * wi[2] +
      (sent ? ((ways[b].out * orenNayar(state.sigma, ways[b].wi, ways[b].wo)) / Math.PI) * sent[b] : 0),
  );
}
// Both ways along one direction as if all were smooth: mirrored by what is smooth, by all, and let through.
function straight(state, band, cosine) {
  let c = cosine,
    above = 1,
    through = 1,
    smooth = 0,
    all = 0;
  const mirror = (share, alpha) => {
    all += through * through * share;
    if (!(alpha > 0)) smooth += through * through * share;
  };
  for (const layer of state.layers) {
    const eta = layer.ior[band] / above,
      reflected = reflectanceAt(layer, band, c, eta);
    mirror(reflected, layer.alpha);
    c = refracted([Math.sqrt(1 - c * c), 0, c], eta)[2];
    through *= (1 - reflected) * Math.exp(-layer.depths[band] / Math.max(c, 1e-6));
    if (layer.flakes) {
      mirror(layer.flakes.coverage * reflectanceAt(layer.flakes, band, c, 1), layer.flakes.alpha);
      through *= 1 - layer.flakes.coverage;
    }
    above = layer.ior[band];
  }
  if (state.base) mirror(reflectanceAt(state.base, band, c, 1), state.base.alpha);
  return { smooth, all, through: c > 0 ? through : 0 };
}
const weidlichWilkieMirror = (state, cosine, bands) =>
  Array.from({ length: bands }, (_, b) => straight(state, b, cosine).smooth);
// Light from all around, by what smooth surfaces would do with it: the picture's surroundings are no measurement.
function weidlichWilkieAround(state, cosine, radiance) {
  const arrives = radiance.map((value, b) => {
    let sum = 0;
    for (let k = 0; k < 16; ++k) {
      const c = (k + 0.5) / 16;
      sum += ((2 * c) / 16) * straight(state, b, c).through;
    }
    return value * sum;
  });
  const sent = state.base ? null : applied(state.operators[0], arrives);
  return radiance.map((value, b) => {
    const way = straight(state, b, cosine);
    return value * way.all + (sent ? way.through * sent[b] : 0);
  });
}
