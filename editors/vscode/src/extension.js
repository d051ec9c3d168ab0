// Start `tltlc lsp` and connect the window of the editor to it.
"use strict";

const vscode = require("vscode");
const { CloseAction, LanguageClient } = require("vscode-languageclient/node");
const { configured, folder, run } = require("./command");
const { redraw, showPicture } = require("./pictures");

let client;
let output;
let ready = Promise.resolve();

async function activate(context) {
  output = vscode.window.createOutputChannel("TLTL", { log: true });
  context.subscriptions.push(
    output,
    vscode.commands.registerCommand("tltl.restart", restart),
    vscode.commands.registerCommand("tltl.showPicture", showPicture),
    vscode.workspace.onDidSaveTextDocument(redraw),
    vscode.workspace.onDidGrantWorkspaceTrust(restart),
    vscode.workspace.onDidChangeConfiguration((change) => change.affectsConfiguration("tltl.command") && restart()),
  );
  await restart();
}

async function deactivate() {
  await stop();
}

/** Stop the server and start it again. This first waits for a start in progress, which cannot be stopped. */
function restart() {
  return (ready = ready.then(stop).then(start));
}

async function stop() {
  // If the server never ran or no longer answers, `dispose` fails. This does not matter.
  await client?.dispose().catch(() => {});
}

async function start() {
  const [command, ...rest] = configured();
  const words = [...rest, "lsp"];
  const options = { command, args: words, options: { cwd: folder() } };
  client = new Client("tltl", "TLTL", { run: options, debug: options }, {
    documentSelector: [{ language: "tltl" }],
    outputChannel: output,
    errorHandler: { error: (...about) => client.usual.error(...about), closed: () => client.closed() },
    initializationFailedHandler: () => false,
    middleware: { provideCodeLenses: lenses },
  });
  try {
    await client.start();
    client.hasRun = true;
  } catch {
    // Do not wait for the answer, so that the commands work in the meantime.
    complain(command, words);
  }
}

/** A client that does not report a server that never ran, because `complain` does. */
class Client extends LanguageClient {
  hasRun = false;
  usual = this.createDefaultErrorHandler();

  error(message, data, shown) {
    super.error(message, data, this.hasRun && shown);
  }

  closed() {
    return this.hasRun ? this.usual.closed() : { action: CloseAction.DoNotRestart, handled: true };
  }
}

async function complain(command, words) {
  // With empty input, a server that can start ends at once, and one that cannot start prints the reason.
  const { code, errors } = await run(command, words);
  const why =
    code === "ENOENT"
      ? `\`${command}\` was not found. Install tltlc with its extra \`lsp\`, or write its path into the setting \`tltl.command\`.`
      : `\`${[command, ...words].join(" ")}\` does not start. ${errors || "See the output panel for details."}`;
  const answer = await vscode.window.showErrorMessage(`TLTL: ${why}`, "Open the Setting", "Try Again");
  if (answer === "Open the Setting") {
    await vscode.commands.executeCommand("workbench.action.openSettings", "tltl.command");
  } else if (answer) {
    await restart();
  }
}

/** Return the lenses of the server. A click on the number of states of a spec draws its automaton. */
async function lenses(document, token, next) {
  const found = (await next(document, token)) ?? [];
  for (const { command, range } of found) {
    if (command && !command.command) {
      Object.assign(command, { command: "tltl.showPicture", arguments: [document.getText(range)] });
    }
  }
  return found;
}

module.exports = { activate, deactivate };
