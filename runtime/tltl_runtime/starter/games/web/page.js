// The game in a page. tltlc plays it if it has opened the page; otherwise a person does, with the arrow keys.

import { CLOCK_HZ, Hall } from "./hall.js";
import { Recorder, isStartedByTltlc, play } from "./tltl_client.js";

const KEYS = ["ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight"]; // in the order of the moves
const element = (id) => document.getElementById(id);

async function read(scene) {
  return (await fetch(`levels/${scene}.txt`)).text();
}

function draw(game) {
  const rows = game.rows.map((row) => [...row]);
  rows[game.player[1]][game.player[0]] = "@";
  element("map").textContent = rows.reverse().map((row) => row.join("")).join("\n");
}

async function playByHand() {
  const game = new Hall(read);
  const recorder = new Recorder("hall", Object.keys(game.hello.signals), { clockHz: CLOCK_HZ, game: game.hello.name });
  const help = element("text").textContent;
  let now = null;
  let seed = null; // of a walk whose first move is still to come
  async function begin() {
    now = null; // until the level is read, no key moves the player
    seed = Math.floor(Math.random() * 2 ** 31);
    now = await game.reset("hall", "v0", seed);
    element("text").textContent = help;
    draw(game);
  }
  addEventListener("keydown", (event) => {
    const action = KEYS.indexOf(event.key);
    if (action < 0 || !now || now.ended) return;
    event.preventDefault();
    now = game.step(action);
    if (seed !== null) recorder.begin("hall", "v0", seed);
    seed = null;
    recorder.sample(now.signals, action);
    element("save").disabled = false;
    draw(game);
    if (now.signals.has_key) element("text").textContent = now.signals.at_door ? "You are out!" : "You have the key.";
    if (now.ended) element("text").textContent = "You fell on the spikes.";
  });
  element("save").addEventListener("click", () => {
    recorder.download();
    element("save").disabled = true;
    return begin();
  });
  await begin();
}

if (isStartedByTltlc()) await play(new Hall(read));
else await playByHand();
