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
