// The hall: fetch the key, then leave by the door. Spikes end the game.
//
// A level is a text: `#` is a wall, `K` the key, `D` the door, `^` spikes. The player begins on a dot.

import { Refusal, state } from "./tltl_client.js";

const SIZE = [9, 6]; // of each level, in cells
const MOVES = [[0, 1], [0, -1], [-1, 0], [1, 0]]; // up, down, left, right
const THINGS = { K: "key", D: "door", "^": "spikes" };

export const CLOCK_HZ = 10;

export class Hall {
  hello = {
    name: "hall",
    clock_hz: CLOCK_HZ,
    signals: { has_key: { type: "bool" }, at_door: { type: "bool" }, on_spikes: { type: "bool" } },
    actions: { type: "discrete", n: MOVES.length },
    observation: { type: "multi_discrete", nvec: SIZE },
    scenes: ["hall"],
    capabilities: ["seed", "positions"],
  };

  // `read` returns the text of a level by its name, or a promise of it.
  constructor(read) {
    this.read = read;
  }

  // Begin an episode, and return its first state.
  async reset(scene, variant, seed) {
    if (scene && !this.hello.scenes.includes(scene)) throw new Refusal(`there is no scene \`${scene}\``);
    if (variant !== "v0") throw new Refusal(`there is no variant \`${variant}\``);
    this.rows = (await this.read(scene ?? "hall")).trim().split(/\s+/).reverse(); // y points up
    const starts = this.cells((mark) => mark === ".");
    this.player = starts[(seed ?? 0) % starts.length];
    this.hasKey = false;
    return this.state();
  }

  // Play one tick, and return the state.
  step(action) {
    const next = this.player.map((value, axis) => value + MOVES[action][axis]);
    if (this.mark(next) !== "#") this.player = next;
    this.hasKey ||= this.mark(this.player) === "K";
    return this.state();
  }

  state() {
    const here = this.mark(this.player);
    const positions = { player: this.player.map((value) => value + 0.5) };
    for (const [x, y] of this.cells((mark) => mark in THINGS)) positions[THINGS[this.mark([x, y])]] = [x + 0.5, y + 0.5];
    return state({
      signals: { has_key: this.hasKey, at_door: here === "D", on_spikes: here === "^" },
      observation: this.player,
      ended: here === "^",
      cause: here === "^" ? "spikes" : null,
      positions,
    });
  }

  mark([x, y]) {
    return this.rows[y][x];
  }

  cells(isWanted) {
    const all = this.rows.flatMap((row, y) => [...row].map((_, x) => [x, y]));
    return all.filter((cell) => isWanted(this.mark(cell)));
  }
}
