// What the camera sees at a pixel, in double: as render.glsl finds it.
const EYE = 4.2,
  VIEW_SCALE = Math.tan((17 * Math.PI) / 180);
const SHAPES = { sphere: 'Sphere', flat5: 'Flat, 5°', flat20: 'Flat, 20°', flat60: 'Flat, 60°', mesh: 'My own shape' };
const FLAT_TILTS = { flat5: 5, flat20: 20, flat60: 60 };
const radians = (degrees) => (degrees * Math.PI) / 180;

const lampDirection = (view) => {
  const across = radians(view.lampAcross),
    up = radians(view.lampUp);
  return [Math.sin(across) * Math.cos(up), Math.sin(up), Math.cos(across) * Math.cos(up)];
};
// Columns of the object's frame in the world.
function objectTurn(view) {
  const a = radians(view.turnAcross),
    b = radians(view.turnUp - (FLAT_TILTS[view.shape] || 0));
  const [ca, sa, cb, sb] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b)];
  return [
    [ca, sa * sb, -sa * cb],
    [0, cb, sb],
    [sa, -ca * sb, ca * cb],
  ];
}
const turned = (columns, v) => [0, 1, 2].map((k) => columns[0][k] * v[0] + columns[1][k] * v[1] + columns[2][k] * v[2]);
const turnedBack = (columns, v) => columns.map((column) => dot(column, v));

function rayAt(x, y, width, height) {
  return unit([((2 * x - width) / height) * VIEW_SCALE, ((height - 2 * y) / height) * VIEW_SCALE, -1]);
}
function meshHit(mesh, columns, ray) {
  const eye = turnedBack(columns, [0, 0, EYE]),
    way = turnedBack(columns, ray);
  let nearest = Infinity,
    normal = null;
  for (let t = 0; t < mesh.positions.length; t += 9) {
    const corner = (k) => mesh.positions.slice(t + 3 * k, t + 3 * k + 3);
    const a = corner(0),
      e1 = added(corner(1), scaled(a, -1)),
      e2 = added(corner(2), scaled(a, -1));
    const p = crossed(way, e2),
      det = dot(e1, p);
    if (Math.abs(det) < 1e-12) continue;
    const from = added(eye, scaled(a, -1)),
      u = dot(from, p) / det,
      q = crossed(from, e1),
      v = dot(way, q) / det;
    const along = dot(e2, q) / det;
    if (u < 0 || v < 0 || u + v > 1 || along <= 0 || along >= nearest) continue;
    nearest = along;
    const n = (k) => scaled(mesh.normals.slice(t + 3 * k, t + 3 * k + 3), [1 - u - v, u, v][k]);
    normal = added(n(0), added(n(1), n(2)));
  }
  return normal ? unit(turned(columns, normal)) : null;
}
function normalAt(view, mesh, ray) {
  const columns = objectTurn(view);
  if (view.shape === 'mesh') return mesh ? meshHit(mesh, columns, ray) : null;
  if (view.shape in FLAT_TILTS) {
    const normal = columns[2],
      along = dot(normal, ray),
      t = (-normal[2] * EYE) / along;
    const point = turnedBack(columns, added([0, 0, EYE], scaled(ray, t)));
    if (!(t > 0) || Math.max(Math.abs(point[0]), Math.abs(point[1])) > 1) return null;
    return along > 0 ? scaled(normal, -1) : normal;
  }
  const b = EYE * ray[2],
    root = b * b - EYE * EYE + 1;
  return root < 0 ? null : unit(added([0, 0, EYE], scaled(ray, -b - Math.sqrt(root))));
}
function localOf(normal, w) {
  const x = unit(crossed(Math.abs(normal[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], normal));
  return [dot(w, x), dot(w, crossed(normal, x)), dot(w, normal)];
}
// Directions to lamp and eye in the frame of the surface that a pixel shows; null beside the object.
function directionsAt(view, mesh, x, y, width, height) {
  const ray = rayAt(x, y, width, height),
    normal = normalAt(view, mesh, ray);
  if (!normal) return null;
  const wo = localOf(normal, scaled(ray, -1));
  return wo[2] > 0 ? { wi: localOf(normal, lampDirection(view)), wo } : null;
}
