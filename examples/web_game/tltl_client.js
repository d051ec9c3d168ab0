// Connect a game in JavaScript to tltlc, and record the play of a person: copy this file into your game.
//
// It is an ES module for pages and for Node 18 or newer, and needs nothing else. A game is an object with the
// property `hello` and some methods:
//
//     import { play, Refusal, state } from "./tltl_client.js";
//
//     class Game {
//       hello = {
//         name: "counter",
//         clock_hz: 10,
//         signals: { position: { range: [0, 10] }, at_goal: { type: "bool" } },
//         actions: { type: "discrete", n: 3 },
//         observation: { type: "box", low: 0, high: 10, shape: [1] },
//         scenes: ["short", "long"],
//         capabilities: ["seed", "positions"],
//       };
//
//       // Begin an episode, and return its first state.
//       reset(scene, variant, seed) {
//         if (scene && !this.hello.scenes.includes(scene)) throw new Refusal(`there is no scene \`${scene}\``);
//         this.goal = scene === "long" ? 10 : 5;
//         this.position = (seed ?? 0) % 4;
//         return this.state();
//       }
//
//       // Play one tick, and return the state.
//       step(action) {
//         this.position = Math.min(Math.max(this.position + action - 1, 0), 10);
//         return this.state();
//       }
//
//       state() {
//         const at_goal = this.position >= this.goal;
//         return state({
//           signals: { position: this.position, at_goal },
//           observation: [this.position],
//           ended: at_goal,
//           positions: { player: [this.position, 0] },
//         });
//       }
//
//       // Optional: `snapshot()` keeps the state of the game and returns an id, `restore(id)` returns to it and returns
//       // the state, `releaseSnapshot(id)` forgets it, because there will be no return to it, `screenshot()` returns a
//       // picture (see `array`), and `close()` is called at the end.
//       // `outline()` returns what maps of the current scene and variant show, in metres, for example
//       // { boxes: { wall: [[[0, 0], [8, 1]], [[8, 0], [9, 6]]] }, regions: { hall: [[0, 1], [8, 6]] } }
//     }
//
//     play(new Game());
//
// Methods may be `async`. Throw a `Refusal` where a request cannot be met. `play` waits for requests. A game with a
// main loop of its own uses `Client`:
//
//     const client = await Client.connect(hello);
//     for (;;) {
//       const [kind, body] = await client.request();
//       ...
//       client.answerState(state);
//     }
//
// In Node, port and token come from the variables TLTL_PORT and TLTL_TOKEN, and in a page from its address:
// `index.html?tltl_port=5000&tltl_token=9f…`. `isStartedByTltlc()` says whether they are given. This file is also a
// program for Node that opens a page for tltlc, in a browser without a window:
//
//     process = ["node", "tltl_client.js", "index.html"]      # in the game file
//
// Node needs `"type": "module"` in package.json for this file, or the name tltl_client.mjs. `docs/wire.md` of tltlc
// describes the protocol.

const PROTOCOL = 1;
const LONGEST_LINE = 1 << 25;
const KINDS = ["reset", "step", "snapshot", "restore", "release", "screenshot", "outline", "close"];
const IS_NODE = typeof process === "object" && Boolean(process.versions?.node) && typeof window === "undefined";

/** Throw this in a method of the game if a request cannot be met. tltlc shows the message, which says why. */
export class Refusal extends Error {
  name = "Refusal";
}

/** Thrown if tltlc has closed the connection, or refuses this game. The message says why, if that is known. */
export class Disconnected extends Error {
  name = "Disconnected";
}

/**
 * Return the state of the game as an object for a message.
 *
 * `signals` are numbers in SI units and booleans, by name. `ended` says whether the episode has ended, and `cause` who or
 * what ended it. `positions` are arrays of two or three coordinates in metres, by the name of the entity; the player's
 * name is `player`. An observation may be a typed array, such as a Float32Array.
 */
export function state({ signals, observation, ended = false, cause = null, positions }) {
  const message = { signals, ended: Boolean(ended), cause };
  if (observation !== undefined) message.observation = plain(observation);
  if (positions !== undefined) message.positions = positions;
  return message;
}

/**
 * Return a large array, such as a picture, as an object for a message.
 *
 * `data` is a typed array or an ArrayBuffer; the last index changes fastest. `dtype` is a word such as `uint8`, and
 * `shape` an array such as `[84, 84, 3]`.
 */
export function array(data, dtype, shape) {
  const bytes = ArrayBuffer.isView(data)
    ? new Uint8Array(data.buffer, data.byteOffset, data.byteLength)
    : new Uint8Array(data);
  return { base64: base64(bytes), dtype, shape: Array.from(shape) };
}

/** Whether port and token are given: if not, a person plays. */
export function isStartedByTltlc() {
  return Boolean(given("port"));
}

/**
 * Connect to tltlc and answer its requests, until it closes the connection.
 *
 * If tltlc refuses the game, or has not started it, the message goes to the console, and the exit status of Node will
 * be 1. If the game is started first and tltlc connects to it, pass a client, and play again after each connection. The
 * method `close` of the game is called at the end of each:
 *
 *     for (;;) await play(game, await listen(gameHello(game), 5000));
 */
export async function play(game, client = null) {
  let problem = "";
  try {
    client ??= await Client.connect(gameHello(game));
    for (;;) {
      const [kind, body] = await client.request();
      if (kind === "close") break;
      try {
        await answer(game, client, kind, body);
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        client.refuse(error.message);
      }
    }
  } catch (error) {
    problem = error instanceof Disconnected ? error.message : String(error);
    if (!(error instanceof Disconnected)) throw error;
    if (problem && !given("end")) fail(problem);
  } finally {
    client?.close(problem);
    await game.close?.();
  }
}

/**
 * Return the `hello` of a game, with the capabilities `snapshot`, `release`, `screenshot` and `outline` if it has the
 * methods.
 */
export function gameHello(game) {
  const words = new Set(game.hello.capabilities ?? []);
  if (game.snapshot && game.restore) words.add("snapshot");
  if (game.releaseSnapshot) words.add("release");
  if (game.screenshot) words.add("screenshot");
  if (game.outline) words.add("outline");
  return { ...game.hello, capabilities: [...words].sort() };
}

async function answer(game, client, kind, body) {
  if (kind === "reset") {
    client.answerState(await game.reset(body.scene ?? null, body.variant ?? "v0", body.seed ?? null));
  } else if (kind === "step") {
    let result = await game.step(body.action);
    for (let tick = 1; tick < (body.repeat ?? 1) && !result.ended; tick++) result = await game.step(body.action);
    client.answerState(result);
  } else if (kind === "snapshot" && game.snapshot) {
    client.answer({ snapshot: { id: await game.snapshot() } });
  } else if (kind === "restore" && game.restore) {
    client.answerState(await game.restore(body.id));
  } else if (kind === "release" && game.releaseSnapshot) {
    await game.releaseSnapshot(body.id);
    client.answer({ release: { id: body.id } });
  } else if (kind === "screenshot" && game.screenshot) {
    client.answer({ screenshot: await game.screenshot() });
  } else if (kind === "outline" && game.outline) {
    client.answer({ outline: await game.outline() });
  } else {
    throw new Refusal(`this game does not know the request \`${kind}\``);
  }
}

/** A connection to tltlc, made by `Client.connect` or `listen`. */
export class Client {
  #connection;

  /**
   * Connect to tltlc, and send `hello`: the declaration of the game, without version and token.
   *
   * By default, port and token come from the variables TLTL_PORT and TLTL_TOKEN of Node, or from the address of the page.
   * Throws Disconnected if no tltlc can be reached.
   */
  static async connect(hello, { port = given("port"), token = given("token") } = {}) {
    if (!port) {
      throw new Disconnected(
        IS_NODE
          ? "tltlc must start this game: the variable TLTL_PORT is not set"
          : "tltlc must open this page: its address has no `tltl_port`",
      );
    }
    return new Client(hello, await (IS_NODE ? connectSocket(port) : connectWebSocket(port)), token);
  }

  constructor(hello, connection, token) {
    this.#connection = connection;
    this.answer({ hello: { tltl: PROTOCOL, ...(token ? { token } : {}), ...hello } });
  }

  /**
   * Wait for the next request; return its kind, such as `step`, and its content: `[kind, body]`.
   *
   * Throws Disconnected if tltlc has closed the connection, or refuses this game.
   */
  async request() {
    const message = await this.#connection.receive();
    if (message === null) throw new Disconnected("");
    if (Object.hasOwn(message, "error")) throw new Disconnected(errorText(message));
    for (const kind of KINDS) {
      if (Object.hasOwn(message, kind)) return [kind, message[kind] ?? {}];
    }
    return [Object.keys(message)[0] ?? "", {}];
  }

  /** Answer a `reset`, a `step` or a `restore` with the result of `state`. */
  answerState(message) {
    this.answer({ state: message });
  }

  /** Answer that the request cannot be met. */
  refuse(reason) {
    this.answer({ error: { message: reason } });
  }

  /** Send a message. Throws RangeError if a number in it is not finite. */
  answer(message) {
    checkFinite(message, "");
    this.#connection.send(JSON.stringify(message));
  }

  /** Close the connection. If the game has failed, `problem` says why. */
  close(problem = "") {
    this.#connection.close(problem);
  }
}

/**
 * Wait on a port of 127.0.0.1 until tltlc connects; return the Client. Only in Node.
 *
 * Use this if the game file has `connect = "127.0.0.1:PORT"`. The default of `token` is the variable TLTL_TOKEN. If the
 * token is not empty, tltlc must send the same one. While one tltlc plays, no other can connect.
 *
 * Throws Disconnected if another program uses the port.
 */
export async function listen(hello, port, { token = given("token") } = {}) {
  for (;;) {
    const connection = new LineConnection(await acceptedSocket(port));
    const reason = refusal(await connection.receive(), token);
    if (!reason) return new Client(hello, connection, "");
    connection.send(JSON.stringify({ error: { message: reason } }));
    connection.close();
  }
}

/** Return why the game refuses the first message of tltlc; empty if it accepts the message. */
function refusal(message, token) {
  const hello = message?.hello;
  if (typeof hello !== "object" || hello === null) return "the first line must be a `hello`";
  if (hello.tltl !== PROTOCOL) return `this game speaks version ${PROTOCOL} of the protocol`;
  if (token && hello.token !== token) {
    return "the token is wrong: start tltlc with the variable TLTL_TOKEN of this game";
  }
  return "";
}

/**
 * Writes the play of a person as traces, which `tltlc monitor` can judge later; needs no connection.
 *
 * In Node, each episode is a file in `folder`: `trace-0001.csv`, `trace-0002.csv` and so on; no file is overwritten. In a
 * page, `end` returns the text of the trace, and `download` offers it to the person. `signals` are the names of the
 * signals, as specs write them. With `clockHz`, the number of samples in a second, the traces have a column `time`:
 *
 *     const recorder = new Recorder("traces", ["position", "at_goal"], { clockHz: 10 });
 *     recorder.begin();
 *     recorder.sample({ position: 1, at_goal: false });    // after each tick
 *     recorder.end();
 *
 * With the actions of the person, as tltlc would send them, each episode is also a tape, `trace-0001.tape.jsonl`, with
 * which the play can be repeated; in a page, `tape` returns its text. The option `game` is the name of the game:
 *
 *     recorder.begin("short", "v0", 7);
 *     recorder.sample({ position: 1, at_goal: false }, 2);
 *
 * Before Node 20.16, give the option `fs`, which is `await import("node:fs")`.
 */
export class Recorder {
  #folder;
  #signals;
  #clockHz;
  #fs;
  #name = "";
  #file = null;
  #text = null;
  #last = "";
  #number = 0;
  #samples = 0;
  #game;
  #played = null;
  #tape = null; // a file in Node, and a text in a page
  #lastTape = "";
  #sums; // of the digest, Adler-32
  #areBools; // whether each signal is a bool in the tape: it keeps the type of its first value

  constructor(folder, signals, { clockHz = null, fs = null, game = "game" } = {}) {
    [this.#folder, this.#signals, this.#clockHz, this.#game] = [folder, [...signals], clockHz, game];
    this.#fs = fs ?? (IS_NODE ? process.getBuiltinModule("node:fs") : null);
  }

  /**
   * Begin a new trace, and end the one before; return the path of its file, which the first sample makes, or in a page
   * its name.
   *
   * A tape says which scene, variant and seed were played; without a variant it is `v0`.
   */
  begin(scene = null, variant = null, seed = null) {
    this.end();
    [this.#played, this.#samples, this.#sums] = [{ scene, variant: variant ?? "v0", seed }, 0, [1, 0]];
    [this.#last, this.#lastTape] = ["", ""];
    return this.#fs ? this.#path(this.#freeNumber(1)) : traceName(this.#number + 1);
  }

  /**
   * Add the values of all signals at one moment, in Node to the file at once; begin a trace if there is none.
   *
   * With `action`, what the person did in the tick before it, the step is written to the tape, too. Throws RangeError if
   * a number is not finite, and TypeError if a signal is missing, or is no number and no boolean, or if some samples of
   * an episode have an action and others have none.
   */
  sample(signals, action = null) {
    const values = this.#signals.map((name) => cellOf(name, signals[name]));
    checkFinite(action, "the action");
    const actionText = JSON.stringify(plain(action));
    if (actionText === undefined) throw new TypeError("the action is no value of JSON");
    if (this.#played === null) this.begin();
    if (this.#text === null) this.#makeTrace();
    if (this.#samples && (action === null) !== (this.#tape === null)) {
      throw new TypeError("give the action of each sample of an episode, or of none");
    }
    if (action !== null) this.#writeStep(actionText, values, signals);
    if (this.#clockHz) values.unshift(String(this.#samples / this.#clockHz));
    this.#write(values);
    this.#samples++;
  }

  /** End the trace and its tape, if there is one. In a page, return the text of the trace. */
  end() {
    for (const file of [this.#file, this.#fs && this.#tape]) if (file !== null) this.#fs.closeSync(file);
    [this.#file, this.#tape, this.#played] = [null, null, null];
    this.#last = this.#text ?? this.#last;
    this.#text = null;
    return this.#last;
  }

  /** In a page: end the trace, and return the text of its tape; empty if the samples had no actions. */
  tape() {
    this.end();
    return this.#lastTape;
  }

  /**
   * In a page: end the trace, and let the browser save the last one, and its tape, in the folder for downloads. Without
   * a sample, there is nothing to save.
   */
  download() {
    const text = this.end();
    if (text) this.#save(text, this.#name, "text/csv");
    if (this.#lastTape) this.#save(this.#lastTape, tapeName(this.#name), "application/jsonl");
  }

  #save(text, name, type) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type }));
    link.download = this.#folder ? `${this.#folder}-${name}` : name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  }

  /** Write a step to the tape, and before the first one the header. */
  #writeStep(action, texts, signals) {
    const quoted = this.#signals.map((name) => JSON.stringify(name));
    if (this.#samples === 0) {
      const versions = IS_NODE ? { node: process.version } : {};
      const about = { ...this.#played, spec: null, versions, clock_hz: this.#clockHz };
      this.#areBools = texts.map((text) => /^[tf]/.test(text));
      const types = quoted.map((name, i) => `${name}:{"type":"${this.#areBools[i] ? "bool" : "number"}"}`);
      const header = JSON.stringify({ tape: 1, game: this.#game, ...about });
      this.#tape = this.#fs ? this.#fs.openSync(tapeName(this.#name), "wx") : "";
      this.#writeTape(`${header.slice(0, -1)},"signals":{${types}}}\n`);
    }
    const bytes = new DataView(new ArrayBuffer(8));
    let [low, high] = this.#sums;
    const values = this.#signals.map((name, i) => (this.#areBools[i] ? Boolean : Number)(signals[name]));
    for (const value of values) {
      bytes.setFloat64(0, Number(value) + 0, true); // -0 counts as 0
      for (let place = 0; place < 8; place++) {
        low = (low + bytes.getUint8(place)) % 65521;
        high = (high + low) % 65521;
      }
    }
    this.#sums = [low, high];
    const digest = (high * 65536 + low).toString(16).padStart(8, "0");
    const end = (this.#samples + 1) % 60 === 0 ? `,"digest":"${digest}"` : "";
    const members = quoted.map((name, i) => `${name}:${values[i]}`);
    this.#writeTape(`{"action":${action},"signals":{${members}}${end}}\n`);
  }

  #writeTape(line) {
    if (this.#fs) this.#fs.writeSync(this.#tape, line);
    else this.#lastTape = this.#tape += line;
  }

  #path(number) {
    return `${this.#folder}/${traceName(number)}`;
  }

  /** Return the first number, from a given one, of which there is neither a trace nor a tape. */
  #freeNumber(number) {
    const exists = (path) => this.#fs.existsSync(path);
    while (exists(this.#path(number)) || exists(tapeName(this.#path(number)))) number++;
    return number;
  }

  #makeTrace() {
    if (this.#fs) this.#openFile();
    else this.#name = traceName(++this.#number);
    this.#text = "";
    this.#write((this.#clockHz ? ["time", ...this.#signals] : this.#signals).map(cell));
  }

  #openFile() {
    this.#fs.mkdirSync(this.#folder, { recursive: true });
    for (let number = 1; this.#file === null; number++) {
      number = this.#freeNumber(number);
      this.#name = this.#path(number);
      try {
        this.#file = this.#fs.openSync(this.#name, "wx");
      } catch (error) {
        if (error.code !== "EEXIST") throw error;
      }
    }
  }

  #write(cells) {
    const line = `${cells.join(",")}\n`;
    if (this.#fs) this.#fs.writeSync(this.#file, line);
    else this.#text += line;
  }
}

function traceName(number) {
  return `trace-${String(number).padStart(4, "0")}.csv`;
}

function tapeName(trace) {
  return trace.replace(/csv$/, "tape.jsonl");
}

function cellOf(name, value) {
  if (typeof value === "boolean") return String(value);
  if (typeof value !== "number") throw new TypeError(`the signal ${name} has no value: ${value}`);
  if (!Number.isFinite(value)) throw new RangeError(`the signal ${name} is ${value}, and numbers must be finite`);
  return String(value);
}

function cell(name) {
  return name.includes(",") || name.startsWith('"') ? `"${name.replaceAll('"', '""')}"` : name;
}

// --- connections -----------------------------------------------------------------------------------------------------

/** Messages that have arrived, and the end of the connection. */
class Inbox {
  #messages = [];
  #waiting = null;
  #hasEnded = false;

  /** Add a message, and return it; what is no object counts as an empty one. */
  add(text) {
    let message = {};
    try {
      message = Object(JSON.parse(text));
    } catch {
      // It is no JSON.
    }
    if (this.#waiting) this.#resolve(message);
    else this.#messages.push(message);
    return message;
  }

  end() {
    this.#hasEnded = true;
    if (this.#waiting) this.#resolve(null);
  }

  /** Wait for the next message; null if the connection has ended. */
  next() {
    if (this.#messages.length) return this.#messages.shift();
    return this.#hasEnded ? null : new Promise((resolve) => (this.#waiting = resolve));
  }

  #resolve(message) {
    const resolve = this.#waiting;
    this.#waiting = null;
    resolve(message);
  }
}

/** Messages in lines, over a socket of Node. */
class LineConnection {
  #socket;
  #inbox = new Inbox();

  constructor(socket) {
    this.#socket = socket;
    socket.setNoDelay(true);
    let pieces = [];
    let length = 0;
    socket.on("data", (chunk) => {
      let start = 0;
      for (let end = chunk.indexOf(10); end >= 0; end = chunk.indexOf(10, start)) {
        pieces.push(chunk.subarray(start, end));
        this.#inbox.add(Buffer.concat(pieces).toString());
        [pieces, length, start] = [[], 0, end + 1];
      }
      if (start === chunk.length) return;
      pieces.push(chunk.subarray(start));
      length += chunk.length - start;
      if (length > LONGEST_LINE) socket.destroy();
    });
    socket.on("error", () => socket.destroy());
    socket.on("end", () => socket.end());
    socket.on("close", () => this.#inbox.end());
  }

  receive() {
    return this.#inbox.next();
  }

  send(text) {
    this.#socket.write(`${text}\n`);
  }

  close() {
    this.#socket.end();
    this.#socket.unref();
  }
}

/** Messages over WebSocket, from a page. When the connection ends, the page tells the program that opened it. */
class WebConnection {
  #socket;
  #inbox = new Inbox();

  constructor(socket) {
    this.#socket = socket;
    let problem = "";
    socket.onmessage = (event) => {
      const message = this.#inbox.add(event.data);
      if (Object.hasOwn(message, "error")) problem = errorText(message);
    };
    socket.onclose = () => {
      this.#inbox.end();
      tellOpener(problem);
    };
  }

  receive() {
    return this.#inbox.next();
  }

  send(text) {
    if (this.#socket.readyState === WebSocket.OPEN) this.#socket.send(text);
  }

  close(problem) {
    tellOpener(problem);
    this.#socket.close();
  }
}

async function connectSocket(port) {
  const { connect } = await builtin("net");
  return new Promise((resolve, reject) => {
    const socket = connect(Number(port), "127.0.0.1");
    socket.once("connect", () => resolve(new LineConnection(socket)));
    socket.once("error", (error) => {
      reject(new Disconnected(`cannot connect to tltlc at port ${port}: ${error.message}`));
    });
  });
}

function connectWebSocket(port) {
  return new Promise((resolve, reject) => {
    const socket = new WebSocket(`ws://127.0.0.1:${Number(port)}`);
    socket.onopen = () => resolve(new WebConnection(socket));
    socket.onerror = () => {
      const problem = `cannot connect to tltlc at port ${port}`;
      tellOpener(problem);
      reject(new Disconnected(problem));
    };
  });
}

/** Wait for one connection at a port; nobody listens there afterwards. */
async function acceptedSocket(port) {
  const { createServer } = await builtin("net");
  return new Promise((resolve, reject) => {
    const server = createServer((socket) => {
      server.close();
      resolve(socket);
    });
    server.maxConnections = 1;
    server.once("error", (error) => {
      reject(new Disconnected(`cannot listen on port ${port}: ${error.message}; does this game run twice?`));
    });
    server.listen(Number(port), "127.0.0.1");
  });
}

/** Import a module of Node by a name that bundlers for pages do not see. */
function builtin(name) {
  return import(/* webpackIgnore: true */ /* @vite-ignore */ `node:${name}`);
}

/** The port, the token, or the path where a page reports its `end`; empty if it is not given. */
function given(name) {
  if (IS_NODE) return name === "end" ? "" : (process.env[`TLTL_${name.toUpperCase()}`] ?? "");
  const { search, hash } = globalThis.location ?? { search: "", hash: "" };
  return new URLSearchParams(`${search}&${hash.slice(1)}`).get(`tltl_${name}`) ?? "";
}

function fail(message) {
  console.error(message);
  if (IS_NODE) process.exitCode = 1;
}

/** Tell the program that opened this page, if one did, that the game has ended; it hears only the first call. */
function tellOpener(problem) {
  const path = given("end");
  if (path) fetch(`/${path}`, { method: "POST", body: problem }).catch(() => {});
}

function errorText(message) {
  return String(message.error?.message ?? message.error);
}

// --- values ----------------------------------------------------------------------------------------------------------

/** A typed array as an array, and anything else as it is. */
function plain(value) {
  return ArrayBuffer.isView(value) ? Array.from(value) : value;
}

/** Check all numbers in a message, since JSON has no NaN and no Infinity. */
function checkFinite(value, path) {
  if (typeof value === "number") {
    if (!Number.isFinite(value)) throw new RangeError(`${path} is ${value}, and numbers must be finite`);
  } else if (Array.isArray(value)) {
    for (let index = 0; index < value.length; index++) checkFinite(value[index], path);
  } else if (typeof value === "object" && value !== null) {
    for (const key of Object.keys(value)) checkFinite(value[key], key);
  }
}

function base64(bytes) {
  if (IS_NODE) return Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength).toString("base64");
  let text = "";
  for (let start = 0; start < bytes.length; start += 8192) {
    text += String.fromCharCode(...bytes.subarray(start, start + 8192));
  }
  return btoa(text);
}

// --- the program: opens a page for tltlc, only in Node ---------------------------------------------------------------

const USAGE = "usage: node tltl_client.js PAGE [BROWSER]    (PAGE is a file in this folder, such as index.html)";

const BROWSERS = [
  "chromium-headless-shell",
  "chromium",
  "chromium-browser",
  "google-chrome",
  "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
  "C:\\Program Files\\Google\\Chrome\\Application\\chrome.exe",
  "C:\\Program Files (x86)\\Microsoft\\Edge\\Application\\msedge.exe",
];

const TYPES = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript; charset=utf-8",
  ".mjs": "text/javascript; charset=utf-8",
  ".css": "text/css; charset=utf-8",
  ".json": "application/json",
  ".wasm": "application/wasm",
  ".png": "image/png",
  ".jpg": "image/jpeg",
  ".svg": "image/svg+xml",
  ".wav": "audio/wav",
  ".ogg": "audio/ogg",
  ".mp3": "audio/mpeg",
};

/** Whether Node was started with this file: false if it is imported or part of a bundle. */
function isProgram() {
  return IS_NODE && /(^|[\\/])tltl_client\.m?js$/.test(process.argv[1] ?? "");
}

/**
 * Serve the current folder, open a page of it in a browser without a window, and wait until the game in it ends.
 *
 * Returns the exit status: 0 if tltlc has closed the connection, 1 if the game or the browser has failed, 2 for wrong
 * usage. Errors and messages of the page go to standard error.
 */
async function openPage(args) {
  if (args.length < 1 || args.length > 2) return complain(USAGE, 2);
  if (!isStartedByTltlc()) return complain("tltlc must start this game: the variable TLTL_PORT is not set", 1);
  const browser = await findBrowser(args[1] ?? process.env.TLTL_BROWSER);
  if (!browser) return complain(`there is no browser here: install one of ${BROWSERS.slice(0, 4).join(", ")}`, 1);
  const { randomBytes } = await builtin("crypto");
  const secret = randomBytes(16).toString("hex");
  let end;
  const ended = new Promise((resolve) => (end = resolve));
  const server = await serveFolder(process.cwd(), secret, end);
  const address = new URL(args[0], `http://127.0.0.1:${server.address().port}/`);
  for (const [name, value] of [["port", given("port")], ["token", given("token")], ["end", secret]]) {
    address.searchParams.set(`tltl_${name}`, value);
  }
  const stop = await startBrowser(browser, address.href, end);
  const problem = await ended;
  await stop();
  server.close();
  server.closeAllConnections?.();
  return problem ? complain(problem, 1) : 0;
}

function complain(message, status) {
  console.error(message);
  return status;
}

/** Return the browser that is asked for, or the first one that is installed; null if there is none. */
async function findBrowser(wanted) {
  const { existsSync } = await builtin("fs");
  const { delimiter, isAbsolute, join } = await builtin("path");
  const folders = (process.env.PATH ?? "").split(delimiter);
  const isThere = (name) => (isAbsolute(name) ? existsSync(name) : folders.some((at) => existsSync(join(at, name))));
  return (wanted ? [wanted] : BROWSERS).find(isThere) ?? null;
}

/** Serve the files of a folder on a free port of 127.0.0.1; a POST to the secret path calls `end` with its text. */
async function serveFolder(folder, secret, end) {
  const { createServer } = await builtin("http");
  const { createReadStream } = await builtin("fs");
  const { extname, join, sep } = await builtin("path");
  const server = createServer((request, response) => {
    let path = "";
    try {
      path = decodeURIComponent(new URL(request.url, "http://127.0.0.1").pathname);
    } catch {
      // The address is malformed: there is no such file.
    }
    if (request.method === "POST" && path === `/${secret}`) {
      let text = "";
      request.setEncoding("utf8");
      request.on("data", (piece) => (text += piece));
      request.on("end", () => {
        response.end();
        end(text);
      });
      return;
    }
    const file = join(folder, path);
    const refuse = () => response.writeHead(404).end();
    if (request.method !== "GET" || !file.startsWith(folder + sep) || path.includes("\0")) return refuse();
    const stream = createReadStream(file);
    stream.on("open", () => {
      response.writeHead(200, { "Content-Type": TYPES[extname(file)] ?? "application/octet-stream" });
      stream.pipe(response);
    });
    stream.on("error", () => (response.headersSent ? response.destroy() : refuse()));
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return server;
}

/**
 * Open a page in a browser; return a function that ends it. If the browser ends by itself, `end` gets the reason.
 *
 * The browser gets the address, which contains the token, through a pipe: every user of the machine can read its command
 * line. It ends with this process, even if this process is killed, because it reads the pipe.
 */
async function startBrowser(browser, address, end) {
  const { spawn } = await builtin("child_process");
  const { rmSync } = await builtin("fs");
  // The shell keeps no profile; a browser needs one of its own, or it passes the page on to one that is running.
  const profile = /headless.shell/.test(browser) ? null : await makeProfile();
  const words = ["--headless", "--disable-gpu", "--mute-audio", "--no-first-run", "--enable-logging=stderr"];
  // As root, Chromium does not start with its sandbox; the page is the user's own.
  if (process.getuid?.() === 0) words.push("--no-sandbox");
  if (profile) words.push(`--user-data-dir=${profile}`);
  words.push("--remote-debugging-pipe", "about:blank");
  const child = spawn(browser, words, { stdio: ["ignore", "ignore", "pipe", "pipe", "pipe"] });
  const last = [];
  let entry = null; // lines of the page's console, until the message ends
  let rest = "";
  child.stderr.setEncoding("utf8").on("data", (text) => {
    const lines = (rest + text).split("\n");
    rest = lines.pop();
    for (const line of lines) {
      // [1127/114500.123456:INFO:CONSOLE(12)] "message of one or more lines", source: http://… (12)
      const begin = entry === null ? /^\[[^\]]*:CONSOLE[^\]]*\] "/.exec(line) : null;
      if (entry === null && !begin) {
        last.push(line);
        continue;
      }
      entry = begin ? line.slice(begin[0].length) : `${entry}\n${line}`;
      const [, message, source, number] = /^([^]*)", source: (.*) ?\((\d+)\)$/.exec(entry) ?? [];
      if (message === undefined) continue;
      // The address of the page has the token after its question mark.
      const file = source.trim().replace(/^\w+:\/\/[^/]*\//, "").replace(/[?#].*/, "");
      console.error(file && message.startsWith("Uncaught ") ? `${message}\n   At: ${file}:${number}` : message);
      entry = null;
    }
    last.splice(0, last.length - 10);
  });
  for (const pipe of child.stdio.slice(3)) pipe.on("error", () => {}).resume?.();
  child.stdio[3].write(`${JSON.stringify({ id: 1, method: "Target.createTarget", params: { url: address } })}\0`);
  const gone = new Promise((resolve) => {
    child.once("error", (error) => {
      end(`cannot start ${browser}: ${error.message}`);
      resolve();
    });
    child.once("exit", (status, signal) => {
      resolve();
      // The last lines of its standard error may still be on their way.
      const reason = `the browser ended by itself: ${signal ?? `exit status ${status}`}`;
      setTimeout(() => end([...last, entry, rest, reason].filter(Boolean).join("\n")), 200);
    });
  });
  return async () => {
    // The browser ends with its pipe. A signal would end only the script that starts it on some systems.
    child.stdio[3].destroy();
    const impatience = setTimeout(() => child.kill("SIGKILL"), 2000);
    await gone;
    clearTimeout(impatience);
    if (profile) rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  };
}

/** Make a folder for the profile of a browser, and remove those of processes that were killed before they could do it. */
async function makeProfile() {
  const { lstatSync, mkdtempSync, readdirSync, rmSync } = await builtin("fs");
  const { tmpdir } = await builtin("os");
  const { join } = await builtin("path");
  for (const name of readdirSync(tmpdir())) {
    const [, pid] = /^tltl-page-(\d+)-/.exec(name) ?? [];
    if (!pid || isRunning(Number(pid))) continue;
    const path = join(tmpdir(), name);
    try {
      if (lstatSync(path).uid === (process.getuid?.() ?? 0)) rmSync(path, { recursive: true, force: true });
    } catch {
      // Another process removes it at the same time.
    }
  }
  return mkdtempSync(join(tmpdir(), `tltl-page-${process.pid}-`));
}

function isRunning(pid) {
  try {
    return process.kill(pid, 0);
  } catch (error) {
    return error.code === "EPERM";
  }
}

// No `await` here, so that importers of the module need not wait.
if (isProgram()) openPage(process.argv.slice(2)).then((status) => process.exit(status));
