// Instruments around the picture: attitude, buttons, timelines, explanation of a bin, and the watch over pings and connection.
import {byId, element, patch} from './dom.js';
import {courseText, degrees, lengthText, speedText} from './settings.js';
import {upstream} from './status.js';

/** Converts a pose in the world of x north, y west, z up: heading clockwise from north [0, 360), pitch positive down,
 *  roll positive to starboard [deg], z [m]; depth [m] if the surface is known. */
export function computeAttitude({position, orientation: [x, y, z, w]}, water_surface) {
  const north = 1 - 2 * (y * y + z * z), west = 2 * (x * y + w * z), up = 2 * (x * z - w * y);
  return {
    heading: (Math.atan2(-west, north) * degrees + 360) % 360,
    pitch: -Math.asin(Math.max(-1, Math.min(1, up))) * degrees,
    roll: Math.atan2(2 * (y * z + w * x), 1 - 2 * (x * x + y * y)) * degrees,
    z: position[2],
    depth: water_surface === undefined ? undefined : water_surface - position[2],
  };
}

const aside = (angle, positive, negative) => `${Math.abs(angle).toFixed(1)}°` + (Math.abs(angle) < 0.05 ? '' : ` ${angle > 0 ? positive : negative}`);

/** Returns the texts to show, by name. */
export function attitudeTexts(it) {
  return {
    heading: courseText(it.heading),
    ...(it.depth === undefined ? {z: lengthText(it.z)} : {depth: lengthText(it.depth)}),
    pitch: aside(it.pitch, 'down', 'up'),
    roll: aside(it.roll, 'stbd', 'port'),
    ...(it.speed === undefined ? {} : {speed: speedText(it.speed)}),
  };
}

/** Shows the attitude, with an artificial horizon: a line that stays level while the vehicle rolls and pitches. */
export function showAttitude(place, it) {
  place.hidden = !it;
  if (!it) return;
  const transform = `rotate(${-it.roll} 22 22) translate(0 ${-Math.max(-40, Math.min(40, it.pitch)) * 0.4})`;
  const line = (d, stroke) => ['path', {d, stroke, fill: 'none', transform}];
  const horizon = ['svg', {viewBox: '0 0 44 44', 'aria-hidden': true}, ['circle', {cx: 22, cy: 22, r: 20, fill: '#12303c', stroke: '#45535f'}],
                   line('M6,22 H38', '#9fdbe6'), ['path', {d: 'M12,22 H18 M26,22 H32 M22,20 V24', stroke: '#f2b04a', fill: 'none'}]];
  patch(place, [horizon, ...Object.entries(attitudeTexts(it)).flatMap(([name, text]) => [['i', {}, name], ['span', {}, text]])]);
}

const sizeText = (bytes) => {
  const [unit, size] = [['GB', 1e9], ['MB', 1e6], ['kB', 1e3]].find(([, one]) => bytes >= one) ?? ['B', 1];
  return `${(bytes / size).toFixed(size === 1 ? 0 : 1)} ${unit}`;
};
const durationText = (s) => s < 60 ? `${Math.floor(s)} s` : s < 3600 ? `${Math.floor(s / 60)} min` :
    s < 360000 ? `${Math.floor(s / 3600)} h ${Math.floor(s / 60) % 60} min` : 'over 100 h';

/** Buttons for recording, pausing and stepping, as far as the deployment offers them, and what is recorded. A button that
 *  is pressed says so; its text says what it does next. */
export class Controls {
  constructor(link, place, recorded) {
    Object.assign(this, {link, place, recorded, seen: new Map()});
  }
  setInterfaces({tasks, control}) {
    this.control = control;
    this.loggers = tasks.filter((task) => task.properties.some((property) => property.name === 'record')).map((task) => task.name);
    this.replays = tasks.filter((task) => task.operations.includes('pause void(bool)')).map((task) => task.name);
    this.built_for = null;
  }
  button(text, ask, title) {
    return element('button', {title, onclick: async () => { this.said.textContent = (await ask()).refused ?? ''; }}, text);
  }
  build(status) {
    this.built_for = status.lockstep;
    this.said = element('span', {className: 'refused', role: 'alert'});
    this.records = new Map(this.loggers.map((name) => [name, this.button(`● ${name}`, () => this.record(name), 'record, or pause recording')]));
    this.clocks = status.lockstep ? [this.clock('', () => this.paused, (on) => this.link.ask({pause: on}), () => this.link.ask({step: true}), 'simulated time')] :
        this.replays.map((name) => this.clock(` ${name}`, () => this.playback.get(name)?.paused === true, (on) => this.link.call(`${name}.pause`, on),
                                              () => this.link.call(`${name}.step`), 'the log\'s time'));
    const parts = [this.said, ...this.records.values(), ...this.clocks.flatMap(({pause, step}) => [pause, step])];
    this.place.replaceChildren(...(this.control ? parts : []));
  }
  /** Makes the buttons of a clock that can be paused. */
  clock(of, is_paused, set, advance, what) {
    const pause = this.button(`pause${of}`, () => set(!is_paused()), `${what} stops, or goes on`);
    return {of, is_paused, pause, step: this.button('step', advance, `one instant more of ${what}; while it is paused`)};
  }
  record(name) { return this.link.call(`${name}.setRecord`, !this.recording.get(name)); }
  /** Records, or stops, with the first logger. */
  recordFirst() { if (this.control && this.loggers?.length) this.records.get(this.loggers[0]).click(); }

  update(status) {
    if (!this.loggers) return;
    this.paused = status.paused;
    this.recording = new Map(status.tasks.map((task) => [task.name, task.properties.record]));
    this.playback = new Map(status.tasks.map((task) => [task.name, task.playback]));
    if (this.built_for !== status.lockstep) this.build(status);
    for (const {of, is_paused, pause, step} of this.clocks) {
      pause.textContent = (is_paused() ? 'go on' : 'pause') + of;
      pause.className = is_paused() ? 'on' : '';
      step.disabled = !is_paused();
    }
    for (const [name, button] of this.records) {
      button.className = this.recording.get(name) ? 'on' : '';
      button.setAttribute('aria-pressed', this.recording.get(name) === true);
    }
    this.showRecording(status);
  }
  /** Whether time stands because someone has paused it. */
  get is_paused() { return this.clocks?.some(({is_paused}) => is_paused()) ?? false; }

  showRecording(status) {
    const texts = status.tasks.filter((task) => task.properties.record === true && task.recording).map((task) => this.recordingText(task, status.sent_s));
    this.recorded.hidden = !texts.length;
    this.recorded.textContent = texts.join(', ');
    this.recorded.title = status.tasks.flatMap(({recording}) => recording?.file ?? []).join('\n');
  }
  /** Returns how much is recorded, and the time until the disk is full at the rate of the last seconds. */
  recordingText({name, state, recording: {bytes, free_bytes}}, now) {
    if (state !== 'Running') return `REC ${name}: ${state}`;
    const seen = this.seen.get(name) ?? {bytes, now, rate: 0};
    this.seen.set(name, seen);
    if (now - seen.now > 2) Object.assign(seen, {rate: (bytes - seen.bytes) / (now - seen.now), bytes, now});
    return `REC ${sizeText(bytes)}, ` + (seen.rate > 0 ? `${durationText(free_bytes / seen.rate)} left` : `${sizeText(free_bytes)} free`);
  }
}

/** The position in each log that is played, and seeking in it. */
export class Timelines {
  constructor(link, place) {
    Object.assign(this, {link, place, rows: new Map()});
  }
  setInterfaces({tasks, control}) {
    this.seekers = new Set(control ? tasks.filter((task) => task.operations.includes('seek void(double)')).map((task) => task.name) : []);
    this.rows.clear();
    this.place.replaceChildren();
  }
  row(name) {
    const title = `${name}: seconds after the first stamp of the log`;
    const slider = element('input', {type: 'range', min: 0, step: 0.01, disabled: !this.seekers?.has(name), title, 'aria-label': title});
    const told = element('span', {className: 'figure'}), said = element('span', {className: 'refused', role: 'alert'});
    slider.onpointerdown = () => { slider.held = true; };
    slider.onpointerup = slider.onpointercancel = () => { slider.held = false; };
    slider.onchange = async () => {
      said.textContent = (await this.link.call(`${name}.seek`, slider.value)).refused ?? '';
    };
    this.rows.set(name, {slider, told});
    this.place.append(element('div', {className: 'timeline'}, element('i', {className: 'dim'}, name), slider, told, said));
    return this.rows.get(name);
  }
  update(status) {
    for (const {name, playback} of status.tasks) {
      if (!playback) continue;
      const {slider, told} = this.rows.get(name) ?? this.row(name);
      slider.max = playback.length_s;
      if (!slider.held) slider.value = playback.at_s;
      told.textContent = `${playback.at_s.toFixed(1)} / ${playback.length_s.toFixed(1)} s`;
    }
  }
}

const poll_ms = 100;

/** What made a bin, as the sonar that sent the ping explains it. */
export class Explanation {
  constructor(link, place) {
    Object.assign(this, {link, place, asked: 0});
  }
  setInterfaces({tasks}) {
    this.sonars = new Set(tasks.filter((task) => task.operations.some((one) => one.startsWith('explain text('))).map((task) => task.name));
  }
  /** Explains the bin at a place [rad, m] of the newest ping of `source`; a later call takes the place of this one. */
  async ask(source, connections, {bearing, range}) {
    const asked = ++this.asked, sonar = [...upstream(connections, source)].find((task) => this.sonars?.has(task));
    this.place.textContent = sonar ? 'explaining ...' : 'no sonar of this deployment explains this ping';
    while (sonar && asked === this.asked) {
      const {result, refused} = await this.link.call(`${sonar}.explain`, (bearing * degrees).toFixed(3), range.toFixed(4));
      if (asked !== this.asked) return;
      if (result || refused) return void (this.place.textContent = result || refused);
      await new Promise((done) => setTimeout(done, poll_ms));
    }
  }
  clear() {
    ++this.asked;
    this.place.textContent = '';
  }
}

/** Shortest and longest time without a ping, or a status, after which something is wrong [s]; and while the interval of
 *  pings is unknown. */
const least_silence = 2, most_silence = 60, first_silence = 10;
const rate_window = 4;  // [s]

/** Watches over pings and connection, so that an old picture never looks live. Times are in seconds. */
export class Watch {
  constructor() { this.forget(); }
  /** Starts again, as for another source. */
  forget() {
    this.arrivals = [];
    this.intervals = [];
    this.since_open = 0;  // pings since the connection was opened
  }
  ping(now) {
    if (this.arrivals.length) this.intervals = [...this.intervals.slice(-4), now - this.arrivals.at(-1)];
    this.arrivals.push(now);
    ++this.since_open;
    while (this.arrivals.length > 2 && this.arrivals[0] < now - Math.max(rate_window, 3 * this.interval)) this.arrivals.shift();
  }
  /** @param waited seconds since the viewer got the last ping, by the deployment's clock. A new connection begins with the
   *  last ping there was, which may be old. */
  status(now, waited = 0) {
    this.status_at = now;
    if (this.since_open === 1) this.arrivals[this.arrivals.length - 1] = Math.min(this.arrivals.at(-1), now - Math.max(0, waited));
  }
  connection(is_open, now) {
    if (is_open) this.since_open = 0;
    if (is_open) this.lost_at = null;
    else this.lost_at ??= now;
  }
  /** Returns the middle of the last intervals, so that a silence is not taken for one; null: unknown. */
  get interval() { return this.intervals.length ? [...this.intervals].sort((a, b) => a - b)[Math.floor(this.intervals.length / 2)] : null; }
  /** Returns the silence after which pings are missing: three of their intervals. */
  get patience() { return this.interval === null ? first_silence : Math.max(least_silence, Math.min(most_silence, 3 * this.interval)); }
  /** Returns the pings per second of the last seconds. They may arrive in bunches where the browser is slow. */
  rateAt(now) {
    const recent = this.arrivals.filter((at) => at > now - rate_window).length;
    if (recent < 5) return this.interval ? 1 / this.interval : 0;
    return recent / Math.min(rate_window, Math.max(now - this.arrivals[0], this.interval * (recent - 1)));
  }
  /** Returns {rate, is_silent, is_known, text}: pings per second; whether pings are missing; whether the last status is
   *  of now; what is wrong, or an empty text. */
  look(now) {
    const age = this.arrivals.length ? now - this.arrivals.at(-1) : null, is_lost = this.lost_at !== null && this.lost_at !== undefined;
    const is_silent = is_lost || (age !== null && age > this.patience);
    const seconds = (since) => `${Math.floor(now - since)} s`, no_ping = age === null ? '' : `no ping for ${seconds(this.arrivals.at(-1))}`;
    return {
      is_silent, age,
      rate: is_silent ? 0 : this.rateAt(now),
      is_known: !is_lost && this.status_at !== undefined && now - this.status_at < least_silence,
      text: is_lost ? `no connection for ${seconds(this.lost_at)}` + (no_ping && `, ${no_ping}`) : is_silent ? no_ping : '',
    };
  }
}

/** Makes a sound each second while something is wrong and the operator wants to hear it. */
export class Alarm {
  constructor() { this.next = 0; }
  /** Unlocks the sound: browsers allow it only after a click or a key. */
  unlock() {
    this.context ??= new AudioContext();
    this.context.resume();
  }
  sound(now) {
    if (now < this.next) return;
    this.next = now + 1;
    this.unlock();
    const {context} = this, tone = context.createOscillator(), volume = context.createGain();
    tone.frequency.value = 880;
    volume.gain.setValueAtTime(0.2, context.currentTime);
    volume.gain.linearRampToValueAtTime(0, context.currentTime + 0.2);
    tone.connect(volume).connect(context.destination);
    tone.start();
    tone.stop(context.currentTime + 0.2);
  }
}
