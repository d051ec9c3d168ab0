// The game: a courier fetches a parcel and brings it to a door, while a dog patrols. It runs in pages and in Node.
//
// A tick is a quarter of a second. In it, the courier rides to a neighbouring cell, which is a square of a metre, and
// the dog runs a part of its route. All coordinates are in metres; x points east, and y north.

import { Refusal, state } from "./tltl_client.js";

export const CLOCK_HZ = 4;
export const ACTIONS = ["stay", "west", "east", "north", "south"];
const MOVES = [[0, 0], [-1, 0], [1, 0], [0, 1], [0, -1]];
const CATCH_M = 1;
const FARTHEST_M = 30;

/** `#` is a wall, `c` where the courier may start, `p` where the parcel may lie, `D` the door, `d` the dog's route. */
const SCENES = {
  yard: [
    "################",
    "#ppp...#d......#",
    "#ppp...#d......#",
    "#......#d......#",
    "#cc.....d......#",
    "#cc....#d....D.#",
    "#......#d......#",
    "#ppp...#d......#",
    "#ppp...#d......#",
    "################",
  ],
  alley: [
    "################",
    "#cc..#.....#...#",
    "#cc..#..pp.#.D.#",
    "#cc..#..pp.#...#",
    "#....#.....#...#",
    "#....#dddd.....#",
    "#..........#...#",
    "#....#..pp.#...#",
    "#....#..pp.#...#",
    "################",
  ],
};

/** What is different in each variant: the cells that the dog runs in a tick, or the gap in which it lies. */
const VARIANTS = {
  v0: {},
  fast_dog: { dogSpeed: 1 },
  dog_in_gap: { place: { yard: [7.5, 5.5], alley: [5.5, 3.5] } },
};

export const SIZE = [SCENES.yard[0].length, SCENES.yard.length];

/** One game of the courier, as tltlc plays it. */
export class Courier {
  hello = {
    name: "courier",
    clock_hz: CLOCK_HZ,
    signals: {
      parcel_distance: { type: "length", range: [0, FARTHEST_M] },
      door_distance: { type: "length", range: [0, FARTHEST_M] },
      dog_distance: { type: "length", range: [0, 20] },
      carrying: { type: "bool" },
      delivered: { type: "bool" },
    },
    actions: { type: "discrete", n: ACTIONS.length },
    observation: { type: "box", low: -1, high: 1, shape: [18], dtype: "float32" },
    scenes: Object.keys(SCENES),
    capabilities: ["seed", "positions"],
  };

  #snapshots = [];
  #distances = {};

  /** Begin an episode. Throws Refusal if there is no such scene or variant. */
  reset(scene, variant, seed) {
    const name = scene ?? "yard";
    if (!Object.hasOwn(SCENES, name)) throw new Refusal(`there is no scene \`${name}\``);
    if (!Object.hasOwn(VARIANTS, variant)) throw new Refusal(`there is no variant \`${variant}\``);
    const random = randomNumbers(seed ?? 0);
    const one = (cells) => [...cells[Math.floor(random() * cells.length)]];
    const { dogSpeed = 0.5, place } = VARIANTS[variant];
    const route = place ? [place[name]] : cellsOf(name, "d");
    this.now = {
      scene: name,
      courier: one(cellsOf(name, "c")),
      parcel: one(cellsOf(name, "p")),
      door: cellsOf(name, "D")[0],
      carrying: false,
      route: [route[0], route[route.length - 1]],
      dog: one(route),
      dogEnd: random() < 0.5 ? 0 : 1,
      dogSpeed,
    };
    this.#measure();
    return this.state();
  }

  /** Play one tick: the courier moves, then the dog. */
  step(action) {
    const { now } = this;
    now.courier = this.#cellAfter(MOVES[action]);
    if (same(now.courier, now.parcel)) now.carrying = true;
    [now.dog, now.dogEnd] = this.#dogAfterTick();
    return this.state();
  }

  /** Keep the state; the ids are 1, 2, 3 and so on. */
  snapshot() {
    return this.#snapshots.push(structuredClone(this.now));
  }

  /** Return to a snapshot. */
  restore(id) {
    if (!this.#snapshots[id - 1]) throw new Refusal(`there is no snapshot ${id}`);
    this.now = structuredClone(this.#snapshots[id - 1]);
    this.#measure();
    return this.state();
  }

  /** What maps are drawn on: the walls. */
  outline() {
    const rows = SCENES[this.now.scene];
    const cells = rows.flatMap((row, index) => [...row].map((letter, x) => [letter, x, rows.length - 1 - index]));
    const wall = cells.filter(([letter]) => letter === "#").map(([, x, y]) => [[x, y], [x + 1, y + 1]]);
    return { bounds: [[0, 0], SIZE], boxes: { wall } };
  }

  /** The values of the signals, in metres, and of the bools. */
  signals() {
    const { courier, parcel, door, dog, carrying } = this.now;
    return {
      parcel_distance: carrying ? 0 : this.#distances.parcel(courier),
      door_distance: this.#distances.door(courier),
      dog_distance: distance(courier, dog),
      carrying,
      delivered: carrying && same(courier, door),
    };
  }

  /** The state as a message. */
  state() {
    const { courier, parcel, door, dog, carrying } = this.now;
    const signals = this.signals();
    const isCaught = signals.dog_distance < CATCH_M;
    return state({
      signals,
      observation: this.#observation(),
      ended: isCaught || signals.delivered,
      cause: isCaught ? "dog" : null,
      positions: { player: courier, ...(carrying ? {} : { parcel }), door, dog },
    });
  }

  /**
   * Numbers in [-1, 1]: where the courier, its target and the dog are, where the dog runs, what the courier's map says of
   * the four neighbouring cells (1: nearer to the target, -1: farther, 0: a wall), and how far each action leads from
   * the dog: -1 at the dog, 0 at the edge of its reach, 1 from 2 m on.
   */
  #observation() {
    const { scene, courier, parcel, door, dog, dogEnd, carrying } = this.now;
    const places = [...courier, ...(carrying ? door : parcel), ...dog];
    const metres = carrying ? this.#distances.door : this.#distances.parcel;
    const map = MOVES.slice(1).map(([east, north]) => {
      const next = [courier[0] + east, courier[1] + north];
      return isWall(scene, next) ? 0 : metres(courier) - metres(next);
    });
    const [nextDog] = this.#dogAfterTick();
    const fromDog = MOVES.map((move) => Math.min(distance(this.#cellAfter(move), nextDog) - CATCH_M, 1));
    const shares = places.map((value, index) => value / (SIZE[index % 2] / 2) - 1);
    return new Float32Array([...shares, dogEnd, carrying ? 1 : 0, scene === "yard" ? 0 : 1, ...map, ...fromDog]);
  }

  /** Where a move leads the courier: walls stop it. */
  #cellAfter([east, north]) {
    const { scene, courier } = this.now;
    const next = [courier[0] + east, courier[1] + north];
    return isWall(scene, next) ? courier : next;
  }

  /** Where the dog is after the next tick, and to which end of its route it then runs; it runs to one end and back. */
  #dogAfterTick() {
    const { dog, dogEnd, dogSpeed, route } = this.now;
    const end = route[dogEnd];
    const next = dog.map((value, axis) => value + Math.min(Math.max(end[axis] - value, -dogSpeed), dogSpeed));
    return [next, same(next, end) ? 1 - dogEnd : dogEnd];
  }

  /** Compute how far the ride from each cell is to the parcel and to the door. */
  #measure() {
    const { scene, parcel, door } = this.now;
    this.#distances = { parcel: rides(scene, parcel), door: rides(scene, door) };
  }
}

/** Whether a wall is at a point. */
export function isWall(scene, [x, y]) {
  const rows = SCENES[scene];
  return rows[rows.length - 1 - Math.floor(y)][Math.floor(x)] === "#";
}

/** The middles of all cells with a letter, row by row from the north. */
function cellsOf(scene, letter) {
  const rows = SCENES[scene];
  const cells = [];
  rows.forEach((row, index) => {
    for (let x = 0; x < row.length; x++) {
      if (row[x] === letter) cells.push([x + 0.5, rows.length - index - 0.5]);
    }
  });
  return cells;
}

/** A function that gives the metres of the shortest ride from a cell to a target, around walls. */
function rides(scene, target) {
  const width = SIZE[0];
  const index = ([x, y]) => Math.floor(y) * width + Math.floor(x);
  const metres = new Map([[index(target), 0]]);
  const queue = [target];
  for (const at of queue) {
    for (const [east, north] of MOVES.slice(1)) {
      const next = [at[0] + east, at[1] + north];
      if (isWall(scene, next) || metres.has(index(next))) continue;
      metres.set(index(next), metres.get(index(at)) + 1);
      queue.push(next);
    }
  }
  return (cell) => metres.get(index(cell)) ?? FARTHEST_M;
}

function same(one, other) {
  return one[0] === other[0] && one[1] === other[1];
}

function distance(one, other) {
  return Math.sqrt((one[0] - other[0]) ** 2 + (one[1] - other[1]) ** 2);
}

/** Random numbers in [0, 1), the same for the same seed (mulberry32). */
function randomNumbers(seed) {
  // Seeds may have 53 bits, the generator has 32.
  let bits = (seed % 2 ** 32 ^ Math.floor(seed / 2 ** 32)) | 0;
  return () => {
    bits = (bits + 0x6d2b79f5) | 0;
    let mixed = Math.imul(bits ^ (bits >>> 15), bits | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}
