// What happened in each stretch of time: hops, messages, faults, the times
// that hops took, and who was there at its end. There are never more than
// LIMIT stretches; when there would be, pairs of them become one.

const LIMIT = 600;
const BUCKETS = 8;              // of hop times, for each factor of two

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

  // The time below which a share of the hops stayed, or null.
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
  // width: seconds of a stretch, to begin with
  constructor(width = 1) {
    this.width = width;
    this.stretches = [];
  }

  // When the last stretch is over.
  get end() {
    const last = this.stretches[this.stretches.length - 1];
    return last ? last.start + this.width : Infinity;
  }

  // The stretch in which time lies; what comes late counts to the first.
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
    if (last) {                 // nothing happened in between
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
