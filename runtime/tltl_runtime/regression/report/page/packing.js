"use strict";

// Decodes the values that packing.py encodes.

const DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/** Decodes values from `steps`: the first value, then the differences, in base64 VLQ. */
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

/** Decodes values from `runs`: pairs of a value and its number of repetitions. */
function unrun(runs) {
  return runs.flatMap(([value, count]) => Array(count).fill(value));
}

/** Decodes a recorded episode, so that it has a value for each row. */
function unpackedEpisode(packed) {
  const positions = ({ x, y }) => ({ x: unstepped(x), y: unstepped(y) });
  // What a game does not have is not in the data.
  const each = (items, unpack) => (items ?? []).map(unpack);
  const { yaw, crouching } = packed.player;
  return {
    ...packed,
    time: unstepped(packed.time),
    state: unrun(packed.state),
    progress: unrun(packed.progress),
    health: packed.health && unrun(packed.health),
    player: {
      ...positions(packed.player),
      yaw: yaw && unstepped(yaw),
      crouching: crouching && unrun(crouching),
    },
    entities: each(packed.entities, (entity) => ({ ...entity, ...positions(entity), there: unrun(entity.there) })),
    enemies: each(packed.enemies, (enemy) => ({
      ...positions(enemy),
      yaw: unstepped(enemy.yaw),
      mode: unrun(enemy.mode),
      sees: unrun(enemy.sees),
    })),
    movers: each(packed.movers, positions),
    active: each(packed.active, unrun),
    open: each(packed.open, unrun),
    atoms: packed.atoms.map(unstepped),
  };
}
