// Heading, depth and attitude of the sonar's carrier, shown over the picture.
import {svg} from './graph.js';
import {element} from './tables.js';

const degrees = 180 / Math.PI;

/** Converts a pose in the world of x north, y west, z up: heading clockwise from north [0, 360), pitch positive down,
 *  roll positive to starboard [deg], z [m]; depth [m] if the surface is known. */
export function attitudeOf({position, orientation: [x, y, z, w]}, water_surface) {
  const north = 1 - 2 * (y * y + z * z), west = 2 * (x * y + w * z), up = 2 * (x * z - w * y);
  return {
    heading: (Math.atan2(-west, north) * degrees + 360) % 360,
    pitch: -Math.asin(Math.max(-1, Math.min(1, up))) * degrees,
    roll: Math.atan2(2 * (y * z + w * x), 1 - 2 * (x * x + y * y)) * degrees,
    z: position[2],
    depth: water_surface === undefined ? undefined : water_surface - position[2],
  };
}

const aside = (angle, positive, negative) => `${Math.abs(angle).toFixed(1)}°` + (Math.abs(angle) < 0.05 ? '' : ` ${angle > 0 ? positive : negative}`);

/** Returns the texts to show, by name. */
export function attitudeTexts(it) {
  return {
    heading: `${it.heading.toFixed(1).padStart(5, '0')}°`.replace('360.0', '000.0'),
    ...(it.depth === undefined ? {z: `${it.z.toFixed(2)} m`} : {depth: `${it.depth.toFixed(2)} m`}),
    pitch: aside(it.pitch, 'down', 'up'),
    roll: aside(it.roll, 'stbd', 'port'),
  };
}

/** Draws an artificial horizon: a line that stays level while the vehicle rolls and pitches. */
function horizon({pitch, roll}) {
  const turn = `rotate(${-roll} 22 22) translate(0 ${-Math.max(-40, Math.min(40, pitch)) * 0.4})`;
  const line = (d, colour, transform = '') => svg('path', {d, stroke: colour, fill: 'none', transform});
  const made = svg('svg', {viewBox: '0 0 44 44'});
  made.append(svg('circle', {cx: 22, cy: 22, r: 20, fill: '#12303c', stroke: '#45535f'}),
              line('M6,22 H38', '#9fdbe6', turn), line('M12,22 H18 M26,22 H32 M22,20 V24', '#f2b04a'));
  return made;
}

export function showAttitude(place, it) {
  place.hidden = !it;
  if (!it) return;
  const texts = Object.entries(attitudeTexts(it)).flatMap(([name, text]) => [element('i', {}, name), element('span', {}, text)]);
  place.replaceChildren(horizon(it), ...texts);
}
