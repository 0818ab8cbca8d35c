// A shape of the reader's own: triangles of an OBJ or PLY file (text), centred in the unit sphere.
function objTriangles(text) {
  const places = [],
    triangles = [];
  text.split(/\r\n|\r|\n/).forEach((line, index) => {
    const words = line.trim().split(/\s+/);
    if (words[0] === 'v') places.push(words.slice(1, 4).map(Number));
    if (words[0] !== 'f') return;
    const corners = words.slice(1).map((word) => {
      const number = parseInt(word, 10),
        at = number < 0 ? places.length + number : number - 1;
      if (!places[at]) throw new Error('line ' + (index + 1) + ' names a corner that is not there');
      return places[at];
    });
    for (let k = 2; k < corners.length; ++k) triangles.push(corners[0], corners[k - 1], corners[k]);
  });
  return triangles;
}
function plyTriangles(text) {
  if (!/format ascii/.test(text.slice(0, 400)))
    throw new Error('a binary PLY is not read here; save it as text (ascii), or as OBJ');
  const [head, body] = text.split(/end_header\s*\n/),
    count = (name) => Number((head.match('element ' + name + '\\s+(\\d+)') || [])[1]);
  const properties = [...head.split('element face')[0].matchAll(/property\s+\w+\s+(\w+)/g)].map((found) => found[1]);
  const axes = ['x', 'y', 'z'].map((axis) => properties.indexOf(axis)),
    lines = body.trim().split(/\r?\n/);
  const places = lines.slice(0, count('vertex')).map((line) => {
    const words = line.trim().split(/\s+/).map(Number);
    return axes.map((k) => words[k]);
  });
  const triangles = [];
  for (const line of lines.slice(count('vertex'), count('vertex') + count('face'))) {
    const corners = line
      .trim()
      .split(/\s+/)
      .map(Number)
      .slice(1)
      .map((k) => places[k]);
    for (let k = 2; k < corners.length; ++k) triangles.push(corners[0], corners[k - 1], corners[k]);
  }
  return triangles;
}
const MOST_TRIANGLES = 200000;

// Normals are those of the corners: the mean of the triangles that meet there.
function meshFromText(text, name) {
  const corners = /^ply/.test(text) ? plyTriangles(text) : objTriangles(text);
  if (corners.length < 3 || corners.some((p) => !p || p.length !== 3 || !p.every(isFinite)))
    throw new Error('no triangles are in this file; OBJ and PLY (ascii) are read');
  if (corners.length > 3 * MOST_TRIANGLES)
    throw new Error('more than ' + MOST_TRIANGLES + ' triangles; reduce the shape first');
  const low = [0, 1, 2].map((k) => corners.reduce((least, p) => Math.min(least, p[k]), Infinity));
  const high = [0, 1, 2].map((k) => corners.reduce((most, p) => Math.max(most, p[k]), -Infinity));
  const middle = low.map((value, k) => 0.5 * (value + high[k]));
  const size = corners.reduce((most, p) => Math.max(most, Math.hypot(...p.map((x, k) => x - middle[k]))), 1e-30);
  const placed = corners.map((p) => p.map((x, k) => (x - middle[k]) / size)),
    sums = new Map();
  for (let t = 0; t < placed.length; t += 3) {
    const normal = crossed(added(placed[t + 1], scaled(placed[t], -1)), added(placed[t + 2], scaled(placed[t], -1)));
    for (let k = 0; k < 3; ++k) {
      const key = placed[t + k].join(' ');
      sums.set(key, added(sums.get(key) || [0, 0, 0], normal));
    }
  }
  return {
    name,
    positions: placed.flat(),
    normals: placed.flatMap((p) => {
      const sum = sums.get(p.join(' '));
      return dot(sum, sum) > 0 ? unit(sum) : [0, 0, 1];
    }),
  };
}
