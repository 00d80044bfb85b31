// The state of a network: hosts, links, agents, counts. Both the live feed
// and a replay write to it a snapshot and lists of events
//
//     [time, host, agent, kind, argument, ...]
//
// and all views read it. It depends neither on pixels nor on the document, and
// does not check what it gets.

import { APPLY, History } from './events.js';
import { machineOf, processOf, programGuess, shortName } from './names.js';

const TRAIL = 64;               // visited hosts stored for each agent
const ENDED = 2000;             // ended agents that are still shown
const RECENT = 60000;           // past events kept for the views, live
const LOGGED = 500000;          // ... in a replay, whose log is in memory
const LINES = 200;              // log lines stored for each host
const MINIMUM = 0.3;            // least seconds for the mark of a hop

// Listeners by the name of the event; on() returns the function that removes one.
export class Announcer {
  constructor() { this.listeners = new Map(); }

  on(name, listener) {
    if (!this.listeners.has(name)) this.listeners.set(name, new Set());
    this.listeners.get(name).add(listener);
    return () => this.listeners.get(name).delete(listener);
  }

  tell(name, ...args) {
    for (const listener of this.listeners.get(name) || []) listener(...args);
  }
}

// The store announces 'change' after changes, at most once a frame and never
// while the page is hidden, and 'events' with each list of events.
export class Store extends Announcer {
  // clock: () => seconds, the time for moving marks; stamped: whether events
  // are shown at their own times (a replay) or when they are received (live).
  constructor({ clock = () => performance.now() / 1000, stamped = false,
                width = 1 } = {}) {
    super();
    this.clock = clock;
    this.stamped = stamped;
    this.width = width;
    this.rate = 1;              // seconds of the clock per real second
    this.version = 0;           // increased with every change
    this.shape = 0;             // ... of hosts or links
    this.dirty = false;
    this.reset();
  }

  reset() {
    this.time = 0;              // of the latest event or snapshot
    this.start = null;          // of the first
    this.hosts = new Map();
    this.agents = new Map();
    this.links = new Map();     // "a b", a before b -> {a, b, cost}
    this.programs = new Map();  // name -> {name, agents}
    this.ended = new Set();     // ids, the oldest first
    this.moving = new Set();    // agents whose hops are shown
    this.overlays = new Map();  // name -> {name, kind, values}
    this.recent = [];           // lists of events, the oldest first
    this.recentCount = 0;
    this.counts = Object.fromEntries(Object.keys(APPLY).map(kind => [kind, 0]));
    this.counts.events = 0;
    this.counts.unknown = 0;
    this.history = new History(this.width);
    this.expected = 0.3;        // mean seconds of recent hops
    this.shape++;
    this.touch();
  }

  touch() {
    this.version++;
    if (this.dirty || typeof requestAnimationFrame !== 'function') return;
    this.dirty = true;
    requestAnimationFrame(() => {   // not called while the page is hidden
      this.dirty = false;
      this.tell('change', this);
    });
  }

  // ---------------------------------------------------------- snapshots

  // Apply the present state. Hosts that are missing in it are lost, and missing
  // agents have ended; counts, trails and history are kept.
  applySnapshot(snapshot) {
    this.note(snapshot.time);
    const hosts = new Set(), agents = new Set();
    for (const entry of snapshot.hosts || []) {
      hosts.add(entry.id);
      this.updateHost(entry);
    }
    for (const host of this.hosts.values())
      if (!hosts.has(host.id) && host.state === 'running') host.state = 'lost';
    this.updateLinks(snapshot.hosts || []);
    for (const entry of snapshot.agents || []) {
      agents.add(entry.id);
      this.updateAgent(entry);
    }
    for (const agent of [...this.agents.values()])
      if (!agents.has(agent.id) && agent.status !== 'ended')
        this.over(agent, 'not seen any more');
    for (const overlay of snapshot.overlays || []) this.overlay(overlay);
    this.shape++;
    this.population();
    this.touch();
  }

  updateHost(entry) {
    const host = this.host(entry.id);
    host.process = entry.process || host.process;
    host.machine = entry.machine || host.machine;
    host.state = entry.state || 'running';
    host.load = typeof entry.load === 'number' ? entry.load : null;
    host.since = entry.since;
    host.parked = entry.parked;
    if (typeof entry.x === 'number' && typeof entry.y === 'number')
      host.given = { x: entry.x, y: entry.y };
  }

  // A link exists if one of its ends reports it.
  updateLinks(hosts) {
    const now = new Map();
    for (const { id, links } of hosts)
      for (const link of links || []) {
        const [other, cost] = Array.isArray(link) ? link : [link];
        now.set(Store.key(id, other), [id, other, cost ?? 1]);
      }
    for (const [key, { a, b }] of [...this.links])
      if (!now.has(key)) this.unlink(a, b);
    for (const [a, b, cost] of now.values()) this.link(a, b, cost);
  }

  updateAgent(entry) {
    const agent = this.agent(entry.id, entry.host);
    this.setProgram(agent, entry.program || agent.program);
    this.revive(agent);
    agent.status = entry.status || 'running';
    if (entry.fault) agent.fault = entry.fault;
    if (agent.host !== entry.host) this.put(agent, entry.host);
    if (agent.hop && agent.hop.arrives === null) agent.hop = null;
  }

  // ------------------------------------------------------------- events

  applyEvents(list) {
    if (list.length === 0) return;
    for (const event of list) {
      if (event[0] >= this.history.end) this.population();
      this.apply(event);
    }
    this.recent.push(list);
    this.recentCount += list.length;
    const most = this.stamped ? LOGGED : RECENT;
    while (this.recentCount > most && this.recent.length > 1)
      this.recentCount -= this.recent.shift().length;
    this.population();
    this.tell('events', list);
    this.touch();
  }

  apply(event) {
    const [time, hostId, agentId, kind] = event;
    this.note(time);
    if (kind !== 'show' && kind !== 'add') this.counts.events++;
    if (!Object.hasOwn(APPLY, kind)) {
      this.counts.unknown++;
      return;
    }
    this.counts[kind]++;
    APPLY[kind](this, event, hostId, agentId);
  }

  note(time) {
    if (typeof time !== 'number') return;
    if (this.start === null) this.start = time;
    if (time > this.time) this.time = time;
  }

  // The stored events, the oldest first.
  *remembered() {
    for (const list of this.recent) yield* list;
  }

  // -------------------------------------------------------------- hosts

  host(id) {
    let host = this.hosts.get(id);
    if (!host) {
      const process = processOf(id);
      host = { id, name: shortName(id), process, machine: machineOf(process),
               state: 'running', load: null, links: new Map(),
               agents: new Set(), given: null, lines: [], facts: 0,
               faultAt: -Infinity };
      this.hosts.set(id, host);
      this.shape++;
    }
    return host;
  }

  // The number of agents on a host, or the load that it reports, as hosts of
  // bridges and robots do.
  loadOf(host) {
    return Math.max(host.load ?? 0, host.agents.size);
  }

  line(hostId, time, agentId, text) {
    const lines = this.host(hostId).lines;
    lines.push([time, agentId, text]);
    if (lines.length > 2 * LINES) lines.splice(0, lines.length - LINES);
  }

  static key(a, b) { return a < b ? `${a} ${b}` : `${b} ${a}`; }

  link(a, b, cost) {
    this.host(a).links.set(b, cost);
    this.host(b).links.set(a, cost);
    const key = Store.key(a, b), link = this.links.get(key);
    if (link) {
      link.cost = cost;
      return;
    }
    this.links.set(key, { a: a < b ? a : b, b: a < b ? b : a, cost,
                          since: this.clock() });
    this.shape++;
  }

  unlink(a, b) {
    if (!this.links.delete(Store.key(a, b))) return;
    this.host(a).links.delete(b);
    this.host(b).links.delete(a);
    this.shape++;
  }

  // ------------------------------------------------------------- agents

  agent(id, hostId) {
    let agent = this.agents.get(id);
    if (!agent) {
      agent = { id, name: shortName(id), host: null, program: null,
                status: 'running', fault: null, outcome: null, parent: null,
                hops: 0, sent: 0, received: 0, trail: [], hop: null,
                said: null, heard: -Infinity };
      this.agents.set(id, agent);
      this.setProgram(agent, programGuess(agent.name));
      if (hostId) this.put(agent, hostId);
    }
    return agent;
  }

  setProgram(agent, name) {
    if (agent.program === name) return;
    const before = this.programs.get(agent.program);
    if (before) before.agents--;
    if (before && before.agents === 0) this.programs.delete(agent.program);
    agent.program = name;
    if (!this.programs.has(name)) this.programs.set(name, { name, agents: 0 });
    this.programs.get(name).agents++;
  }

  put(agent, hostId) {
    if (agent.host !== null) this.hosts.get(agent.host)?.agents.delete(agent);
    agent.host = hostId;
    this.host(hostId).agents.add(agent);
    agent.trail.push(hostId);
    if (agent.trail.length > 2 * TRAIL)
      agent.trail.splice(0, agent.trail.length - TRAIL);
  }

  // Whether an event is older than what is known of the agent. Each process
  // sends its own events, so those of a previous host of an agent may arrive
  // after those of its present host. Events of the host at which the agent is
  // to arrive are never late, since the clocks of machines differ.
  late({ heard, hop }, hostId, time) {
    return time < heard && !(hop && hop.to === hostId && hop.arrives === null);
  }

  // An event shows that the agent is on this host, whatever was known before. A
  // late event is ignored, and false is returned.
  here(agent, hostId, time) {
    if (this.late(agent, hostId, time)) return false;
    agent.heard = time;
    this.revive(agent);
    if (agent.host !== hostId && hostId) {
      this.put(agent, hostId);
      if (agent.hop && agent.hop.to !== hostId) agent.hop = null;
    }
    return true;
  }

  over(agent, outcome) {
    agent.outcome = outcome;
    if (agent.status === 'ended') return;
    agent.status = 'ended';
    agent.hop = null;
    this.hosts.get(agent.host)?.agents.delete(agent);
    this.moving.delete(agent);
    this.ended.add(agent.id);
    if (this.ended.size > ENDED) this.forget(this.ended.values().next().value);
  }

  forget(id) {
    const { program } = this.agents.get(id), known = this.programs.get(program);
    this.ended.delete(id);
    this.agents.delete(id);
    if (--known.agents === 0) this.programs.delete(program);
  }

  revive(agent) {
    if (!this.ended.delete(agent.id)) return;
    agent.outcome = null;
    agent.status = 'running';
    this.hosts.get(agent.host)?.agents.add(agent);
  }

  // --------------------------------------------------------------- hops

  // A hop is {from, to, start, arrives}, in seconds of the clock; `arrives`
  // is null while that time is unknown.
  setOut(agent, from, to, time, seconds, room) {
    const start = this.stamped ? time : this.clock();
    agent.hop = { from, to, start, shown: start, done: 0,
                  arrives: seconds === undefined ? null
                    : this.arrivesAt(start, seconds, room) };
    this.moving.add(agent);
    agent.status = 'in_transit';
  }

  // A hop is shown for a least time, but ends before the next one begins.
  arrivesAt(start, seconds, room = Infinity) {
    return start + Math.max(seconds, Math.min(MINIMUM * this.rate, 0.8 * room));
  }

  arrive(agent, from, to, time, seconds) {
    const took = typeof seconds === 'number' ? seconds : null;
    const hop = agent.hop, now = this.stamped ? time : this.clock();
    if (hop && hop.from === from && hop.to === to && hop.arrives !== null) {
      // a replay knew the arrival at the departure
    } else if (hop && hop.to === to && hop.arrives === null && !this.stamped) {
      hop.done = this.progress(hop, now);
      hop.shown = now;
      hop.arrives = Math.max(now + 0.1, hop.start + MINIMUM);
    } else if (from && from !== to) {
      const start = this.stamped ? time - (took || 0) : now;
      agent.hop = { from, to, start, shown: start, done: 0,
                    arrives: this.arrivesAt(start, took || 0) };
      this.moving.add(agent);
    }
    if (agent.host !== to) this.put(agent, to);
  }

  hopped(agent, time, seconds) {
    const took = typeof seconds === 'number' ? seconds : null;
    agent.hops++;
    this.history.hop(time, took);
    if (took !== null) this.expected += (took - this.expected) / 64;
  }

  // Returns the agents whose marks still move; the hops of others have ended.
  settle(now = this.clock()) {
    for (const agent of this.moving) {
      const hop = agent.hop;
      if (hop && (hop.arrives === null || now < hop.arrives)) continue;
      agent.hop = null;
      this.moving.delete(agent);
    }
    return this.moving;
  }

  // The part of a hop that is done, from 0 to 1.
  progress(hop, now = this.clock()) {
    if (hop.arrives === null)
      return 0.9 * (1 - Math.exp(-(now - hop.start)
        / Math.max(MINIMUM, this.expected)));
    const share = (now - hop.shown) / Math.max(1e-9, hop.arrives - hop.shown);
    return hop.done + (1 - hop.done) * Math.min(1, Math.max(0, share));
  }

  // ----------------------------------------------------------- overlays

  // An overlay of an agent program or a study. Its values are by host, or, for
  // links, by "a b".
  overlay({ name, kind, title }) {
    let overlay = this.overlays.get(name);
    if (!overlay) {
      overlay = { name, kind: kind || 'label', title: title || name,
                  values: new Map() };
      this.overlays.set(name, overlay);
    }
    return overlay;
  }

  // ------------------------------------------------------------ history

  // The number of agents of each program, without ended ones.
  populations() {
    const counts = new Map();
    for (const { name, agents } of this.programs.values())
      counts.set(name, agents);
    for (const id of this.ended) {
      const { program } = this.agents.get(id);
      counts.set(program, counts.get(program) - 1);
    }
    for (const [name, n] of counts) if (n === 0) counts.delete(name);
    return counts;
  }

  population() {
    if (this.start === null) return;
    const stretch = this.history.at(this.time);
    stretch.populations = this.populations();
    let all = 0, most = 0, count = 0;
    for (const host of this.hosts.values()) {
      if (host.state !== 'running') continue;
      const load = this.loadOf(host);
      all += load;
      count++;
      if (load > most) most = load;
    }
    stretch.load = { mean: count ? all / count : 0, most };
  }
}
