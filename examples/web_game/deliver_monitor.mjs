// Monitor of the specification `deliver`, written by tltlc.
//
// Fetch the parcel and bring it to the door, out of the dog's reach.
//
//     F((parcel_distance < 0.5) & X F(door_distance < 0.5)) & G !(dog_distance < 1)
//
// An ES module for browsers and for Node, without dependencies.  In a game:
//
//     import { Monitor, Result } from "./deliver_monitor.mjs";
//
//     const monitor = new Monitor();
//     const result = new Result();  // reused at each step; without it, each step creates a new one
//
//     monitor.step({ parcel_distance: …, door_distance: …, … }, result);
//     // ... result.verdict, result.progress, result.reward
//
// In Node (20.16 or later) it is also a program that prints a row for each sample of a trace in CSV:
//
//     node deliver_monitor.mjs TRACE.csv    (- is standard input)

/** @typedef {import("./deliver_monitor.d.mts").Signals} Signals */
/** @typedef {import("./deliver_monitor.d.mts").Params} Params */
/** @typedef {import("./deliver_monitor.d.mts").Options} Options */
/** @typedef {import("./deliver_monitor.d.mts").Verdict} Verdict */

/**
 * The signals of a sample; `low` and `high` are in SI units.
 * @type {ReadonlyArray<{name: string, isBool: boolean, low: number, high: number}>}
 */
const SIGNALS = [
  { name: "parcel_distance", isBool: false, low: 0, high: 30 },
  { name: "door_distance", isBool: false, low: 0, high: 30 },
  { name: "dog_distance", isBool: false, low: 0, high: 20 },
];

/** @type {ReadonlyArray<{name: string, value: number, low: number, high: number}>} */
const PARAMS = [];

/**
 * For each state: what remains to be satisfied, as a formula and in words, its verdict, whether it is accepting, whether
 * an episode ends on entry.
 * @type {ReadonlyArray<{label: string, label_english: string, verdict: Verdict, accepting: boolean, ends: boolean}>}
 */
const STATES = [
  { label: "F((parcel_distance < 0.5) & X F(door_distance < 0.5)) & G !(dog_distance < 1)", label_english: "Reach parcel_distance < 0.5, then door_distance < 0.5, and keep dog_distance >= 1 throughout.", verdict: "pending", accepting: false, ends: false },
  { label: "F(door_distance < 0.5) & G !(dog_distance < 1)", label_english: "Reach door_distance < 0.5, and keep dog_distance >= 1 throughout.", verdict: "pending", accepting: false, ends: false },
  { label: "false", label_english: "The spec is violated.", verdict: "violated", accepting: false, ends: true },
  { label: "G !(dog_distance < 1)", label_english: "Keep dog_distance >= 1 throughout.", verdict: "holding", accepting: true, ends: true },
];

/** @typedef {{clause: string | null, atom: string | null, step: number | null}} Failure */

/** @type {Failure} */
const NOT_FAILED = { clause: null, atom: null, step: null };

/** What a step can fail at: the clause that it breaks, and the atom that decides it. */
const FAILURES = [
  { clause: "avoid dog_distance < 1 m", atom: "dog_distance < 1" },
];

/** The result of one sample. */
export class Result {
  constructor() {
    this.state = 0;
    /** What remains to be satisfied. */
    this.label = "";
    /** @type {Verdict} */
    this.verdict = "pending";
    /** Whether the trace so far is accepted. */
    this.accepting = false;
    /** An episode ends here, or ended before. */
    this.done = false;
    /** The best so far, in [0, 1]. */
    this.progress = 0;
    /** Of this step; 0 after the end of the episode. */
    this.reward = 0;
    /** Of the edge taken, in [-1, 1]. */
    this.robustness = 0;
    /**
     * The atom that bounds the nearest edge that would have improved the distance to acceptance; null if the
     * automaton moved or no edge improves it.
     * @type {string | null}
     */
    this.limiting = null;
    /** What remains to be satisfied, in words. */
    this.label_english = "";
    /**
     * The clause that the step `failed_step` broke; null if only several clauses together cannot be met any more.
     * @type {string | null}
     */
    this.failed_clause = null;
    /**
     * The atom that decides it: the one that had to hold but did not, or else the one that must not hold but did.
     * @type {string | null}
     */
    this.failed_atom = null;
    /**
     * The first step, from 1, after which no continuation of the trace can meet the specification; null before it.
     * @type {number | null}
     */
    this.failed_step = null;
  }
}

/** A sample that the automaton cannot take, or a param value that is not allowed; the state is unchanged. */
export class MonitorError extends Error {
  /** @param {string} message */
  constructor(message) {
    super(message);
    this.name = "MonitorError";
  }
}

/** Runs the automaton over one trace after another. */
export class Monitor {
  #noticed = new Set();
  /** What the trace fails at. */
  #failure = NOT_FAILED;
  #sparse;

  /**
   * @param {Partial<Params>} [params] override values of params, in SI units
   * @param {Options} [options] `sparse`: samples have only the events that happened; missing bools are false
   * @throws {MonitorError} if there is no such param, or its value is not in its range
   */
  constructor(params = {}, options = {}) {
    paramValues(params);
    this.#sparse = options.sparse === true;
    /**
     * Messages about values that were clamped, one for each signal and atom.
     * @type {string[]}
     */
    this.notices = [];
    this.state = 0;
    this.steps = 0;
    this.progress = 0;
    this.done = false;
  }

  /** Go back to the state before the first sample. */
  reset() {
    this.state = 0;
    this.steps = 0;
    this.progress = 0;
    this.done = false;
    this.#failure = NOT_FAILED;
  }

  /**
   * Take one sample; other properties of the object are ignored.
   *
   * @param {Signals} signals numbers in SI units, or booleans
   * @param {Result} [result] the result to fill; a new one if it is left out
   * @throws {MonitorError} if a signal is missing or not finite, an atom has no value, or exclusive atoms hold at
   *   once; the state is unchanged.  A bool may be missing only if the monitor is `sparse`: then it is false
   */
  step(signals, result = new Result()) {
    const steps = this.steps + 1;

    let parcel_distance = signals.parcel_distance;
    if (!(typeof parcel_distance === "number" && 0 <= parcel_distance && parcel_distance <= 30)) {
      parcel_distance = this.#signal(0, signals);
    }
    let door_distance = signals.door_distance;
    if (!(typeof door_distance === "number" && 0 <= door_distance && door_distance <= 30)) {
      door_distance = this.#signal(1, signals);
    }
    let dog_distance = signals.dog_distance;
    if (!(typeof dog_distance === "number" && 0 <= dog_distance && dog_distance <= 20)) {
      dog_distance = this.#signal(2, signals);
    }

    // dog_distance < 1
    const dog_distance_under_1 = max(1 - dog_distance, (1 - dog_distance) / 19);

    let target = this.state;
    let robustness = 0;
    let progress = 0;
    let limiting = null;
    let failure = -1;
    switch (this.state) {
      // F((parcel_distance < 0.5) & X F(door_distance < 0.5)) & G !(dog_distance < 1)
      case 0: {
        // parcel_distance < 0.5
        const parcel_distance_under_0_5 = max((0.5 - parcel_distance) / 0.5, (0.5 - parcel_distance) / 29.5);
        if (dog_distance_under_1 > 0) {
          // dog_distance < 1
          target = 2;
          robustness = dog_distance_under_1;
          failure = 0;
          progress = 0;
          limiting = null;
        } else if (parcel_distance_under_0_5 <= 0 && dog_distance_under_1 <= 0) {
          // !(parcel_distance < 0.5) & !(dog_distance < 1)
          target = 0;
          robustness = Math.min(-parcel_distance_under_0_5, -dog_distance_under_1);
          const nearest = Math.min(parcel_distance_under_0_5, -dog_distance_under_1);
          if (parcel_distance_under_0_5 === nearest) {
            limiting = "parcel_distance < 0.5";
          } else {
            limiting = "dog_distance < 1";
          }
          progress = (1 + nearest) / 2;
        } else {
          // (parcel_distance < 0.5) & !(dog_distance < 1)
          target = 1;
          robustness = Math.min(parcel_distance_under_0_5, -dog_distance_under_1);
          progress = 0.5;
          limiting = null;
        }
        break;
      }
      // F(door_distance < 0.5) & G !(dog_distance < 1)
      case 1: {
        // door_distance < 0.5
        const door_distance_under_0_5 = max((0.5 - door_distance) / 0.5, (0.5 - door_distance) / 29.5);
        if (dog_distance_under_1 > 0) {
          // dog_distance < 1
          target = 2;
          robustness = dog_distance_under_1;
          failure = 0;
          progress = 0;
          limiting = null;
        } else if (door_distance_under_0_5 <= 0 && dog_distance_under_1 <= 0) {
          // !(door_distance < 0.5) & !(dog_distance < 1)
          target = 1;
          robustness = Math.min(-door_distance_under_0_5, -dog_distance_under_1);
          const nearest = Math.min(door_distance_under_0_5, -dog_distance_under_1);
          if (door_distance_under_0_5 === nearest) {
            limiting = "door_distance < 0.5";
          } else {
            limiting = "dog_distance < 1";
          }
          progress = 0.5 + (1 + nearest) / 2;
        } else {
          // (door_distance < 0.5) & !(dog_distance < 1)
          target = 3;
          robustness = Math.min(door_distance_under_0_5, -dog_distance_under_1);
          progress = 1;
          limiting = null;
        }
        break;
      }
      // false
      case 2: {
        // true
        target = 2;
        robustness = 1;
        progress = 0;
        limiting = null;
        break;
      }
      // G !(dog_distance < 1)
      case 3: {
        if (dog_distance_under_1 > 0) {
          // dog_distance < 1
          target = 2;
          robustness = dog_distance_under_1;
          failure = 0;
          progress = 0;
          limiting = null;
        } else {
          // !(dog_distance < 1)
          target = 3;
          robustness = -dog_distance_under_1;
          progress = 1;
          limiting = null;
        }
        break;
      }
    }

    const entered = STATES[target];
    let best = this.progress;
    let done = this.done;
    let reward;
    const ends = entered.ends;
    const violated = entered.verdict === "violated";
    const before = best;
    if (progress > best) {
      best = progress;
    }
    if (done) {
      reward = 0;
    } else {
      reward = best - before - 0.016666666666666666;
      if (violated) {
        reward = reward - (60 - steps) / 60;
      }
      done = ends || steps >= 60;
    }

    if (failure >= 0) this.#failure = { ...FAILURES[failure], step: steps };

    this.state = target;
    this.steps = steps;
    this.progress = best;
    this.done = done;
    result.state = target;
    result.label = entered.label;
    result.verdict = entered.verdict;
    result.accepting = entered.accepting;
    result.done = done;
    result.progress = best;
    result.reward = reward;
    // Adding 0 turns -0 into 0.
    result.robustness = robustness + 0;
    result.limiting = limiting;
    // To compare is faster than to assign.
    if (result.label_english !== entered.label_english) result.label_english = entered.label_english;
    if (result.failed_step !== null || this.#failure !== NOT_FAILED) {
      result.failed_clause = this.#failure.clause;
      result.failed_atom = this.#failure.atom;
      result.failed_step = this.#failure.step;
    }
    return result;
  }

  /** Checks a signal, and returns its value as a number in its range. */
  #signal(index, signals) {
    const { name, isBool, low, high } = SIGNALS[index];
    const given = signals[name];
    if (given === undefined && isBool && this.#sparse) return 0;
    const missing = SIGNALS.filter((signal) => signals[signal.name] === undefined && !(signal.isBool && this.#sparse));
    if (missing.length > 0) throw this.#error(`no value for ${listed(missing.map((signal) => signal.name))}`);
    if (typeof given !== "number" && typeof given !== "boolean") {
      throw this.#error(`the signal \`${name}\` is not a number`);
    }
    const value = Number(given);
    if (!Number.isFinite(value)) {
      throw this.#error(`the signal \`${name}\` is ${shown(value)}, not a finite number`);
    }
    if (isBool && value !== 0 && value !== 1) {
      throw this.#error(`the signal \`${name}\` is ${shown(value)}, not true or false`);
    }
    if (low <= value && value <= high) return value;
    return this.#clamped("signal", name, value, low, high);
  }

  /** The nearest value inside a range; the first time is reported. */
  #clamped(kind, name, value, low, high) {
    const nearest = value < low ? low : high;
    const key = `${kind} ${name}`;
    if (!this.#noticed.has(key)) {
      this.#noticed.add(key);
      const range = `[${shown(low)}, ${shown(high)}]`;
      const text = `the ${kind} \`${name}\` is ${shown(value)}, outside ${range}: it counts as ${shown(nearest)}`;
      this.notices.push(`step ${this.steps + 1}: ${text}`);
    }
    return nearest;
  }

  #error(text) {
    return new MonitorError(`step ${this.steps + 1}: ${text}`);
  }
}

function paramValues(given) {
  const values = Float64Array.from(PARAMS, (param) => param.value);
  for (const [name, value] of Object.entries(given)) {
    const index = PARAMS.findIndex((param) => param.name === name);
    if (index < 0) throw new MonitorError(`there is no param \`${name}\` to set`);
    if (value === undefined) continue;
    const { low, high } = PARAMS[index];
    if (typeof value !== "number") throw new MonitorError(`the value given for the param \`${name}\` is not a number`);
    if (!Number.isFinite(value)) throw new MonitorError(`the param \`${name}\` cannot be ${shown(value)}`);
    if (value < low || value > high) {
      const range = `[${shown(low)}, ${shown(high)}]`;
      throw new MonitorError(`the param \`${name}\` cannot be ${shown(value)}: its range is ${range}`);
    }
    values[index] = value;
  }
  return values;
}

/** Returns the first of equal values; Math.max treats -0 and 0 as different. */
function max(x, y) {
  return y > x ? y : x;
}

function shown(value) {
  return String(value).replace("Infinity", "inf").replace("NaN", "nan");
}

function listed(names) {
  const quoted = names.map((name) => `\`${name}\``);
  const last = quoted.pop();
  return quoted.length ? `${quoted.join(", ")} and ${last}` : last;
}

// --- the program: a row for each sample of a trace, only in Node -----------------------------------------------------

/** Whether Node was started with this file: false if it is imported or part of a bundle. */
function isProgram() {
  const script = typeof process === "object" ? process.argv?.[1] : undefined;
  return script?.split(/[\\/]/).pop() === "deliver_monitor.mjs";
}

/**
 * Run over a trace. Returns the exit status: 0 for success, 1 for a bad trace, 2 for wrong usage, 3 for a file that
 * cannot be read or an output that cannot be written, 141 if the reader of the output has gone.
 */
async function main(args) {
  const full = args[0] === "--full";
  const path = args[full ? 1 : 0];
  if (args.length !== (full ? 2 : 1) || (path.startsWith("-") && path !== "-")) {
    console.error("usage: node deliver_monitor.mjs [--full] TRACE.csv    (- is standard input)");
    return 2;
  }
  // Not imported, because bundlers for browsers would look for it.
  const { createReadStream } = process.getBuiltinModule("node:fs");
  const input = path === "-" ? process.stdin : createReadStream(path);
  let lost = null;
  // A row may be refused while the next ones are already being read.
  process.stdout.on("error", (error) => {
    lost ??= error;
    input.destroy();
  });
  const monitor = new Monitor();
  let status = 0;
  let message = "";
  try {
    await run(monitor, input, full);
  } catch (error) {
    const refused = error instanceof MonitorError;
    if (!refused && !error.code) throw error;
    status = refused ? 1 : 3;
    message = `${refused ? "" : `cannot read \`${path}\`: `}${error.message}`;
  }
  // The last write is the last to be confirmed.
  const problem = monitor.steps > 0 && (await new Promise((answered) => process.stdout.write("", answered)));
  lost ??= problem;
  if (lost) {
    if (lost.code === "EPIPE") return 141;
    status = 3;
    message = `cannot write to standard output: ${lost.message}`;
  }
  if (message) console.error(`error: ${message}`);
  for (const notice of monitor.notices) console.error(`warning: ${notice}`);
  return status;
}

async function run(monitor, input, full) {
  const result = new Result();
  const reader = new RowReader();
  let columns = null;
  for await (const bytes of lines(input)) {
    const cells = reader.row(bytes);
    if (!cells) continue;
    if (!columns) {
      checkColumns(cells, reader.first);
      columns = cells;
      continue;
    }
    monitor.step(sampleOf(cells, columns, reader.first), result);
    print(monitor.steps, result, full);
    if (process.stdout.errored) return;
  }
  reader.end();
  if (monitor.steps === 0) throw new MonitorError("the trace contains no sample");
}

/** The longest row, in bytes. */
const ROW_BYTES = 1048576;

/** The lines of a file, as bytes without their line feeds; only the beginning of a line that is too long. */
async function* lines(input) {
  const { Buffer } = process.getBuiltinModule("node:buffer");
  let pieces = [];
  let length = 0;
  const take = (piece) => {
    if (length <= ROW_BYTES) pieces.push(piece);
    length += piece.length;
  };
  for await (const bytes of input) {
    let start = 0;
    for (let end = bytes.indexOf(10); end >= 0; end = bytes.indexOf(10, start)) {
      take(bytes.subarray(start, end));
      yield Buffer.concat(pieces);
      [pieces, length, start] = [[], 0, end + 1];
    }
    if (start < bytes.length) take(bytes.subarray(start));
    if (length > ROW_BYTES) yield Buffer.concat(pieces);
  }
  if (length > 0) yield Buffer.concat(pieces);
}

/** Makes rows of lines: cells without the blanks around them. */
class RowReader {
  /** The number of the line in which the current row begins. */
  first = 0;
  #line = 0;
  #bytes = 0;
  #isHeader = true;
  #cells = [];
  /** @type {any} The text so far in a quote that is still open; null if none is. */
  #open = null;
  #decoder = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true });

  /** The row that ends with a line; null if none does. */
  row(bytes) {
    this.#line++;
    if (this.#open === null) [this.first, this.#bytes] = [this.#line, -1];
    this.#bytes += bytes.length + 1;
    if (this.#bytes > ROW_BYTES) this.#fail(`more than ${ROW_BYTES} bytes`);
    const text = this.#text(bytes);
    if (this.#open === null && /^[ \t]*\r?$/.test(text)) return null;
    if (this.#isHeader && this.#open === null && /^[ \t]*\{/.test(text)) {
      throw new MonitorError("the trace is JSON, but this program reads only CSV: `tltlc monitor` reads both");
    }
    let place = this.#open === null ? this.#cell(text, 0) : this.#quoted(text, 0);
    while (place < text.length) place = this.#cell(text, place + 1);
    if (this.#open !== null) return null;
    const cells = this.#cells;
    this.#cells = [];
    this.#isHeader = false;
    return cells;
  }

  end() {
    if (this.#open !== null) this.#fail("a quote is not closed");
  }

  #fail(problem, line = this.first) {
    throw new MonitorError(`line ${line}: ${problem}`);
  }

  #text(bytes) {
    let text = "\0";
    try {
      text = this.#decoder.decode(bytes);
    } catch {
      // It is not text.
    }
    if (text.includes("\0")) this.#fail("it is not UTF-8, or contains a NUL", this.#line);
    return this.#line === 1 ? text.replace(/^\ufeff/, "") : text;
  }

  /** Takes the cell that begins there; returns where it ends: at a comma, or at the end of the line. */
  #cell(text, from) {
    const start = afterBlanks(text, from);
    if (text[start] === '"') {
      this.#open = [];
      return this.#quoted(text, start + 1);
    }
    const comma = text.indexOf(",", start);
    const end = comma < 0 ? text.length : comma;
    const cell = comma < 0 ? text.slice(start).replace(/\r$/, "") : text.slice(start, end);
    if (cell.includes("\r")) this.#fail("a carriage return without a line feed");
    this.#cells.push(trimmed(cell));
    return end;
  }

  /** The same for a cell in quotes, which may continue in the next line. */
  #quoted(text, start) {
    let end = text.indexOf('"', start);
    while (end >= 0 && text[end + 1] === '"') end = text.indexOf('"', end + 2);
    this.#open.push(end < 0 ? text.slice(start) : text.slice(start, end));
    if (end < 0) return text.length;
    this.#cells.push(this.#open.join("\n").replaceAll('""', '"'));
    this.#open = null;
    const place = afterBlanks(text, end + 1);
    if (place === text.length || (text[place] === "\r" && place + 1 === text.length)) return text.length;
    if (text[place] !== ",") this.#fail("a cell continues after its closing quote");
    return place;
  }
}

function afterBlanks(text, start) {
  while (text[start] === " " || text[start] === "\t") start++;
  return start;
}

/** A text without the blanks around it. */
function trimmed(text) {
  let end = text.length;
  while (text[end - 1] === " " || text[end - 1] === "\t") end--;
  return text.slice(afterBlanks(text, 0), end);
}

function checkColumns(columns, line) {
  const names = SIGNALS.map((signal) => signal.name);
  const missing = names.filter((name) => !columns.includes(name));
  if (missing.length) throw new MonitorError(`line ${line}: the trace has no column for ${listed(missing)}`);
  const twice = names.find((name) => columns.indexOf(name) !== columns.lastIndexOf(name));
  if (twice !== undefined) throw new MonitorError(`line ${line}: two columns are called \`${twice}\``);
}

/** The signals of a row. */
function sampleOf(cells, columns, line) {
  if (cells.length !== columns.length) {
    throw new MonitorError(`line ${line}: ${cells.length} values for ${columns.length} columns`);
  }
  const sample = Object.create(null);
  for (const { name, isBool } of SIGNALS) {
    const cell = cells[columns.indexOf(name)];
    const value = parsed(trimmed(cell));
    const problem = value === null ? "not a number" : isBool && value !== 0 && value !== 1 ? "not true or false" : "";
    if (problem) throw new MonitorError(`line ${line}: the signal \`${name}\` is \`${cell}\`, ${problem}`);
    sample[name] = value;
  }
  return sample;
}

/** The number in a text, or true or false; null if there is none. */
function parsed(text) {
  if (/^[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?$/.test(text)) return Number(text);
  // The lower case of a letter outside ASCII may be in ASCII.
  const word = /^[\x21-\x7e]+$/.test(text) ? text.toLowerCase() : "";
  if (word === "true" || word === "false") return word === "true" ? 1 : 0;
  const [, sign, name] = /^([+-]?)(inf|infinity|nan)$/.exec(word) ?? [];
  if (!name) return null;
  return name === "nan" ? NaN : sign === "-" ? -Infinity : Infinity;
}

function print(steps, result, full) {
  if (steps === 1) {
    const more = full ? ",robustness,limiting,failed_clause,failed_atom,failed_step" : "";
    process.stdout.write(`step,state,verdict,accepting,done,progress,reward${more}\n`);
  }
  const cells = [steps, result.state, result.verdict, result.accepting, result.done];
  cells.push(printed(result.progress), printed(result.reward));
  if (full) {
    const texts = [result.limiting, result.failed_clause, result.failed_atom, result.failed_step];
    cells.push(printed(result.robustness), ...texts.map((text) => quoted(String(text ?? ""))));
  }
  process.stdout.write(`${cells.join(",")}\n`);
}

/** A number with 17 significant digits, as C's `%.17g` prints it: without zeros at the end, ties to even. */
function printed(value) {
  if (value === 0) return Object.is(value, -0) ? "-0" : "0";
  let [digits, power] = Math.abs(value).toExponential(16).split("e");
  // JavaScript rounds ties up.
  const exact = Math.abs(value).toExponential(60).split("e")[0];
  if (/^[02468]50*$/.test(exact.slice(17))) digits = exact.slice(0, 18);
  digits = digits.replace(".", "").replace(/0+$/, "");
  const sign = value < 0 ? "-" : "";
  const exponent = Number(power);
  if (exponent < -4 || exponent >= 17) {
    const fraction = digits.length > 1 ? `.${digits.slice(1)}` : "";
    const size = String(Math.abs(exponent)).padStart(2, "0");
    return `${sign}${digits[0]}${fraction}e${exponent < 0 ? "-" : "+"}${size}`;
  }
  if (exponent < 0) return `${sign}0.${"0".repeat(-exponent - 1)}${digits}`;
  const whole = digits.slice(0, exponent + 1).padEnd(exponent + 1, "0");
  const fraction = digits.slice(exponent + 1);
  return `${sign}${whole}${fraction ? `.${fraction}` : ""}`;
}

/** A cell of CSV. */
function quoted(text) {
  return /[,"\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

// No `await` here, so that importers of the module need not wait.
if (isProgram()) main(process.argv.slice(2)).then((status) => (process.exitCode = status));
