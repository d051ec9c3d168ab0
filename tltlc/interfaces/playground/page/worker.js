// A worker that runs the compiler in Python, with Pyodide. It answers one request after another.

import { loadPyodide } from "./pyodide/pyodide.mjs";

const FOLDER = "/compiler";

async function load() {
  const here = new URL("pyodide/", self.location.href).href;
  const [python, archive] = await Promise.all([
    loadPyodide({ indexURL: here }),
    fetch("tltlc.zip").then((response) => {
      if (!response.ok) throw new Error(`tltlc.zip: ${response.status}`);
      return response.arrayBuffer();
    }),
  ]);
  python.unpackArchive(archive, "zip", { extractDir: FOLDER });
  python.runPython(`import sys; sys.path.insert(0, "${FOLDER}")`);
  return python.runPython("from tltlc.interfaces.playground.protocol import answer; answer");
}

let answer = null;
self.onmessage = ({ data }) => {
  try {
    self.postMessage({ answer: answer(data) });
  } catch (error) {
    // The browser's stack may overflow before Python's recursion limit. Firefox then throws an InternalError.
    const isDeep = ["RangeError", "InternalError"].includes(error.name);
    self.postMessage({ error: isDeep ? "deep" : String(error.message ?? error) });
  }
};
load().then(
  (compiler) => {
    answer = compiler;
    self.postMessage({ answer: "" });
  },
  (error) => self.postMessage({ error: `Python could not be loaded: ${error.message ?? error}` }),
);
