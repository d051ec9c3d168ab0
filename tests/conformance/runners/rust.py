"""Rust, edition 2021, with warnings as errors: one crate of all monitors, since compiler starts are slow."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

from tests.conformance.runner import LONGEST_BUILD_S, Runner

STRICT = ("--edition", "2021", "-D", "warnings", "-C", "debuginfo=0", "--cfg", "tltl_main")


def linked(folder: Path, names: Sequence[str]) -> None:
    """The program ``monitors``, whose first argument says which monitor runs."""
    lines = ["#![allow(non_snake_case)]", "", *(f"mod {name}_monitor;" for name in names), ""]
    lines += ["fn main() -> std::process::ExitCode {", "    let mut words = std::env::args_os().skip(1);"]
    lines += ["    let name = words.next().unwrap_or_default();", "    let rest = words.collect();"]
    lines += ["    std::process::ExitCode::from(match name.to_str() {"]
    lines += [f'        Some("{name}") => {name}_monitor::program::run(rest),' for name in names]
    lines += ["        _ => 70,", "    })", "}", ""]
    (folder / "monitors.rs").write_text("\n".join(lines))
    command = ["rustc", *STRICT, "monitors.rs"]
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST_BUILD_S)
    assert done.returncode == 0, (done.stdout + done.stderr).decode(errors="replace")


RUNNERS = (
    Runner(
        name="rust",
        target="rust",
        build_all=linked,
        run=("./monitors", "{name}"),
        tools=("rustc",),
    ),
)
