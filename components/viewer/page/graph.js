// The tasks as boxes from left to right, with their connections, states and losses.

export const svg = (name, attributes, text) => {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
};
/** Returns whether dropped samples are a fault; they are not if the newest sample replaces others by design. */
export const isLoss = ({policy}) => policy === 'buffer';
/** Returns the task of a port. */
export const owner = (port) => port.slice(0, port.indexOf('.'));
const lamp = {Running: '#58b368', RunTimeError: '#e0b13c', Exception: '#e4574c', FatalError: '#e4574c'};

/** Returns the max number of connections before each task; loops count once. */
function ranks(status) {
  const rank = new Map(status.tasks.map((task) => [task.name, 0]));
  for (let pass = 0; pass < status.tasks.length; ++pass)
    for (const {from, to} of status.connections)
      if (rank.get(owner(to)) <= rank.get(owner(from)) && rank.get(owner(from)) + 1 < status.tasks.length)
        rank.set(owner(to), rank.get(owner(from)) + 1);
  return rank;
}

export function showGraph(target, status, rates) {
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
    parts.push(svg('path', {class: 'edge', d: `M${x0},${y0} C${x0 + bend},${y0} ${b.x - bend},${y1} ${b.x},${y1}`}));
    if (lost) parts.push(svg('text', {class: 'lost', x: (x0 + b.x) / 2, y: (y0 + y1) / 2 - 3, 'text-anchor': 'middle'}, `-${lost}`));
  }
  for (const task of status.tasks) {
    const {x, y} = place.get(task.name), rate = rates.ofTask(task);
    parts.push(svg('rect', {class: 'node', x, y, width: wide, height: tall, rx: 2}),
               svg('rect', {x, y, width: 3, height: tall, fill: lamp[task.state] ?? '#6f7d89'}),
               svg('text', {x: x + 8, y: y + 12}, task.name),
               svg('text', {x: x + 8, y: y + 24, opacity: 0.6}, rate ? `${rate.toFixed(1)} /s` : task.state));
  }
  target.setAttribute('viewBox', `0 0 ${width} ${height}`);
  target.replaceChildren(...parts);
}
