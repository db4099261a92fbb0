// The connection to the viewer: opens it, opens it again when it breaks, and takes its messages apart.

const protocol = 'insonify.view.v1';

/** A binary message: u32 kind, u32 size of the JSON, JSON, data. */
export function takeApart(buffer) {
  const head = new DataView(buffer);
  const kind = head.getUint32(0, true), size = head.getUint32(4, true);
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, size)));
  return {kind, json, buffer, start: 8 + size};
}

export class Link {
  /** @param heard gets each message: JSON with a `type`, or {kind, json, buffer, start}. */
  constructor(heard, changed) {
    this.heard = heard;
    this.changed = changed;
    this.waiting = new Map();
    this.next_id = 1;
    this.opened = 0;
    this.delay = 250;
    this.open();
  }

  open() {
    this.socket = new WebSocket(`ws://${location.host}/${location.search}`, protocol);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onopen = () => {
      this.delay = 250;
      ++this.opened;
      this.changed(true);
    };
    this.socket.onmessage = (event) => this.take(event.data);
    this.socket.onclose = () => {
      this.changed(false);
      for (const done of this.waiting.values()) done({refused: 'the connection broke'});
      this.waiting.clear();
      setTimeout(() => this.open(), this.delay);
      this.delay = Math.min(this.delay * 1.5, 3000);
    };
  }

  take(data) {
    const message = typeof data === 'string' ? JSON.parse(data) : takeApart(data);
    if (message.type !== 'answer') return this.heard(message);
    this.waiting.get(message.id)?.(message);
    this.waiting.delete(message.id);
  }

  /** Gives {result} or {refused: why}. */
  ask(request) {
    const id = this.next_id++;
    if (this.socket.readyState !== WebSocket.OPEN) return Promise.resolve({refused: 'there is no connection'});
    this.socket.send(JSON.stringify({id, ...request}));
    return new Promise((done) => this.waiting.set(id, done));
  }
  call(operation, ...args) { return this.ask({call: operation, arguments: args.map(String)}); }
}
