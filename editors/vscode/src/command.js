// Find and run the command `tltlc` for a window.
"use strict";

const { execFile } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const vscode = require("vscode");

/** Return the command as a list of words. A relative path becomes absolute; by default, use the `.venv` of the workspace. */
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

/** Return the folder to run in. A folder that is not trusted is not used: Windows would start a `tltlc.exe` in it. */
function folder() {
  return vscode.workspace.isTrusted ? vscode.workspace.workspaceFolders?.[0]?.uri.fsPath : os.homedir();
}

/** Run a command with empty input. Return its output, and its status or, if it does not exist, `ENOENT`. */
function run(command, words) {
  return new Promise((resolve) => {
    const started = execFile(command, words, { cwd: folder(), maxBuffer: 1 << 26 }, (error, output, errors) =>
      resolve({ code: error ? error.code : 0, output, errors: errors.trim() }),
    );
    started.stdin?.end();
  });
}

module.exports = { configured, folder, run };
