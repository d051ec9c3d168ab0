"use strict";

// Unpacks what packing.py has packed.

const DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/** The values of which `steps` has the first one, and what each is more than the last, in base 64 VLQ. */
function unstepped(steps) {
  const values = [];
  let value = 0;
  let number = 0;
  let weight = 1;
  for (const letter of steps) {
    const digit = DIGITS.indexOf(letter);
    number += (digit % 32) * weight;
    weight *= 32;
    if (digit < 32) {
      value += number % 2 ? -(number - 1) / 2 : number / 2;
      values.push(value);
      number = 0;
      weight = 1;
    }
  }
  return values;
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
    time: unstepped(packed.time),
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
