// The game without a page, which is fast: tltlc starts it with Node.

import { readFileSync } from "node:fs";

import { Hall } from "./hall.js";
import { play } from "./tltl_client.js";

await play(new Hall((scene) => readFileSync(new URL(`levels/${scene}.txt`, import.meta.url), "utf8")));
