// Types of deliver_monitor.mjs, written by tltlc.

/** A sample, in SI units. */
export interface Signals {
  /** The length of the shortest ride to the parcel; 0 m once the courier carries it. In [0, 30] m. */
  parcel_distance: number;
  /** The length of the shortest ride to the customer's door. In [0, 30] m. */
  door_distance: number;
  /** How far the dog is. In [0, 20] m. */
  dog_distance: number;
}

/** Params, in SI units. */
export type Params = Record<string, never>;

/** What the verdict would be if the trace ended here: for good, so far, not yet, never. */
export type Verdict = "satisfied" | "holding" | "pending" | "violated";

/** The result of one sample. */
export class Result {
  state: number;
  /** What remains to be satisfied. */
  label: string;
  verdict: Verdict;
  /** Whether the trace so far is accepted. */
  accepting: boolean;
  /** An episode ends here, or ended before. */
  done: boolean;
  /** The best so far, in [0, 1]. */
  progress: number;
  /** Of this step; 0 after the end of the episode. */
  reward: number;
  /** Of the edge taken, in [-1, 1]. */
  robustness: number;
  /**
   * The atom that bounds the nearest edge that would have improved the distance to acceptance; null if the automaton
   * moved or no edge improves it.
   */
  limiting: string | null;
}

/** A sample that the automaton cannot take, or a param value that is not allowed; the state is unchanged. */
export class MonitorError extends Error {
  constructor(message: string);
}

/** Runs the automaton over one trace after another. */
export class Monitor {
  readonly state: number;
  readonly steps: number;
  readonly progress: number;
  readonly done: boolean;
  /** Messages about values that were clamped, one for each signal and atom. */
  readonly notices: readonly string[];

  /** `params` override values of params; throws MonitorError if one is not in its range. */
  constructor(params?: Partial<Params>);

  /** Go back to the state before the first sample. */
  reset(): void;

  /**
   * Take one sample; the result is `result` or a new one.  Throws MonitorError, and leaves the state unchanged, if a
   * signal is missing or not finite, an atom has no value, or exclusive atoms hold at once.
   */
  step(signals: Signals, result?: Result): Result;
}
