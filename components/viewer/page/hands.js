// Pointer gestures and keys on the picture: the wheel or two fingers zoom, dragging moves it, a click does what the tool is
// for, with Shift it explains. Arrows move a cursor, and Enter is a click there.

const click_px = 4, key_px = 8;

export class Hands {
  /** @param changed called when the picture must be drawn again */
  constructor(fan, changed) {
    this.fan = fan;
    this.changed = changed;
    this.tool = '';  // measure, target, line; empty: none
    this.down = new Map();  // pointers, by id
    const on = (kind, heard) => fan.canvas.addEventListener(kind, heard, {passive: false});
    on('pointermove', (event) => this.move(event));
    on('pointerdown', (event) => this.press(event));
    on('pointerup', (event) => this.lift(event));
    on('pointercancel', (event) => this.down.delete(event.pointerId));
    on('pointerleave', () => this.leave());
    on('wheel', (event) => this.wheel(event));
    on('dblclick', () => this.tool || this.whole());
    on('keydown', (event) => this.key(event));
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
    else if (!this.tool || finger.far > click_px) this.fan.moveBy(dx, dy);
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
    if (finger?.far <= click_px) this.click(this.at(event), event.shiftKey);
    if (event.pointerType === 'touch') this.fan.cursor = null;
    this.changed();
  }
  click(at, has_shift) {
    if (has_shift) return this.on_shift_click?.(at);
    this.on_click?.(at);
    if (this.tool === 'measure') this.fan.mark(at);
  }
  leave() {
    if (!this.down.size) this.fan.cursor = null;
    this.changed();
  }
  wheel(event) {
    event.preventDefault();
    this.zoom(Math.exp(-event.deltaY * 0.0015), this.at(event));
  }
  /** Zooms about a pixel, else about the cursor or the middle. */
  zoom(factor, about = this.fan.cursor ?? [this.fan.canvas.width / 2, this.fan.canvas.height / 2]) {
    this.fan.zoomBy(factor, about);
    this.tell();
    this.changed();
  }
  whole() {
    this.fan.whole();
    this.tell();
    this.changed();
  }
  /** Chooses a tool; empty: none. */
  use(tool) {
    this.tool = tool;
    this.fan.marks = [];
    this.tell();
    this.changed();
  }

  /** Handles a key of the picture that has the focus; other keys are for the page. */
  key(event) {
    const {fan} = this, {canvas} = fan, step = key_px * devicePixelRatio * (event.repeat ? 3 : 1);
    const by = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]}[event.key];
    if ((!by && event.key !== 'Enter') || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    fan.cursor ??= [canvas.width / 2, canvas.height / 2];
    if (by) this.moveCursor(by);
    else this.click(fan.cursor, event.shiftKey);
    this.changed();
    this.on_key?.();
  }
  /** Moves the cursor, and the picture where the cursor would leave it. */
  moveCursor(by) {
    const {fan} = this, size = [fan.canvas.width, fan.canvas.height], wanted = fan.cursor.map((x, i) => x + by[i]);
    fan.cursor = wanted.map((x, i) => Math.max(0, Math.min(size[i], x)));
    fan.moveBy(...wanted.map((x, i) => fan.cursor[i] - x));
  }
  /** Updates the cursor and the gestures' state on the page. */
  tell() {
    this.fan.canvas.className = this.tool ? 'measuring' : this.fan.zoom > 1 ? 'near' : '';
    this.on_zoom?.(this.fan.zoom);
  }
}
