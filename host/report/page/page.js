'use strict';
// What the pages share: elements, numbers that came as base64, charts of spectra.
function decode(text, Type) {
  const raw = atob(text),
    bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return new Type(bytes.buffer);
}
function make(tag, properties, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}
const number = (v) => (v === null || !isFinite(v) ? '-' : Number(v).toPrecision(4));
const clamp = (v, low, high) => Math.min(high, Math.max(low, v));
const bandAt = (grid, nm) => clamp(Math.round((nm - grid.from) / grid.step), 0, grid.count - 1);
// A colour of page.css, as the page is shown: light or dark.
const ink = (name) =>
  getComputedStyle(document.documentElement)
    .getPropertyValue('--' + name)
    .trim();

// A chart of series { label, from, step, values } over nm, on a canvas of twice the pixels that it takes.
const seriesColours = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9'];
const chartEdge = { left: 104, right: 16, top: 16, bottom: 44 };
function chartRange(series) {
  const last = (one) => one.from + (one.values.length - 1) * one.step;
  return {
    low: Math.min(...series.map((one) => one.from)),
    high: Math.max(...series.map(last)),
    top: Math.max(1e-30, ...series.flatMap((one) => one.values.filter((v) => v !== null && isFinite(v)))),
  };
}
function chartPlaces(canvas, { low, high, top }) {
  const width = canvas.width - chartEdge.left - chartEdge.right,
    height = canvas.height - chartEdge.top - chartEdge.bottom;
  return {
    x: (nm) => chartEdge.left + ((nm - low) / (high - low || 1)) * width,
    y: (v) => chartEdge.top + height * (1 - v / top),
    nm: (x) => clamp(low + ((x - chartEdge.left) / width) * (high - low), low, high),
  };
}
// Wavelength under the pointer.
function chartNm(canvas, series, event) {
  const box = canvas.getBoundingClientRect();
  return chartPlaces(canvas, chartRange(series)).nm(((event.clientX - box.left) * canvas.width) / box.width);
}
function drawAxes(g, canvas, { low, high, top }, { x, y }) {
  const line = (x0, y0, x1, y1) => {
    g.beginPath();
    g.moveTo(x0, y0);
    g.lineTo(x1, y1);
    g.stroke();
  };
  g.font = '20px sans-serif';
  g.fillStyle = ink('faint');
  g.strokeStyle = ink('grid');
  g.lineWidth = 1;
  g.textAlign = 'center';
  for (let nm = Math.ceil(low / 100) * 100; nm <= high; nm += 100) {
    line(x(nm), y(0), x(nm), y(top));
    g.fillText(nm, x(nm), canvas.height - 6);
  }
  g.textAlign = 'right';
  for (const share of [0, 0.5, 1]) {
    line(x(low), y(share * top), x(high), y(share * top));
    g.fillText((share * top).toPrecision(2), chartEdge.left - 6, y(share * top) + 7);
  }
}
function drawChart(canvas, series, markedNm) {
  const g = canvas.getContext('2d');
  g.clearRect(0, 0, canvas.width, canvas.height);
  if (series.length === 0) return;
  const range = chartRange(series),
    places = chartPlaces(canvas, range);
  drawAxes(g, canvas, range, places);
  series.forEach((one, index) => {
    g.strokeStyle = seriesColours[index % seriesColours.length];
    g.lineWidth = 3;
    g.beginPath();
    let down = false;
    one.values.forEach((v, i) => {
      if (v === null || !isFinite(v)) {
        down = false;
        return;
      }
      g[down ? 'lineTo' : 'moveTo'](places.x(one.from + i * one.step), places.y(v));
      down = true;
    });
    g.stroke();
  });
  if (markedNm === null) return;
  g.strokeStyle = ink('ink');
  g.lineWidth = 1;
  g.beginPath();
  g.moveTo(places.x(markedNm), places.y(0));
  g.lineTo(places.x(markedNm), places.y(range.top));
  g.stroke();
}
