// Finds the snapshot or pose that a ping was made from.
import {owner} from './graph.js';

const most = 64;

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

export class Places {
  constructor() { this.snapshots = []; }
  add(snapshot) {
    this.snapshots.push(snapshot);
    if (this.snapshots.length > most) this.snapshots.shift();
  }
  newest() { return this.snapshots.at(-1); }
  /** Returns the entry of the ping's stamp, else the last before it; from tasks upstream of the ping, if any of them
   *  write entries. */
  of(ping, connections) {
    const tasks = upstream(connections, ping.source), own = this.snapshots.filter((one) => tasks.has(owner(one.source)));
    const list = own.length ? own : this.snapshots;
    return list.findLast((one) => one.time_us === ping.time_us) ?? list.findLast((one) => one.time_us < ping.time_us) ?? list.at(-1);
  }
}
