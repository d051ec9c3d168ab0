"""The extension for VS Code: it builds, its grammar tests pass, it is packaged, and it starts the
server."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import tltlc
from tests.waiting import HANG_S
from tltlc.grammar.keywords import CLAUSES

EXTENSION = Path(__file__).parents[2] / "editors" / "vscode"
FILES = [
    path
    for path in sorted(EXTENSION.rglob("*"))
    if path.is_file()
    and not {"node_modules", "dist"} & set(path.relative_to(EXTENSION).parts)
    and path.suffix != ".vsix"
]


def npm(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["npm", *words], cwd=folder, capture_output=True, text=True, timeout=HANG_S)


@pytest.fixture(scope="module")
def extension(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A built copy of the extension; skipped if node or the packages are missing."""
    if shutil.which("node") is None or shutil.which("npm") is None:
        pytest.skip("node and npm build the extension; they are not installed")
    folder = tmp_path_factory.mktemp("vscode")
    for path in FILES:
        copy = folder / path.relative_to(EXTENSION)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, copy)
    installed = npm(folder, "ci", "--no-audit", "--no-fund", "--prefer-offline")
    if installed.returncode != 0:
        offline = re.search(r"ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ETIMEDOUT|E404|EBADENGINE|network", installed.stderr)
        assert offline, installed.stderr
        pytest.skip(f"npm could not install the packages of the extension ({offline[0]})")
    done = npm(folder, "run", "build")
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.slow
def test_the_grammar_tests_pass(extension: Path) -> None:
    done = npm(extension, "test")
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_the_package_is_complete(extension: Path) -> None:
    done = npm(extension, "run", "package")
    assert done.returncode == 0, done.stdout + done.stderr
    with zipfile.ZipFile(extension / "tltl.vsix") as package:
        names = {name.removeprefix("extension/").lower() for name in package.namelist()}
    manifest = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
    named = re.findall(r'"\./([^"]+)"', json.dumps([manifest["contributes"], manifest["main"]]))
    assert {name.lower() for name in (*named, manifest["icon"], "readme.md")} <= names
    assert not any(name.startswith(("node_modules", "src", "test")) for name in names)


def run_extension(
    extension: Path,
    folder: Path,
    setting: list[str],
    *,
    answer: str = "",
    fails: bool = False,
    drawn: Path | None = None,
    trusted: bool = True,
) -> list[str]:
    """Run the extension with stand-ins for the editor and its client, then draw a file; return the
    log."""
    script = extension / "start.js"
    script.write_text(STAND_IN, encoding="utf-8")
    words = ["node", str(script), json.dumps([str(folder), setting, answer, fails, drawn and str(drawn), trusted])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    completed = subprocess.run(words, cwd=extension, env=environment, capture_output=True, text=True, timeout=HANG_S)
    assert completed.returncode == 0, completed.stderr
    return completed.stdout.splitlines()


def test_the_server_is_started(extension: Path, tmp_path: Path) -> None:
    """The command comes from the settings and gets `lsp`; by default it is the one in the folder's
    `.venv`, if any."""
    commands = "commands tltl.restart,tltl.showPicture"
    own = tmp_path / ".venv" / "bin" / "tltlc"
    assert run_extension(extension, tmp_path, ["tltlc"]) == [f"start tltlc lsp in {tmp_path}", commands]
    assert run_extension(extension, tmp_path, [".venv/bin/tltlc", "-X"]) == [
        f"start {own} -X lsp in {tmp_path}",
        commands,
    ]
    own.parent.mkdir(parents=True)
    own.touch()
    assert run_extension(extension, tmp_path, ["tltlc"]) == [f"start {own} lsp in {tmp_path}", commands]
    assert run_extension(extension, tmp_path, ["tltlc"], trusted=False) == [
        f"start tltlc lsp in {Path.home()}",
        commands,
    ]


def test_a_failed_start_is_reported_once(extension: Path, tmp_path: Path) -> None:
    missing = run_extension(extension, tmp_path, ["no-such-tltlc"], fails=True)
    assert missing[-1].startswith("error TLTL: `no-such-tltlc` was not found. Install tltlc with its extra `lsp`")
    failing_command = [sys.executable, "-c", "raise SystemExit('error: no pygls')"]
    *_, message = run_extension(extension, tmp_path, failing_command, fails=True)
    assert message.endswith("lsp` does not start. error: no pygls")
    retried = run_extension(extension, tmp_path, ["no-such-tltlc"], fails=True, answer="Try Again")
    assert [line.split()[0] for line in retried] == ["start", "commands", "error", "start"]


def test_automata_are_drawn_and_redrawn(extension: Path, tmp_path: Path) -> None:
    file = tmp_path / "a.tltl"
    tltlc = [sys.executable, "-m", "tltlc"]
    file.write_text("signal p: bool\nspec alone = G p\n", encoding="utf-8")
    *_, drawn, redrawn = run_extension(extension, tmp_path, tltlc, drawn=file)
    assert drawn == redrawn == "picture alone <!DOCTYPE html>"
    file.write_text("signal p: bool\nspec alone = G q\n", encoding="utf-8")
    *_, message = run_extension(extension, tmp_path, tltlc, drawn=file)
    assert message.startswith("error TLTL: `alone` cannot be drawn: error[TLT0201]: ")
    file.write_text("signal p: bool\nspec one = G p\nspec two = F p\n", encoding="utf-8")
    assert run_extension(extension, tmp_path, tltlc, drawn=file)[-1] == "picture two <!DOCTYPE html>"


STAND_IN = """
const fs = require("node:fs");
const Module = require("node:module");
const [folder, setting, answer, fails, drawn, isTrusted] = JSON.parse(process.argv[2]);
const commands = {};
let starts = 0;
let saved;
const document = {
  languageId: "tltl", uri: { fsPath: drawn }, getText: () => fs.readFileSync(drawn, "utf-8"), save: async () => true,
};
const panel = (name) => ({
  viewColumn: 2,
  onDidDispose: () => {},
  reveal: () => {},
  webview: { set html(text) { if (text.includes("</svg>")) console.log("picture", name, text.slice(0, 15)); } },
});
const vscode = {
  commands: { registerCommand: (name, run) => (commands[name] = run), executeCommand: async () => {} },
  ViewColumn: { Active: -1 },
  workspace: {
    isTrusted,
    workspaceFolders: [{ uri: { fsPath: folder } }],
    getConfiguration: () => ({ get: () => setting }),
    onDidChangeConfiguration: () => ({}),
    onDidSaveTextDocument: (run) => (saved = run),
    onDidGrantWorkspaceTrust: () => ({}),
  },
  window: {
    activeTextEditor: { document, viewColumn: 1 },
    createOutputChannel: () => ({}),
    createWebviewPanel: (kind, name) => panel(name),
    showErrorMessage: async (text) => (console.log("error", text), answer),
    showQuickPick: async (names) => names.at(-1),
  },
};
class LanguageClient {
  constructor(id, name, server) { this.server = server.run; }
  createDefaultErrorHandler() { return {}; }
  async dispose() { throw new Error("is not running"); }
  async start() {
    console.log("start", this.server.command, ...this.server.args, "in", this.server.options.cwd);
    // The second time it waits for ever: what is said is known by then.
    if (fails) await (starts++ ? new Promise(() => {}) : Promise.reject(new Error("no connection")));
  }
}
const load = Module._load;
Module._load = (name, ...rest) => name === "vscode" ? vscode
  : name === "vscode-languageclient/node" ? { LanguageClient, CloseAction: {} } : load(name, ...rest);
require("./src/extension.js").activate({ subscriptions: [] }).then(async () => {
  console.log("commands", Object.keys(commands).join());
  if (drawn) {
    await commands["tltl.showPicture"](document.uri);
    await saved(document);
  }
});
"""


SNIPPETS = json.loads((EXTENSION / "snippets" / "tltl.json").read_text(encoding="utf-8"))
AROUND = """\
signal alive: bool
signal goal: bool
signal alarm: bool
signal hidden: bool
signal first: bool
signal second: bool
signal third: bool
signal atom: bool
signal value(x: entity): number
spec another = F goal
clock 10 Hz
"""


@pytest.mark.parametrize("name", SNIPPETS)
def test_the_snippets_compile(name: str) -> None:
    """With their placeholders, for each choice that they offer."""
    body = SNIPPETS[name]["body"]
    text = body if isinstance(body, str) else "\n".join(body)
    text = re.sub(r"\$\{\d+:([^}]*)\}", r"\1", text)
    choices = re.search(r"\$\{\d+\|([^|]*)\|\}", text)
    for choice in choices[1].split(",") if choices else [""]:
        chosen = text.replace(choices[0], choice) if choices else text
        assert "$" not in chosen
        if chosen.split()[0] in CLAUSES:
            chosen = f"spec around {{\n{chosen}\n}}"
        if chosen.startswith("test"):
            chosen += "\nspec name = F atom\n"
        assert tltlc.compile_text(AROUND + chosen)


def test_no_file_names_a_package_registry() -> None:
    for path in FILES:
        if path.suffix != ".png":
            text = path.read_text(encoding="utf-8")
            assert '"resolved"' not in text, path
            assert "registry." not in text, path


def test_the_version_is_that_of_the_compiler() -> None:
    assert json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))["version"] == tltlc.__version__


def test_the_settings_are_in_the_guide() -> None:
    manifest = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
    guide = (EXTENSION.parents[1] / "docs" / "guides" / "editors.md").read_text(encoding="utf-8")
    for setting in manifest["contributes"]["configuration"]["properties"]:
        assert f"`{setting}`" in guide
