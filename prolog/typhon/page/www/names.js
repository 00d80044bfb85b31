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

// The id of an agent is its name, then a dot, then what makes it unique.
export const programGuess = name => {
  const dot = name.indexOf('.');
  return dot < 0 ? name : name.slice(0, dot);
};
