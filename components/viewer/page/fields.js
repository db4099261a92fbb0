// Properties of tasks in fields that can be set.
import {byId, element} from './dom.js';
import {change, settings} from './settings.js';
import {upstream} from './status.js';

const setter = (name) => 'set' + name[0].toUpperCase() + name.slice(1);

/** Returns an input that fits the property's type. */
function inputFor(property) {
  if (property.type === 'bool') return element('input', {type: 'checkbox'});
  if (property.type.includes('|') && !property.type.includes(' '))
    return element('select', {}, ...property.type.split('|').map((name) => element('option', {}, name)));
  return element('input', {type: 'text', spellcheck: false, placeholder: property.type.includes('optional') ? 'none' : ''});
}
function put(input, value) {
  if (input.type === 'checkbox') return void (input.checked = value === true);
  const text = String(typeof value === 'number' && !Number.isInteger(value) ? +value.toPrecision(9) : value ?? '');
  if (input.value !== text) input.value = text;  // else an open list or a selection would be lost
}

/** Units that may be written behind a number, by what they measure, in terms of the first. */
const units = [
  {m: 1, km: 1e3, cm: 1e-2, mm: 1e-3, ft: 0.3048, in: 0.0254, nmi: 1852}, {s: 1, ms: 1e-3, us: 1e-6, min: 60, h: 3600},
  {Hz: 1, kHz: 1e3, MHz: 1e6}, {deg: 1, '°': 1, rad: 180 / Math.PI}, {'m/s': 1, kn: 1852 / 3600, 'km/h': 1 / 3.6, 'ft/s': 0.3048},
  {B: 1, kB: 1e3, MB: 1e6, GB: 1e9}, {1: 1, '%': 1e-2},
];

/** Returns the number that a person has written for a property in `unit`: "20", "20 m", "2000 cm", "12,5". Other text is
 *  returned as it is, for the task to judge. Throws an Error for a unit of something else, and for a comma that may stand
 *  for thousands or for a decimal point. */
export function numberText(text, unit) {
  const [, sign, digits, power, behind] = /^([-+]?)(\d[\d.,]*|\.\d+)(e[-+]?\d+)?\s*(\S.*)?$/i.exec(text.trim().replace('µ', 'u')) ?? [];
  if (digits === undefined || (digits.match(/[.,]/g) ?? []).length > 1) return text;
  if (/^[1-9]\d{0,2},\d{3}$/.test(digits))
    throw new Error(`is ${text.trim()}, which may be ${digits.replace(',', '')} or ${digits.replace(',', '.')}; write one of these`);
  const number = sign + digits.replace(',', '.') + (power ?? '');
  if (behind === undefined || behind === unit) return number;
  const table = units.find((one) => Object.hasOwn(one, unit));
  if (!table || !Object.hasOwn(table, behind))
    throw new Error(`is ${text.trim()}; ${unit && unit !== '1' ? `write ${number}, or ${number} ${unit}` : `it has no unit: write ${number}`}` +
        (table && Object.keys(table).length > 2 ? `; also in ${Object.keys(table).filter((one) => one !== unit && one !== '1').join(', ')}` : ''));
  return String(+(Number(number) * (table[behind] / table[unit])).toPrecision(12));
}

/** Returns the key names of a block in flow YAML, without those of nested blocks. */
function getKeys(block) {
  let outer = block.slice(1, -1), before;
  do {
    before = outer;
    outer = outer.replace(/\{[^{}]*\}|\[[^\[\]]*\]/g, '');
  } while (outer !== before);
  return [...outer.matchAll(/(?:^|,)\s*"?(\w+)"?\s*:/g)].map((found) => found[1]);
}

/** Returns the value to set to change a property from `before` to `after`. Setting merges blocks, so removed keys, and
 *  the content of emptied blocks, are set to null. Throws as numberText(). */
function setting({type, unit}, before, after) {
  const text = after.trim(), isBlock = (one) => /^\{.*\}$/s.test(one);
  if (!text) return 'null';
  if (type === 'text' || type === 'text, optional') return JSON.stringify(after);  // it may contain YAML syntax: "a: b #c"
  if (/^(double|integer)/.test(type)) return numberText(after, unit);
  if (!type.startsWith('block') || !isBlock(text) || !isBlock(before ?? '')) return after;
  const kept = getKeys(text), gone = getKeys(before).filter((key) => !kept.includes(key)).map((key) => `${key}: null`);
  return `{${[text.slice(1, -1).trim(), ...gone].filter((part) => part).join(', ')}}`;
}

/** Order of properties: these first, the others in the order of the task. */
export const rank = ({name}) => (['range', 'gain_db', 'gain', 'frequency_khz'].indexOf(name) + 1) || 99;

const readValues = (status, task) => status?.tasks.find((one) => one.name === task)?.properties ?? {};
let last_id = 0;

/** A property's field: its input, and why its last change was refused. Typed text stays in the input until Enter, or
 *  leaving it, sets the property, or Escape restores the value. A property that no running task takes is read-only. */
export function getField(link, task, property, control) {
  const input = inputFor(property), id = `refused_${++last_id}`, said = element('span', {className: 'refused', id, role: 'alert'});
  let is_edited = false, unanswered = 0, is_left_alone = false;
  const held = () => readValues(field.status, task)[property.name];
  const field = {input, said, update(status) {
    field.status = status;
    if (!is_edited && !unanswered) put(input, held());
  }};
  const say = (text) => {
    said.textContent = text;
    input.setAttribute('aria-invalid', text !== '');
  };
  input.setAttribute('aria-label', `${task}.${property.name}` + (property.unit && property.unit !== '1' ? ` [${property.unit}]` : ''));
  input.setAttribute('aria-describedby', id);
  const is_fixed = property.fixed === true;
  if (is_fixed && input.type === 'text') input.readOnly = true;
  input.disabled = !control || (is_fixed && !input.readOnly);
  input.oninput = () => { is_edited = true; };
  input.onchange = async () => {
    is_edited = false;
    is_left_alone = true;
    ++unanswered;
    const {refused} = await changed();
    --unanswered;
    say(refused ?? '');
    if (is_edited || unanswered) return;
    if (refused) put(input, held());
    if (is_left_alone) input.select?.();  // so that typing replaces it
  };
  async function changed() {
    try {
      const value = input.type === 'checkbox' ? input.checked : setting(property, held(), input.value);
      return await link.call(`${task}.${setter(property.name)}`, value);
    } catch (error) {
      return {refused: `${property.name}: ${error.message}`};
    }
  }
  input.onblur = () => { is_edited = is_left_alone = false; };
  input.onpointerdown = () => { is_left_alone = false; };
  input.onkeydown = (event) => {
    is_left_alone = false;  // else a late answer would move the caret while the user types
    if (event.key !== 'Escape') return;
    is_edited = false;
    say('');
    put(input, held());
  };
  return field;
}

/** The properties of one task. */
export class Properties {
  constructor(link) {
    this.link = link;
    byId('task').onchange = () => {
      change({task: byId('task').value});
      this.build();
    };
  }
  setInterfaces({tasks, control}) {
    this.control = control;
    const chosen = byId('task').value || settings.task;
    this.tasks = new Map(tasks.filter((task) => task.properties.length).map((task) => [task.name, task]));
    byId('task').replaceChildren(...[...this.tasks.keys()].map((name) => element('option', {}, name)));
    const sonar = tasks.find((task) => task.properties.some((property) => property.name === 'bin_count'));
    byId('task').value = this.tasks.has(chosen) ? chosen : sonar?.name ?? this.tasks.keys().next().value;
    this.build();
  }
  build() {
    const task = this.tasks.get(byId('task').value);
    this.fields = [];
    const sorted = [...task?.properties ?? []].sort((a, b) => rank(a) - rank(b));
    byId('properties').replaceChildren(...sorted.map((property) => this.row(task.name, property)));
    if (this.status) this.update(this.status);
  }
  row(task, property) {
    const field = getField(this.link, task, property, this.control), cell = (text, kind = '') => element('td', {className: kind}, text);
    const bounds = property.min === null && property.max === null ? '' : ` (${property.min ?? '-inf'} to ${property.max ?? 'inf'})`;
    const fixed = property.fixed ? '; can be set while the task is stopped, in the deployment' : '';
    this.fields.push(field);
    const unit = property.unit === '1' ? '' : property.unit;
    return element('tr', {title: property.doc + bounds + fixed}, cell(property.name), element('td', {}, field.input, field.said), cell(unit, 'dim'));
  }
  update(status) {
    this.status = status;
    for (const field of this.fields ?? []) field.update(status);
  }
}

const first_labels = {range: 'range', gain_db: 'gain', gain: 'gain', frequency_khz: 'frequency'};

/** The properties used most: range, gain and frequency of the sonar that is shown. */
export class First {
  constructor(link, place) {
    this.link = link;
    this.place = place;
    this.fields = [];
  }
  setInterfaces({tasks, control}) {
    this.tasks = tasks;
    this.control = control;
    this.key = null;
  }
  /** Finds for each label the first property of a task that contributes to the pings of `source`. */
  find(source, connections) {
    const made_by = upstream(connections, source), found = new Map();
    for (const task of this.tasks.filter((one) => made_by.has(one.name)))
      for (const property of task.properties)
        if (first_labels[property.name] && !found.has(first_labels[property.name])) found.set(first_labels[property.name], {task: task.name, property});
    return [...found].sort(([, a], [, b]) => rank(a.property) - rank(b.property));
  }
  update(status, source) {
    if (!this.tasks || !source) return;
    const found = this.find(source, status.connections), key = JSON.stringify(found);
    if (key !== this.key) this.build(found);
    this.key = key;
    for (const field of this.fields) field.update(status);
  }
  build(found) {
    this.fields = found.map(([, {task, property}]) => getField(this.link, task, property, this.control));
    this.place.replaceChildren(...found.map(([label, {task, property}], i) =>
        element('label', {title: `${task}.${property.name}: ${property.doc}`}, label, this.fields[i].input, property.unit, ' ', this.fields[i].said)));
  }
}
