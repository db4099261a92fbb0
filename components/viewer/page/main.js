// Routes messages of the link to the parts of the page.
import {names} from './colours.js';
import {attitudeOf, showAttitude} from './attitude.js';
import {Controls} from './controls.js';
import {Explanation} from './explain.js';
import {Fan} from './fan.js';
import {First} from './first.js';
import {showGraph} from './graph.js';
import {Hands} from './hands.js';
import {Link} from './link.js';
import {Places} from './places.js';
import {Scan, pingOf, strongLevel} from './ping.js';
import {savePicture} from './save.js';
import {Properties, Rates, element, showPlan, showTasks} from './tables.js';
import {Timelines} from './timeline.js';
import {World, loadThree} from './world.js';

const byId = (id) => document.getElementById(id);
const fan = new Fan(byId('fan'), byId('overlay'));
const rates = new Rates(), scans = new Map(), arrivals = [], scenes = new Map(), places = new Places(), poses = new Places();
let interfaces = '', world = null, scene = null, snapshot = null, shown_attitude = null, placed = '', reference = null, missed = 0, last_count = null, shown = 0, needs_drawing = false, frozen = false;

const link = new Link(take, (open) => {
  byId('link').className = open ? 'lamp' : 'lamp off';
  byId('link').textContent = open ? 'connected' : 'no connection';
  byId('link').title = `Foxglove: open connection, Foxglove WebSocket, ws://${location.host}`;
  last_count = null;
});
const properties = new Properties(link), controls = new Controls(link, byId('controls'));
const first = new First(link, byId('first')), timelines = new Timelines(link, byId('timelines'));
const hands = new Hands(fan, () => { needs_drawing = true; }), explanation = new Explanation(link, byId('explained'));

const show = {
  interfaces(message) {
    const before = interfaces;
    interfaces = JSON.stringify(message);
    if (interfaces === before) return;  // a restored connection: fields keep the text being typed
    for (const part of [properties, controls, first, timelines, explanation]) part.setInterfaces(message);
  },
  status(status) {
    rates.update(status);
    showTasks(status, rates);
    showGraph(byId('graph'), status, rates);
    showPlan(status);
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
  if (message.kind === 1) return setPing(pingOf(message));
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
  byId('pose_text').textContent = 'sonar ' + snapshot.position.map((x) => x.toFixed(2)).join('  ') + ' m';
}

/** Returns the attitude of the vehicle at the time of the ping, else of the sonar; null if unknown. */
function attitude() {
  const {ping} = fan, connections = properties.status?.connections ?? [];
  const found = (ping && poses.of(ping, connections)) ?? snapshot;
  return found ? {...attitudeOf(found, snapshot?.water_surface), source: found.source} : null;
}

function setPing(ping) {
  const chooser = byId('source');
  if (![...chooser.options].some((option) => option.value === ping.source)) chooser.append(element('option', {}, ping.source));
  if (chooser.value !== ping.source || !ping.beams) return;
  if (ping.beams === 1) {
    if (!scans.has(ping.source)) scans.set(ping.source, new Scan());
    ping = scans.get(ping.source).add(ping);
  }
  const strong = strongLevel(ping);
  reference = reference === null || Math.abs(strong - reference) > 30 ? strong : reference + 0.1 * (strong - reference);
  tell(ping);
  if (frozen) return;
  display(ping);
  shown_attitude = attitude();  // while its pose is still known
  showAttitude(byId('attitude'), shown_attitude);
}

function tell(ping) {
  const now = performance.now();
  arrivals.push(now);
  while (arrivals[0] < now - 2000) arrivals.shift();
  if (last_count !== null && ping.count > last_count) missed += ping.count - last_count - 1;
  last_count = ping.count;
  byId('time').textContent = `${(ping.time_us * 1e-6).toFixed(2)} s`;
  if (ping.time_us > 1e15) byId('time').textContent = new Date(ping.time_us / 1e3).toISOString().slice(11, 22);
  byId('reach').textContent = `${(ping.bins * ping.bin_m).toFixed(1)} m, ${ping.beams} x ${ping.bins}, ${(ping.bin_m * 1e3).toFixed(0)} mm`;
  byId('rate').textContent = arrivals.length > 1 ? ((arrivals.length - 1) * 1e3 / (now - arrivals[0])).toFixed(1) : '-';
  byId('latency').textContent = `${(ping.latency_s * 1e3).toFixed(1)} ms`;
  byId('missed').textContent = missed;
}

function display(ping) {
  const top = reference - Number(byId('gain').value);
  fan.span_db = Number(byId('span').value);
  fan.show(ping, top);
  place();
  world?.showPing(ping, top, fan.span_db, byId('map').value);
  needs_drawing = true;
  ++shown;
}

function settingsChanged() {
  byId('gain_db').textContent = `${byId('gain').value} dB`;
  byId('span_db').textContent = `${byId('span').value} dB`;
  fan.rings = byId('rings').checked;
  fan.setColours(byId('map').value);
  if (fan.ping) display(fan.ping);
}

if (!fan.gl) {
  byId('no_fan').hidden = false;
  byId('no_fan').textContent = 'The picture is not there: this browser has no WebGL 2.';
}
for (const name of names) byId('map').append(element('option', {}, name));
for (const id of ['map', 'gain', 'span', 'rings']) byId(id).oninput = settingsChanged;
byId('source').onchange = () => { reference = null; last_count = null; };
byId('shape').onclick = () => {
  fan.polar = !fan.polar;
  byId('shape').textContent = fan.polar ? 'polar' : 'fan';
  needs_drawing = true;
};
byId('freeze').onclick = () => {
  frozen = !frozen;
  byId('freeze').className = frozen ? 'on' : '';
};
byId('measure').onclick = () => {
  hands.measure(!hands.measuring);
  byId('measure').className = hands.measuring ? 'on' : '';
};
hands.on_shift_click = (at) => fan.ping && explanation.ask(fan.ping.source, properties.status?.connections ?? [], fan.placeAt(...at));
hands.on_click = () => explanation.clear();
byId('whole').onclick = () => hands.whole();
hands.on_zoom = (zoom) => { byId('whole').disabled = zoom === 1; };
byId('save').onclick = () => savePicture(fan, shown_attitude);
addEventListener('resize', () => { needs_drawing = true; });
settingsChanged();

/** Draws the scene for at most a fifth of the time, so that most is left to the fan, but at least once a second. */
let next_view = 0;
function frame(now) {
  if (needs_drawing) fan.draw();
  needs_drawing = false;
  byId('cursor').textContent = fan.cursorText();
  byId('measured').textContent = fan.measuredText(snapshot ? attitudeOf(snapshot).heading : undefined);
  if (world && now >= next_view) {
    const begin = performance.now();
    world.draw();
    next_view = now + Math.min(1000, 4 * (performance.now() - begin));
  }
  requestAnimationFrame(frame);
}
requestAnimationFrame(frame);

loadThree().then((THREE) => {
  world = new World(THREE, byId('view'));
  showScene();
  if (snapshot) world.showSnapshot(snapshot);
  if (fan.ping) display(fan.ping);
}).catch((error) => {
  world = null;
  byId('no_view').hidden = false;
  byId('no_view').textContent = `The 3-D view is not there: ${error.message}. It needs three.js, which is built into the viewer where Debian's libjs-three is installed.`;
});

/** For tests and debugging. */
self.insonify = {fan, link, attitude, shown: () => shown, world: () => world, snapshot: () => snapshot, status: () => properties.status};
