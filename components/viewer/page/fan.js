// The picture of a ping, drawn by the graphics device from its levels; rings and cursor on a canvas above.
import {beamAt, levelAt, sameBeams, turned} from './ping.js';
import {bearingText, courseText, degrees, lengthIn, lengthText, lengthUnit, shortest} from './settings.js';

/** Colour maps: anchors [level, red, green, blue], linear in between; the first map is that of the picture files. */
const anchors = {
  amber: [[0, 6, 5, 6], [40, 44, 22, 6], [96, 120, 62, 8], [150, 204, 118, 14], [200, 246, 180, 48], [235, 255, 226, 140],
          [255, 255, 252, 236]],
  copper: [[0, 0, 0, 0], [203, 255, 159, 101], [255, 255, 199, 127]],
  gray: [[0, 0, 0, 0], [255, 255, 255, 255]],
  ice: [[0, 2, 6, 14], [70, 8, 44, 92], [140, 24, 118, 176], [205, 120, 206, 232], [255, 244, 255, 255]],
  viridis: [[0, 68, 1, 84], [64, 59, 82, 139], [128, 33, 145, 140], [191, 94, 201, 98], [255, 253, 231, 37]],
  inferno: [[0, 0, 0, 4], [51, 66, 10, 104], [102, 147, 38, 103], [153, 221, 81, 58], [204, 252, 165, 10], [255, 252, 255, 164]],
};

export const names = Object.keys(anchors);

/** Returns 256 colours of 4 bytes. */
export function palette(name) {
  const list = anchors[name], colours = new Uint8Array(1024);
  for (let level = 0, i = 0; level < 256; ++level) {
    while (level > list[i + 1][0]) ++i;
    const share = (level - list[i][0]) / (list[i + 1][0] - list[i][0]);
    for (let c = 0; c < 3; ++c) colours[4 * level + c] = Math.round(list[i][c + 1] * (1 - share) + list[i + 1][c + 1] * share);
    colours[4 * level + 3] = 255;
  }
  return colours;
}

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
uniform float turn;                         // from a bearing to its direction in the picture
out vec4 colour;
const vec3 nothing = vec3(.027, .035, .043);
void main() {
  vec2 p = (gl_FragCoord.xy - origin) / scale;
  float range = polar ? p.y : length(p), bearing = polar ? -p.x : atan(p.x == 0. ? -1e-6 : -p.x, p.y) - turn;  // some devices have no atan(0, y)
  if (!polar) bearing += 6.28318531 * ceil((bearings.x - bearing) / 6.28318531);  // the fan may cross +-180 degrees
  float share = (bearing - bearings.x) / (bearings.y - bearings.x);
  int bin = int(floor(range / bins.y));
  colour = vec4(nothing, 1);
  if (share < 0. || share >= 1. || range < 0. || bin >= int(bins.x)) return;
  int beam = int(texelFetch(beams, ivec2(share * 4096., 0), 0).r) - 1;
  if (beam < 0) return;
  int covered = clamp(int(1. / (scale.y * bins.y)), 1, 8);
  float level = 0.;
  for (int k = 0; k < covered; ++k) level = max(level, texelFetch(levels, ivec2(min(bin + k, int(bins.x) - 1), beam), 0).r);
  float bright = level == 0. ? 0. : clamp(brightness.x + level * 255. * brightness.y, 0., 1.);
  colour = texelFetch(colours, ivec2(int(bright * 255. + .5), 0), 0);
}`;

function makeProgram(gl) {
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

function makeTexture(gl, unit) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
}

const table_size = 4096;
/** Converts a place to metres ahead and to port, and back. */
const getMetres = ({range, bearing}) => [range * Math.cos(bearing), range * Math.sin(bearing)];
const getPlace = ([ahead, port]) => ({range: Math.hypot(ahead, port), bearing: Math.atan2(port, ahead)});

export class Fan {
  constructor(canvas, overlay) {
    this.canvas = canvas;
    this.overlay = overlay;
    this.polar = false;
    this.rings = true;
    this.span_db = 45;
    this.top_db = 0;
    this.turn = 0;       // from a bearing to its direction in the picture, positive to port [rad]
    this.heading = undefined;  // of the sonar, clockwise from north [deg]; undefined: unknown
    this.marks = [];     // the places of a measurement, at most two
    this.targets = [];   // {name, range, bearing}
    this.line = null;    // the place to which the range and bearing line leads
    this.whole();
    const gl = this.gl = canvas.getContext('webgl2', {antialias: false, preserveDrawingBuffer: true});
    if (!gl) return;  // rings, cursor and levels work nonetheless
    this.program = makeProgram(gl);
    this.uniforms = {};
    gl.useProgram(this.program);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    for (let unit = 0; unit < 3; ++unit) makeTexture(gl, unit);
    for (const [unit, name] of ['levels', 'beams', 'colours'].entries()) gl.uniform1i(this.at(name), unit);
    this.setColours('amber');
  }
  at(name) { return this.uniforms[name] ??= this.gl.getUniformLocation(this.program, name); }

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
  /** Turns the picture so that north is up, or ahead if `is_north_up` is false or no heading is known. */
  orient(is_north_up, heading) {
    this.heading = heading;
    this.is_turned = is_north_up && heading !== undefined && !this.polar;
    this.turn = this.is_turned ? -heading / degrees : 0;
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
    if (this.is_turned) Object.assign(box, {x0: -far, x1: far, y0: -far, y1: far});  // one scale on all headings
    else for (let i = 0; i <= 90; ++i) {
      const bearing = this.low + (this.high - this.low) * i / 90, x = -far * Math.sin(bearing), y = far * Math.cos(bearing);
      Object.assign(box, {x0: Math.min(box.x0, x), x1: Math.max(box.x1, x), y0: Math.min(box.y0, y), y1: Math.max(box.y1, y)});
    }
    const scale = Math.min(inner[0] / (box.x1 - box.x0), inner[1] / (box.y1 - box.y0));
    return {scale: [scale, scale],
            origin: [width / 2 - (box.x0 + box.x1) / 2 * scale, height / 2 - (box.y0 + box.y1) / 2 * scale]};
  }

  /** Returns the canvas pixel, from the lower left corner, that shows a place. */
  findPixel(range, bearing) {
    const {scale, origin} = this.place();
    const p = this.polar ? [-turned(this.ping, bearing), range] : [-range * Math.sin(bearing + this.turn), range * Math.cos(bearing + this.turn)];
    return [origin[0] + p[0] * scale[0], origin[1] + p[1] * scale[1]];
  }
  placeAt(x, y) {
    const {scale, origin} = this.place(), p = [(x - origin[0]) / scale[0], (y - origin[1]) / scale[1]];
    return this.polar ? {range: p[1], bearing: -p[0]} : {range: Math.hypot(...p), bearing: shortest(Math.atan2(-p[0], p[1]) - this.turn)};
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
    gl.uniform1f(this.at('turn'), this.turn);
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
        const [x, y] = this.findPixel(range, bearing);
        context.lineTo(x, height - y);
      }
      context.stroke();
    };
    const label = (text, range, bearing, dx, dy) => {
      const [x, y] = this.findPixel(range, bearing), half = context.measureText(text).width / 2 + devicePixelRatio;
      const middle = x + dx * devicePixelRatio, right = this.overlay.width - half;
      if (x < this.overlay.width) context.fillText(text, Math.min(middle, right), height - y + dy * devicePixelRatio);
    };
    const arc = Array.from({length: 121}, (_, i) => this.low + (this.high - this.low) * i / 120);
    context.strokeStyle = 'rgba(150, 175, 190, .28)';
    context.fillStyle = 'rgba(185, 205, 215, .85)';
    line(arc.map((b) => [far, b]));
    if (this.high - this.low < 6.2) for (const b of [this.low, this.high]) line([[0, b], [far, b]]);
    if (this.rings) this.drawRings(far, arc, line, label);
    if (this.is_turned) this.drawNorth(context);
    if (this.cursor) this.drawCross(context, this.cursor, 'rgba(242, 176, 74, .8)');
    if (this.line) this.drawLine(this.line, arc, context, line, label);
    this.drawTargets(context);
    this.drawMarks(context, line, label);
  }

  /** Draws the range and bearing line from the sonar, with the circle of its range. */
  drawLine({range, bearing}, arc, context, line, label) {
    context.strokeStyle = context.fillStyle = '#7fd4e8';
    line([[0, bearing], [range, bearing]]);
    line(arc.map((b) => [range, b]));
    label(`${lengthText(range)}  ${bearingText(bearing, this.heading)}`, range, bearing, 0, -8);
  }
  drawTargets(context) {
    context.strokeStyle = context.fillStyle = '#8df08a';
    for (const {name, range, bearing} of this.targets) {
      if (range > this.ping.bins * this.ping.bin_m) continue;
      const [x, up] = this.findPixel(range, bearing), y = this.overlay.height - up, size = 6 * devicePixelRatio;
      context.beginPath();
      context.arc(x, y, size, 0, 2 * Math.PI);
      context.stroke();
      context.fillText(name, x, y - 1.5 * size);
    }
  }
  drawNorth(context) {
    const size = devicePixelRatio, x = 20 * size, y = 62 * size;
    context.fillStyle = context.strokeStyle = '#e4ebf1';
    context.fillText('N', x, y - 14 * size);
    context.beginPath();
    for (const [dx, dy] of [[0, 12], [0, -10], [-4, -3], [0, -10], [4, -3]]) context.lineTo(x + dx * size, y + dy * size);
    context.stroke();
  }

  drawRings(far, arc, line, label) {
    const seen = lengthIn(far) / this.zoom, unit = lengthIn(1), step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500].find((s) => seen / s <= 6) ?? 1000;
    const middle = this.placeAt(this.canvas.width / 2, this.canvas.height / 2).bearing;
    const labelled = this.zoom > 1.5 ? Math.max(this.low, Math.min(this.high, middle)) : this.low;
    for (let n = step; n < lengthIn(far) * 0.999; n += step) {
      const r = n / unit;
      line(arc.map((b) => [r, b]));
      label(`${+n.toFixed(1)} ${lengthUnit()}`, r, labelled, this.polar ? -2 : 16, this.polar ? -3 : 4);
    }
    const turn = (this.high - this.low) * degrees > 200 ? 45 : 15;
    for (let d = Math.ceil(this.low * degrees / turn) * turn; d <= this.high * degrees; d += turn) {
      line([[far * 0.985, d / degrees], [far, d / degrees]]);
      const shown = d / degrees + this.turn;
      label(bearingText(d / degrees, this.heading, 0).replace(/ .*/, ''), far, d / degrees, this.polar ? 0 : -14 * Math.sin(shown), this.polar ? -6 : -8 * Math.cos(shown) + 3);
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
    const ends = this.marks.map(getMetres), colour = '#f2b04a';
    for (const mark of this.marks) this.drawCross(context, this.findPixel(mark.range, mark.bearing), colour);
    if (ends.length < 2) return;
    const between = (share) => getPlace(ends[0].map((a, i) => a + share * (ends[1][i] - a)));
    context.strokeStyle = context.fillStyle = colour;
    line(Array.from({length: 65}, (_, i) => between(i / 64)).map(({range, bearing}) => [range, bearing]));
    const middle = between(0.5);
    label(lengthText(this.measured().distance), middle.range, middle.bearing, 0, -8);
  }
  /** Returns the distance [m] and the direction [rad], positive to port of ahead, from the first mark to the second;
   *  null without two marks. */
  measured() {
    if (this.marks.length < 2) return null;
    const [a, b] = this.marks.map(getMetres), way = getPlace([b[0] - a[0], b[1] - a[1]]);
    return {distance: way.range, bearing: way.bearing};
  }
  measuredText() {
    const told = this.marks.map(({range, bearing}) => `${lengthText(range)}   ${bearingText(bearing, this.heading)}`), way = this.measured();
    if (way) told.push(`${lengthText(way.distance)} apart, towards ${bearingText(way.bearing, this.heading)}` +
        (this.heading === undefined ? '' : `, ${courseText(this.heading - way.bearing * degrees)} true`));
    return told.join('\n');
  }

  /** Returns range, bearing and level under the cursor as text. */
  cursorText() {
    if (!this.cursor || !this.ping) return '';
    const {range, bearing} = this.placeAt(...this.cursor), level = levelAt(this.ping, range, bearing);
    if (level === null) return '';
    return `${lengthText(range)}   ${bearingText(bearing, this.heading)}   ` +
        (level === -Infinity ? 'no echo' : `${level.toFixed(1)} dB`);
  }

  /** Draws the levels of one beam over range, from the darkest level of the picture to the strongest echo; returns what it
   *  shows as text. The beam is that under the cursor, else the last one that was. */
  drawProfile(canvas) {
    const {ping} = this, w = canvas.width = Math.round(canvas.clientWidth * devicePixelRatio), h = canvas.height = Math.round(canvas.clientHeight * devicePixelRatio);
    const under = this.cursor && beamAt(ping, this.placeAt(...this.cursor).bearing);
    if (under >= 0 && under !== null) this.profiled = under;
    const beam = Math.min(this.profiled ?? Math.floor(ping.beams / 2), ping.beams - 1), levels = ping.data.subarray(beam * ping.bins, (beam + 1) * ping.bins);
    const context = canvas.getContext('2d'), low = this.top_db - this.span_db, high = Math.max(this.top_db, ping.top_db);
    const decibels = (level) => ping.top_db - (255 - level) * ping.step_db, toY = (db) => h - 2 - (h - 6) * Math.max(0, Math.min(1, (db - low) / (high - low)));
    context.strokeStyle = '#45535f';
    context.beginPath();
    for (let db = Math.ceil(low / 20) * 20; db < high; db += 20) context.rect(0, toY(db), w, 0);
    context.stroke();
    context.strokeStyle = '#f2b04a';
    context.beginPath();
    levels.forEach((level, i) => context.lineTo((i + 0.5) / ping.bins * w, level ? toY(decibels(level)) : h - 2));
    context.stroke();
    const at = levels.reduce((best, level, i) => level > levels[best] ? i : best, 0), bearing = (ping.edges[2 * beam] + ping.edges[2 * beam + 1]) / 2;
    if (this.cursor) {
      context.fillStyle = '#7fd4e8';
      context.fillRect(this.placeAt(...this.cursor).range / (ping.bins * ping.bin_m) * w, 0, devicePixelRatio, h);
    }
    return `beam ${beam + 1} of ${ping.beams}, ${bearingText(bearing, this.heading)}, ${Math.round(low) + 0} to ${Math.round(high) + 0} dB; ` +
        (levels[at] ? `strongest ${decibels(levels[at]).toFixed(1)} dB at ${lengthText((at + 0.5) * ping.bin_m)}` : 'no echo');
  }
}
