// Navigation: near(s1), then near(s2), then near(exit); judged at the goal, 300 steps.

import { Episode, Result, finite, near } from "./common.mjs";

export { Result };

const ATOMS = ["near(s1)", "near(s2)", "near(exit)"];
const LABELS = ["F(near(s1) & X F(near(s2) & X F near(exit)))", "F(near(s2) & X F near(exit))", "F near(exit)", "true"];
const ENGLISH = [
  "Reach near(s1), then near(s2), then near(exit).",
  "Reach near(s2), then near(exit).",
  "Reach near(exit).",
  "Nothing remains to be done.",
];
const GOAL = 3;
const LIMIT = 300;

/** The state is the number of marks that were reached in order. */
export class Monitor extends Episode {
  constructor(levelSize = 20) {
    super(levelSize);
  }

  /** Take one sample; throws, and the state stays, where a signal is missing or not finite. */
  step(signals, result = new Result()) {
    const s1 = finite(signals["distance(s1)"], "distance(s1)");
    const s2 = finite(signals["distance(s2)"], "distance(s2)");
    const exit = finite(signals["distance(exit)"], "distance(exit)");
    let state = this.state;
    let robustness = 1;
    let progress = 1;
    let limiting = null;
    if (state < GOAL) {
      const closeness = near(state === 0 ? s1 : state === 1 ? s2 : exit, this.levelSize);
      if (closeness > 0) {
        state += 1;
        robustness = closeness;
        progress = state / 3;
      } else {
        robustness = -closeness;
        progress = (state + 1 + closeness) / 3;
        limiting = ATOMS[state];
      }
    }
    const accepting = state === GOAL;
    this.state = state;
    result.reward = this.advance(progress, false, accepting, LIMIT);
    result.state = state;
    result.label = LABELS[state];
    result.label_english = ENGLISH[state];
    result.verdict = accepting ? "satisfied" : "pending";
    result.accepting = accepting;
    result.done = this.done;
    result.progress = this.progress;
    result.robustness = robustness;
    result.limiting = limiting;
    return result;
  }
}
