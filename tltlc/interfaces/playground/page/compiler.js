// The compiler behind the page: the server that sent the page, or Python in a worker of the browser.
// Both answer `ask({text, spec, letters, notation})` with what tltlc.interfaces.playground.view returns, and `ask({})`
// with the examples and the words of the language.

import { keepToken, refuseToken, token } from "./token.js";

const LIMIT_MS = 10_000;
const PATIENCE_MS = 3_000;
const START_LIMIT_MS = 120_000;

const REFUSED = {
  403: "open the address that `tltlc serve` shows, because this address has no token or the token of an earlier server",
  413: "the text is too long",
};

export function compiler() {
  return document.body.dataset.compiler === "browser" ? inBrowser() : byServer();
}

function byServer() {
  let running = null;
  return {
    async ask(request) {
      // A new request replaces the previous one.
      running?.abort();
      const { signal } = (running = new AbortController());
      let used;
      let answer;
      do {
        used = token();
        answer = await post(request, used, signal);
      } while (answer.status === 403 && refuseToken(used));
      if (!answer.ok) throw new Error(REFUSED[answer.status] ?? `the server says: ${answer.statusText}`);
      keepToken(used);
      return answer.json();
    },
  };
}

function post(request, used, signal) {
  return fetch("api", {
    method: "POST",
    headers: { "Content-Type": "application/json", "Tltlc-Token": used },
    body: JSON.stringify(request),
    signal,
  }).catch((error) => {
    // The browser's own message for a server that does not answer would not help.
    throw error instanceof TypeError ? new Error("the server is gone; start `tltlc serve` again") : error;
  });
}

function inBrowser() {
  let worker = null;
  let ready = null;
  let busy = Promise.resolve();
  let running = null;
  let last = 0;

  function start() {
    worker = new Worker("worker.js", { type: "module" });
    ready = reply(worker, START_LIMIT_MS).answer;
  }
  function stop() {
    worker.terminate();
    worker = null;
  }
  async function answer(request) {
    if (!worker) start();
    try {
      await ready;
    } catch (error) {
      stop();
      throw error;
    }
    worker.postMessage(JSON.stringify(request));
    try {
      running = reply(worker, LIMIT_MS);
      return JSON.parse(await running.answer);
    } catch (error) {
      // The only way to interrupt a worker is to end it.
      stop();
      const title = GIVEN_UP[error.message];
      if (!title) throw error;
      return { ...NOTHING, diagnostics: [givenUp(title)] };
    } finally {
      running = null;
    }
  }
  return {
    ask(request) {
      const number = ++last;
      // The answer to the previous request is no longer needed. But a new worker takes seconds to start, so wait a little
      // before ending the current one.
      if (running) setTimeout(running.giveUp, running.since + PATIENCE_MS - performance.now());
      const asked = busy.then(() => {
        if (number !== last) throw new DOMException("a later request has come", "AbortError");
        return answer(request);
      });
      busy = asked.catch(() => {});
      return asked;
    },
  };
}

const NOTHING = { diagnostics: [], more: 0, specs: [], tests: [], spec: null };

const GIVEN_UP = {
  late: `this takes longer than ${LIMIT_MS / 1000} s, so it was stopped`,
  deep: "this nests too deep for a browser, so it was stopped",
};

function givenUp(title) {
  const help = "make the spec smaller: bounds and large conjunctions cost most";
  return { code: "TLT0775", severity: "error", title, help, labels: [], fixes: [] };
}

/** Wait for the next message of a worker: `answer` is its promise, `since` when the wait began, `giveUp()` ends it. */
function reply(worker, limit) {
  let giveUp;
  const answer = new Promise((resolve, reject) => {
    giveUp = () => reject(new Error("late"));
    const timer = setTimeout(giveUp, limit);
    worker.onmessage = ({ data }) => {
      clearTimeout(timer);
      data.error ? reject(new Error(data.error)) : resolve(data.answer);
    };
    worker.onerror = (event) => {
      clearTimeout(timer);
      reject(new Error(event.message || "Python could not be loaded"));
    };
  });
  return { answer, giveUp, since: performance.now() };
}
