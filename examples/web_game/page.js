// The game in a page: tltlc plays it if it has opened the page, and otherwise a person does, with the arrow keys.

import { loadAgent } from "./agent.js";
import { CLOCK_HZ, Courier, SIZE, isWall } from "./courier.js";
import { Monitor } from "./deliver_monitor.mjs";
import { Recorder, array, isStartedByTltlc, play } from "./tltl_client.js";

const KEYS = { ArrowLeft: 1, ArrowRight: 2, ArrowUp: 3, ArrowDown: 4 };
const element = (id) => document.getElementById(id);
const canvas = element("map");
const context = canvas.getContext("2d", { willReadFrequently: true });
const cell = canvas.width / SIZE[0];

/** Draw the game; things are `share` of their way from where they were `before` to where they are. */
function draw(now, before = now, share = 1) {
  context.fillStyle = "#dfe7d8";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = "#5b6770";
  for (let x = 0; x < SIZE[0]; x++) {
    for (let y = 0; y < SIZE[1]; y++) {
      if (isWall(now.scene, [x, y])) context.fillRect(x * cell, canvas.height - (y + 1) * cell, cell, cell);
    }
  }
  const between = (name) => now[name].map((value, axis) => before[name][axis] + share * (value - before[name][axis]));
  dot(now.door, "#8a5a2b", 0.45);
  dot(between("dog"), "#b3261e", 0.4);
  dot(between("courier"), "#1f5fa8", 0.4);
  dot(now.carrying ? between("courier") : now.parcel, "#e0a100", 0.2);
}

function dot([x, y], colour, radius) {
  context.fillStyle = colour;
  context.beginPath();
  context.arc(x * cell, canvas.height - y * cell, radius * cell, 0, 2 * Math.PI);
  context.fill();
}

/** The game that can also show what the page draws. */
class DrawnCourier extends Courier {
  screenshot() {
    draw(this.now);
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    return array(data, "uint8", [canvas.height, canvas.width, 4]);
  }
}

/** The page's own loop: a tick each quarter of a second, and pictures as often as the screen can show them. */
function playByHand() {
  const game = new Courier();
  const monitor = new Monitor();
  const options = { clockHz: CLOCK_HZ, game: game.hello.name };
  const recorder = new Recorder("courier", Object.keys(game.hello.signals), options);
  const held = [];
  let action = 0;
  let agent = null;
  let before, state, start;

  function begin() {
    const seed = Math.floor(Math.random() * 2 ** 31);
    state = game.reset("yard", "v0", seed);
    before = structuredClone(game.now);
    monitor.reset();
    recorder.begin("yard", "v0", seed);
    // Saving ends a trace: only a whole ride can be saved.
    element("save").disabled = true;
    start = performance.now();
    askAgent();
  }

  /** Let the agent choose the next action; until it has, no tick is played. */
  async function askAgent() {
    if (!agent || state.ended) return;
    action = null;
    action = await agent(state.observation, monitor.state, monitor.progress);
  }

  function tick() {
    before = structuredClone(game.now);
    const played = held.at(-1) ?? action;
    state = game.step(played);
    action = 0;
    recorder.sample(state.signals, played);
    const result = monitor.step(state.signals);
    element("progress").value = result.progress;
    element("text").textContent = `Still to do: ${result.label}`;
    if (result.done || state.ended) {
      const help = agent ? "" : " Press a key.";
      element("text").textContent = (result.accepting ? "Delivered!" : "That went wrong.") + help;
      element("save").disabled = false;
      state.ended = true;
    }
    askAgent();
  }

  addEventListener("keydown", (event) => {
    if (!(event.key in KEYS)) return;
    event.preventDefault();
    if (state.ended) begin();
    else if (!event.repeat) held.push((action = KEYS[event.key]));
  });
  addEventListener("keyup", (event) => {
    const index = held.indexOf(KEYS[event.key]);
    if (index >= 0) held.splice(index, 1);
  });
  element("save").addEventListener("click", () => recorder.download());
  element("agent").addEventListener("click", async () => {
    try {
      agent = await loadAgent();
      begin();
    } catch (error) {
      element("text").textContent = `There is no agent here yet: see README.md. ${error.message}`;
    }
  });

  function frame(time) {
    const share = Math.max((time - start) * CLOCK_HZ / 1000, 0);
    if (share >= 1 && !state.ended && action !== null) {
      tick();
      start = time;
    }
    draw(game.now, before, Math.min(share, 1));
    requestAnimationFrame(frame);
  }
  begin();
  requestAnimationFrame(frame);
}

if (isStartedByTltlc()) await play(new DrawnCourier());
else playByHand();
