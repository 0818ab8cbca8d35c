// Pages come packed: their script begins when what it shows is unpacked, and the promise `ready` is then kept.
async function inflated(text) {
  if (typeof DecompressionStream === 'undefined')
    throw new Error('This browser cannot unpack the page; current Firefox, Chrome, Edge and Safari can.');
  const stream = new Blob([decode(text, Uint8Array)]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
// Floats whose first, second, third and fourth bytes stand together.
function decodeFloats(text) {
  const planes = decode(text, Uint8Array),
    count = planes.length / 4,
    bytes = new Uint8Array(planes.length);
  for (let i = 0; i < count; ++i) for (let k = 0; k < 4; ++k) bytes[4 * i + k] = planes[k * count + i];
  return new Float32Array(bytes.buffer);
}
let unpacked = null;
async function start() {
  const source = document.getElementById('view-script');
  if (!source) return;
  try {
    const text = await inflated(document.getElementById('view-materials').textContent);
    unpacked = JSON.parse(new TextDecoder().decode(text));
  } catch (error) {
    document.getElementById('message').textContent = error.message;
    return;
  }
  document.body.append(make('script', { textContent: source.textContent }));
}
window.ready = start();
