// The game of the conformance script in JavaScript; `tests/runtime/wire/conversation.py` describes it. The test copies
// the client beside this file.
//
// Usage: node counter.js [--listen PORT], or node tltl_client.js index.html

import { Disconnected, Refusal, array, gameHello, listen, play, state } from "./tltl_client.js";

const GOALS = { short: 5, long: 10 };

/** Count up to the goal, and in the variant `trap` never down to 0. */
class Counter {
  hello = {
    name: "counter",
    clock_hz: 10,
    signals: { position: { range: [0, 10] }, moves: { range: [0, null] }, at_goal: { type: "bool" } },
    params: { goal: 10 },
    actions: { type: "discrete", n: 3 },
    observation: { type: "box", low: 0, high: 10, shape: [1], dtype: "float32" },
    scenes: ["short", "long"],
    capabilities: ["seed", "positions"],
  };
  #now = { goal: 5, hasTrap: false, position: 1, moves: 0 };
  #snapshots = [];

  /** Begin at 1 + seed mod 4. */
  reset(scene, variant, seed) {
    if (scene !== null && !Object.hasOwn(GOALS, scene)) throw new Refusal(`there is no scene \`${scene}\``);
    if (variant !== "v0" && variant !== "trap") throw new Refusal(`there is no variant \`${variant}\``);
    this.#now = { goal: GOALS[scene ?? "short"], hasTrap: variant === "trap", position: 1 + ((seed ?? 0) % 4), moves: 0 };
    return this.#state();
  }

  /** Move left (0), stay (1) or move right (2). */
  step(action) {
    this.#now.position = Math.min(Math.max(this.#now.position + action - 1, 0), 10);
    this.#now.moves++;
    return this.#state();
  }

  /** Keep the state; the ids are 1, 2, 3 and so on. */
  snapshot() {
    return this.#snapshots.push({ ...this.#now });
  }

  /** Return to a snapshot. */
  restore(id) {
    this.#now = { ...this.#kept(id) };
    return this.#state();
  }

  /** Forget a snapshot. */
  releaseSnapshot(id) {
    this.#kept(id);
    this.#snapshots[id - 1] = null;
  }

  #kept(id) {
    const kept = this.#snapshots[id - 1];
    if (!kept) throw new Refusal(`there is no snapshot ${id}`);
    return kept;
  }

  /** Draw a row of 11 black pixels; that of the player is white. */
  screenshot() {
    const pixels = new Uint8Array(33);
    pixels.fill(255, 3 * this.#now.position, 3 * this.#now.position + 3);
    return array(pixels, "uint8", [1, 11, 3]);
  }

  /** Say what maps show: the edges of the row, the goal, and the trap if there is one. */
  outline() {
    const { goal, hasTrap } = this.#now;
    if (hasTrap && goal === GOALS.short) throw new Refusal("there is no outline of the trap in `short`");
    return {
      bounds: [[-1, -2], [11, 3]],
      boxes: { edge: [[[-1, -1], [-0.5, 2]], [[10.5, -1], [11, 2]]] },
      polygons: hasTrap ? { trap: [[-0.5, -1], [0.5, -1], [0, 2]] } : {},
      regions: { goal: [[goal - 0.5, -1], [10.5, 2]] },
      image: { pixels: array(new Uint8Array([255, 255, 255]), "uint8", [1, 1, 3]), extent: [-0.5, -1, 10.5, 2] },
    };
  }

  #state() {
    const { goal, hasTrap, position, moves } = this.#now;
    const [at_goal, isTrapped] = [position >= goal, hasTrap && position === 0];
    return state({
      signals: { position, moves, at_goal },
      observation: new Float32Array([position]),
      ended: at_goal || isTrapped,
      cause: at_goal ? "goal" : isTrapped ? "trap" : null,
      positions: { player: [position, 0] },
    });
  }
}

const game = new Counter();
const [, , option, port] = globalThis.process?.argv ?? [];
if (option === "--listen") {
  try {
    for (;;) await play(game, await listen(gameHello(game), port));
  } catch (error) {
    if (!(error instanceof Disconnected)) throw error;
    console.error(error.message);
    process.exitCode = 1;
  }
} else {
  await play(game);
}
