// Routes messages of the link to the parts of the page.
import {byId, element} from './dom.js';
import {Fan, names} from './fan.js';
import {First, Properties} from './fields.js';
import {Hands} from './hands.js';
import {Alarm, Controls, Explanation, Timelines, Watch, computeAttitude, showAttitude} from './instruments.js';
import {Link} from './link.js';
import {History, Places, Scan, makePing, strongLevel} from './ping.js';
import {change, fillDialog, lengthText, onSettings, settings} from './settings.js';
import {Rates, showStatus} from './status.js';
import {Targets, findDatum, savePicture} from './targets.js';
import {World, loadThree} from './world.js';

const seconds = () => performance.now() / 1e3;
const fan = new Fan(byId('fan'), byId('overlay'));
const rates = new Rates(), scans = new Map(), scenes = new Map(), places = new Places(), poses = new Places(), history = new History();
const watch = new Watch(), alarm = new Alarm();
let interfaces = '', world = null, scene = null, snapshot = null, shown_attitude = null, placed = '', reference = null;
let missed = 0, last_count = null, shown = 0, needs_drawing = false;
let moment = null;   // the entry of the history that is shown; null: the newest ping
let playing = null;  // {from, since}: the last minute plays from there
let is_chosen = false, was_silent = false;

const link = new Link(take, (open) => {
  byId('link').className = open ? 'lamp' : 'lamp off';
  byId('link').textContent = open ? 'connected' : 'no connection';
  byId('link').title = `Foxglove: open connection, Foxglove WebSocket, ws://${location.host}`;
  last_count = null;
  watch.connection(open, seconds());
});
const properties = new Properties(link), controls = new Controls(link, byId('controls'), byId('recorded'));
const first = new First(link, byId('first')), timelines = new Timelines(link, byId('timelines'));
const redraw = () => { needs_drawing = true; };
const hands = new Hands(fan, redraw), explanation = new Explanation(link, byId('explained'));
const targets = new Targets(byId('marked'), showTargets, () => findDatum(properties.status));

const show = {
  interfaces(message) {
    const before = interfaces;
    interfaces = JSON.stringify(message);
    if (interfaces === before) return;  // a restored connection: fields keep the text being typed
    for (const part of [properties, controls, first, timelines, explanation]) part.setInterfaces(message);
  },
  status(status) {
    const ping = history.newest?.ping;
    watch.status(seconds(), ping && (status.now_us - ping.time_us) * 1e-6 - ping.latency_s);
    rates.update(status);
    showStatus(status, rates, true);
    for (const part of [properties, controls, timelines]) part.update(status);
    first.update(status, byId('source').value);
  },
  snapshot(message) {
    places.add(message);
    place();
  },
  pose(message) {
    poses.add(message);
    world?.showPose(message);
  },
};

function take(message) {
  if (message.type) return show[message.type]?.(message);
  if (message.kind === 1) return setPing(makePing(message));
  if (message.kind === 3) return show.snapshot({...message.json, buffer: message.buffer, start: message.start});
  scenes.set(message.json.source, message);
  showScene();
}

/** Shows the scene of the current snapshot. */
function showScene() {
  const wanted = scenes.get(snapshot?.source) ?? scenes.values().next().value;
  if (!world || !wanted || scene === wanted) return;
  scene = wanted;
  byId('scene_text').textContent = world.showScene(scene);
}

/** Places everything as it was at the time of the ping; a snapshot may arrive after its ping. */
function place() {
  const {ping} = fan, key = ping && `${ping.source} ${ping.time_us}`;
  const found = ping ? places.of(ping, properties.status?.connections ?? []) : places.newest();
  if (!found || found === snapshot || (key && key === placed)) return;
  snapshot = found;
  placed = found.time_us === ping?.time_us ? key : '';
  showScene();
  world?.showSnapshot(snapshot);
  byId('pose_text').textContent = 'sonar ' + snapshot.position.map((x) => lengthText(x)).join('  ');
  orient();
}
/** Turns the pictures as the settings say, and shows targets where the sonar sees them now. */
function orient() {
  fan.orient(settings.up === 'north', snapshot ? computeAttitude(snapshot).heading : undefined);
  if (world) world.is_north_up = settings.up === 'north';
  fan.targets = targets.seenFrom(snapshot);
  redraw();
}
function showTargets() {
  world?.showTargets(targets.list);
  orient();
}

/** Returns the attitude of the vehicle at the time of the ping, else of the sonar; null if unknown. */
function attitude() {
  const {ping} = fan, connections = properties.status?.connections ?? [], pose = ping && poses.of(ping, connections), found = pose ?? snapshot;
  return found ? {...computeAttitude(found, snapshot?.water_surface), speed: pose && poses.speed(pose), source: found.source} : null;
}

function setPing(ping) {
  const chooser = byId('source');
  if (![...chooser.options].some((option) => option.value === ping.source)) {
    chooser.append(element('option', {}, ping.source));
    if (!is_chosen && ping.source === settings.source) choose(ping.source);
  }
  if (chooser.value !== ping.source || !ping.beams) return;
  history.add(ping, seconds());
  const scan = ping.beams === 1 && (scans.get(ping.source) ?? scans.set(ping.source, new Scan()).get(ping.source));
  if (scan) ping = scan.add(ping);
  const strong = strongLevel(ping);
  if (settings.auto) reference = reference === null || Math.abs(strong - reference) > 30 ? strong : reference + 0.1 * (strong - reference);
  reference ??= settings.held_db;
  tell(ping);
  if (moment === null) display(ping);
}
/** Chooses the source of pings. */
function choose(source) {
  byId('source').value = source;
  is_chosen = true;
  reference = last_count = null;
  watch.forget();
  history.clear();
  goTo(null);
}

function tell(ping) {
  watch.ping(seconds());
  if (last_count !== null && ping.count > last_count) missed += ping.count - last_count - 1;
  last_count = ping.count;
  byId('time').textContent = ping.time_us > 1e15 ? new Date(ping.time_us / 1e3).toISOString().slice(11, 22) : `${(ping.time_us * 1e-6).toFixed(2)} s`;
  byId('reach').textContent = `${lengthText(ping.bins * ping.bin_m, 1)}, ${ping.beams} x ${ping.bins}, ${(ping.bin_m * 1e3).toFixed(0)} mm`;
  byId('latency').textContent = `${(ping.latency_s * 1e3).toFixed(1)} ms`;
  byId('missed').textContent = missed;
}

function display(ping) {
  const top = reference + settings.high, is_new = fan.ping !== ping, restore = !fan.ping;
  fan.span_db = settings.high - settings.low;
  fan.show(ping, top);
  if (restore) restoreZoom();
  place();
  world?.showPing(ping, top, fan.span_db, settings.map);
  if (is_new) shown_attitude = attitude();
  showAttitude(byId('attitude'), shown_attitude);
  needs_drawing = true;
  ++shown;
}
function restoreZoom() {
  const {zoom, shift_x, shift_y} = settings;
  fan.fit();
  fan.zoom = Math.max(1, Math.min(50, zoom));
  fan.shiftTo([shift_x * fan.canvas.width, shift_y * fan.canvas.height]);
  hands.tell();
}

/** Shows an entry of the last minute and stays there; null: the newest ping, and those that follow. */
function goTo(entry, is_playing = false) {
  moment = entry ?? null;
  if (!is_playing) playing = null;
  const wanted = moment ?? history.newest;
  if (wanted && wanted.ping !== fan.shown_entry?.ping) display(history.shown(wanted));
  fan.shown_entry = moment;
  showMoment();
}
function showMoment() {
  const newest = history.newest?.at ?? 0, before = moment ? moment.at - newest : 0, slider = byId('moment');
  slider.min = Math.min(-1, (history.entries[0]?.at ?? newest) - newest).toFixed(1);
  if (document.activeElement !== slider || !slider.matches(':active')) slider.value = before;
  byId('moment_text').textContent = moment ? `${before.toFixed(1)} s` : '';
  byId('past').hidden = !moment;
  byId('past').textContent = playing ? `playing, ${(-before).toFixed(1)} s ago` : `frozen, ${(-before).toFixed(1)} s ago`;
  pressed('live', !moment);
  pressed('freeze', moment !== null);
  byId('play').textContent = playing ? '❚❚' : '▶';
  byId('play').setAttribute('aria-label', playing ? 'stop playing' : 'play from here');
}
function step(by) {
  const entry = history.beside(moment ?? history.newest ?? {at: 0}, by);
  if (entry) goTo(entry);
}
function play() {
  if (playing) return goTo(moment);
  const from = moment ?? history.entries[0];
  if (!from) return;
  goTo(from);
  playing = {from: from.at, since: seconds()};
  showMoment();
}
function playOn() {
  const at = playing.from + seconds() - playing.since, entry = history.at(at);
  if (!entry || (entry === history.newest && at > entry.at)) return goTo(null);
  if (entry.ping !== moment?.ping) goTo(entry, true);
}

/** Shows whether pings and statuses still come; called four times a second. */
function lookOut() {
  const now = seconds(), {rate, is_silent, is_known, text, age} = watch.look(now), {status} = properties;
  const is_paused = controls.is_paused && is_known, is_wrong = is_silent && !is_paused;
  byId('rate').textContent = rate.toFixed(1);
  byId('silence').hidden = !is_silent;
  byId('silence').textContent = is_paused ? text.replace('no ping', 'paused, no ping') : text;
  document.body.classList.toggle('silent', is_wrong);
  document.body.classList.toggle('paused', is_paused);
  if (is_silent) byId('latency').textContent = '-';
  if (status && !is_known) showStatus(status, rates, false);
  if (is_wrong !== was_silent) {
    byId('alarm').textContent = is_wrong ? text.replace(/ for .*/, '') : '';  // once, for screen readers
    document.title = is_wrong ? '\u26a0 no pings - Insonify' : 'Insonify';
  }
  was_silent = is_wrong;
  if (is_wrong && settings.alarm === 'heard') alarm.sound(now);
  if (age === null && now > 10) {
    byId('silence').hidden = false;
    byId('silence').textContent ||= 'no ping yet';
  }
  showMoment();
}
setInterval(lookOut, 250);

const pressed = (id, on) => {
  byId(id).classList.toggle('on', on);
  byId(id).setAttribute('aria-pressed', on);
};
function showSettings() {
  const {low, high, auto} = settings;
  for (const name of ['low', 'high', 'map']) byId(name).value = settings[name];
  byId('contrast').textContent = auto ? `${low} to ${high} dB` : `${((reference ?? 0) + low).toFixed(0)} to ${((reference ?? 0) + high).toFixed(0)} dB`;
  byId('auto').checked = auto;
  byId('rings').checked = fan.rings = settings.rings;
  byId('north').checked = settings.up === 'north';
  fan.polar = settings.polar;
  byId('shape').textContent = settings.polar ? 'polar' : 'fan';
  document.documentElement.dataset.theme = settings.theme;
  document.body.dataset.layout = settings.layout;
  pressed('full_fan', settings.layout === 'fan');
  pressed('full_view', settings.layout === 'scene');
  pressed('profile', settings.profile);
  byId('profiled').hidden = !settings.profile;
  fan.setColours(settings.map);
  placed = '';
  orient();
  targets.show();
  if (fan.ping) display(fan.ping);
}

function useTool(tool) {
  hands.use(hands.tool === tool ? '' : tool);
  fan.line = null;
  for (const id of ['measure', 'target', 'line']) pressed(id, hands.tool === id);
  if (hands.tool) byId('fan').focus();
}
const actions = {
  ' ': () => goTo(moment ? null : history.newest), '.': () => goTo(null), '[': () => step(-1), ']': () => step(1), p: play,
  '+': () => zoom(1.25), '-': () => zoom(0.8), 0: () => hands.whole(), f: () => change({polar: !settings.polar}),
  n: () => change({up: settings.up === 'north' ? 'heading' : 'north'}), m: () => useTool('measure'), t: () => useTool('target'), l: () => useTool('line'),
  b: () => change({profile: !settings.profile}), g: () => change({rings: !settings.rings}), a: () => holdLevels(!settings.auto),
  c: () => change({map: names[(names.indexOf(settings.map) + 1) % names.length]}), s: () => savePicture(fan, shown_attitude), r: () => controls.recordFirst(),
  1: () => change({layout: 'both'}), 2: () => change({layout: 'fan'}), 3: () => change({layout: 'scene'}),
  '?': () => byId('dialog').showModal(), Escape: () => useTool(hands.tool),
};
/** Zooms the scene if it has the focus, else the fan. */
function zoom(factor) {
  document.activeElement === byId('view') ? world?.key(factor > 1 ? '+' : '-') : hands.zoom(factor);
}
function holdLevels(auto) { change({auto, held_db: reference ?? 0}); }

/** Keys of the page, unless they are for a field or a button. */
addEventListener('keydown', (event) => {
  alarm.context?.resume();
  const {target, key} = event, is_field = target.matches?.('input:not([type=checkbox]):not([type=range]), select, textarea') || byId('dialog').open;
  if (event.ctrlKey || event.altKey || event.metaKey || event.defaultPrevented || is_field || (settings.keys === 'off' && key !== 'Escape')) return;
  if (!Object.hasOwn(actions, key) || (key === ' ' && target.matches('button, input') && !target.closest('dialog')) || (key === 'Escape' && !hands.tool)) return;
  event.preventDefault();
  actions[key]();
});
byId('view').addEventListener('keydown', (event) => {
  if (event.key.startsWith('Arrow') && world?.key(event.key)) event.preventDefault();
});

/** Moves one handle of the contrast; they stay 5 dB apart. */
function setContrast(name) {
  const value = Number(byId(name).value);
  change(name === 'low' ? {low: Math.min(value, settings.high - 5)} : {high: Math.max(value, settings.low + 5)});
}
const handles = byId('low').parentElement;
handles.onpointermove = handles.onpointerdown = ({clientX, buttons}) => {
  if (buttons) return;  // the handle that is held stays above
  const box = handles.getBoundingClientRect(), {min, max} = byId('low'), at = Number(min) + (clientX - box.left) / box.width * (max - min);
  handles.classList.toggle('lower', at < (settings.low + settings.high) / 2);
};
handles.ondblclick = () => change({low: -45, high: 0});

if (!fan.gl) {
  byId('no_fan').hidden = false;
  byId('no_fan').textContent = 'The picture is not there: this browser has no WebGL 2.';
}
for (const name of names) byId('map').append(element('option', {}, name));
if (!names.includes(settings.map)) settings.map = names[0];
byId('low').oninput = byId('high').oninput = ({target}) => setContrast(target.id);
byId('map').oninput = () => change({map: byId('map').value});
byId('auto').oninput = () => holdLevels(byId('auto').checked);
byId('rings').oninput = () => change({rings: byId('rings').checked});
byId('north').oninput = () => change({up: byId('north').checked ? 'north' : 'heading'});
byId('source').onchange = () => {
  change({source: byId('source').value});
  choose(settings.source);
};
const buttons = {shape: 'f', freeze: ' ', save: 's', measure: 'm', target: 't', line: 'l', profile: 'b', whole: '0', back: '[', ahead: ']', play: 'p',
                 live: '.', settings: '?'};
for (const [id, key] of Object.entries(buttons)) byId(id).onclick = () => actions[key]();
for (const [id, layout] of [['full_fan', 'fan'], ['full_view', 'scene']]) byId(id).onclick = () => change({layout: settings.layout === layout ? 'both' : layout});
byId('moment').oninput = () => {
  const {value, min} = byId('moment'), before = Number(value), {newest, entries} = history;
  goTo(before > -0.05 || !newest ? null : before <= Number(min) ? entries[0] : history.at(newest.at + before));
};
hands.on_shift_click = (at) => fan.ping && explanation.ask(fan.ping.source, properties.status?.connections ?? [], fan.placeAt(...at));
hands.on_click = (at) => {
  explanation.clear();
  if (hands.tool === 'target' && fan.ping) targets.add(fan.placeAt(...at), fan.ping, snapshot);
  if (hands.tool === 'line' && fan.ping) fan.line = fan.placeAt(...at);
};
hands.on_key = () => { byId('spoken').textContent = `${fan.cursorText()} ${fan.measuredText()}`; };
hands.on_zoom = (zoom) => {
  byId('whole').disabled = zoom === 1;
  Object.assign(settings, {zoom, shift_x: fan.shift[0] / fan.canvas.width, shift_y: fan.shift[1] / fan.canvas.height});
};
addEventListener('pagehide', () => change({}));  // remembers the zoom
byId('dialog').onclick = ({target}) => target === byId('dialog') && byId('dialog').close();
addEventListener('pointerdown', () => settings.alarm === 'heard' && alarm.unlock());
new ResizeObserver(redraw).observe(byId('fan'));
fillDialog(byId('dialog'));
onSettings(showSettings);
showSettings();

/** Draws the scene for at most a fifth of the time, so that most is left to the fan, but about once a second. The time is
 *  that of the graphics device, which draws after the page. */
let next_view = 0, view_began = 0, view_drawn = null;
function drawScene(now) {
  const gl = world.renderer.getContext();
  if (view_drawn && gl.clientWaitSync(view_drawn, 0, 0) === gl.TIMEOUT_EXPIRED) return;
  if (view_drawn) next_view = now + Math.min(1000, 4 * (now - view_began));
  view_drawn = null;
  if (now < next_view || !world.draw()) return;
  view_began = now;
  view_drawn = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
}
function frame(now) {
  if (playing) playOn();
  if (needs_drawing) {
    const follows = hands.tool === 'line' && !fan.line && fan.cursorText() !== '';
    if (follows) fan.line = fan.placeAt(...fan.cursor);
    fan.draw();
    if (follows) fan.line = null;
    if (settings.profile && fan.ping) byId('beam').textContent = fan.drawProfile(byId('levels'));
  }
  needs_drawing = false;
  byId('cursor').textContent = fan.cursorText();
  byId('measured').textContent = fan.measuredText();
  if (world) drawScene(now);
  requestAnimationFrame(frame);
}
requestAnimationFrame(frame);

loadThree().then((THREE) => {
  world = new World(THREE, byId('view'));
  showScene();
  if (snapshot) world.showSnapshot(snapshot);
  showTargets();
  if (fan.ping) display(fan.ping);
}).catch((error) => {
  world = null;
  byId('no_view').hidden = false;
  byId('no_view').textContent = `The 3-D view is not there: ${error.message}. It needs three.js, which is built into the viewer where Debian's libjs-three is installed.`;
});

/** For tests and debugging. */
self.insonify = {fan, link, history, watch, settings, attitude, take, shown: () => shown, world: () => world, snapshot: () => snapshot, status: () => properties.status};
