"""``tltlc fmt``: the files that it writes, its output and its exit status."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

ROUGH = "signal seen:bool\nspec hide=G !seen // ◇\n"
WORDS = "signal seen: bool\nspec hide = always not seen  // ◇\n"
LETTERS = "signal seen: bool\nspec hide = G !seen  // ◇\n"


def test_only_files_that_change_are_rewritten(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("levels/.hidden").mkdir(parents=True)
    for name in ("levels/rough.tltl", "levels/.hidden/rough.tltl", "levels/other.txt"):
        Path(name).write_text(ROUGH, encoding="utf-8")
    Path("levels/done.tltl").write_text(WORDS, encoding="utf-8")
    os.utime("levels/done.tltl", (0, 0))
    outcome = tltlc("fmt", "levels")
    assert (outcome.status, outcome.out) == (0, "")
    assert outcome.err == f"formatted {Path('levels/rough.tltl')}\n1 file already had this layout\n"
    assert Path("levels/rough.tltl").read_text(encoding="utf-8") == WORDS
    assert Path("levels/.hidden/rough.tltl").read_text(encoding="utf-8") == ROUGH
    assert Path("levels/other.txt").read_text(encoding="utf-8") == ROUGH
    assert Path("levels/done.tltl").stat().st_mtime == 0


def test_check_lists_files_and_writes_nothing(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("rough.tltl").write_text(ROUGH, encoding="utf-8")
    Path("done.tltl").write_text(WORDS, encoding="utf-8")
    outcome = tltlc("fmt", "--check", "done.tltl", "rough.tltl")
    assert (outcome.status, outcome.out, outcome.err) == (1, "rough.tltl\n", "1 file would change, 1 would not\n")
    assert tltlc("fmt", "--check", "done.tltl").status == 0
    assert Path("rough.tltl").read_text(encoding="utf-8") == ROUGH


def test_diff_prints_changes_and_writes_nothing(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("rough.tltl").write_text(ROUGH.rstrip(), encoding="utf-8")
    outcome = tltlc("fmt", "--diff", "rough.tltl")
    assert outcome.status == 0
    assert outcome.out == (
        "--- rough.tltl\n+++ rough.tltl\n@@ -1,2 +1,2 @@\n-signal seen:bool\n-spec hide=G !seen // ◇\n"
        "\\ No newline at end of file\n+signal seen: bool\n+spec hide = always not seen  // ◇\n"
    )
    checked = tltlc("fmt", "--diff", "--check", "rough.tltl")
    assert (checked.status, checked.out) == (1, outcome.out)
    assert Path("rough.tltl").read_text(encoding="utf-8") == ROUGH.rstrip()


def test_the_lines_of_a_coloured_diff_have_ansi_colours() -> None:
    from tltlc.tools.fmt.changes import diff_text

    assert diff_text("a", "x\ny\n", "x\nz\n", color=True) == (
        "\x1b[1m--- a\x1b[0m\n\x1b[1m+++ a\x1b[0m\n\x1b[36m@@ -1,2 +1,2 @@\x1b[0m\n"
        " x\n\x1b[31m-y\x1b[0m\n\x1b[32m+z\x1b[0m\n"
    )
    assert diff_text("a", "x\n", "x\n", color=True) == ""


def test_line_ends_and_byte_order_marks_count_as_changes(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    for data in (WORDS.encode("utf-8-sig"), WORDS.replace("\n", "\r\n").encode(), WORDS.rstrip().encode()):
        Path("a.tltl").write_bytes(data)
        assert tltlc("fmt", "--check", "a.tltl").status == 1
        assert tltlc("fmt", "a.tltl").status == 0
        assert Path("a.tltl").read_bytes() == WORDS.encode()


def test_standard_input_is_formatted_to_standard_output(process, inside: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = process("fmt", "-", stdin=ROUGH.encode(), PYTHONIOENCODING="ascii")
    assert (outcome.status, outcome.out, outcome.err) == (0, WORDS, "")
    checked = process("fmt", "--check", "-", stdin=ROUGH.encode())
    assert (checked.status, checked.out) == (1, "<stdin>\n")
    broken = process("fmt", "-", stdin=b"spec a = F (")
    assert (broken.status, broken.out) == (1, "")
    assert "TLT0101" in broken.err


def test_the_option_takes_precedence_over_the_style_of_the_project(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("tltl.toml").write_text('[style]\nformatting = "letters"\n')
    Path("a.tltl").write_text(ROUGH, encoding="utf-8")
    assert tltlc("fmt", "a.tltl").status == 0
    assert Path("a.tltl").read_text(encoding="utf-8") == LETTERS
    assert tltlc("fmt", "--style", "words", "a.tltl").status == 0
    assert Path("a.tltl").read_text(encoding="utf-8") == WORDS
    Path("tltl.toml").write_text('[style]\nformatting = "greek"\n')
    wrong = tltlc("fmt", "a.tltl")
    assert wrong.status == 1
    assert 'expected one of "words", "letters", "symbols", "unicode"' in wrong.err


def test_a_file_with_errors_is_skipped_and_the_others_are_formatted(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("bad.tltl").write_text("spec a = F (")
    Path("rough.tltl").write_text(ROUGH, encoding="utf-8")
    outcome = tltlc("fmt", "bad.tltl", "gone.tltl", "rough.tltl")
    assert outcome.status == 3
    assert "error[TLT0101]" in outcome.err
    assert "error[TLT0001]" in outcome.err
    assert Path("bad.tltl").read_text() == "spec a = F ("
    assert Path("rough.tltl").read_text(encoding="utf-8") == WORDS
    assert tltlc("fmt", "gone.tltl").status == 3
    assert tltlc("fmt").status == 1  # the current folder, which contains the file with errors
    Path("empty").mkdir()
    assert tltlc("fmt", "empty").status == 2


def test_standard_input_is_checked_like_a_file(process, inside: Path) -> None:  # type: ignore[no-untyped-def]
    for data in (WORDS.encode("utf-8-sig"), WORDS.replace("\n", "\r").encode()):
        assert process("fmt", "--check", "-", stdin=data).out == "<stdin>\n"
        assert process("fmt", "-", stdin=data).out == WORDS


def test_a_read_only_file_is_not_changed(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    for name in ("kept.tltl", "other.tltl"):
        Path(name).write_text(ROUGH, encoding="utf-8")
    Path("kept.tltl").chmod(0o444)
    outcome = tltlc("fmt", "kept.tltl", "other.tltl")
    assert outcome.status == 3
    assert "error[TLT0005]: cannot write `kept.tltl`: it is read-only" in outcome.err
    assert Path("kept.tltl").read_text(encoding="utf-8") == ROUGH
    assert Path("other.tltl").read_text(encoding="utf-8") == WORDS
    assert tltlc("fmt", "--check", "kept.tltl").out == "kept.tltl\n"
    Path("kept.tltl").chmod(0o644)


@pytest.mark.skipif(os.name == "nt", reason="needs links")
def test_links_are_followed_and_kept(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("rough.tltl").write_text(ROUGH, encoding="utf-8")
    Path("link.tltl").symlink_to("rough.tltl")
    Path("loose.tltl").symlink_to("gone.tltl")
    outcome = tltlc("fmt", "link.tltl", "loose.tltl")
    assert outcome.status == 3
    assert (
        "cannot read `loose.tltl`: there is no such file\n  help: it is a link, and its target does not exist"
        in outcome.err
    )
    assert Path("link.tltl").is_symlink()
    assert Path("rough.tltl").read_text(encoding="utf-8") == WORDS


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="needs a folder that refuses")
def test_a_file_in_a_read_only_folder_is_not_written(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("shut").mkdir()
    Path("shut/a.tltl").write_text(ROUGH, encoding="utf-8")
    Path("shut").chmod(0o500)
    assert tltlc("fmt", "shut/a.tltl").status == 3


def test_formatting_does_not_import_the_compiler(inside: Path) -> None:
    from tests.interfaces.cli.test_loading import HEAVY, loaded_modules

    modules = loaded_modules("fmt", "hide.tltl", folder=inside)
    assert not modules & {*HEAVY, "tltlc.pipeline", "tltlc.automaton", "tltlc.resolve"}


@pytest.mark.parametrize(
    ("first", "options"),
    [("spec a {\n", ((), ("--check",), ("--diff",))), ("spec a { // tltlc: allow TLT0411\n", ((),))],
    ids=["plain", "with a comment that allows"],
)
def test_a_file_that_would_exceed_the_limits_is_kept(  # type: ignore[no-untyped-def]
    tltlc, inside: Path, first: str, options: tuple[tuple[str, ...], ...]
) -> None:
    text = first + "//c\n" * 140_000 + "require true }\n"
    Path("big.tltl").write_text(text)
    for words in options:
        outcome = tltlc("fmt", *words, "big.tltl")
        assert (outcome.status, outcome.out) == (1, "")
        assert (
            "error[TLT0004]: the layout of `big.tltl` would have more than 1 MiB, or more than 131,072 words and signs"
            in outcome.err
        )
        assert "the file is not changed; to format it, split it" in outcome.err
    assert Path("big.tltl").read_text() == text


def test_a_file_may_grow_up_to_the_limit_in_bytes(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    text = "spec a = true\n" + "// ◇◇◇\n" * 80_000
    Path("big.tltl").write_text(text + "//" + "x" * ((1 << 20) - len(text.encode()) - 3) + "\n", encoding="utf-8")
    assert tltlc("fmt", "big.tltl").status == 0
    assert tltlc("check", "big.tltl").status == 0
