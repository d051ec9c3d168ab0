"use strict";

// Unpacks what packing.py has packed.

/** The values of which `steps` has the first one, and by how much each differs from the one before. */
function unstepped(steps) {
  let value = 0;
  return steps.map((step) => (value += step));
}

/** The values of which `runs` has pairs: a value, and how often it stands there. */
function unrun(runs) {
  return runs.flatMap(([value, count]) => Array(count).fill(value));
}

/** A recorded episode with a value for each of its rows. */
function unpackedEpisode(packed) {
  const way = ({ x, y }) => ({ x: unstepped(x), y: unstepped(y) });
  return {
    ...packed,
    time: unstepped(unrun(packed.time)),
    state: unrun(packed.state),
    progress: unrun(packed.progress),
    health: unrun(packed.health),
    player: {
      ...way(packed.player),
      yaw: unstepped(packed.player.yaw),
      crouching: unrun(packed.player.crouching),
    },
    enemies: packed.enemies.map((enemy) => ({
      ...way(enemy),
      yaw: unstepped(enemy.yaw),
      mode: unrun(enemy.mode),
      sees: unrun(enemy.sees),
    })),
    movers: packed.movers.map(way),
    active: packed.active.map(unrun),
    open: packed.open.map(unrun),
    atoms: packed.atoms.map(unstepped),
  };
}
