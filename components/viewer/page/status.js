// What the deployment reports of itself: its tasks as a drawing and a table, what is omitted, what was lost.
import {byId, patch} from './dom.js';

/** Returns whether dropped samples are a fault; they are not if the newest sample replaces others by design. */
const isLoss = ({policy}) => policy === 'buffer';
/** Returns the task of a port. */
export const owner = (port) => port.slice(0, port.indexOf('.'));
/** Returns the tasks that contribute to `port`, by the connections. */
export function upstream(connections, port) {
  const tasks = new Set([owner(port)]);
  for (let size = 0; size !== tasks.size;) {
    size = tasks.size;
    for (const {from, to} of connections)
      if (tasks.has(owner(to))) tasks.add(owner(from));
  }
  return tasks;
}

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
const milliseconds = (s) => s === null ? '-' : (s * 1e3).toFixed(s < 0.01 ? 2 : 1);
const cell = (text, kind) => ['td', {class: kind}, text];

/** Shows the state of a deployment. @param known whether the status is of now; otherwise states and rates are unknown */
export function showStatus(status, rates, known) {
  showTasks(status, rates, known);
  showGraph(byId('graph'), status, rates, known);
  showPlan(status);
}

/** Shows errors as long as they last. Refused settings are reported at their fields. */
function showTasks(status, rates, known) {
  const head = [['task'], ['state'], ['cycle ms', 'n'], ['latency ms', 'n'], ['samples/s', 'n'], ['error']].map(
      ([text, kind]) => ['th', {class: kind, scope: 'col'}, text]);
  const rows = status.tasks.map((task) => ['tr', {title: task.error ? `${task.type}; last error: ${task.error}` : task.type},
      cell(task.name), known ? cell(task.state, task.state) : cell('unknown', 'dim'), cell(known ? milliseconds(task.cycle_s) : '-', 'n'),
      cell(status.lockstep || !task.latency_s || !known ? '-' : milliseconds(task.latency_s), 'n'), cell(known ? rates.ofTask(task).toFixed(1) : '-', 'n'),
      cell(failed.includes(task.state) ? task.error : '', 'refused')]);
  patch(byId('tasks'), [['thead', {}, ['tr', {}, ...head]], ['tbody', {}, ...rows]]);
}

/** Returns the max number of connections before each task; loops count once. */
function ranks(status) {
  const rank = new Map(status.tasks.map((task) => [task.name, 0]));
  for (let pass = 0; pass < status.tasks.length; ++pass)
    for (const {from, to} of status.connections)
      if (rank.get(owner(to)) <= rank.get(owner(from)) && rank.get(owner(from)) + 1 < status.tasks.length)
        rank.set(owner(to), rank.get(owner(from)) + 1);
  return rank;
}

/** Draws the tasks as boxes from left to right, with their connections, states and losses. */
function showGraph(target, status, rates, known) {
  const rank = ranks(status), columns = new Map();
  for (const task of status.tasks) columns.set(rank.get(task.name), [...(columns.get(rank.get(task.name)) ?? []), task]);
  const count = Math.max(...columns.keys()) + 1, tallest = Math.max(...[...columns.values()].map((list) => list.length));
  const width = 560, height = 40 * tallest + 20, wide = Math.min(92, width / count - 22), tall = 28, place = new Map();
  for (const [column, list] of columns)
    list.forEach((task, i) => place.set(task.name, {x: 10 + column * (width - 20 - wide) / Math.max(1, count - 1),
                                                    y: height * (i + 0.5) / list.length - tall / 2}));
  const parts = [], seen = new Map();
  for (const connection of status.connections) {
    const {from, to} = connection, lost = isLoss(connection) ? connection.lost : 0;
    const key = owner(from) + ' ' + owner(to), edge = seen.get(key) ?? {a: place.get(owner(from)), b: place.get(owner(to)), lost: 0};
    edge.lost += lost;
    seen.set(key, edge);
  }
  for (const {a, b, lost} of seen.values()) {
    const x0 = a.x + wide, y0 = a.y + tall / 2, y1 = b.y + tall / 2, bend = (b.x - x0) / 2;
    parts.push(['path', {class: 'edge', d: `M${x0},${y0} C${x0 + bend},${y0} ${b.x - bend},${y1} ${b.x},${y1}`}]);
    if (lost) parts.push(['text', {class: 'lost', x: (x0 + b.x) / 2, y: (y0 + y1) / 2 - 3, 'text-anchor': 'middle'}, `-${lost}`]);
  }
  for (const task of status.tasks) {
    const {x, y} = place.get(task.name), rate = rates.ofTask(task), state = known ? task.state : 'unknown';
    parts.push(['rect', {class: 'node', x, y, width: wide, height: tall, rx: 2}],
               ['rect', {class: `lamp ${state}`, x, y, width: 3, height: tall}],
               ['text', {x: x + 8, y: y + 12}, task.name],
               ['text', {class: 'small', x: x + 8, y: y + 24}, known && rate ? `${rate.toFixed(1)} /s` : state]);
  }
  target.setAttribute('viewBox', `0 0 ${width} ${height}`);
  patch(target, parts);
}

function showPlan(status) {
  const parts = [];
  for (const task of status.tasks) {
    if (!task.plan) continue;
    const plan = task.plan;
    const quality = `${plan.rows} rows, ${plan.columns_per_beam} columns per beam, ${plan.slabs ? `${plan.slabs} frusta` : 'rays'}` +
        (plan.predicted_error === null ? '' : `, predicted error ${plan.predicted_error.toPrecision(2)}`);
    parts.push(['h3', {}, task.name], ['div', {}, quality],
               ['div', {class: 'dim'}, 'compiled: ' + (plan.features.join(', ') || 'nothing beyond the minimum')],
               ['div', {class: 'dim'}, 'run: ' + plan.passes.join(', ')]);
    const omitted = plan.omitted.flatMap(({name, reason}) => [['dt', {}, name], ['dd', {}, reason]]);
    if (omitted.length) parts.push(['h3', {}, 'omitted'], ['dl', {}, ...omitted]);
    for (const notice of plan.notices) parts.push(['div', {class: 'RunTimeError'}, notice]);
  }
  patch(byId('plan'), [...parts, ...computeLosses(status.connections)]);
}

/** Lists lost samples, and samples replaced by newer samples as configured. */
function computeLosses(connections) {
  const lost = connections.filter((one) => isLoss(one) && one.lost), parts = [['h3', {}, 'lost samples']];
  for (const one of lost) parts.push(['div', {class: 'refused'}, `${one.lost}  ${one.from} > ${one.to} (${one.policy})`]);
  if (!lost.length) parts.push(['div', {class: 'dim'}, 'none']);
  const replaced = connections.map((one) => ({...one, count: one.passed_over + (isLoss(one) ? 0 : one.lost)})).filter((one) => one.count);
  if (replaced.length) parts.push(['h3', {}, 'replaced by newer samples, as configured']);
  for (const one of replaced) parts.push(['div', {class: 'dim'}, `${one.count}  ${one.from} > ${one.to} (${one.policy})`]);
  return parts;
}
