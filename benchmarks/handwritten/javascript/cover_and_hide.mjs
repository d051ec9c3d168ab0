// Cover and Hide: near(s1), then near(s2), then near(exit), alive throughout; judged at the goal, 400 steps.  The three
// places exclude each other.

import { Episode, Result, finite, near } from "./common.mjs";

export { Result };

const ATOMS = ["near(s1)", "near(s2)", "near(exit)"];
const LABELS = [
  "F(near(s1) & X F(near(s2) & X F near(exit))) & G alive",
  "F(near(s2) & X F near(exit)) & G alive",
  "false",
  "F near(exit) & G alive",
  "G alive",
];
const ENGLISH = [
  "Reach near(s1), then near(s2), then near(exit), and keep alive throughout.",
  "Reach near(s2), then near(exit), and keep alive throughout.",
  "The spec is violated.",
  "Reach near(exit), and keep alive throughout.",
  "Keep alive throughout.",
];
const VERDICTS = ["pending", "pending", "violated", "pending", "holding"];
const PLACE = [0, 1, -1, 2, -1];
const NEXT = [1, 3, -1, 4, -1];
const TRAP = 2;
const GOAL = 4;
const LIMIT = 400;

/** States 0, 1 and 3 wait for a place, 4 is the goal, 2 is the trap. */
export class Monitor extends Episode {
  constructor(levelSize = 20) {
    super(levelSize);
  }

  /** Take one sample; throws, and the state stays, where one is not finite or two places are near at once. */
  step(signals, result = new Result()) {
    const nearS1 = near(finite(signals["distance(s1)"], "distance(s1)"), this.levelSize);
    const nearS2 = near(finite(signals["distance(s2)"], "distance(s2)"), this.levelSize);
    const nearExit = near(finite(signals["distance(exit)"], "distance(exit)"), this.levelSize);
    const alive = Math.min(Math.max(finite(signals.health, "health"), 0), 1);
    if (nearS1 > 0 ? nearS2 > 0 || nearExit > 0 : nearS2 > 0 && nearExit > 0) {
      throw new RangeError(`only one of ${ATOMS.join(", ")} may hold at a time`);
    }
    let state = this.state;
    let robustness = 0;
    let progress = 0;
    let limiting = null;
    if (state === TRAP) {
      robustness = 1;
    } else if (alive <= 0) {
      state = TRAP;
    } else if (state === GOAL) {
      robustness = alive;
      progress = 1;
    } else {
      const place = PLACE[state];
      const here = place === 0 ? nearS1 : place === 1 ? nearS2 : nearExit;
      if (here > 0) {
        state = NEXT[state];
        robustness = Math.min(here, alive);
        progress = (place + 1) / 3;
      } else {
        // At another place the player is certainly not here, because the places exclude each other.
        const elsewhere = Math.max(place === 0 ? nearS2 : nearS1, place === 2 ? nearS2 : nearExit);
        robustness = Math.min(Math.max(-here, elsewhere), alive);
        progress = (place + 1 + here) / 3;
        limiting = ATOMS[place];
      }
    }
    this.state = state;
    result.reward = this.advance(progress, state === TRAP, state === TRAP || state === GOAL, LIMIT);
    result.state = state;
    result.label = LABELS[state];
    result.label_english = ENGLISH[state];
    result.verdict = VERDICTS[state];
    result.accepting = state === GOAL;
    result.done = this.done;
    result.progress = this.progress;
    result.robustness = robustness;
    result.limiting = limiting;
    result.failed_clause = state === TRAP ? "keep alive" : null;
    result.failed_atom = state === TRAP ? "alive" : null;
    result.failed_step = this.failedStep;
    return result;
  }
}
