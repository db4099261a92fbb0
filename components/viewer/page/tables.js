// Tasks, connections, plan and properties as tables, with inputs for what can be changed.
import {isLoss} from './graph.js';

export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes))
    key in made ? made[key] = value : made.setAttribute(key, value);
  made.append(...children);
  return made;
}
const cell = (text, kind = '') => element('td', {className: kind}, text);
const byId = (id) => document.getElementById(id);
const milliseconds = (s) => s === null ? '-' : (s * 1e3).toFixed(s < 0.01 ? 2 : 1);

/** Computes the samples per second of each port, from one status to the next. */
export class Rates {
  update(status) {
    const now = status.sent_s, counts = new Map();
    for (const task of status.tasks)
      for (const port of task.outputs) counts.set(`${task.name}.${port.name}`, port.written);
    if (!this.since || now - this.since > 0.9) {
      this.rates = new Map([...counts].map(([port, n]) => [port, this.counts ? (n - (this.counts.get(port) ?? n)) / (now - this.since) : 0]));
      this.counts = counts;
      this.since = now;
    }
  }
  of(port) { return this.rates?.get(port) ?? 0; }
  /** Returns the rate of the task's busiest port except `state`. */
  ofTask(task) { return Math.max(0, ...task.outputs.filter((port) => port.name !== 'state').map((port) => this.of(`${task.name}.${port.name}`))); }
}

const failed = ['RunTimeError', 'Exception', 'FatalError'];

/** Shows errors as long as they last. Refused settings are reported at their fields. */
export function showTasks(status, rates) {
  const rows = status.tasks.map((task) => element('tr', {title: task.error ? `${task.type}; last error: ${task.error}` : task.type},
      cell(task.name), cell(task.state, task.state), cell(milliseconds(task.cycle_s), 'n'),
      cell(status.lockstep || !task.latency_s ? '-' : milliseconds(task.latency_s), 'n'), cell(rates.ofTask(task).toFixed(1), 'n'), cell(failed.includes(task.state) ? task.error : '', 'refused')));
  const head = element('tr', {}, ...[['task'], ['state'], ['cycle ms', 'n'], ['latency ms', 'n'], ['samples/s', 'n'], ['']].map(
      ([text, kind]) => element('th', {className: kind ?? ''}, text)));
  byId('tasks').replaceChildren(head, ...rows);
}

export function showPlan(status) {
  const parts = [];
  for (const task of status.tasks) {
    if (!task.plan) continue;
    const plan = task.plan, list = element('dl');
    for (const {name, reason} of plan.omitted) list.append(element('dt', {}, name), element('dd', {}, reason));
    const quality = `${plan.rows} rows, ${plan.columns_per_beam} columns per beam, ${plan.slabs} frusta` +
        (plan.predicted_error === null ? '' : `, predicted error ${plan.predicted_error.toPrecision(2)}`);
    parts.push(element('h3', {}, task.name), element('div', {}, quality),
               element('div', {className: 'dim'}, 'compiled: ' + (plan.features.join(', ') || 'nothing beyond the minimum')),
               element('div', {className: 'dim'}, 'run: ' + plan.passes.join(', ')));
    if (plan.omitted.length) parts.push(element('h3', {}, 'omitted'), list);
    for (const notice of plan.notices) parts.push(element('div', {className: 'RunTimeError'}, notice));
  }
  byId('plan').replaceChildren(...parts, ...lossesOf(status.connections));
}

/** Lists lost samples, and samples replaced by newer samples as configured. */
function lossesOf(connections) {
  const lost = connections.filter((one) => isLoss(one) && one.lost), parts = [element('h3', {}, 'lost samples')];
  for (const one of lost) parts.push(element('div', {className: 'refused'}, `${one.lost}  ${one.from} > ${one.to} (${one.policy})`));
  if (!lost.length) parts.push(element('div', {className: 'dim'}, 'none'));
  const replaced = connections.map((one) => ({...one, count: one.passed_over + (isLoss(one) ? 0 : one.lost)})).filter((one) => one.count);
  if (replaced.length) parts.push(element('h3', {}, 'replaced by newer samples, as configured'));
  for (const one of replaced) parts.push(element('div', {className: 'dim'}, `${one.count}  ${one.from} > ${one.to} (${one.policy})`));
  return parts;
}

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

/** Returns the key names of a block in flow YAML, without those of nested blocks. */
function keysOf(block) {
  let outer = block.slice(1, -1), before;
  do {
    before = outer;
    outer = outer.replace(/\{[^{}]*\}|\[[^\[\]]*\]/g, '');
  } while (outer !== before);
  return [...outer.matchAll(/(?:^|,)\s*"?(\w+)"?\s*:/g)].map((found) => found[1]);
}

/** Returns the value to set to change a property from `before` to `after`. Setting merges blocks, so removed keys, and
 *  the content of emptied blocks, are set to null. */
export function setting(type, before, after) {
  const text = after.trim(), isBlock = (one) => /^\{.*\}$/s.test(one);
  if (!text) return 'null';
  if (type === 'text' || type === 'text, optional') return JSON.stringify(after);  // it may contain YAML syntax: "a: b #c"
  if (!type.startsWith('block') || !isBlock(text) || !isBlock(before ?? '')) return after;
  const kept = keysOf(text), gone = keysOf(before).filter((key) => !kept.includes(key)).map((key) => `${key}: null`);
  return `{${[text.slice(1, -1).trim(), ...gone].filter((part) => part).join(', ')}}`;
}

/** Order of properties: these first, the others in the order of the task. */
export const rank = ({name}) => (['range', 'gain_db', 'gain', 'frequency_khz'].indexOf(name) + 1) || 99;

const valuesOf = (status, task) => status?.tasks.find((one) => one.name === task)?.properties ?? {};

/** A property's field: its input, and why its last change was refused. Typed text stays in the input until Enter, or
 *  leaving it, sets the property, or Escape restores the value. */
export function fieldOf(link, task, property, control) {
  const input = inputFor(property), said = element('span', {className: 'refused'});
  let is_edited = false, unanswered = 0, is_left_alone = false;
  const held = () => valuesOf(field.status, task)[property.name];
  const field = {input, said, update(status) {
    field.status = status;
    if (!is_edited && !unanswered) put(input, held());
  }};
  input.disabled = !control;
  input.oninput = () => { is_edited = true; };
  input.onchange = async () => {
    is_edited = false;
    is_left_alone = true;
    ++unanswered;
    const value = input.type === 'checkbox' ? input.checked : setting(property.type, held(), input.value);
    const {refused} = await link.call(`${task}.${setter(property.name)}`, value);
    --unanswered;
    said.textContent = refused ?? '';
    if (is_edited || unanswered) return;
    if (refused) put(input, held());
    if (is_left_alone) input.select?.();  // so that typing replaces it
  };
  input.onblur = () => { is_edited = is_left_alone = false; };
  input.onpointerdown = () => { is_left_alone = false; };
  input.onkeydown = (event) => {
    is_left_alone = false;  // else a late answer would move the caret while the user types
    if (event.key !== 'Escape') return;
    is_edited = false;
    said.textContent = '';
    put(input, held());
  };
  return field;
}

/** The properties of one task. */
export class Properties {
  constructor(link) {
    this.link = link;
    byId('task').onchange = () => this.build();
  }
  setInterfaces({tasks, control}) {
    this.control = control;
    const chosen = byId('task').value;
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
    const field = fieldOf(this.link, task, property, this.control);
    const bounds = property.min === null && property.max === null ? '' : ` (${property.min ?? '-inf'} to ${property.max ?? 'inf'})`;
    this.fields.push(field);
    return element('tr', {title: property.doc + bounds}, cell(property.name), element('td', {}, field.input, field.said), cell(property.unit === '1' ? '' : property.unit, 'dim'));
  }
  update(status) {
    this.status = status;
    for (const field of this.fields ?? []) field.update(status);
  }
}
