// The parts that the handwritten monitors share: their result, the reward, and reading samples.

/** The result of a step. */
export class Result {
  state = 0;
  label = "";
  verdict = "pending";
  accepting = false;
  done = false;
  progress = 0;
  reward = 0;
  robustness = 0;
  /** @type {string | null} */
  limiting = null;
  label_english = "";
  /** @type {string | null} */
  failed_clause = null;
  /** @type {string | null} */
  failed_atom = null;
  /** @type {number | null} */
  failed_step = null;
}

/** An automaton that runs over one episode after another. */
export class Episode {
  constructor(levelSize) {
    this.levelSize = levelSize;
    this.reset();
  }

  reset() {
    this.state = 0;
    this.steps = 0;
    this.progress = 0;
    this.done = false;
    /** @type {number | null} */
    this.failedStep = null;
  }

  /** Count a step with this progress; returns its reward. */
  advance(progress, violated, ends, limit) {
    this.steps += 1;
    if (violated) this.failedStep ??= this.steps;
    const best = progress > this.progress ? progress : this.progress;
    let reward = 0;
    if (!this.done) {
      reward = best - this.progress - 1 / limit;
      if (violated) reward -= (limit - this.steps) / limit;
    }
    this.progress = best;
    this.done ||= ends || this.steps >= limit;
    return reward;
  }
}

/** The value of a signal; throws where it is missing or not finite. */
export function finite(value, name) {
  if (!Number.isFinite(value)) throw new RangeError(`no finite number for ${name}`);
  return value;
}

/** Closeness in [-1, 1]: 1 at the target, 0 at 1 m, -1 from `levelSize` on. */
export function near(distance, levelSize) {
  if (distance < 1) return distance > 0 ? 1 - distance : 1;
  if (distance > levelSize) return -1;
  const rest = (levelSize - distance) / (levelSize - 1);
  return rest * rest - 1;
}
