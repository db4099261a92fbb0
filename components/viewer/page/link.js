// The connection to the viewer: opens it, reopens it when it breaks, and splits its messages.

const protocol = 'insonify.view.v1';
/** Max silence until the first status (a scene may be large) and after it [ms]. */
const first_patience = 30000, patience = 5000;

/** Splits a binary message: u32 kind, u32 size of the JSON, JSON, data. */
export function splitFrame(buffer) {
  const head = new DataView(buffer);
  const kind = head.getUint32(0, true), size = head.getUint32(4, true);
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, size)));
  return {kind, json, buffer, start: 8 + size};
}

export class Link {
  /** @param heard receives each message: JSON with a `type`, or {kind, json, buffer, start} */
  constructor(heard, changed) {
    this.heard = heard;
    this.changed = changed;
    this.waiting = new Map();
    this.next_id = 1;
    this.opened = 0;
    this.delay = 250;
    this.open();
    setInterval(() => this.watch(), 500);
  }

  open() {
    const socket = this.socket = new WebSocket(`ws://${location.host}/${location.search}`, protocol);
    socket.binaryType = 'arraybuffer';
    this.heard_at = performance.now();
    this.patience = first_patience;
    socket.onopen = () => {
      this.delay = 250;
      ++this.opened;
      this.changed(true);
    };
    socket.onmessage = (event) => this.take(event.data);
    socket.onclose = () => this.again();
  }
  /** Reopens a silent connection. The other end may be gone without notice; closing would wait long for its answer. */
  watch() {
    if (performance.now() - this.heard_at < this.patience || this.socket.onclose === null) return;
    this.socket.close();
    this.again();
  }
  again() {
    this.socket.onclose = this.socket.onmessage = this.socket.onopen = null;
    this.changed(false);
    for (const done of this.waiting.values()) done({refused: 'the connection broke'});
    this.waiting.clear();
    setTimeout(() => this.open(), this.delay);
    this.delay = Math.min(this.delay * 1.5, 3000);
  }

  take(data) {
    const message = typeof data === 'string' ? JSON.parse(data) : splitFrame(data);
    this.heard_at = performance.now();
    if (message.type === 'status') this.patience = patience;
    if (message.type !== 'answer') return this.heard(message);
    this.waiting.get(message.id)?.(message);
    this.waiting.delete(message.id);
  }

  /** Sends a request; resolves to {result} or {refused: why}. */
  ask(request) {
    const id = this.next_id++;
    if (this.socket.readyState !== WebSocket.OPEN) return Promise.resolve({refused: 'there is no connection'});
    this.socket.send(JSON.stringify({id, ...request}));
    return new Promise((done) => this.waiting.set(id, done));
  }
  call(operation, ...args) { return this.ask({call: operation, arguments: args.map(String)}); }
}
