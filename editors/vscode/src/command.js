// The command `tltlc` of a window.
"use strict";

const { execFile } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const vscode = require("vscode");

/** Its words: a path in the workspace made absolute, and without a setting the one of the workspace's `.venv`. */
function configured() {
  const [first = "tltlc", ...rest] = vscode.workspace.getConfiguration("tltl").get("command", ["tltlc"]);
  const root = folder();
  if (first === "tltlc" && root && vscode.workspace.isTrusted) {
    const own = [path.join(".venv", "bin", "tltlc"), path.join(".venv", "Scripts", "tltlc.exe")];
    const found = own.map((each) => path.join(root, each)).find((each) => fs.existsSync(each));
    return [found ?? first, ...rest];
  }
  return [/[\\/]/.test(first) && root ? path.resolve(root, first) : first, ...rest];
}

/** Where it runs: not in a folder that is not trusted, since Windows would start a `tltlc.exe` that lies there. */
function folder() {
  return vscode.workspace.isTrusted ? vscode.workspace.workspaceFolders?.[0]?.uri.fsPath : os.homedir();
}

/** What a command wrote, and its status, or `ENOENT` where there is none; it has nothing to read. */
function run(command, words) {
  return new Promise((resolve) => {
    const started = execFile(command, words, { cwd: folder(), maxBuffer: 1 << 26 }, (error, output, errors) =>
      resolve({ code: error ? error.code : 0, output, errors: errors.trim() }),
    );
    started.stdin?.end();
  });
}

module.exports = { configured, folder, run };
