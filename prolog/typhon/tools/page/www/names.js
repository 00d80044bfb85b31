// What the names of hosts and agents tell, and how they are sorted.

// What stands before the first @ of a name.
export const shortName = id => {
  const at = id.indexOf('@');
  return at < 0 ? id : id.slice(0, at);
};

export const processOf = id => id.slice(id.indexOf('@') + 1);
export const machineOf = process => {
  const colon = process.lastIndexOf(':');
  return colon < 0 ? process : process.slice(0, colon);
};

// n2 comes before n10.
const collator = new Intl.Collator('en', { numeric: true });
export const byName = (a, b) => collator.compare(a, b);

// Ids of what `known` lists (lists of {id, name, status}) whose name holds the
// text: those that are called so first, then those whose name begins so; of
// equals in the order of the lists, then of names. A text with an @ is looked
// for in the whole id, which of an agent names its home, too.
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

// The id of an agent is its name, then a dot, then what makes it unique.
export const programGuess = name => {
  const dot = name.indexOf('.');
  return dot < 0 ? name : name.slice(0, dot);
};

// Round times along an axis, and how they are written.

export function timeTicks(from, to, count) {
  const rough = (to - from) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(n => n * power).find(n => n >= rough);
  const ticks = [];
  for (let time = Math.ceil(from / step) * step; time <= to; time += step)
    ticks.push(time);
  return ticks;
}

// Times of day where times are so large; seconds otherwise.
export function timeText(time, span) {
  if (time > 1e8) {
    const text = new Date(time * 1000).toISOString();
    return span < 10 ? text.slice(17, 23) : text.slice(11, 19);
  }
  const digits = Math.max(0, Math.min(6, 2 - Math.floor(Math.log10(span || 1))));
  return `${time.toFixed(digits)} s`;
}
