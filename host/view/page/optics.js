// Formulas of facets and interfaces, in double: those of the renderer's kernels, which material.glsl has in
// single precision for the picture. Directions are [x, y, z] in the surface's frame.
const square = (x) => x * x;
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const sine = (w) => Math.hypot(w[0], w[1]);
const scaled = (v, s) => v.map((x) => x * s);
const added = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const unit = (v) => scaled(v, 1 / Math.sqrt(dot(v, v)));
const crossed = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

function fresnel(c, eta) {
  const excess = (eta - 1) * (eta + 1),
    g2 = excess + c * c;
  if (eta === 1) return 0;
  if (g2 <= 0) return 1;
  const g = Math.sqrt(g2),
    s = excess / square(c + g);
  const p = (excess * ((excess + 2) * c * c - 1)) / square(eta * eta * c + g);
  return Math.min(0.5 * (s * s + p * p), 1);
}
function refracted(w, eta) {
  const g2 = (eta - 1) * (eta + 1) + w[2] * w[2];
  return [w[0] / eta, w[1] / eta, g2 <= 0 ? 0 : Math.min(Math.sqrt(g2) / eta, 1)];
}
// Cody's rational form by way of a continued fraction and a series: relative error below 1e-12, x >= 0.
function erfc(x) {
  if (x < 2) {
    let term = x,
      sum = x;
    for (let k = 1; k < 60; ++k) {
      term *= (-x * x) / k;
      sum += term / (2 * k + 1);
    }
    return 1 - (2 / Math.sqrt(Math.PI)) * sum;
  }
  let f = 0;
  for (let k = 60; k > 0; --k) f = k / 2 / (x + f);
  return Math.exp(-x * x) / Math.sqrt(Math.PI) / (x + f);
}
function facetDensity(distribution, alpha, h) {
  const sin2 = h[0] * h[0] + h[1] * h[1],
    cos2 = h[2] * h[2],
    a2 = alpha * alpha;
  if (h[2] <= 0) return 0;
  if (distribution === 2) return 1 / (Math.PI * a2 * square(cos2 + sin2 / a2));
  if (distribution === 1) return Math.exp(-sin2 / (cos2 * a2)) / (Math.PI * a2 * cos2 * cos2);
  const logCos2 = sin2 < 0.5 ? Math.log1p(-sin2) : 2 * Math.log(h[2]);
  return Math.exp(Math.max(1 / a2 - 1, 0) * logCos2) / (Math.PI * a2);
}
function lambdaCos(distribution, alpha, w) {
  const s = alpha * sine(w);
  if (s <= 0) return 0;
  if (distribution === 1) {
    const a = w[2] / s;
    return 0.5 * Math.max((s * Math.exp(-a * a)) / Math.sqrt(Math.PI) - w[2] * erfc(a), 0);
  }
  return (0.5 * s * s) / (w[2] + Math.sqrt(w[2] * w[2] + s * s));
}
// Masking and shadowing over the product of the cosines.
function shadowing(distribution, alpha, wi, wo, h) {
  const cc = wi[2] * wo[2];
  if (distribution === 0) return Math.min(1 / cc, (2 * h[2]) / (dot(wi, h) * wo[2]), (2 * h[2]) / (dot(wo, h) * wi[2]));
  return 1 / (cc + wo[2] * lambdaCos(distribution, alpha, wi) + wi[2] * lambdaCos(distribution, alpha, wo));
}
function facetLobe(distribution, alpha, wi, wo) {
  if (wi[2] <= 0 || wo[2] <= 0) return 0;
  const h = unit(added(wi, wo));
  return 0.25 * facetDensity(distribution, alpha, h) * shadowing(distribution, alpha, wi, wo, h);
}
// Oren and Nayar 1994, qualitative form, times pi over the reflectance.
function orenNayar(sigma, wi, wo) {
  const s2 = sigma * sigma,
    along = wi[0] * wo[0] + wi[1] * wo[1];
  if (wi[2] <= 0 || wo[2] <= 0) return 0;
  return 1 - (0.5 * s2) / (s2 + 0.33) + ((0.45 * s2) / (s2 + 0.09)) * (along > 0 ? along / Math.max(wi[2], wo[2]) : 0);
}
function meanOrenNayar(sigma) {
  const s2 = sigma * sigma;
  return 1 - (0.5 * s2) / (s2 + 0.33) + ((0.45 * s2) / (s2 + 0.09)) * (2 / 3 - 64 / (45 * Math.PI));
}

// A lamp that is a disc of this sine of its radius: as in material.glsl.
function nearestOfDisc(wi, wo, sinRadius) {
  const mirror = [-wo[0], -wo[1], wo[2]],
    radius = Math.asin(sinRadius);
  const away = Math.acos(clamp(dot(mirror, wi), -1, 1));
  if (radius <= 0) return wi;
  if (away <= radius) return mirror;
  const t = radius / away;
  return unit(added(scaled(wi, 1 - t), scaled(mirror, t)));
}
const spread = (alpha, sinRadius) => square(alpha / Math.min(alpha + 0.5 * sinRadius, 1));
function discShare(wi, wo, sinRadius) {
  if (sinRadius <= 0) return 0;
  const away = Math.acos(clamp(dot([-wo[0], -wo[1], wo[2]], wi), -1, 1)),
    radius = Math.asin(sinRadius);
  const t = clamp((away / radius - 0.94) / 0.12, 0, 1);
  return 1 - t * t * (3 - 2 * t);
}

// Trilinear in a table of 16 by 16 cosines and 17 places.
function shapeValue(values, placeI, placeO, place) {
  const i = clamp(Math.floor(placeI), 0, 14),
    o = clamp(Math.floor(placeO), 0, 14),
    s = clamp(Math.floor(place), 0, 15);
  const part = (at, from, step) => {
    const t = clamp(at - from, 0, 1);
    return step ? t : 1 - t;
  };
  let sum = 0;
  for (let corner = 0; corner < 8; ++corner) {
    const a = corner & 1,
      b = (corner >> 1) & 1,
      c = corner >> 2;
    sum += part(placeI, i, a) * part(placeO, o, b) * part(place, s, c) * values[((i + a) * 16 + o + b) * 17 + s + c];
  }
  return sum;
}
// Ratio of the light of several facets to the lobe of one.
function facetRatio(values, alpha, wi, wo) {
  const si = sine(wi),
    so = sine(wo),
    ui = 1 / Math.max(si, 1e-15),
    uo = 1 / Math.max(so, 1e-15);
  const q = 0.25 * (square(ui * wi[0] + uo * wo[0]) + square(ui * wi[1] + uo * wo[1]));
  const sum = square(alpha * Math.max(wi[2] + wo[2], 1e-15));
  const difference = (sum * square(wi[2] - wo[2])) / (alpha * alpha * square(Math.max(si + so, 1e-15)));
  const k = Math.sqrt((sum + difference) / (sum + difference + 4 * si * so));
  const cosinePlace = (c) => clamp(((Math.sqrt(Math.max(c, 0)) - 0.1) * 15) / 0.9, 0, 15);
  return shapeValue(values, cosinePlace(wi[2]), cosinePlace(wo[2]), clamp((q * (1 + k)) / (q + k), 0, 1) * 16);
}
// Ratio of the light that comes back from a deeper interface to its lobe, from the first of two directions: linear
// in a table of 32 cosines, 28 slopes of the half vector and 9 azimuths (kernels/scatter/lobe_ratio.h).
const azimuthPlace = (cosine) => {
  const x = Math.min(Math.abs(cosine), 1);
  const angle = Math.sqrt(1 - x) * (1.5707288 + x * (-0.2121144 + x * (0.074261 - x * 0.0187293)));
  return (8 / Math.PI) * (cosine < 0 ? Math.PI - angle : angle);
};
function returnedRatio(values, width, own, other) {
  const sum = added(own, other),
    across = sum[0] * sum[0] + sum[1] * sum[1],
    sin2 = own[0] * own[0] + own[1] * own[1];
  const largest = (1 + Math.sqrt(Math.max(1 - own[2] * own[2], 0))) / Math.max(own[2], 0.01);
  const u = Math.min(Math.sqrt(across) / Math.max(sum[2], 1e-15) / largest, 1),
    k = (8 * width) / largest;
  const along = own[0] * sum[0] + own[1] * sum[1];
  const places = [
    clamp(((Math.sqrt(Math.max(own[2], 0)) - 0.1) * 31) / 0.9, 0, 31),
    ((u * (1 + k)) / (u + k)) * 27,
    azimuthPlace(along / Math.sqrt(Math.max(across * sin2, 1e-30))),
  ];
  const at = places.map((place, axis) => clamp(Math.floor(place), 0, [30, 26, 7][axis]));
  let value = 0;
  for (let corner = 0; corner < 8; ++corner) {
    const step = [corner & 1, (corner >> 1) & 1, corner >> 2];
    const weight = step.reduce((product, s, axis) => {
      const t = places[axis] - at[axis];
      return product * (s ? t : 1 - t);
    }, 1);
    value += weight * values[((at[0] + step[0]) * 28 + at[1] + step[1]) * 9 + at[2] + step[2]];
  }
  return value;
}
// Width of a deeper interface's lobe over the half vector in air.
function lobeWidth(lobe, cosI, cosO) {
  if (lobe.ior === 0) return lobe.alpha;
  const isGgx = lobe.distribution === 2,
    term = (x) => (isGgx ? x * Math.sqrt(x) : x * x);
  const sines = [cosI, cosO].map((c) => (1 - c) * (1 + c));
  const normal = (ior, sin2) => Math.sqrt(Math.max(ior * ior - sin2, 0));
  let terms = term(lobe.alpha * (normal(lobe.ior, sines[0]) + normal(lobe.ior, sines[1])));
  for (const [alpha, above, below] of lobe.passages)
    for (const sin2 of sines) terms += term(alpha * Math.abs(normal(below, sin2) - normal(above, sin2)));
  const width = isGgx ? Math.exp(Math.log(Math.max(terms, 1e-30)) / 1.5) : Math.sqrt(terms);
  return clamp(width / Math.max(cosI + cosO, 1e-6), 0.0009765625, 1);
}
function phaseFunction(g, deflection) {
  const d = g < 0 ? square(1 + g) - 2 * g * (1 + deflection) : square(1 - g) + 2 * g * (1 - deflection);
  return ((1 - g) * (1 + g)) / (4 * Math.PI * d * Math.sqrt(Math.max(d, 1e-30)));
}
