// Received pings, the poses they were made from, and the last minute of them.
import {owner, upstream} from './status.js';

/** Converts a message. Beams are from starboard to port; `edges` has the starboard and the port edge of each [rad]. */
export function makePing(message) {
  return {...message.json, data: new Uint8Array(message.buffer, message.start)};
}

const turn = 2 * Math.PI, rows = 720;
const whole_edges = Array.from({length: 2 * rows}, (_, i) => -Math.PI + Math.ceil(i / 2) * turn / rows);

/** Combines the last turn of a single-beam head into one ping of all directions. */
export class Scan {
  add(ping) {
    if (!this.whole || this.whole.bins !== ping.bins || this.whole.bin_m !== ping.bin_m) this.clear(ping);
    const levels = ping.data, shift = (ping.top_db - this.whole.top_db) / ping.step_db;
    const half = Math.max(ping.beam_width, turn / rows) / 2;
    const first = Math.floor((ping.bearings[0] - half + Math.PI) / turn * rows);
    const last = Math.floor((ping.bearings[0] + half + Math.PI) / turn * rows);
    for (let row = first; row <= last; ++row) {
      const at = ((row + rows) % rows) * ping.bins;
      for (let i = 0; i < ping.bins; ++i)
        this.whole.data[at + i] = levels[i] ? Math.max(0, Math.min(255, levels[i] + shift)) : 0;
    }
    return {...this.whole, count: ping.count, time_us: ping.time_us, latency_s: ping.latency_s};
  }
  clear(ping) {
    this.whole = {...ping, beams: rows, edges: whole_edges, data: new Uint8Array(rows * ping.bins),
                  top_db: ping.top_db + 20};
  }
}

/** Returns the level that 0.2 % of the echoes exceed, which is shown brightest apart from the gain [dB]. */
export function strongLevel(ping) {
  const counts = new Uint32Array(256);
  for (const level of ping.data) ++counts[level];
  const enough = (ping.data.length - counts[0]) / 500;
  let level = 255;
  for (let above = counts[255]; level > 1 && above <= enough; above += counts[level]) --level;
  return ping.top_db - (255 - level) * ping.step_db;
}

/** Returns whether two pings have the same beams. */
export const sameBeams = ({edges: a}, {edges: b}) => a === b || (a.length === b.length && a.every((edge, i) => edge === b[i]));

/** Returns the same direction within half a turn of the fan's middle, unless it is already between the fan's edges. */
export function turned({edges}, bearing) {
  const low = edges[0], high = edges[edges.length - 1];
  return bearing >= low && bearing <= high ? bearing : bearing - turn * Math.round((bearing - (low + high) / 2) / turn);
}

/** Returns the beam at a bearing; -1: none. */
export function beamAt(ping, bearing) {
  const {edges} = ping, at = turned(ping, bearing);
  for (let i = 0; i < ping.beams; ++i) if (at >= edges[2 * i] && at < edges[2 * i + 1]) return i;
  return -1;
}

/** Returns the level at a place [dB]; null without a beam or bin, -Infinity without an echo. */
export function levelAt(ping, range, bearing) {
  const beam = beamAt(ping, bearing), bin = Math.floor(range / ping.bin_m);
  if (beam < 0 || bin < 0 || bin >= ping.bins) return null;
  const level = ping.data[beam * ping.bins + bin];
  return level ? ping.top_db - (255 - level) * ping.step_db : -Infinity;
}

/** The last poses or snapshots. */
export class Places {
  constructor() { this.all = []; }
  add(place) {
    this.all.push(place);
    const old = this.all.at(-65);
    if (old?.buffer) this.all[this.all.length - 65] = {...old, buffer: undefined, shapes: undefined};  // shapes take memory
    if (this.all.length > 8192) this.all.splice(0, 4096);
  }
  newest() { return this.all.at(-1); }
  /** Returns the speed [m/s] over the half second before a pose; undefined: there are no earlier poses of its source. */
  speed({source, time_us, position}) {
    const before = this.all.findLast((one) => one.source === source && one.time_us <= time_us - 5e5);
    return before && before.time_us > time_us - 5e6 ? Math.hypot(...position.map((p, i) => p - before.position[i])) / (time_us - before.time_us) * 1e6 : undefined;
  }
  /** Returns the entry of the ping's stamp, else the last before it; from tasks upstream of the ping, if any of them
   *  write entries. */
  of(ping, connections) {
    const tasks = upstream(connections, ping.source), ours = ({source}) => tasks.has(owner(source));
    const list = this.all.some(ours) ? this.all.filter(ours) : this.all;
    return list.findLast((one) => one.time_us === ping.time_us) ?? list.findLast((one) => one.time_us < ping.time_us) ?? list.at(-1);
  }
}

/** The last minute of pings as {ping, at}, oldest first. Where it would take more than `most_bytes`, pings are left out
 *  evenly before its newest quarter, so that it stays a minute. The newest ping always stays. */
export class History {
  constructor(seconds = 60, most_bytes = 256e6) {
    Object.assign(this, {seconds, most_bytes, entries: [], bytes: 0});
  }
  /** @param at when it arrived [s] */
  add(ping, at) {
    this.entries.push({ping, at});
    this.bytes += ping.data.length;
    while (this.entries[0].at < at - this.seconds) this.remove(0);
    while (this.bytes > this.most_bytes && this.entries.length > 1) this.remove(this.closest());
  }
  remove(i) { this.bytes -= this.entries.splice(i, 1)[0].ping.data.length; }
  /** Returns the index of the entry, apart from the oldest and the newest quarter, whose neighbours are closest. */
  closest() {
    const {entries} = this, gap = (i) => entries[i + 1].at - entries[i - 1].at;
    let found = entries.length > 2 ? 1 : 0;
    for (let i = 2; i < 0.75 * entries.length && i + 1 < entries.length; ++i) if (gap(i) < gap(found)) found = i;
    return found;
  }
  clear() {
    this.entries = [];
    this.bytes = 0;
  }
  get newest() { return this.entries.at(-1); }
  /** Returns the last entry that had arrived at a time [s], else the oldest; undefined without any. */
  at(time) { return this.entries.findLast((one) => one.at <= time) ?? this.entries[0]; }
  /** Returns the entry before or after one that may no longer be there; undefined: there is none. */
  beside(entry, step) {
    return step < 0 ? this.entries.findLast((one) => one.at < entry.at) : this.entries.find((one) => one.at > entry.at);
  }
  /** Returns an entry's ping as it was shown: of a scanning head the disc that the beams until then made. */
  shown({ping, at}) {
    if (ping.beams !== 1) return ping;
    const scan = new Scan();
    let disc = null;
    for (const one of this.entries) if (one.at <= at) disc = scan.add(one.ping);
    return disc ?? scan.add(ping);
  }
}
