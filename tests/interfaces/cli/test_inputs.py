from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import HIDE, Outcome
from tltlc.io.spec_file import split


@pytest.mark.parametrize(
    ("argument", "path", "name"),
    [
        ("a.tltl", "a.tltl", None),
        ("a.tltl:b", "a.tltl", "b"),
        ("-", "-", None),
        ("-:b", "-", "b"),
        ("dir:x/a.tltl", "dir:x/a.tltl", None),
        ("dir:x/a.tltl:b", "dir:x/a.tltl", "b"),
        ("a:b:c", "a:b", "c"),
        (":b", ":b", None),
        ("a.tltl:", "a.tltl:", None),
        ("a.tltl:b c", "a.tltl:b c", None),
        ("C:\\levels\\a.tltl", "C:\\levels\\a.tltl", None),
        ("C:\\levels\\a.tltl:b", "C:\\levels\\a.tltl", "b"),
        ("a.tltl:é", "a.tltl:é", None),
    ],
)
def test_arguments_are_split_into_path_and_name(argument: str, path: str, name: str | None, inside: Path) -> None:
    assert split(argument) == (path, name)


def test_a_path_that_exists_is_not_split(inside: Path) -> None:
    Path("odd:name").write_text(HIDE)
    assert split("odd:name") == ("odd:name", None)


def test_a_drive_letter_is_not_split(monkeypatch: pytest.MonkeyPatch, inside: Path) -> None:
    assert split("C:spec") == ("C", "spec")
    monkeypatch.setattr(os, "name", "nt")
    assert split("C:spec") == ("C:spec", None)


def test_standard_input_is_read_like_a_file(process) -> None:  # type: ignore[no-untyped-def]
    assert process("check", "-", stdin=HIDE.encode()).status == 0
    broken = process("check", "-", stdin=b"spec hide = G !seen")
    assert broken.status == 1
    assert "<stdin>:1:16" in broken.err
    assert "did you mean `hide`?" in process("check", "-:hidden", stdin=HIDE.encode()).err
    assert process("check", "-:hide", stdin=HIDE.encode()).status == 0
    two = f"{HIDE}spec seek = F seen".encode()
    assert "e.g. `-:hide`" in process("render", "-", stdin=two).err
    assert process("render", "-:seek", "-t", "dot", stdin=two).out.startswith("digraph seek")


def test_byte_order_marks_and_line_ends_are_accepted(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("bom.tltl").write_bytes(b"\xef\xbb\xbf" + HIDE.replace("\n", "\r\n").encode())
    assert tltlc("check", "bom.tltl").status == 0
    Path("late.tltl").write_bytes(b"\xef\xbb\xbfsignal seen: bool // \xe9\n")
    assert "late.tltl:1:22" in tltlc("check", "late.tltl").err


def test_an_artefact_is_accepted_in_place_of_a_source(tltlc, process, inside: Path) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("compile", "hide.tltl", "-o", "one", "-t", "json,dot").status == 0
    artefact = Path("one/hide.fspa.json")
    assert tltlc("check", artefact).status == 0
    assert tltlc("compile", artefact, "-o", "two", "-t", "json,dot").status == 0
    for name in ("hide.fspa.json", "hide.dot"):
        assert Path("one", name).read_bytes() == Path("two", name).read_bytes()
    assert tltlc("render", artefact, "-t", "dot").out == Path("one/hide.dot").read_text()
    assert tltlc("render", f"{artefact}:hide", "-t", "dot").status == 0
    assert tltlc("render", f"{artefact}:other", "-t", "dot").status == 2
    assert process("render", "-", "-t", "dot", stdin=artefact.read_bytes()).out == Path("one/hide.dot").read_text()


def test_params_apply_to_sources_and_artefacts(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    text = "signal d: length in [0 m, 100 m]\nparam far: length in [1 m, 50 m] = 20 m\n"
    Path("far.tltl").write_text(text + "predicate away in [-1, 1] = clamp(d / far - 1, -1, 1)\nspec go = F away\n")
    assert tltlc("compile", "far.tltl", "-t", "json", "-o", "plain").status == 0
    assert tltlc("compile", "far.tltl", "-t", "json", "-o", "source", "--param", "far = 2500 cm").status == 0
    assert tltlc("compile", "plain/go.fspa.json", "-t", "json", "-o", "artefact", "-p", "far=25 m").status == 0
    assert Path("source/go.fspa.json").read_text() == Path("artefact/go.fspa.json").read_text()
    assert Path("source/go.fspa.json").read_text() != Path("plain/go.fspa.json").read_text()
    for source in ("far.tltl", "plain/go.fspa.json"):
        assert "TLT0307" in tltlc("check", source, "--param", "far=51").err
        assert "TLT0308" in tltlc("check", source, "--param", "far=2 s").err
        assert "did you mean `far`?" in tltlc("check", source, "--param", "fra=2").err


@pytest.mark.parametrize(
    ("command", "suggestion"),
    [
        (("explain", "dash"), "levels/deep/dash.tltl:dash"),
        (("render", "hide"), "hide.tltl"),
        (("witness", "levels/deep/dash"), "levels/deep/dash.tltl"),
        (("monitor", "dash", "trace.csv"), "levels/deep/dash.tltl:dash"),
        (("diff", "hide.tltl", "dash"), "levels/deep/dash.tltl:dash"),
        (("check", "secret"), None),
        (("check", "spoken_of"), None),
    ],
)
def test_a_spec_name_in_place_of_a_file_gets_a_suggestion(  # type: ignore[no-untyped-def]
    command: tuple[str, ...], suggestion: str | None, tltlc, inside: Path
) -> None:
    for name, text in {
        "levels/deep/dash.tltl": "// not spec spoken_of\nsignal loud: bool\nspec dash = F loud\nspec\n",
        "levels/.old/secret.tltl": "spec secret = true",
        "levels/deep/odd.tltl": "\0dash",
        "trace.csv": "loud\n1\n",
    }.items():
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_text(text)
    outcome = tltlc(*command)
    assert outcome.status == 3
    assert ("did you mean" in outcome.err) == (suggestion is not None)
    assert suggestion is None or f"\n  help: did you mean `{suggestion}`?\n" in outcome.err


def test_the_search_for_a_spec_stops_after_some_folders(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    for number in range(300):
        Path(f"a{number:03}").mkdir()
    for name in ("a001", "a299"):
        Path(name, "file.tltl").write_text(f"spec {name}_spec = true\n")
    assert "did you mean `a001/file.tltl:a001_spec`?" in tltlc("check", "a001_spec").err
    assert "did you mean" not in tltlc("check", "a299_spec").err


@pytest.mark.parametrize("text", [b"", b"\n", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("name", ["hide.fspa.json", "hide.tltl.json"])
@pytest.mark.parametrize("command", ["check", "compile", "test", "explain", "render", "witness", "lint", "fmt"])
def test_a_truncated_artefact_is_an_error(
    command: str,
    name: str,
    text: bytes,
    inside: Path,
    tltlc: Callable[..., Outcome],
) -> None:
    """A full disk leaves an empty file. A build must not treat it as a file without specs."""
    (inside / name).write_bytes(text)
    outcome = tltlc(command, name)
    code, status = ("TLT0722", 2) if command in ("lint", "fmt") else ("TLT0601", 1)
    assert outcome.status == status
    assert f"error[{code}]: `{name}`" in outcome.err


def test_an_empty_source_is_valid(inside: Path, tltlc: Callable[..., Outcome]) -> None:
    """It is an empty library, which other files may import."""
    (inside / "empty.tltl").touch()
    (inside / "hide.tltl").write_text(f'import "empty.tltl"\n{HIDE}')
    assert tltlc("check", "empty.tltl", "hide.tltl").status == 0
