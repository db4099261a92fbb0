// The scene, the sonar's fan in it, the water and the vehicles' paths in three dimensions; z is up.
import {palette} from './fan.js';
import {sameBeams} from './ping.js';

const tints = {sand: 0xb09a6c, mud: 0x7d7058, clay: 0x8a7460, gravel: 0x8f877a, stone: 0x85817a, rock: 0x7a756d, concrete: 0x9da1a2,
               steel: 0x86684e, rubber: 0x34373a, wood: 0x7c5c3c};
const deep = 0x0b2733, fog_density = 0.014;

const fan_vertex = `varying vec2 at; void main() { at = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.); }`;
const fan_fragment = `uniform sampler2D levels, colours; uniform vec2 brightness; varying vec2 at;
void main() {
  float level = texture2D(levels, at).r;
  float bright = level == 0. ? 0. : clamp(brightness.x + level * 255. * brightness.y, 0., 1.);
  gl_FragColor = vec4(texture2D(colours, vec2((bright * 255. + .5) / 256., .5)).rgb, .12 + .83 * bright);
}`;

const most_places = 20000, vehicle_tints = [0xf2c230, 0x4fc3f7, 0xef6c8f, 0x9ccc65, 0xb39ddb];

/** One source of poses: a body, and the path behind it. */
class Vehicle {
  /** @param number of earlier vehicles */
  constructor(THREE, number) {
    const colour = vehicle_tints[number % vehicle_tints.length];
    this.body = this.makeBody(THREE, colour);
    this.places = new THREE.BufferAttribute(new Float32Array(3 * most_places), 3);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', this.places);
    this.path = new THREE.Line(geometry, new THREE.LineBasicMaterial({color: colour, fog: false}));
    this.path.frustumCulled = false;
    this.group = new THREE.Group();
    this.group.add(this.body, this.path);
    this.count = 0;
  }
  makeBody(THREE, colour) {
    const hull = new THREE.CylinderGeometry(0.16, 0.16, 1, 16), nose = new THREE.ConeGeometry(0.16, 0.3, 16);
    for (const geometry of [hull, nose]) geometry.rotateZ(-Math.PI / 2);
    nose.translate(0.65, 0, 0);
    const material = new THREE.MeshPhongMaterial({color: colour}), group = new THREE.Group();
    group.add(new THREE.Mesh(hull, material), new THREE.Mesh(nose, material));
    return group;
  }

  /** Moves the body. A time that goes back begins another path: a run was restarted, or a log was sought in. */
  moveTo({time_us, position, orientation}) {
    this.body.position.fromArray(position);
    this.body.quaternion.fromArray(orientation);
    if (time_us < this.time_us) this.count = 0;
    this.time_us = time_us;
    if (this.count === most_places) {
      this.places.array.copyWithin(0, 3 * most_places / 2);
      this.count = most_places / 2;
    }
    this.places.array.set(position, 3 * this.count++);
    this.places.needsUpdate = true;
    this.path.geometry.setDrawRange(0, this.count);
  }
}

/** Loads three.js, which the viewer may have been built without. */
export async function loadThree() {
  await import('./three.min.js');
  return self.THREE;
}

/** Removes everything from a group, and from the graphics device. */
function empty(group) {
  group.traverse((node) => {
    node.geometry?.dispose();
    node.material?.dispose();
  });
  group.remove(...group.children);
}

export class World {
  constructor(THREE, canvas) {
    this.THREE = THREE;
    this.canvas = canvas;
    const context = canvas.getContext('webgl2', {antialias: true});
    if (!context) throw new Error('this browser has no WebGL 2');
    this.renderer = new THREE.WebGLRenderer({canvas, context});
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(deep);
    this.scene.fog = new THREE.FogExp2(deep, fog_density);
    this.camera = new THREE.PerspectiveCamera(55, 1, 0.1, 2000);
    this.camera.up.set(0, 0, 1);
    const sun = new THREE.DirectionalLight(0xdff2f5, 0.55);
    sun.position.set(0.4, 0.5, 1);
    this.scene.add(new THREE.HemisphereLight(0xbfe3ea, 0x24323a, 0.75), sun);
    this.content = new THREE.Group();
    this.sonar = new THREE.Group();
    this.scene.add(this.content, this.sonar);
    this.vehicles = new Map();  // by source
    this.objects = new Map();
    this.moved = [];
    this.azimuth = -2.55;   // of the camera around the sonar [rad]
    this.elevation = 0.62;
    this.distance = 24;
    this.is_north_up = false;
    this.dirty = true;
    this.steer();
  }

  /** Handles dragging, which turns; the wheel or two fingers zoom. */
  steer() {
    const down = new Map(), on = (kind, heard) => this.canvas.addEventListener(kind, heard, {passive: false});
    on('pointerdown', (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      down.set(event.pointerId, [event.clientX, event.clientY]);
    });
    on('pointermove', ({pointerId, clientX, clientY}) => {
      const from = down.get(pointerId), to = [clientX, clientY];
      if (!from) return;
      const still = [...down].find(([id]) => id !== pointerId)?.[1], apart = (at) => Math.max(1, Math.hypot(at[0] - still[0], at[1] - still[1]));
      down.set(pointerId, to);
      still ? this.approach(apart(from) / apart(to)) : this.turn(to[0] - from[0], to[1] - from[1]);
    });
    for (const kind of ['pointerup', 'pointercancel']) on(kind, (event) => down.delete(event.pointerId));
    on('wheel', (event) => {
      event.preventDefault();
      this.approach(Math.exp(event.deltaY * 0.001));
    });
  }
  /** Handles a key: arrows turn, + and - zoom. Returns whether it did. */
  key(name) {
    const step = 12, turns = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]}[name];
    if (turns) this.turn(...turns);
    else if (name === '+' || name === '-') this.approach(name === '+' ? 1 / 1.25 : 1.25);
    return turns !== undefined || name === '+' || name === '-';
  }
  turn(dx, dy) {
    this.azimuth -= dx * 0.006;
    this.elevation = Math.max(-1.4, Math.min(1.5, this.elevation + dy * 0.006));
    this.dirty = true;
  }
  approach(factor) {
    this.distance = Math.max(1, Math.min(500, this.distance * factor));
    this.dirty = true;
  }

  /** Shows the scene's meshes: a message of kind 2. */
  showScene({json, buffer, start}) {
    const {THREE} = this;
    empty(this.content);
    this.objects.clear();
    const materials = json.materials.map((name) => new THREE.MeshPhongMaterial(
        {color: tints[name.toLowerCase()] ?? 0x8d9498, flatShading: true, shininess: 4, side: THREE.DoubleSide}));
    const meshes = json.meshes.map((mesh) => {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(buffer, start + mesh.positions.offset, mesh.positions.count), 3));
      geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(buffer, start + mesh.indices.offset, mesh.indices.count), 1));
      return {geometry, material: materials[mesh.material]};
    });
    for (const object of json.objects) {
      const mesh = new THREE.Mesh(meshes[object.mesh].geometry, meshes[object.mesh].material);
      mesh.matrixAutoUpdate = false;
      mesh.matrix.fromArray(object.matrix);
      this.objects.set(object.object, {mesh, home: object.matrix, rest: mesh.geometry});
      this.content.add(mesh);
    }
    this.dirty = true;
    return `${json.triangles.toLocaleString()} triangles, ${json.objects.length} objects` +
        (json.coarse ? `, coarse; ${json.left_out} small objects not shown` : '');
  }

  showSnapshot(json) {
    this.sonar.position.fromArray(json.position);
    this.sonar.quaternion.fromArray(json.orientation);
    for (const number of this.moved) this.objects.get(number)?.mesh.matrix.fromArray(this.objects.get(number).home);
    for (const {object, matrix} of json.moved) this.objects.get(object)?.mesh.matrix.fromArray(matrix);
    this.moved = json.moved.map((one) => one.object);
    this.showShapes(json);
    this.showWater(json.water_surface);
    this.dirty = true;
  }
  /** Shows deformed meshes: positions of their vertices. Other meshes are as in the scene's message. */
  showShapes({shapes = [], buffer, start}) {
    for (const one of this.objects.values()) one.mesh.geometry = one.rest;
    for (const {object, offset, count} of shapes) {
      const one = this.objects.get(object);
      if (!one) continue;
      one.posed ??= one.rest.clone();
      one.posed.attributes.position.array.set(new Float32Array(buffer, start + offset, count));
      one.posed.attributes.position.needsUpdate = true;
      one.posed.computeBoundingSphere();
      one.mesh.geometry = one.posed;
    }
  }
  /** @param z undefined: no water */
  showWater(z) {
    const {THREE} = this;
    if (!this.water && z !== undefined) {
      this.water = new THREE.Mesh(new THREE.PlaneBufferGeometry(600, 600), new THREE.MeshBasicMaterial(
          {color: 0x6fc3d6, transparent: true, opacity: 0.16, side: THREE.DoubleSide, depthWrite: false}));
      this.grid = new THREE.GridHelper(600, 60, 0x9fdbe6, 0x9fdbe6);
      this.grid.rotation.x = Math.PI / 2;
      Object.assign(this.grid.material, {transparent: true, opacity: 0.14, depthWrite: false});
      this.scene.add(this.water, this.grid);
    }
    for (const node of this.water ? [this.water, this.grid] : []) {
      node.visible = z !== undefined;
      node.position.z = z ?? 0;
    }
  }

  showPose(json) {
    if (!this.vehicles.has(json.source)) {
      this.vehicles.set(json.source, new Vehicle(this.THREE, this.vehicles.size));
      this.scene.add(this.vehicles.get(json.source).group);
    }
    this.vehicles.get(json.source).moveTo(json);
    this.dirty = true;
  }

  /** @param targets those with a position [m] */
  showTargets(targets) {
    const {THREE} = this;
    this.marks ??= new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({color: 0x8df08a, size: 9, sizeAttenuation: false, fog: false, depthTest: false, transparent: true}));
    this.marks.geometry.setAttribute('position', new THREE.Float32BufferAttribute(targets.flatMap(({position}) => position ?? []), 3));
    this.marks.frustumCulled = false;
    this.marks.renderOrder = 1;  // after all else: a mark may be below the sea floor
    this.scene.add(this.marks);
    this.dirty = true;
  }

  /** Shows the ping in the world; level 0 of the display is as faint as visible. */
  showPing(ping, top_db, span_db, map) {
    const {THREE} = this, key = [ping.bins, ping.bin_m, ping.beam_height].join();
    if (this.fan_key !== key || !sameBeams(this.shown, ping)) this.makeFan(ping, key);
    if (this.map !== map) {
      this.map = map;
      this.uniforms.colours.value?.dispose();
      this.uniforms.colours.value = new THREE.DataTexture(palette(map), 256, 1, THREE.RGBAFormat);
      this.uniforms.colours.value.needsUpdate = true;
    }
    this.levels.image.data = ping.data;
    this.levels.needsUpdate = true;
    this.uniforms.brightness.value.set((ping.top_db - 255 * ping.step_db - top_db) / span_db + 1, ping.step_db / span_db);
    this.dirty = true;
  }
  makeFan(ping, key) {
    const {THREE} = this, far = ping.bins * ping.bin_m, positions = [], uvs = [], indices = [];
    this.fan_key = key;
    this.shown = ping;
    empty(this.sonar);
    this.levels?.dispose();
    this.uniforms?.colours.value?.dispose();
    ping.edges.forEach((edge, i) => {
      for (const r of [0.02 * far, far]) positions.push(r * Math.cos(edge), r * Math.sin(edge), 0);
      for (const u of [0.02, 1]) uvs.push(u, Math.ceil(i / 2) / ping.beams);
      if (i % 2) indices.push(2 * i - 2, 2 * i - 1, 2 * i + 1, 2 * i - 2, 2 * i + 1, 2 * i);
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
    geometry.setAttribute('uv', new THREE.Float32BufferAttribute(uvs, 2));
    geometry.setIndex(indices);
    this.levels = new THREE.DataTexture(ping.data, ping.bins, ping.beams, THREE.LuminanceFormat);
    this.uniforms = {levels: {value: this.levels}, colours: {value: null}, brightness: {value: new THREE.Vector2()}};
    this.map = null;
    const material = new THREE.ShaderMaterial({uniforms: this.uniforms, vertexShader: fan_vertex, fragmentShader: fan_fragment,
                                               transparent: true, side: THREE.DoubleSide, depthWrite: false});
    const fan = new THREE.Mesh(geometry, material);
    fan.frustumCulled = false;
    this.sonar.add(fan, this.makeFrame(ping, far));
  }
  /** Returns the edges of the water in the fan. */
  makeFrame(ping, far) {
    const {THREE} = this, points = [], half = ping.beam_height / 2, low = ping.edges[0], high = ping.edges[ping.edges.length - 1];
    const at = (edge, up) => [far * Math.cos(up) * Math.cos(edge), far * Math.cos(up) * Math.sin(edge), far * Math.sin(up)];
    for (const up of [-half, half]) {
      for (let k = 0; k < 48; ++k)
        for (const share of [k, k + 1]) points.push(...at(low + (high - low) * share / 48, up));
      for (const edge of [low, high]) points.push(0, 0, 0, ...at(edge, up));
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
    const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: 0xf2b04a, transparent: true, opacity: 0.4}));
    lines.frustumCulled = false;
    return lines;
  }

  /** Returns whether there was something to draw. */
  draw() {
    const {clientWidth: w, clientHeight: h} = this.canvas, {THREE} = this;
    if (this.drawn_size !== `${w} ${h} ${devicePixelRatio}`) {
      this.drawn_size = `${w} ${h} ${devicePixelRatio}`;
      this.renderer.setPixelRatio(devicePixelRatio);
      this.renderer.setSize(w, h, false);
      this.camera.aspect = w / h;
      this.camera.updateProjectionMatrix();
      this.dirty = true;
    }
    if (!this.dirty || !w || !h) return false;
    this.dirty = false;
    const heading = new THREE.Vector3(1, 0, 0).applyQuaternion(this.sonar.quaternion);
    const target = this.sonar.position.clone().addScaledVector(heading, this.distance * 0.45);
    const c = Math.cos(this.elevation) * this.distance, turn = this.azimuth + (this.is_north_up ? 0 : Math.atan2(heading.y, heading.x));
    this.camera.position.set(target.x + c * Math.cos(turn), target.y + c * Math.sin(turn), target.z + this.distance * Math.sin(this.elevation));
    this.camera.lookAt(target);
    this.renderer.render(this.scene, this.camera);
    return true;
  }
}
