// What pages with controls share: every control is a labelled input, so that keys and screen readers work it.
const place = (id) => document.getElementById(id);
const fold = (id, summary, ...parts) => {
  const details = make('details', { id }, make('summary', { textContent: summary }), ...parts);
  return details;
};
function picked(id, label, options, value, change) {
  const select = make(
    'select',
    { id, onchange: () => change(select.value) },
    ...options.map(([key, text]) => make('option', { value: key, textContent: text })),
  );
  select.value = value;
  return make('label', { className: 'row' }, make('span', { textContent: label }), select);
}
function slid(id, label, range, value, change, shown) {
  const input = make('input', { type: 'range', id, min: range[0], max: range[1], step: range[2], value });
  const output = make('output', { textContent: shown(value) });
  output.htmlFor = id;
  input.oninput = () => {
    output.textContent = shown(Number(input.value));
    change(Number(input.value));
  };
  return make('label', { className: 'row' }, make('span', { textContent: label }), input, output);
}
function fileRow(id, label, accept, take) {
  const input = make('input', { type: 'file', id, accept });
  input.onchange = () => input.files[0] && take(input.files[0]);
  return make('label', { className: 'row' }, make('span', { textContent: label }), input);
}
function said(text, isError) {
  place('message').textContent = text;
  place('message').classList.toggle('error', Boolean(isError));
}
const attempt = (work) =>
  Promise.resolve()
    .then(work)
    .catch((error) => said(error.message, true));

const times = (value) => '× ' + Number(value).toPrecision(3);
