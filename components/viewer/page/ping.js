// A received ping, or several pings of a scanning head combined.

/** Converts a message. Beams are from starboard to port; `edges` has the starboard and the port edge of each [rad]. */
export function pingOf(message) {
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
