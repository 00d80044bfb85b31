// Parts of the names of hosts and agents, and their order.

// The part of a name before the first @.
export const shortName = id => {
  const at = id.indexOf('@');
  return at < 0 ? id : id.slice(0, at);
};

export const processOf = id => id.slice(id.indexOf('@') + 1);
export const machineOf = process => {
  const colon = process.lastIndexOf(':');
  return colon < 0 ? process : process.slice(0, colon);
};

// What is known of a host that is away, or ''.
export const absence = ({ state, since, parked }) => state !== 'away' ? ''
  : (typeof since === 'number'
      ? `since ${new Date(since * 1000).toLocaleString()}` : '')
    + (parked ? `, ${parked} waiting` : '');

// n2 is before n10.
const collator = new Intl.Collator('en', { numeric: true });
export const byName = (a, b) => collator.compare(a, b);

// Ids of the items in the lists `known`, lists of {id, name, status}, whose
// name contains the text: first those whose name equals it, then those whose
// name begins with it; among equals in the order of the lists, then of names. A
// text with an @ is searched in the whole id, which contains the home of an
// agent.
export function found(text, known) {
  const wanted = text.trim().toLowerCase();
  if (wanted === '') return [];
  const hits = known.flatMap((list, order) => [...list]
    .filter(({ status }) => status !== 'ended')
    .map(({ id, name }) => {
      const at = (wanted.includes('@') ? id : name).toLowerCase();
      return { id, order, rank: at === wanted ? 0 : at.startsWith(wanted) ? 1
        : at.includes(wanted) ? 2 : 3 };
    })
    .filter(({ rank }) => rank < 3));
  return hits.sort((a, b) => a.rank - b.rank || a.order - b.order
    || byName(a.id, b.id)).map(({ id }) => id);
}

// The id of an agent is its name, a dot, and a unique part.
export const programGuess = name => {
  const dot = name.indexOf('.');
  return dot < 0 ? name : name.slice(0, dot);
};

// '1 host', '2 hosts'.
export function counted(count, noun) {
  return `${count} ${noun}${count === 1 ? '' : noun.endsWith('ss') ? 'es' : 's'}`;
}

// Round times along an axis, and their texts.

export function timeTicks(from, to, count) {
  const rough = (to - from) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(n => n * power).find(n => n >= rough);
  const ticks = [];
  for (let time = Math.ceil(from / step) * step; time <= to; time += step)
    ticks.push(time);
  return ticks;
}

// Times of day for large numbers; seconds otherwise.
export function timeText(time, span) {
  if (time > 1e8) {
    const text = new Date(time * 1000).toISOString();
    return span < 10 ? text.slice(17, 23) : text.slice(11, 19);
  }
  const digits = Math.max(0, Math.min(6, 2 - Math.floor(Math.log10(span || 1))));
  return `${time.toFixed(digits)} s`;
}
