// Starts `tltlc lsp` and keeps an editor's window in touch with it.
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

/** Waits for a start that is under way: what is only starting cannot be stopped. */
function restart() {
  return (ready = ready.then(stop).then(start));
}

async function stop() {
  // One that never ran, or that no longer answers, is dropped without its answer.
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
    // Nobody waits for the answer: the commands have to work meanwhile.
    complain(command, words);
  }
}

/** A client that leaves it to `complain` to say that a server has never run. */
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
  // With nothing to read, a server that can start ends at once; one that cannot says why.
  const { code, errors } = await run(command, words);
  const why =
    code === "ENOENT"
      ? `\`${command}\` is not found. Install tltlc with its extra \`lsp\`, or say in the setting \`tltl.command\` where it is.`
      : `\`${[command, ...words].join(" ")}\` does not start. ${errors || "The output panel says more."}`;
  const answer = await vscode.window.showErrorMessage(`TLTL: ${why}`, "Open the Setting", "Try Again");
  if (answer === "Open the Setting") {
    await vscode.commands.executeCommand("workbench.action.openSettings", "tltl.command");
  } else if (answer) {
    await restart();
  }
}

/** The lenses of the server; a click on a spec's number of states draws its automaton. */
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
