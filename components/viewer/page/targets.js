// Target marks, and what the page saves as files: targets as CSV and GeoJSON, the picture as PNG.
import {byId, element, patch} from './dom.js';
import {computeAttitude, attitudeTexts} from './instruments.js';
import {bearingText, change, degrees, lengthIn, lengthUnit, settings} from './settings.js';

/** Rotates a vector by a quaternion [x, y, z, w]. */
function rotated([x, y, z, w], [a, b, c]) {
  const [u, v, t] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * u + y * t - z * v, b + w * v + z * u - x * t, c + w * t + x * v - y * u];
}
/** Returns the position in the world of a place in the middle plane of a fan [m]: range and bearing give no elevation. */
export function getPosition({range, bearing}, {position, orientation}) {
  const away = rotated(orientation, [range * Math.cos(bearing), range * Math.sin(bearing), 0]);
  return position.map((p, i) => p + away[i]);
}
/** Returns range and bearing at which a sonar sees a position. */
export function getPlace(at, {position, orientation: [x, y, z, w]}) {
  const [ahead, port, up] = rotated([-x, -y, -z, w], at.map((a, i) => a - position[i]));
  return {range: Math.hypot(ahead, port, up), bearing: Math.atan2(port, ahead)};
}

const equator = 6378137, flattening = 1 / 298.257223563, e2 = flattening * (2 - flattening);  // WGS 84
/** Returns the world's origin on the earth, {latitude_deg, longitude_deg, height_m} on WGS 84: the `datum` of a
 *  deployment, which its tasks have; undefined: it has none. */
export function findDatum(status) {
  for (const {properties} of status?.tasks ?? []) {
    let found = null;
    try { found = JSON.parse(properties.datum); } catch { /* it has none */ }
    if (Number.isFinite(found?.latitude_deg) && Number.isFinite(found.longitude_deg)) return found;
  }
}
/** Returns latitude, longitude [deg] and height [m] on WGS 84 of a position in the world of x north, y west, z up, by
 *  earth-centred coordinates, exact at any distance. */
export function onEarth([north, west, up], {latitude_deg, longitude_deg, height_m: height = 0}) {
  const [p, l] = [latitude_deg / degrees, longitude_deg / degrees], [sp, cp, sl, cl] = [Math.sin(p), Math.cos(p), Math.sin(l), Math.cos(l)];
  const radius = equator / Math.sqrt(1 - e2 * sp * sp), out = up * cp - north * sp;
  const x = (radius + height) * cp * cl + out * cl + west * sl, y = (radius + height) * cp * sl + out * sl - west * cl;
  const z = (radius * (1 - e2) + height) * sp + north * cp + up * sp, across = Math.hypot(x, y);
  let at = Math.atan2(z, across * (1 - e2)), high = 0;
  for (let i = 0; i < 6; ++i) {
    const r = equator / Math.sqrt(1 - e2 * Math.sin(at) ** 2);
    high = across * Math.cos(at) + z * Math.sin(at) - r * (1 - e2 * Math.sin(at) ** 2);
    at = Math.atan2(z, across * (1 - e2 * r / (r + high)));
  }
  return {latitude: at * degrees, longitude: Math.atan2(y, x) * degrees, height: high};
}

/** Downloads a file. */
function download(name, content, type) {
  const link = element('a', {href: URL.createObjectURL(new Blob([content], {type})), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

const timeText = (us) => us > 1e15 ? new Date(us / 1e3).toISOString() : `${(us * 1e-6).toFixed(3)} s`;
const rounded = (number, digits) => number === undefined || number === null ? '' : String(+number.toFixed(digits));
const csvCell = (text) => /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;

/** Returns the table that other programs read: a line per target, empty where something was unknown.
 *  @param datum that of findDatum(); undefined: unknown */
export function toCsv(targets, datum) {
  const head = ['name', 'time', 'source', 'range_m', 'bearing_starboard_deg', 'sonar_heading_deg', 'bearing_true_deg', 'north_m', 'east_m', 'up_m', 'depth_m',
                'latitude_deg', 'longitude_deg', 'height_m'];
  const lines = targets.map(({name, time_us, source, range, bearing, heading, position, depth}) => {
    const earth = position && datum ? onEarth(position, datum) : {}, starboard = -bearing * degrees;
    return [name, timeText(time_us), source, rounded(range, 3), rounded(starboard, 3), rounded(heading, 3),
            heading === null ? '' : rounded((heading + starboard + 720) % 360, 3),
            rounded(position?.[0], 3), rounded(position && -position[1], 3), rounded(position?.[2], 3), rounded(depth, 3), rounded(earth.latitude, 8), rounded(earth.longitude, 8), rounded(earth.height, 3)].map(csvCell).join(',');
  });
  return [head.join(','), ...lines, ''].join('\n');
}

/** Returns the targets that have a position as GeoJSON (RFC 7946). Without a datum their coordinates are metres east,
 *  north and up of the world's origin, and a member `frame` of the collection says so. */
export function toGeoJson(targets, datum) {
  const features = targets.filter(({position}) => position).map(({name, time_us, source, range, bearing, heading, position, depth}) => {
    const {latitude, longitude, height} = datum ? onEarth(position, datum) : {longitude: -position[1], latitude: position[0], height: position[2]};
    const digits = datum ? 8 : 3, coordinates = [+longitude.toFixed(digits), +latitude.toFixed(digits), +height.toFixed(3)];
    return {type: 'Feature', geometry: {type: 'Point', coordinates},
            properties: {name, time: timeText(time_us), source, range_m: +range.toFixed(3), bearing_starboard_deg: +(-bearing * degrees).toFixed(3),
                         sonar_heading_deg: heading, depth_m: depth}};
  });
  const frame = datum ? {} : {frame: 'local: metres east, north and up of the origin of the deployment; no datum is known'};
  return JSON.stringify({type: 'FeatureCollection', ...frame, features}, null, 1);
}

/** Whether what was remembered is a target. */
function isTarget(one) {
  const isNumber = Number.isFinite, isKnown = (value, check) => value === null || check(value);
  return isNumber(one?.range) && isNumber(one.bearing) && isNumber(one.time_us) && typeof one.name === 'string' && typeof one.source === 'string' &&
      isKnown(one.heading, isNumber) && isKnown(one.depth, isNumber) && isKnown(one.position, (p) => Array.isArray(p) && p.length === 3 && p.every(isNumber));
}

/** The targets that the operator has marked. They are remembered until they are removed. */
export class Targets {
  /** @param changed called when the list has changed  @param datum returns that of findDatum() */
  constructor(section, changed, datum) {
    Object.assign(this, {section, changed, datum});
    byId('csv').onclick = () => download('targets.csv', toCsv(this.list, this.datum()), 'text/csv');
    byId('geojson').onclick = () => download('targets.geojson', toGeoJson(this.list, this.datum()), 'application/geo+json');
    byId('targets').onclick = ({target}) => {
      if (target.dataset.remove !== undefined) this.set(this.list.filter((_, i) => i !== Number(target.dataset.remove)));
    };
    byId('targets').onchange = ({target}) => this.set(this.list.map((one, i) => i === Number(target.dataset.name) ? {...one, name: target.value} : one));
    this.show();
  }
  get list() { return settings.targets.filter(isTarget); }
  set(targets) {
    change({targets});
    this.show();
    this.changed();
  }
  /** Marks a place of a ping. @param snapshot where the sonar was; undefined: unknown */
  add({range, bearing}, ping, snapshot) {
    const numbers = this.list.map(({name}) => Number(/^T(\d+)$/.exec(name)?.[1] ?? 0)), position = snapshot ? getPosition({range, bearing}, snapshot) : null;
    const depth = position && snapshot.water_surface !== undefined ? snapshot.water_surface - position[2] : null;
    this.set([...this.list, {name: `T${Math.max(0, ...numbers) + 1}`, time_us: ping.time_us, source: ping.source, range, bearing,
                             heading: snapshot ? +computeAttitude(snapshot).heading.toFixed(3) : null, position, depth}]);
  }
  /** Returns the targets as a sonar at a snapshot sees them. */
  seenFrom(snapshot) {
    return this.list.map((one) => ({name: one.name, ...(one.position && snapshot ? getPlace(one.position, snapshot) : one)}));
  }
  /** Shows the list; the section is there while it has something to show. */
  show() {
    this.section.hidden = !this.list.length;
    const deep = this.list.every(({depth}) => depth !== null), cell = (text) => ['td', {class: 'n'}, text], number = (m) => lengthIn(m).toFixed(1), unit = lengthUnit();
    const head = ['name', 'time', `range ${unit}`, 'bearing', 'north', 'east', deep ? 'depth' : 'up'].map(
        (text, i) => ['th', {scope: 'col', class: i > 1 ? 'n' : undefined}, text]);
    const rows = this.list.map(({name, time_us, range, bearing, heading, position, depth}, i) => ['tr', {},
      ['td', {}, ['input', {'data-name': i, value: name, 'aria-label': `name of target ${i + 1}`}]],
      ['td', {}, timeText(time_us).replace(/.*T|[.]\d*Z/g, '')], cell(number(range)), cell(bearingText(bearing, heading ?? undefined)),
      ...(position ? [position[0], -position[1], deep ? depth : position[2]].map((x) => cell(number(x))) : [['td', {colspan: 3}, 'position unknown']]),
      ['td', {}, ['button', {'data-remove': i, 'aria-label': `remove target ${name}`}, '×']]]);
    patch(byId('targets'), [['thead', {}, ['tr', {}, ...head, ['td', {}]]], ['tbody', {}, ...rows]]);
    for (const input of byId('targets').querySelectorAll('input')) if (input !== document.activeElement) input.value = input.getAttribute('value');
  }
}

const caption_px = 22;

/** Returns the picture with its overlays, and a line that names the ping. */
function makePicture(fan, attitude) {
  const {width, height} = fan.canvas, caption = caption_px * devicePixelRatio;
  const canvas = element('canvas', {width, height: height + caption}), context = canvas.getContext('2d');
  context.fillStyle = '#0a0d10';
  context.fillRect(0, 0, width, height + caption);
  for (const layer of [fan.canvas, fan.overlay]) context.drawImage(layer, 0, 0);
  context.fillStyle = '#b9c4cd';
  context.font = `${12 * devicePixelRatio}px system-ui, "DejaVu Sans", sans-serif`;
  const told = Object.entries(attitude ? attitudeTexts(attitude) : {}).map(([name, text]) => `${name} ${text}`);
  context.fillText([fan.ping.source, `${(fan.ping.time_us * 1e-6).toFixed(3)} s`, ...told].join('   '), caption / 3, height + 0.7 * caption, width - caption);
  return canvas;
}

/** Downloads the picture as SOURCE_MICROSECONDS.png. */
export async function savePicture(fan, attitude) {
  if (!fan.ping) return;
  const {source, time_us} = fan.ping;
  fan.draw();
  download(`${source}_${time_us}.png`, await new Promise((done) => makePicture(fan, attitude).toBlob(done, 'image/png')), 'image/png');
}
