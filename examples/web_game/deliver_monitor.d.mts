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

/** A sample of a monitor that is `sparse`: missing bools are false. */
export type SparseSignals = Signals;

export interface Options {
  /** Samples have only the events that happened: missing bools are false, and not an error. Numbers are needed. */
  sparse?: boolean;
}

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
  /** What remains to be satisfied, in words. */
  label_english: string;
  /** The clause that the step `failed_step` broke; null if only several clauses together cannot be met any more. */
  failed_clause: string | null;
  /** The atom that decides it: the one that had to hold but did not, or else the one that must not hold but did. */
  failed_atom: string | null;
  /** The first step, from 1, after which no continuation of the trace can meet the specification; null before it. */
  failed_step: number | null;
}

/** A sample that the automaton cannot take, or a param value that is not allowed; the state is unchanged. */
export class MonitorError extends Error {
  constructor(message: string);
}

/**
 * Runs the automaton over one trace after another.  One that is `sparse` is a `Monitor<SparseSignals>`:
 *
 *     const monitor = new Monitor<SparseSignals>({}, { sparse: true });
 */
export class Monitor<Sample extends SparseSignals = Signals> {
  readonly state: number;
  readonly steps: number;
  readonly progress: number;
  readonly done: boolean;
  /** Messages about values that were clamped, one for each signal and atom. */
  readonly notices: readonly string[];

  /** `params` override values of params; throws MonitorError if one is not in its range. */
  constructor(params?: Partial<Params>, options?: Options);

  /** Go back to the state before the first sample. */
  reset(): void;

  /**
   * Take one sample; the result is `result` or a new one.  Throws MonitorError, and leaves the state unchanged, if a
   * signal is missing or not finite, an atom has no value, or exclusive atoms hold at once.  A bool may be missing only
   * if the monitor is `sparse`: then it is false.
   */
  step(signals: Sample, result?: Result): Result;
}
