// What each kind of event does to the store.

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
  stopped(store, event, id) { gone(store, id, 'stopped'); },
  refused(store, [time, , , , agent, reason], host) {
    store.line(host, time, agent, `refused: ${reason}`);
  },
  lost(store, event, id) { gone(store, id, 'lost'); },
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
    store.over(agent, state === 'lost' ? 'its host is lost' : 'its host stopped');
  }
};
