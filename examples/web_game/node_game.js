// The game without a page, which is fast: tltlc starts it with Node.

import { Courier } from "./courier.js";
import { play } from "./tltl_client.js";

await play(new Courier());
