// What comes from the server, and what it is asked. The connection is made
// again whenever it is lost; what was shown stays meanwhile.

const SILENCE = 16000;          // ms without a word: nobody is there
const LONGEST = 8000;           // ms between attempts

export class Connection {
  // Told: snapshot(dict), events(list), state('open' | 'lost' | 'refused').
  constructor(told) {
    this.told = told;
    this.wait = 300;
    this.held = null;
    this.open();
    document.addEventListener('visibilitychange', () => {
      if (!document.hidden && !this.socket) this.again(0);
    });
  }

  open() {
    clearTimeout(this.timer);
    const address = new URL('feed', location.href);
    address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = this.socket = new WebSocket(address);
    socket.onmessage = ({ data }) => {
      if (socket === this.socket) this.heard(JSON.parse(data));
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

  heard(frame) {
    this.listen();
    if (frame.snapshot) {
      this.wait = 300;
      this.held = null;
      this.told.snapshot(frame.snapshot);
      this.told.state('open');
    } else if (frame.events) {
      if (this.held) this.held.push(frame.events);
      else this.told.events(frame.events);
    } else if (frame.error) {
      this.refused = true;
      this.told.state('refused', frame.error);
    }
  }

  lost() {
    clearTimeout(this.silence);
    this.socket = null;
    if (!this.refused) this.told.state('lost');     // else it was told why
    this.again(this.wait);
    this.wait = Math.min(LONGEST, this.wait * 1.7);
  }

  again(wait) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => { if (!this.socket) this.open(); }, wait);
  }

  // What happens while the server looks may be in what it sees or not: it
  // is told afterwards once more.
  async refresh() {
    if (this.held || !this.socket) return;
    this.held = [];
    try {
      const scene = await this.ask({ ask: 'survey' });
      if (this.held) this.told.snapshot(scene);
    } finally {
      const held = this.held || [];
      this.held = null;
      for (const events of held) this.told.events(events);
    }
  }

  // The answer to a question or an order; an error says why there is none.
  async ask(message) {
    let response;
    try {
      response = await fetch('ask', { method: 'POST',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify(message) });
    } catch {
      throw new Error('The server of this page does not answer');
    }
    if (!response.ok)
      throw new Error((await response.text()).trim() || `Status ${response.status}`);
    const told = await response.json();
    if (told.error !== undefined) throw new Error(told.error);
    return told.answer;
  }
}
