"""Rust, edition 2021, with warnings as errors."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tests.tools.conformance.runner import Runner, execute

STRICT = ("--edition", "2021", "-D", "warnings", "-C", "debuginfo=0", "--cfg", "tltl_main")

_DRIVER = """
fn main() {
    let mut words = std::env::args_os().skip(1);
    while let (Some(name), Some(trace)) = (words.next(), words.next()) {
        println!("@@ {}", trace.to_string_lossy());
        eprintln!("@@ {}", trace.to_string_lossy());
        let rest = vec!["--full".into(), trace];
        let status = match name.to_str() {
@@cases@@
            _ => 70,
        };
        eprintln!("@@status {status}");
    }
}
"""


def link(folder: Path, names: Sequence[str]) -> None:
    """Build the program ``monitors``, one crate with all monitors."""
    lines = ["#![allow(non_snake_case)]", "", *(f"mod {name}_monitor;" for name in names)]
    cases = [f'            Some("{name}") => {name}_monitor::program::run(rest),' for name in names]
    (folder / "monitors.rs").write_text("\n".join(lines) + "\n" + _DRIVER.replace("@@cases@@", "\n".join(cases)))
    execute(["rustc", *STRICT, "-C", "codegen-units=1", "monitors.rs"], folder)


RUNNERS = (
    Runner(
        name="rust",
        target="rust",
        build=("rustc", *STRICT, "{name}_monitor.rs"),
        run=("./{name}_monitor",),
        build_all=link,
        run_all=("./monitors",),
        tools=("rustc",),
    ),
)
