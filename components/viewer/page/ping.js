// A ping as it came, or many of a scanning head's put together.

/** Edges between beams, one more than beams, in the order of beams [rad]. */
function edgesOf(bearings, width) {
  const n = bearings.length;
  if (n === 1) return [bearings[0] - width / 2, bearings[0] + width / 2];
  const edges = [bearings[0] - (bearings[1] - bearings[0]) / 2];
  for (let i = 1; i < n; ++i) edges.push((bearings[i - 1] + bearings[i]) / 2);
  edges.push(bearings[n - 1] + (bearings[n - 1] - bearings[n - 2]) / 2);
  return edges;
}

export function pingOf(message) {
  const json = message.json;
  return {...json, data: new Uint8Array(message.buffer, message.start), edges: edgesOf(json.bearings, json.beam_width || 0.03)};
}

const turn = 2 * Math.PI, rows = 720;

/** The last turn of a head of one beam, as one ping of beams all around. */
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
    const bearings = Array.from({length: rows}, (_, i) => -Math.PI + (i + 0.5) * turn / rows);
    this.whole = {...ping, beams: rows, bearings, edges: edgesOf(bearings, 0), data: new Uint8Array(rows * ping.bins),
                  top_db: ping.top_db + 20};
  }
}

/** Level at which 0.2 % of the echoes are louder: what is shown brightest, but for the gain [dB]. */
export function strongLevel(ping) {
  const counts = new Uint32Array(256);
  for (const level of ping.data) ++counts[level];
  const enough = (ping.data.length - counts[0]) / 500;
  let level = 255;
  for (let above = counts[255]; level > 1 && above <= enough; above += counts[level]) --level;
  return ping.top_db - (255 - level) * ping.step_db;
}

/** Which beam is at a bearing; -1: none. */
export function beamAt(ping, bearing) {
  const edges = ping.edges, up = edges[edges.length - 1] > edges[0];
  for (let i = 0; i < ping.beams; ++i)
    if (up ? bearing >= edges[i] && bearing < edges[i + 1] : bearing <= edges[i] && bearing > edges[i + 1]) return i;
  return -1;
}

/** Level there [dB]; null where there is no beam or bin, -Infinity where there is no echo. */
export function levelAt(ping, range, bearing) {
  const beam = beamAt(ping, bearing), bin = Math.floor(range / ping.bin_m);
  if (beam < 0 || bin < 0 || bin >= ping.bins) return null;
  const level = ping.data[beam * ping.bins + bin];
  return level ? ping.top_db - (255 - level) * ping.step_db : -Infinity;
}
