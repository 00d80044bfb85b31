// The connection to the hosts: a server, or a worker of this tab, see open().

const SILENCE = 16000;          // ms without a frame: the connection is lost
const LONGEST = 8000;           // ms between attempts

// callbacks are snapshot(dict), events(list), and state('open' | 'lost' |
// 'refused' | 'stopped').
class Connection {
  constructor(callbacks) {
    this.callbacks = callbacks;
    this.held = null;
  }

  onFrame(frame) {
    if (frame.snapshot) {
      this.held = null;
      this.callbacks.snapshot(frame.snapshot);
      this.callbacks.state('open');
    } else if (frame.events) {
      if (this.held) this.held.push(frame.events);
      else this.callbacks.events(frame.events);
    }
  }

  // The snapshot may or may not contain events that happen while the hosts
  // make it: so they are applied again afterwards.
  async refresh() {
    if (this.held || !this.there) return;
    this.held = [];
    try {
      const scene = await this.ask({ ask: 'survey' });
      if (this.held) this.callbacks.snapshot(scene);
    } finally {
      const held = this.held || [];
      this.held = null;
      for (const events of held) this.callbacks.events(events);
    }
  }

  // Returns the answer to a query or an order, or throws an error with the
  // reason.
  async ask(message) {
    const reply = JSON.parse(await this.send(JSON.stringify(message)));
    if (reply.error !== undefined) throw new Error(reply.error);
    return reply.answer;
  }
}

// The connection to a server. It is made again whenever it is lost; the page
// keeps its contents meanwhile.
class ServerConnection extends Connection {
  constructor(callbacks) {
    super(callbacks);
    this.wait = 300;
    this.open();
    document.addEventListener('visibilitychange', () => {
      if (!document.hidden && !this.socket) this.again(0);
    });
  }

  get there() { return Boolean(this.socket); }

  open() {
    clearTimeout(this.timer);
    const address = new URL('feed', location.href);
    address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = this.socket = new WebSocket(address);
    socket.onmessage = ({ data }) => {
      if (socket === this.socket) this.onFrame(JSON.parse(data));
    };
    socket.onopen = () => { this.refused = false; };
    socket.onclose = () => {
      if (socket === this.socket) this.lost();
    };
    this.listen();
  }

  listen() {
    clearTimeout(this.silence);
    this.silence = setTimeout(() => {
      const socket = this.socket;
      this.lost();
      socket?.close();
    }, SILENCE);
  }

  onFrame(frame) {
    this.listen();
    if (frame.snapshot) this.wait = 300;
    super.onFrame(frame);
    if (frame.error) {
      this.refused = true;
      this.callbacks.state('refused', frame.error);
    }
  }

  lost() {
    clearTimeout(this.silence);
    this.socket = null;
    if (!this.refused) this.callbacks.state('lost'); // else state() has the reason
    this.again(this.wait);
    this.wait = Math.min(LONGEST, this.wait * 1.7);
  }

  again(wait) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => { if (!this.socket) this.open(); }, wait);
  }

  async send(body) {
    let response;
    try {
      response = await fetch('ask', { method: 'POST', body,
        headers: { 'Content-Type': 'application/json' } });
    } catch {
      throw new Error('The server of this page does not answer');
    }
    const text = await response.text();
    if (!response.ok)
      throw new Error(text.trim() || `Status ${response.status}`);
    return text;
  }
}

// The connection to a worker of this tab. Frames and replies are JSON, as those
// of a server; other messages are announced to `onNews`. A worker that does not
// come to an end is replaced by another one.
class WorkerConnection extends Connection {
  constructor(callbacks, start) {
    super(callbacks);
    this.start = start;         // () => a promise of a worker
    this.waiting = new Map();   // id -> {resolve, reject, since}
    this.count = 0;
    this.onNews = () => {};
    this.begin();
  }

  get there() { return Boolean(this.worker); }

  begin() {
    const worker = this.ready = this.start();
    return worker.then(made => {
      if (worker !== this.ready) return made.terminate();
      this.worker = made;
      made.onmessage = ({ data }) => this.heard(data);
      made.onerror = event => this.stop(event.message);
      return this.post({ do: 'first' });
    }).catch(error => this.callbacks.state('stopped', error.message));
  }

  heard({ frame, id, reply, error, ...news }) {
    if (frame) this.onFrame(JSON.parse(frame));
    const asked = this.waiting.get(id);
    this.waiting.delete(id);
    if (error !== undefined && asked) asked.reject(new Error(error));
    else if (asked) asked.resolve(reply);
    if (Object.keys(news).length > 0) this.onNews(news);
  }

  // When the oldest message was sent that has no reply yet.
  get waitsSince() {
    const [oldest] = this.waiting.values();
    return oldest ? oldest.since : Infinity;
  }

  // Send a message to the worker; returns a promise of its reply.
  async post(message) {
    await this.ready;
    return new Promise((resolve, reject) => {
      const id = ++this.count;
      this.waiting.set(id, { resolve, reject, since: performance.now() });
      this.worker.postMessage({ ...message, id });
    });
  }

  send(body) { return this.post({ ask: body }); }

  // End the worker, whatever it does, and begin another one.
  stop(why = 'The run was stopped') {
    this.worker?.terminate();
    this.worker = null;
    for (const { reject } of this.waiting.values()) reject(new Error(why));
    this.waiting.clear();
    this.held = null;
    this.callbacks.snapshot({ time: 0, hosts: [], agents: [] });
    this.callbacks.state('stopped', why);
    return this.begin();
  }
}

// The hosts are in a worker if the page, before this is called, has set
// globalThis.typhonWorker to a function that starts one.
export const open = callbacks => globalThis.typhonWorker
  ? new WorkerConnection(callbacks, globalThis.typhonWorker)
  : new ServerConnection(callbacks);
