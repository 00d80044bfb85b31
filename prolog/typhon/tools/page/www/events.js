// The effect of each kind of event on the store, and the history of counts.

export const APPLY = {
  created(store, [time, , , , program], host, id) {
    const agent = store.agent(id, host);
    store.here(agent, host, time);
    if (program) store.setProgram(agent, program);
  },
  left(store, [time, , , , to, seconds, room], host, id) {
    const agent = store.agent(id, host);
    if (store.here(agent, host, time))
      store.setOut(agent, host, to, time, seconds, room);
  },
  stayed(store, [time], host, id) {
    const agent = store.agent(id, host);
    if (!store.here(agent, host, time)) return;
    agent.hop = null;
    agent.status = 'running';
  },
  arrived(store, [time, , , , from, seconds], host, id) {
    const agent = store.agent(id, from || host);
    store.hopped(agent, time, seconds);
    if (store.late(agent, host, time)) return;
    agent.heard = time;
    store.revive(agent);
    agent.status = 'running';
    store.arrive(agent, from, host, time, seconds);
  },
  cloned(store, [, , , , cloneId], host, id) {
    const parent = store.agent(id, host), clone = store.agent(cloneId, host);
    clone.parent = id;
    store.setProgram(clone, parent.program);
  },
  sent(store, [time], host, id) {
    if (id) store.agent(id, host).sent++;
    store.history.at(time).messages++;
  },
  received(store, [time], host, id) {
    if (!id) return;
    const agent = store.agent(id, host);
    store.here(agent, host, time);
    agent.received++;
  },
  ended(store, [time, , , , outcome], host, id) {
    const agent = store.agent(id, host);
    store.here(agent, host, time);
    store.over(agent, outcome);
  },
  fault(store, [time, , , , text], host, id) {
    const agent = store.agent(id, host);
    agent.fault = text;
    if (store.here(agent, host, time)) agent.status = 'faulty';
    store.host(host).faultAt = store.stamped ? time : store.clock();
    store.history.at(time).faults++;
    store.line(host, time, id, text);
  },
  log(store, [time, , , , text], host, id) {
    store.line(host, time, id, text);
    if (id) store.agent(id, host).said = text;
  },
  link(store, [, , , , other, cost], host) {
    store.link(host, other, cost ?? 1);
  },
  unlink(store, [, , , , other], host) {
    store.unlink(host, other);
  },
  leave(store, [time, , , , fact], host, id) {
    store.host(host).facts++;
    store.line(host, time, id, `+ ${fact}`);
  },
  take(store, [time, , , , fact], host, id) {
    const at = store.host(host);
    if (at.facts > 0) at.facts--;
    store.line(host, time, id, `− ${fact}`);
  },
  started(store, event, id) {
    store.host(id).state = 'running';
    store.shape++;
  },
  // Events of a fleet: its process is not heard of, and is back.
  away(store, [, , , , since, parked], id) {
    if (store.host(id).state !== 'away') gone(store, id, 'away');
    Object.assign(store.host(id), { since, parked });
  },
  back(store, event, id) {
    store.host(id).state = 'running';
    store.shape++;
  },
  stopped(store, event, id) { gone(store, id, 'stopped'); },
  refused(store, [time, , , , agent, reason], host) {
    store.line(host, time, agent, `refused: ${reason}`);
  },
  lost(store, event, id) {
    if (store.hosts.get(id)?.state !== 'away') gone(store, id, 'lost');
  },
  show(store, [time, , , , name, key, value], host) {
    const overlay = store.overlay({ name });
    const at = key || host;
    if (value === null) overlay.values.delete(at);
    else overlay.values.set(at, value);
  },
  add(store, [, , , , name, key, value], host) {
    const { values } = store.overlay({ name }), at = key || host;
    values.set(at, (Number(values.get(at)) || 0) + value);
  },
  goal(store, [, , , , text], host, id) {
    if (id) store.agent(id, host).said = text;
  },
  skipped(store, [, , , , count]) {
    store.counts.skipped += (Number(count) || 1) - 1;
  },
};

const gone = (store, id, state) => {
  const host = store.host(id);
  host.state = state;
  store.shape++;
  if (state === 'stopped')
    for (const other of [...host.links.keys()]) store.unlink(id, other);
  for (const agent of [...host.agents]) {
    if (agent.hop && agent.hop.arrives === null) continue;
    store.over(agent, state === 'stopped' ? 'its host stopped' : `its host is ${state}`);
  }
};

// The history has a stretch for each interval of time: numbers of hops,
// messages and faults, the durations of hops, and the agents at its end. When
// there would be more than LIMIT stretches, pairs of them are merged.

const LIMIT = 600;
const BUCKETS = 8;              // classes of hop times for each factor of two

const bucketOf = seconds => Math.round(Math.log2(Math.max(seconds, 1e-6)) * BUCKETS);
const secondsOf = bucket => 2 ** (bucket / BUCKETS);

class Stretch {
  constructor(start) {
    this.start = start;
    this.hops = 0;
    this.messages = 0;
    this.faults = 0;
    this.times = new Map();     // bucket -> number of hops
    this.populations = null;    // Map of program -> agents, at its end
    this.load = null;           // {mean, most}, at its end
  }

  add(other) {
    this.hops += other.hops;
    this.messages += other.messages;
    this.faults += other.faults;
    for (const [bucket, n] of other.times)
      this.times.set(bucket, (this.times.get(bucket) || 0) + n);
    this.populations = other.populations || this.populations;
    this.load = other.load || this.load;
  }

  // The time below which a share of the hop times are, or null.
  percentile(share) {
    if (this.times.size === 0) return null;
    const sorted = [...this.times].sort((a, b) => a[0] - b[0]);
    const all = sorted.reduce((sum, [, n]) => sum + n, 0);
    let left = share * all;
    for (const [bucket, n] of sorted) {
      left -= n;
      if (left <= 1e-9) return secondsOf(bucket);
    }
    return secondsOf(sorted[sorted.length - 1][0]);
  }
}

export class History {
  // width: initial seconds of a stretch
  constructor(width = 1) {
    this.width = width;
    this.stretches = [];
  }

  // The end of the last stretch.
  get end() {
    const last = this.stretches[this.stretches.length - 1];
    return last ? last.start + this.width : Infinity;
  }

  // The stretch that contains time, or the first one for earlier times.
  at(time) {
    const start = Math.floor(time / this.width) * this.width;
    const last = this.stretches[this.stretches.length - 1];
    if (!last || start > last.start) return this.append(start, last);
    if (start === last.start) return last;
    for (let i = this.stretches.length - 2; i >= 0; i--)
      if (this.stretches[i].start <= start) return this.stretches[i];
    return this.stretches[0];
  }

  append(start, last) {
    if (last && (start - this.stretches[0].start) / this.width >= LIMIT) {
      this.halve();
      return this.at(start);
    }
    const made = new Stretch(start);
    if (last) {                 // no events in between
      made.populations = last.populations;
      made.load = last.load;
    }
    this.stretches.push(made);
    return made;
  }

  halve() {
    this.width *= 2;
    const old = this.stretches;
    this.stretches = [];
    for (const stretch of old) {
      const start = Math.floor(stretch.start / this.width) * this.width;
      const last = this.stretches[this.stretches.length - 1];
      if (last && last.start === start) {
        last.add(stretch);
      } else {
        stretch.start = start;
        this.stretches.push(stretch);
      }
    }
  }

  hop(time, seconds) {
    const stretch = this.at(time);
    stretch.hops++;
    if (seconds !== null) {
      const bucket = bucketOf(seconds);
      stretch.times.set(bucket, (stretch.times.get(bucket) || 0) + 1);
    }
  }
}
