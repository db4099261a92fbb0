// One source of poses: a body, and the path behind it.

const most_places = 20000, tints = [0xf2c230, 0x4fc3f7, 0xef6c8f, 0x9ccc65, 0xb39ddb];

export class Vehicle {
  /** @param number of earlier vehicles */
  constructor(THREE, number) {
    const colour = tints[number % tints.length];
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
