// The operator's settings, remembered by this browser, and numbers written as they say.
import {element} from './dom.js';

const memory = 'insonify.view';
/** Settings with a choice, as the dialog shows them: title, and a word for each value. The first is the default. */
const choices = {
  units: ['lengths and speeds', {metric: 'm, m/s', imperial: 'ft, kn'}],
  bearings: ['bearings', {sides: '12.0° port, 12.0° stbd', starboard: 'starboard is positive', port: 'port is positive', true: 'from north, 000° to 360°'}],
  up: ['pictures are', {heading: 'heading up', north: 'north up'}],
  theme: ['theme', {dark: 'dark', light: 'light'}],
  alarm: ['when pings stop', {seen: 'show it', heard: 'show it, with a sound'}],
  keys: ['keys without Ctrl or Alt', {on: 'are shortcuts', off: 'do nothing'}],
};
const defaults = {
  ...Object.fromEntries(Object.entries(choices).map(([name, [, words]]) => [name, Object.keys(words)[0]])),
  map: 'amber', low: -45, high: 0, auto: true, held_db: 0, rings: true, polar: false, layout: 'both', profile: false,
  line: false, source: '', task: '', zoom: 1, shift_x: 0, shift_y: 0, targets: [],
};

/** Returns what was remembered, without what no version of the page understands. */
export function understood(text) {
  const found = {...defaults};
  let read = null;
  try { read = JSON.parse(text); } catch { /* nothing is remembered */ }
  for (const [name, value] of Object.entries(read ?? {})) {
    if (!Object.hasOwn(defaults, name) || typeof value !== typeof defaults[name] || Array.isArray(value) !== Array.isArray(defaults[name])) continue;
    if (Object.hasOwn(choices, name) && !Object.hasOwn(choices[name][1], value)) continue;
    if (typeof value === 'number' && !Number.isFinite(value)) continue;
    found[name] = value;
  }
  return found;
}
function remembered() {
  try { return localStorage.getItem(memory); } catch { return null; }  // a browser may forbid it
}

export const settings = understood(remembered());
const heard = [];
/** Calls `listener` after each change of a setting. */
export const onSettings = (listener) => heard.push(listener);
export function change(values) {
  Object.assign(settings, values);
  try { localStorage.setItem(memory, JSON.stringify(settings)); } catch { /* the settings hold until the page is closed */ }
  for (const listener of heard) listener(values);
}

export const degrees = 180 / Math.PI;
const foot = 0.3048, knot = 1852 / 3600;
/** Returns a length in the chosen unit, as a number. */
export const lengthIn = (metres) => settings.units === 'metric' ? metres : metres / foot;
export const lengthUnit = () => settings.units === 'metric' ? 'm' : 'ft';
export const lengthText = (metres, digits = 2) => `${lengthIn(metres).toFixed(settings.units === 'metric' ? digits : Math.min(digits, 1))} ${lengthUnit()}`;
export const speedText = (m_s) => settings.units === 'metric' ? `${m_s.toFixed(2)} m/s` : `${(m_s / knot).toFixed(1)} kn`;
/** Returns an angle [rad] within half a turn of 0. */
export const shortest = (angle) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
export const courseText = (deg, digits = 1) => `${((deg % 360 + 360) % 360).toFixed(digits).padStart(digits ? digits + 4 : 3, '0')}°`.replace(/^360/, '000');
/** Returns a bearing as text: a side or a sign, never both.
 *  @param rad positive to port of ahead  @param heading clockwise from north [deg]; undefined: unknown */
export function bearingText(rad, heading, digits = 1) {
  const port = +(shortest(rad) * degrees).toFixed(digits), size = `${Math.abs(port).toFixed(digits)}°`;
  if (settings.bearings === 'true' && heading !== undefined) return courseText(heading - port, digits);
  if (settings.bearings === 'sides' || settings.bearings === 'true') return size + (port === 0 ? '' : port > 0 ? ' port' : ' stbd');
  const positive = settings.bearings === 'port' ? port : -port;
  return port === 0 ? size : (positive > 0 ? '+' : '-') + size;
}

/** The keys of the page: name, what it does. Main binds them. */
export const shortcuts = [
  ['Space', 'freeze the picture, or go on'], ['.', 'back to the newest ping'], ['[ ]', 'one ping back, one ahead'], ['p', 'play the last minute from here'],
  ['+ -', 'zoom'], ['0', 'the whole picture'], ['f', 'fan, or bearing over range'], ['n', 'north up, or heading up'],
  ['m', 'measure'], ['t', 'mark targets'], ['l', 'range and bearing line'], ['b', 'profile of a beam'], ['g', 'rings'],
  ['c', 'next colours'], ['a', 'automatic gain'], ['s', 'save the picture'], ['r', 'record, or stop'],
  ['1 2 3', 'both pictures, the fan alone, the scene alone'], ['?', 'this list'], ['Escape', 'end measuring and marking'],
];
const in_pictures = [
  ['arrows', 'move the cursor in the fan, turn the scene'], ['Enter', 'what a click does there'], ['Shift+Enter', 'what made the bin'],
];

/** Fills the dialog of settings and keys. */
export function fillDialog(dialog) {
  const lists = Object.entries(choices).map(([name, [title, words]]) => {
    const list = element('select', {id: `set_${name}`, onchange: () => change({[name]: list.value})},
                         ...Object.entries(words).map(([value, text]) => element('option', {value}, text)));
    list.value = settings[name];
    onSettings(() => { list.value = settings[name]; });
    return element('label', {}, element('span', {}, title), list);
  });
  const keys = (text) => element('dt', {}, ...text.split(' ').map((one) => element('kbd', {}, one)));
  const table = (rows) => element('dl', {}, ...rows.flatMap(([text, what]) => [keys(text), element('dd', {}, what)]));
  dialog.append(element('h2', {id: 'dialog_title'}, 'settings and keys'), element('div', {className: 'choices'}, ...lists), table(shortcuts),
                element('h3', {}, 'in a picture that has the focus'), table(in_pictures),
                element('button', {autofocus: true, onclick: () => dialog.close()}, 'close'));
}
