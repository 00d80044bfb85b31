// Converts events to lines in space and time: stays, hops and messages of
// agents.
//
//   stays:   {agent, host, from, to, lane}
//   hops:    {agent, a, from, b, to}
//   letters: {sender, a, from, receiver, b, to, text}; b and to are null
//            until it is taken
//   marks:   {kind, agent, host, time}, of kind begins, ends, fails, clone
//   lanes:   Map of host -> greatest number of agents at a time

export function story(events, last) {
  const history = { stays: [], hops: [], letters: [], marks: [], lanes: new Map() };
  const where = new Map();      // agent -> its stay, or {host, left: time}
  const busy = new Map();       // host -> whether each lane is in use
  const post = new Map();       // "sender receiver" -> untaken letters

  const begin = (agent, host, time) => {
    if (!busy.has(host)) busy.set(host, []);
    const lanes = busy.get(host);
    let lane = lanes.indexOf(false);
    if (lane < 0) lane = lanes.length;
    lanes[lane] = true;
    history.lanes.set(host, Math.max(history.lanes.get(host) || 1, lanes.length));
    const stay = { agent, host, from: time, to: last, lane };
    history.stays.push(stay);
    where.set(agent, stay);
  };
  const end = (stay, time) => {
    stay.to = Math.max(stay.from, time);
    busy.get(stay.host)[stay.lane] = false;
  };
  const hop = (agent, a, from, b, to) => history.hops.push({ agent, a, from, b, to });

  // The agent has an event on this host.
  const here = (agent, host, time) => {
    const at = where.get(agent);
    if (at && at.host === host && at.left === undefined) return;
    if (at && at.left !== undefined && at.host !== host)
      hop(agent, at.host, at.left, host, time);
    else if (at && at.left === undefined) {
      end(at, time);
      hop(agent, at.host, time, host, time);
    }
    begin(agent, host, time);
  };

  const KIND = {
    created: (time, host, agent) => mark('begins', agent, host, time),
    left(time, host, agent) {
      end(where.get(agent), time);
      where.set(agent, { host, left: time });
    },
    ended(time, host, agent, outcome) {
      end(where.get(agent), time);
      where.delete(agent);
      mark(outcome === 'done' || outcome === 'disposed' ? 'ends' : 'fails',
           agent, host, time);
    },
    fault: (time, host, agent) => mark('fails', agent, host, time),
    cloned: (time, host, agent) => mark('clone', agent, host, time),
    sent(time, host, agent, receiver, text) {
      const letter = { sender: agent, a: host, from: time, receiver, b: null,
                       to: null, text: text ?? '' };
      history.letters.push(letter);
      const key = `${agent} ${receiver}`;
      if (!post.has(key)) post.set(key, []);
      post.get(key).push(letter);
    },
    received(time, host, agent, sender, text) {
      const letter = post.get(`${sender} ${agent}`)?.shift();
      if (letter) Object.assign(letter, { b: host, to: time });
      else history.letters.push({ sender, a: null, from: null, receiver: agent,
                               b: host, to: time, text: text ?? '' });
    },
  };
  const mark = (kind, agent, host, time) =>
    history.marks.push({ kind, agent, host, time });

  for (const [time, host, agent, kind, ...more] of inTime(events)) {
    if (kind === 'arrived') {
      arrive(time, host, agent, ...more);
      continue;
    }
    here(agent, host, time);
    if (Object.hasOwn(KIND, kind)) KIND[kind](time, host, agent, ...more);
  }

  function arrive(time, host, agent, from, seconds) {
    const at = where.get(agent);
    const start = time - (typeof seconds === 'number' ? seconds : 0);
    if (at && at.left !== undefined) {
      hop(agent, at.host, at.left, host, time);
    } else if (at) {
      end(at, Math.max(at.from, start));
      hop(agent, at.host, at.to, host, time);
    } else if (from) {
      hop(agent, from, start, host, time);
    }
    begin(agent, host, time);
  }

  return history;
}

// The events of agents in the order of time: processes send them independently.
const inTime = events => [...events].filter(([time, , agent, kind]) =>
  agent && typeof time === 'number' && kind !== 'show' && kind !== 'add')
  .sort(([a], [b]) => a - b);
