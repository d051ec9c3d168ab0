// Branching: three switches in order, then the exit behind an open barrier, alive throughout; 600 steps.

import { Episode, Result, finite, near } from "./common.mjs";

export { Result };

const ATOMS = ["near(s1)", "near(s2)", "near(s3)"];
const LABELS = [
  "F(near(s1) & X F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))))) & G alive",
  "F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left)))) & G alive",
  "false",
  "F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))) & G alive",
  "F(open_right & near(e_right) | open_left & near(e_left)) & G alive",
  "G alive",
];
const ENGLISH = [
  "Reach near(s1), then near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
  "Reach near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
  "The spec is violated.",
  "Reach near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
  "Reach (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
  "Keep alive throughout.",
];
const VERDICTS = ["pending", "pending", "violated", "pending", "pending", "holding"];
const SWITCH = [0, 1, -1, 2, -1, -1];
const NEXT = [1, 3, -1, 4, -1, -1];
const TRAP = 2;
const EXITS = 4;
const GOAL = 5;
const LIMIT = 600;

/** States 0, 1 and 3 wait for a switch, 4 for an exit, 5 is the goal, 2 is the trap. */
export class Monitor extends Episode {
  constructor(levelSize = 20) {
    super(levelSize);
  }

  /** Take one sample; throws, and the state stays, where a signal is missing or not finite. */
  step(signals, result = new Result()) {
    const s1 = finite(signals["distance(s1)"], "distance(s1)");
    const s2 = finite(signals["distance(s2)"], "distance(s2)");
    const s3 = finite(signals["distance(s3)"], "distance(s3)");
    const toRight = finite(signals["distance(e_right)"], "distance(e_right)");
    const toLeft = finite(signals["distance(e_left)"], "distance(e_left)");
    const alive = Math.min(Math.max(finite(signals.health, "health"), 0), 1);
    if (signals.open_right === undefined || signals.open_left === undefined) {
      throw new RangeError("nothing says which barrier is open");
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
    } else if (state === EXITS) {
      const rightOpen = signals.open_right ? 1 : -1;
      const leftOpen = signals.open_left ? 1 : -1;
      const rightNear = near(toRight, this.levelSize);
      const leftNear = near(toLeft, this.levelSize);
      const right = Math.min(rightOpen, rightNear);
      const left = Math.min(leftOpen, leftNear);
      const nearest = Math.max(right, left);
      if (nearest > 0) {
        state = GOAL;
        robustness = Math.min(nearest, alive);
        progress = 1;
      } else {
        robustness = Math.min(-nearest, alive);
        progress = (4 + nearest) / 4;
        if (right >= left) {
          limiting = rightOpen <= rightNear ? "open_right" : "near(e_right)";
        } else {
          limiting = leftOpen <= leftNear ? "open_left" : "near(e_left)";
        }
      }
    } else {
      const number = SWITCH[state];
      const closeness = near(number === 0 ? s1 : number === 1 ? s2 : s3, this.levelSize);
      if (closeness > 0) {
        state = NEXT[state];
        robustness = Math.min(closeness, alive);
        progress = (number + 1) / 4;
      } else {
        robustness = Math.min(-closeness, alive);
        progress = (number + 1 + closeness) / 4;
        limiting = ATOMS[number];
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
