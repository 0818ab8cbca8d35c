// Draws a material under one model; two pictures with a divider stand side by side on one canvas.
const nodeCosine = (k) => square(k / (NODES - 1));

// A matrix that is no sum of few terms is applied in the script, for every direction of the lamp's light.
function denseTables(state, lamp) {
  const through = (b, c) =>
    state.model === 'adding' ? lookUp(state.transmission[b], c) : straight(state, b, c).through;
  return state.operators.map((operator) => {
    const byNode = Array.from({ length: NODES }, (_, k) =>
      applied(
        operator,
        lamp.map((value, b) => value * through(b, nodeCosine(k))),
      ),
    );
    return lamp.map((_, b) => Float64Array.from(byNode, (sent) => sent[b]));
  });
}
function aroundTable(state, radiance) {
  const of = state.model === 'adding' ? addingAround : weidlichWilkieAround;
  const byNode = Array.from({ length: NODES }, (_, k) => of(state, nodeCosine(k), radiance));
  return radiance.map((_, b) => Float64Array.from(byNode, (one) => one[b]));
}
const GLSL_TYPES = { int: 'uniform1i', float: 'uniform1f' };
const GLSL_ARRAYS = { int: 'uniform1iv', float: 'uniform1fv', bool: 'uniform1iv', vec3: 'uniform3fv' };

class Picture {
  constructor(gl) {
    this.gl = gl;
    this.programs = new Map();
    this.textures = [];
  }
  // Takes a state and the light (radiance of the lamp by band, of what is around it, rows for r, g, b).
  prepare(state, lamp, around, screen) {
    const layout = state.model === 'adding' ? addingLayout(state) : weidlichWilkieLayout(state);
    const isDense = Boolean(state.operators[0].dense),
      rows = [],
      defines = { RR_CHUNKS: chunksOf(lamp.length), RR_NODES: FINE_NODES };
    for (const [name, some] of Object.entries({ LAMP: [lamp], WEIGHT: screen, ...layout.rows })) {
      defines['RR_' + name + '_ROW'] = rows.length;
      rows.push(...some);
    }
    defines.RR_OPERATOR_ROW = rows.length;
    rows.push(...operatorRows(state.operators));
    const tables = [...layout.tables];
    defines.RR_SENT = tables.length;
    if (state.dyed) tables.push(...dyedTables(state.dyed, lamp));
    else if (isDense) tables.push(...denseTables(state, lamp));
    defines.RR_AROUND = tables.length;
    this.isAround = around.some((value) => value > 0);
    if (this.isAround) tables.push(aroundTable(state, around));
    Object.assign(defines, layout.defines, {
      RR_TERMS: state.operators[0].emission.length,
      RR_OPERATORS: state.operators.length,
      RR_DENSE: Number(isDense),
      RR_DYE_NODES: state.dyed ? state.dyed.nodes.length : 0,
    });
    this.uniforms = layout.uniforms;
    this.program = this.programOf(state.model, defines, layout.uniforms);
    this.upload(rows, tables, layout.shapes, lamp.length);
  }
  programOf(model, defines, uniforms) {
    const arrays = Object.keys(uniforms).map((key) => {
      const [type, name] = key.split(' ');
      return (
        'uniform ' +
        type +
        ' ' +
        (name.endsWith('[]') ? name.slice(0, -1) + uniforms[key].length / (type === 'vec3' ? 3 : 1) + ']' : name) +
        ';\n'
      );
    });
    const source =
      Object.entries(defines)
        .map(([name, value]) => '#define ' + name + ' ' + value + '\n')
        .join('') +
      shaderParts.access +
      arrays.join('') +
      shaderParts.material +
      shaderParts[model] +
      shaderParts.render;
    if (!this.programs.has(source)) this.programs.set(source, linkedProgram(this.gl, source));
    return this.programs.get(source);
  }
  upload(rows, tables, shapes, bands) {
    const gl = this.gl,
      widthOf = (k, values) => [17, 17, values.length, 9][k];
    this.textures.forEach((one) => gl.deleteTexture(one));
    this.textures = [
      bandTexture(gl, rows, bands),
      nodeTexture(gl, tables, bands),
      ...shapes.map((values, k) =>
        values ? texture(gl, widthOf(k, values), values.length / widthOf(k, values), values, ['R32F', 'RED']) : null,
      ),
    ];
  }
  setUniforms(view, size, turn) {
    const gl = this.gl,
      at = (name) => gl.getUniformLocation(this.program, name),
      lamp = lampDirection(view);
    for (const [key, value] of Object.entries(this.uniforms)) {
      const [type, name] = key.split(' ');
      if (name.endsWith('[]')) gl[GLSL_ARRAYS[type]](at(name.slice(0, -2)), value);
      else gl[GLSL_TYPES[type]](at(name), value);
    }
    gl.uniform2f(at('rr_size'), size, size);
    gl.uniform3f(at('rr_eye'), 0, 0, EYE);
    gl.uniform3fv(at('rr_eye_of_mesh'), [0, 0, EYE]);
    gl.uniform3fv(at('rr_lamp'), lamp);
    gl.uniform1f(at('rr_view_scale'), VIEW_SCALE);
    gl.uniform1f(at('rr_scale_of_mesh'), VIEW_SCALE);
    gl.uniform1f(at('rr_lamp_sine'), Math.sin(radians(view.lampRadius)));
    const shape = view.shape === 'mesh' ? 2 : view.shape in FLAT_TILTS ? 1 : 0;
    gl.uniform1i(at('rr_shape'), shape);
    gl.uniform1i(at('rr_shape_of_mesh'), shape);
    gl.uniformMatrix3fv(at('rr_turn'), false, turn.flat());
    gl.uniformMatrix3fv(at('rr_turn_of_mesh'), false, turn.flat());
    gl.uniform1f(at('rr_around'), Number(this.isAround));
    ['rr_bands', 'rr_nodes', 'rr_ratios', 'rr_spreads', 'rr_separable', 'rr_returned'].forEach((name, k) => {
      gl.activeTexture(gl.TEXTURE0 + k);
      gl.bindTexture(gl.TEXTURE_2D, this.textures[k] || this.textures[0]);
      gl.uniform1i(at(name), k);
    });
  }
  // Draws the columns from `left` to `right` of a square canvas.
  draw(view, mesh, size, left, right) {
    const gl = this.gl,
      isMesh = view.shape === 'mesh' && mesh;
    if (right <= left) return;
    gl.useProgram(this.program);
    this.setUniforms(view, size, objectTurn(view));
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(left, 0, right - left, size);
    gl.viewport(0, 0, size, size);
    gl[isMesh ? 'enable' : 'disable'](gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const [positions, normals] = isMesh
      ? [mesh.positions, mesh.normals]
      : [
          [-1, -1, 0, 3, -1, 0, -1, 3, 0],
          [0, 0, 1, 0, 0, 1, 0, 0, 1],
        ];
    if (view.shape === 'mesh' && !mesh) return;
    const buffers = [positions, normals].map((values, k) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STREAM_DRAW);
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 0, 0);
      return buffer;
    });
    gl.drawArrays(gl.TRIANGLES, 0, positions.length / 3);
    buffers.forEach((buffer) => gl.deleteBuffer(buffer));
  }
}
