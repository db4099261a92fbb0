// The picture of a ping, drawn by the graphics device from its levels; rings and cursor on a canvas above.
import {palette} from './colours.js';
import {beamAt, levelAt, sameBeams, turned} from './ping.js';

const vertex = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4. - 1., 0, 1); }`;

const fragment = `#version 300 es
precision highp float;
precision highp int;
uniform sampler2D levels, beams, colours;   // levels by bin and beam; beam by bearing; colour by brightness
uniform vec2 origin;                        // of the sonar, in pixels
uniform vec2 scale;                         // pixels per metre; in the polar picture pixels per radian and metre
uniform vec2 bearings;                      // the lowest and highest edge
uniform vec2 bins;                          // count, metres
uniform vec2 brightness;                    // brightness of level 0, and per level
uniform bool polar;
out vec4 colour;
const vec3 nothing = vec3(.027, .035, .043);
void main() {
  vec2 p = (gl_FragCoord.xy - origin) / scale;
  float range = polar ? p.y : length(p), bearing = polar ? -p.x : atan(p.x == 0. ? -1e-6 : -p.x, p.y);  // some devices have no atan(0, y)
  if (!polar) bearing += 6.28318531 * ceil((bearings.x - bearing) / 6.28318531);  // the fan may cross +-180 degrees
  float share = (bearing - bearings.x) / (bearings.y - bearings.x);
  int bin = int(floor(range / bins.y));
  colour = vec4(nothing, 1);
  if (share < 0. || share >= 1. || range < 0. || bin >= int(bins.x)) return;
  int beam = int(texelFetch(beams, ivec2(share * 4096., 0), 0).r) - 1;
  if (beam < 0) return;
  int covered = clamp(int(1. / (scale.y * bins.y)), 1, 8);
  float level = 0.;
  for (int k = 0; k < 8; ++k) if (k < covered) level = max(level, texelFetch(levels, ivec2(min(bin + k, int(bins.x) - 1), beam), 0).r);
  float bright = level == 0. ? 0. : clamp(brightness.x + level * 255. * brightness.y, 0., 1.);
  colour = texelFetch(colours, ivec2(int(bright * 255. + .5), 0), 0);
}`;

function programOf(gl) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  return program;
}

function textureOf(gl, unit) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
}

const table_size = 4096, degrees = 180 / Math.PI;
const shortest = (bearing) => bearing - 2 * Math.PI * Math.round(bearing / (2 * Math.PI));
const bearingText = (any, bearing = shortest(any)) => `${(bearing * degrees).toFixed(1)}°` + (Math.abs(bearing) < 5e-4 ? '' : bearing > 0 ? ' port' : ' stbd');
/** Converts a place to metres ahead and to port, and back. */
const metresOf = ({range, bearing}) => [range * Math.cos(bearing), range * Math.sin(bearing)];
const placeOf = ([ahead, port]) => ({range: Math.hypot(ahead, port), bearing: Math.atan2(port, ahead)});

export class Fan {
  constructor(canvas, overlay) {
    this.canvas = canvas;
    this.overlay = overlay;
    this.polar = false;
    this.rings = true;
    this.span_db = 45;
    this.top_db = 0;
    this.marks = [];  // the places of a measurement, at most two
    this.whole();
    const gl = this.gl = canvas.getContext('webgl2', {antialias: false, preserveDrawingBuffer: true});
    if (!gl) return;  // rings, cursor and levels work nonetheless
    this.program = programOf(gl);
    gl.useProgram(this.program);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    for (let unit = 0; unit < 3; ++unit) textureOf(gl, unit);
    for (const [unit, name] of ['levels', 'beams', 'colours'].entries()) gl.uniform1i(this.at(name), unit);
    this.setColours('amber');
  }
  at(name) { return this.gl.getUniformLocation(this.program, name); }

  setColours(name) {
    const gl = this.gl;
    if (!gl) return;
    gl.activeTexture(gl.TEXTURE2);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, palette(name));
  }

  /** Shows a ping. @param top_db the level of the brightest colour */
  show(ping, top_db) {
    const gl = this.gl, old = this.ping;
    this.ping = ping;
    this.top_db = top_db;
    if (gl) {
      gl.activeTexture(gl.TEXTURE0);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, ping.bins, ping.beams, 0, gl.RED, gl.UNSIGNED_BYTE, ping.data);
    }
    if (!old || !sameBeams(old, ping)) this.setBeams(ping);
  }

  setBeams(ping) {
    const gl = this.gl;
    this.low = ping.edges[0];
    this.high = ping.edges[ping.edges.length - 1];
    if (!gl) return;
    const table = new Float32Array(table_size);
    for (let i = 0; i < table_size; ++i) table[i] = 1 + beamAt(ping, this.low + (this.high - this.low) * (i + 0.5) / table_size);
    gl.activeTexture(gl.TEXTURE1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32F, table_size, 1, 0, gl.RED, gl.FLOAT, table);
  }

  /** Shows the whole picture, as large as fits. */
  whole() {
    this.zoom = 1;
    this.shift = [0, 0];  // of the picture's middle, in pixels of the canvas, like all offsets
  }
  moveBy(dx, dy) { this.shiftTo([this.shift[0] + dx, this.shift[1] + dy]); }
  /** Zooms by a factor about a pixel that stays in place. */
  zoomBy(factor, about) {
    const zoom = Math.max(1, Math.min(50, this.zoom * factor)), by = zoom / this.zoom, middle = [this.canvas.width / 2, this.canvas.height / 2];
    this.zoom = zoom;
    this.shiftTo(middle.map((m, i) => (1 - by) * (about[i] - m) + by * this.shift[i]));
  }
  /** Shifts the picture, at most until its edge is in the middle. */
  shiftTo(shift) {
    const most = [this.canvas.width, this.canvas.height].map((size) => (this.zoom - 1) * size / 2);
    this.shift = shift.map((s, i) => Math.max(-most[i], Math.min(most[i], s)));
  }
  /** Marks the start or the end of a measurement; a third mark starts a new one. */
  mark(at) {
    if (this.ping) this.marks = [...this.marks.length === 2 ? [] : this.marks, this.placeAt(...at)];
  }

  /** Returns origin and scale of metres, or of radians and metres, on the canvas; y is up. */
  place() {
    const {scale, origin} = this.wholePlace(), middle = [this.canvas.width / 2, this.canvas.height / 2];
    return {scale: scale.map((s) => s * this.zoom), origin: origin.map((o, i) => middle[i] + (o - middle[i]) * this.zoom + this.shift[i])};
  }
  /** Returns the same for the whole picture. */
  wholePlace() {
    const {width, height} = this.canvas, margin = 26 * devicePixelRatio, far = this.ping.bins * this.ping.bin_m;
    const inner = [width - 2 * margin, height - 2 * margin];
    if (this.polar) {
      const scale = [inner[0] / (this.high - this.low), inner[1] / far];
      return {scale, origin: [margin + this.high * scale[0], margin]};
    }
    const box = {x0: 0, x1: 0, y0: 0, y1: 0};
    for (let i = 0; i <= 90; ++i) {
      const bearing = this.low + (this.high - this.low) * i / 90, x = -far * Math.sin(bearing), y = far * Math.cos(bearing);
      Object.assign(box, {x0: Math.min(box.x0, x), x1: Math.max(box.x1, x), y0: Math.min(box.y0, y), y1: Math.max(box.y1, y)});
    }
    const scale = Math.min(inner[0] / (box.x1 - box.x0), inner[1] / (box.y1 - box.y0));
    return {scale: [scale, scale],
            origin: [width / 2 - (box.x0 + box.x1) / 2 * scale, height / 2 - (box.y0 + box.y1) / 2 * scale]};
  }

  /** Returns the canvas pixel, from the lower left corner, that shows a place. */
  pixelOf(range, bearing) {
    const {scale, origin} = this.place();
    const p = this.polar ? [-turned(this.ping, bearing), range] : [-range * Math.sin(bearing), range * Math.cos(bearing)];
    return [origin[0] + p[0] * scale[0], origin[1] + p[1] * scale[1]];
  }
  placeAt(x, y) {
    const {scale, origin} = this.place(), p = [(x - origin[0]) / scale[0], (y - origin[1]) / scale[1]];
    return this.polar ? {range: p[1], bearing: -p[0]} : {range: Math.hypot(...p), bearing: Math.atan2(-p[0], p[1])};
  }

  fit() {
    const w = Math.round(this.canvas.clientWidth * devicePixelRatio), h = Math.round(this.canvas.clientHeight * devicePixelRatio);
    if (this.canvas.width === w && this.canvas.height === h) return;
    for (const canvas of [this.canvas, this.overlay]) Object.assign(canvas, {width: w, height: h});
  }

  draw() {
    this.fit();
    if (!this.ping || !this.canvas.width) return;
    if (this.gl) this.drawPicture();
    this.drawOverlay();
  }

  drawPicture() {
    const gl = this.gl, ping = this.ping, {scale, origin} = this.place();
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.uniform2f(this.at('origin'), ...origin);
    gl.uniform2f(this.at('scale'), ...scale);
    gl.uniform2f(this.at('bearings'), this.low, this.high);
    gl.uniform2f(this.at('bins'), ping.bins, ping.bin_m);
    gl.uniform2f(this.at('brightness'), (ping.top_db - 255 * ping.step_db - this.top_db) / this.span_db + 1, ping.step_db / this.span_db);
    gl.uniform1i(this.at('polar'), this.polar);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  drawOverlay() {
    const context = this.overlay.getContext('2d'), height = this.overlay.height, far = this.ping.bins * this.ping.bin_m;
    context.clearRect(0, 0, this.overlay.width, height);
    context.font = `${11 * devicePixelRatio}px system-ui, "DejaVu Sans", sans-serif`;
    context.textAlign = 'center';
    const line = (places) => {
      context.beginPath();
      for (const [range, bearing] of places) {
        const [x, y] = this.pixelOf(range, bearing);
        context.lineTo(x, height - y);
      }
      context.stroke();
    };
    const label = (text, range, bearing, dx, dy) => {
      const [x, y] = this.pixelOf(range, bearing), half = context.measureText(text).width / 2 + devicePixelRatio;
      const middle = x + dx * devicePixelRatio, right = this.overlay.width - half;
      if (x < this.overlay.width) context.fillText(text, Math.min(middle, right), height - y + dy * devicePixelRatio);
    };
    const arc = Array.from({length: 121}, (_, i) => this.low + (this.high - this.low) * i / 120);
    context.strokeStyle = 'rgba(150, 175, 190, .28)';
    context.fillStyle = 'rgba(185, 205, 215, .85)';
    line(arc.map((b) => [far, b]));
    if (this.high - this.low < 6.2) for (const b of [this.low, this.high]) line([[0, b], [far, b]]);
    if (this.rings) this.drawRings(far, arc, line, label);
    if (this.cursor) this.drawCross(context, this.cursor, 'rgba(242, 176, 74, .8)');
    this.drawMarks(context, line, label);
  }

  drawRings(far, arc, line, label) {
    const seen = far / this.zoom, step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500].find((s) => seen / s <= 6) ?? 1000;
    const middle = this.placeAt(this.canvas.width / 2, this.canvas.height / 2).bearing;
    const labelled = this.zoom > 1.5 ? Math.max(this.low, Math.min(this.high, middle)) : this.low;
    for (let r = step; r < far * 0.999; r += step) {
      line(arc.map((b) => [r, b]));
      label(`${+r.toFixed(1)} m`, r, labelled, this.polar ? -2 : 16, this.polar ? -3 : 4);
    }
    const turn = (this.high - this.low) * degrees > 200 ? 45 : 15;
    for (let d = Math.ceil(this.low * degrees / turn) * turn; d <= this.high * degrees; d += turn) {
      line([[far * 0.985, d / degrees], [far, d / degrees]]);
      label(`${d > 180 ? d - 360 : d}°`, far, d / degrees, this.polar ? 0 : -14 * Math.sin(d / degrees), this.polar ? -6 : -8 * Math.cos(d / degrees) + 3);
    }
  }

  drawCross(context, [x, y], colour) {
    const height = this.overlay.height, size = devicePixelRatio;
    context.strokeStyle = colour;
    context.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      context.moveTo(x + dx * 4 * size, height - y + dy * 4 * size);
      context.lineTo(x + dx * 12 * size, height - y + dy * 12 * size);
    }
    context.stroke();
  }

  /** Draws the measurement: a straight line in the water, which is curved in the polar picture. */
  drawMarks(context, line, label) {
    const ends = this.marks.map(metresOf), colour = '#f2b04a';
    for (const mark of this.marks) this.drawCross(context, this.pixelOf(mark.range, mark.bearing), colour);
    if (ends.length < 2) return;
    const between = (share) => placeOf(ends[0].map((a, i) => a + share * (ends[1][i] - a)));
    context.strokeStyle = context.fillStyle = colour;
    line(Array.from({length: 65}, (_, i) => between(i / 64)).map(({range, bearing}) => [range, bearing]));
    const middle = between(0.5);
    label(`${this.measured().distance.toFixed(2)} m`, middle.range, middle.bearing, 0, -8);
  }
  /** Returns the distance [m] and the direction [rad], positive to port of ahead, from the first mark to the second;
   *  null without two marks. */
  measured() {
    if (this.marks.length < 2) return null;
    const [a, b] = this.marks.map(metresOf), way = placeOf([b[0] - a[0], b[1] - a[1]]);
    return {distance: way.range, bearing: way.bearing};
  }
  /** @param heading of the sonar, clockwise from north [deg]; undefined: unknown */
  measuredText(heading) {
    const told = this.marks.map(({range, bearing}) => `${range.toFixed(2)} m   ${bearingText(bearing)}`), way = this.measured();
    if (way) told.push(`${way.distance.toFixed(2)} m apart, towards ${bearingText(way.bearing)}` +
        (heading === undefined ? '' : `, ${((heading - way.bearing * degrees + 720) % 360).toFixed(1).padStart(5, '0')}° true`));
    return told.join('\n');
  }

  /** Returns range, bearing (positive to port, as in pictures) and level under the cursor as text. */
  cursorText() {
    if (!this.cursor || !this.ping) return '';
    const {range, bearing} = this.placeAt(...this.cursor), level = levelAt(this.ping, range, bearing);
    if (level === null) return '';
    return `${range.toFixed(2)} m   ${bearingText(bearing)}   ` +
        (level === -Infinity ? 'no echo' : `${level.toFixed(1)} dB`);
  }
}
