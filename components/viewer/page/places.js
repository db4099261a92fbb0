// Which snapshot or pose a ping was made of.
import {owner} from './graph.js';

const most = 64;

/** Tasks that what `port` writes is made by, as far as connections tell. */
export function upstream(connections, port) {
  const tasks = new Set([owner(port)]);
  for (let size = 0; size !== tasks.size;) {
    size = tasks.size;
    for (const {from, to} of connections)
      if (tasks.has(owner(to))) tasks.add(owner(from));
  }
  return tasks;
}

export class Places {
  constructor() { this.snapshots = []; }
  add(snapshot) {
    this.snapshots.push(snapshot);
    if (this.snapshots.length > most) this.snapshots.shift();
  }
  newest() { return this.snapshots.at(-1); }
  /** That of the ping's stamp, or else the last before; of tasks that the ping comes from, where such write any. */
  of(ping, connections) {
    const tasks = upstream(connections, ping.source), own = this.snapshots.filter((one) => tasks.has(owner(one.source)));
    const list = own.length ? own : this.snapshots;
    return list.findLast((one) => one.time_us === ping.time_us) ?? list.findLast((one) => one.time_us < ping.time_us) ?? list.at(-1);
  }
}
