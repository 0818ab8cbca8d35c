// Light that dyes in layers send out again, which depends on two cosines: interpolated between few nodes of both.
function dyedState(material) {
  const { nodes, isLower, numbers, through } = material.dyed;
  const byBand = Array.from({ length: material.bands.count }, (_, b) => through.subarray(b * NODES, (b + 1) * NODES));
  return { nodes, isLower, numbers, through: byBand };
}
// Values at a cosine of the polynomials that are 1 at one node each.
function nodeWeights(nodes, cosine) {
  return nodes.map((own, k) =>
    nodes.reduce((weight, other, j) => (j === k ? weight : (weight * (cosine - other)) / (own - other)), 1),
  );
}
// What the stack would let through if it were clear; the numbers are over it.
const letThrough = (dyed, band, cosine) => lookUp(dyed.through[band], cosine);

// What is sent out to the nodes, by band: `arriving(q, b)` is light at a node of the incident cosine.
function sentToNodes(dyed, bands, arriving) {
  const count = dyed.nodes.length;
  const light = dyed.nodes.map((_, q) => Float64Array.from({ length: bands }, (__, b) => arriving(q, b)));
  let at = 0;
  return dyed.nodes.map(() => {
    const sent = new Float64Array(bands);
    for (let q = 0; q < count; ++q)
      for (let o = 0; o < bands; ++o)
        for (let i = 0; i < (dyed.isLower ? o + 1 : bands); ++i) sent[o] += dyed.numbers[at++] * light[q][i];
    return sent;
  });
}
// Of a lamp's light from one direction, its cosine not included.
function dyedSent(dyed, cosine, light) {
  const weights = nodeWeights(dyed.nodes, cosine);
  return sentToNodes(dyed, light.length, (q, b) => weights[q] * letThrough(dyed, b, cosine) * light[b]);
}
// Of light from all around, cosines included.
function dyedSentAround(dyed, radiance) {
  const steps = 24;
  const directions = Array.from({ length: steps }, (_, k) => {
    const cosine = (k + 0.5) / steps;
    return { cosine, weights: nodeWeights(dyed.nodes, cosine) };
  });
  const share = (q, b) =>
    directions.reduce((sum, { cosine, weights }) => sum + weights[q] * cosine * letThrough(dyed, b, cosine), 0);
  return sentToNodes(dyed, radiance.length, (q, b) => ((2 * Math.PI) / steps) * share(q, b) * radiance[b]);
}
// What of it goes towards a cosine, whose weights of the nodes are known.
const dyedSeenAt = (dyed, sent, weights, band, cosine) =>
  letThrough(dyed, band, cosine) * sent.reduce((sum, one, p) => sum + weights[p] * one[band], 0);
function dyedSeen(dyed, sent, cosine) {
  const weights = nodeWeights(dyed.nodes, cosine);
  return Array.from(sent[0], (_, band) => dyedSeenAt(dyed, sent, weights, band, cosine));
}
// Tables of what a lamp's light sends to each node, by band and incident cosine.
function dyedTables(dyed, lamp) {
  const byNode = Array.from({ length: NODES }, (_, k) => dyedSent(dyed, nodeCosine(k), lamp));
  return dyed.nodes.map((_, p) => lamp.map((__, b) => Float64Array.from(byNode, (sent) => sent[p][b])));
}
