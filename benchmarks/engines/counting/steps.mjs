// Times steps of monitors that count: `steps ROUNDS MONITORS` prints nanoseconds of CPU time per step, as JSON lines.
// `first` is the time of the first steps of a count, and `last` that of the last ones.

import { Monitor, Result } from "./quiet_monitor.mjs";

const STEPS = 20;
const BEFORE = 570;
const QUIET = { pit: false };
const result = new Result();

function nanoseconds(monitors, before) {
  for (const monitor of monitors) {
    monitor.reset();
    monitor.step({ pit: true }, result);
    for (let i = 0; i < before; i++) monitor.step(QUIET, result);
  }
  const start = process.cpuUsage();
  for (const monitor of monitors) {
    for (let i = 0; i < STEPS; i++) monitor.step(QUIET, result);
  }
  const spent = process.cpuUsage(start);
  return ((spent.user + spent.system) * 1e3) / (monitors.length * STEPS);
}

const [rounds, count] = process.argv.slice(2).map(Number);
const monitors = Array.from({ length: count }, () => new Monitor());
for (let round = 0; round < rounds; round++) {
  const first = nanoseconds(monitors, 0);
  console.log(JSON.stringify({ first, last: nanoseconds(monitors, BEFORE) }));
}
