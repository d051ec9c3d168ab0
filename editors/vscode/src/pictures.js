// Pictures of automata, shown below their text and drawn again when the text is saved.
"use strict";

const vscode = require("vscode");
const { configured, run } = require("./command");

// The pictures are made for a white background.
const STYLE = "body { background: white } svg { max-width: 100%; height: auto }";

/** The open panels, by file and spec. */
const panels = new Map();

/** Save the shown file and draw one of its specs. Ask which one, unless its name is given or there is only one. */
async function showPicture(wanted) {
  const { document } = vscode.window.activeTextEditor ?? {};
  if (document?.languageId !== "tltl") {
    return;
  }
  // A menu passes the file, a lens the name.
  const name = typeof wanted === "string" ? wanted : await chosen(document);
  if (!name || !(await document.save())) {
    return;
  }
  const drawn = await draw(document, name);
  if (drawn.code !== 0) {
    const why = drawn.errors.split("\n")[0] || "tltlc does not start";
    vscode.window.showErrorMessage(`TLTL: \`${name}\` cannot be drawn: ${why}`);
    return;
  }
  const key = keyOf(document, name);
  if (!panels.has(key)) {
    await open(name, key);
  }
  panels.get(key)?.panel.reveal(undefined, true);
  fill(key, drawn);
}

/** Draw the pictures of a file again. If that fails, marks in the text show why. */
async function redraw(document) {
  for (const [key, { name }] of panels) {
    if (key === keyOf(document, name)) {
      const drawn = await draw(document, name);
      if (drawn.code === 0) {
        fill(key, drawn);
      }
    }
  }
}

async function chosen(document) {
  const names = [...document.getText().matchAll(/^\s*spec\s+([A-Za-z_]\w*)/gm)].map((match) => match[1]);
  return names.length > 1 ? vscode.window.showQuickPick(names, { title: "Which spec?" }) : names[0];
}

function draw(document, name) {
  const [command, ...rest] = configured();
  return run(command, [...rest, "render", `${document.uri.fsPath}:${name}`, "-t", "svg"]);
}

/** Open a panel below the text, because automata are wide. The text keeps the focus. */
async function open(name, key) {
  const [other] = panels.values();
  if (!other) {
    await vscode.commands.executeCommand("workbench.action.newGroupBelow");
  }
  const place = { viewColumn: other?.panel.viewColumn ?? vscode.ViewColumn.Active, preserveFocus: true };
  const panel = vscode.window.createWebviewPanel("tltl.picture", name, place);
  panels.set(key, { name, panel });
  panel.onDidDispose(() => panels.delete(key));
  if (!other) {
    await vscode.commands.executeCommand("workbench.action.focusAboveGroup");
  }
}

function fill(key, drawn) {
  const picture = drawn.output.replace(/^[\s\S]*?(?=<svg)/, "");
  const found = panels.get(key);
  if (found) {
    found.panel.webview.html = `<!DOCTYPE html><style>${STYLE}</style>${picture}`;
  }
}

function keyOf(document, name) {
  return `${document.uri}#${name}`;
}

module.exports = { redraw, showPicture };
