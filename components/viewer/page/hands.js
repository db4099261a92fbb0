// Pointer gestures on the picture: the wheel or two fingers zoom, dragging moves it, a click measures, with Shift it explains.

const click_px = 4;

export class Hands {
  /** @param changed called when the picture must be drawn again */
  constructor(fan, changed) {
    this.fan = fan;
    this.changed = changed;
    this.measuring = false;
    this.down = new Map();  // pointers, by id
    const on = (kind, heard) => fan.canvas.addEventListener(kind, heard, {passive: false});
    on('pointermove', (event) => this.move(event));
    on('pointerdown', (event) => this.press(event));
    on('pointerup', (event) => this.lift(event));
    on('pointercancel', (event) => this.down.delete(event.pointerId));
    on('pointerleave', () => this.leave());
    on('wheel', (event) => this.wheel(event));
    on('dblclick', () => this.measuring || this.whole());
  }
  /** Returns the place in pixels of the canvas, from its lower left corner. */
  at({offsetX, offsetY}) { return [offsetX * devicePixelRatio, this.fan.canvas.height - offsetY * devicePixelRatio]; }

  press(event) {
    if (event.button !== 0) return;
    this.fan.canvas.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, {at: this.at(event), far: 0});
  }
  move(event) {
    const {fan} = this, at = this.at(event), finger = this.down.get(event.pointerId);
    fan.cursor = at;
    if (finger) this.drag(finger, at);
    this.changed();
  }
  drag(finger, at) {
    const [dx, dy] = [at[0] - finger.at[0], at[1] - finger.at[1]];
    const other = [...this.down.values()].find((one) => one !== finger);
    if (other) this.pinch(finger.at, at, other.at);
    else if (!this.measuring || finger.far > click_px) this.fan.moveBy(dx, dy);
    finger.far += Math.hypot(dx, dy);
    finger.at = at;
    this.tell();
  }
  pinch(from, to, still) {
    const apart = (a) => Math.max(1, Math.hypot(a[0] - still[0], a[1] - still[1]));
    this.fan.zoomBy(apart(to) / apart(from), [(to[0] + still[0]) / 2, (to[1] + still[1]) / 2]);
  }
  lift(event) {
    const finger = this.down.get(event.pointerId);
    this.down.delete(event.pointerId);
    if (finger?.far <= click_px) this.click(event);
    if (event.pointerType === 'touch') this.fan.cursor = null;
    this.changed();
  }
  click(event) {
    if (event.shiftKey) return this.on_shift_click?.(this.at(event));
    this.on_click?.();
    if (this.measuring) this.fan.mark(this.at(event));
  }
  leave() {
    if (!this.down.size) this.fan.cursor = null;
    this.changed();
  }
  wheel(event) {
    event.preventDefault();
    this.fan.zoomBy(Math.exp(-event.deltaY * 0.0015), this.at(event));
    this.tell();
    this.changed();
  }
  whole() {
    this.fan.whole();
    this.tell();
    this.changed();
  }
  measure(on) {
    this.measuring = on;
    this.fan.marks = [];
    this.tell();
    this.changed();
  }
  /** Updates the cursor and the gestures' state on the page. */
  tell() {
    this.fan.canvas.className = this.measuring ? 'measuring' : this.fan.zoom > 1 ? 'near' : '';
    this.on_zoom?.(this.fan.zoom);
  }
}
