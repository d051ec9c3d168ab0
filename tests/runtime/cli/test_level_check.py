"""``tltlc check --level``; the golden tests cover its messages, too."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import ROOT, Outcome, inside, tltlc  # noqa: F401
from tltl_runtime.stealth.capabilities.vocabulary import available_signals
from tltl_runtime.stealth.levels.file import level_names, load_level, variants
from tltl_runtime.stealth.signals import readers

EXAMPLES = ROOT / "examples"
SHIPPED = [(name, variant) for name in level_names() for variant in variants(name)]


@pytest.mark.parametrize(("name", "variant"), SHIPPED)
def test_every_signal_has_a_type_and_a_range(name: str, variant: str) -> None:
    level = load_level(name, variant)
    assert available_signals(level).keys() == readers(level).keys()


def test_the_shipped_levels_supply_the_signals_of_their_specs(tltlc) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("check", "--level", "all")
    # One variant is unsolvable on purpose.
    assert result.status == 1
    for name, variant in SHIPPED:
        assert (f"{name}:{variant} supplies " in result.err) == ((name, variant) != ("navigation", "v2"))
    assert result.err.count("error[") == 2
    assert (
        "error[TLT0814]: nobody can reach `exit` in `navigation:v2`, so nobody can do what `navigation` asks"
        in result.err
    )
    assert "help: the way ends at `corridor_block_2`, which is 2.2 m high" in result.err
    assert "navigation:v0 supplies s1, s2, exit, level_size = 27.39 m (nothing to report)" in result.err
    assert result.err.count("navigation: the agent senses entities 9 (s1, s2, exit); map 4 x 15 x 15 (") == 1


def test_a_spec_is_checked_against_levels(tltlc) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    spec = EXAMPLES / "navigation.tltl"
    assert tltlc("check", spec, "--level", "navigation:v0").status == 0
    other: Outcome = tltlc("check", spec, "--level", "cover_and_hide:v0", "--level", "branching:v0")
    assert other.status == 1  # branching has no `exit`
    assert "warning[TLT0813]: `navigation` is made for the level `navigation`, not for `cover_and_hide`" in other.err
    assert "error[TLT0810]: the level `branching` has no entity `exit`" in other.err


def test_an_artefact_is_checked_against_levels(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    assert tltlc("compile", EXAMPLES / "branching.tltl:branching", "-t", "json").status == 0
    result: Outcome = tltlc("check", "branching.fspa.json", "--level", "branching:v0", "--level", "navigation:v0")
    assert "branching:v0 supplies s1, s2, s3, e_right, e_left, open_right, open_left, health," in result.err
    assert "error[TLT0810]: the level `navigation` has no entity `s3`\n  help" in result.err


def test_a_message_on_several_variants_is_printed_once(tltlc) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("check", EXAMPLES / "cover_and_hide.tltl", "--level", "branching")
    assert result.err.count("TLT0810") == 1


def test_messages_are_in_the_machine_readable_formats(tltlc) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    arguments = ("check", EXAMPLES / "cover_and_hide.tltl", "--level", "branching:v0", "--format")
    result: Outcome = tltlc(*arguments, "json")
    codes = [diagnostic["code"] for diagnostic in json.loads(result.out)["diagnostics"]]
    assert (codes, result.err) == (["TLT0810", "TLT0813"], "")
    assert "ruleId" in tltlc(*arguments, "sarif").out
    assert "::error file=" in tltlc(*arguments, "github").out


def test_a_plan_of_one_level_is_written(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    written: Outcome = tltlc("check", "--level", "navigation:v2", "--plan", "plan.png")
    assert (written.status, written.err.splitlines()[-1]) == (1, "wrote plan.png")
    assert Path("plan.png").read_bytes().startswith(b"\x89PNG")
    several_variants: Outcome = tltlc("check", "--level", "cover_and_hide", "--plan", "several.png")
    assert several_variants.status == 2 and not Path("several.png").exists()
    assert "wrote" not in several_variants.err
    count = len(variants("cover_and_hide"))
    assert f"--plan needs one level and variant, e.g. `--level navigation:v2`, not {count}" in several_variants.err


def test_one_variant_of_all_levels_is_checked(tltlc) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("check", "--level", "all:v0", "--no-map", "--no-variables", "--no-entities")
    assert result.status == 0
    assert result.err.count("(nothing to report)") == 3
    assert "navigation: the agent senses nothing of the level" in result.err


def test_invalid_options_are_rejected(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    assert tltlc("check", "--level", "navigation:v7").status == 2
    assert tltlc("check", "--level", "nowhere.toml").status == 3
    assert tltlc("check", "--level", "navigation:v0", "--entities", "s9").status == 2
    assert tltlc("check", "missing.tltl", "--level", "navigation").status == 3


def test_a_jump_out_of_the_level_is_reported(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    level, spec = tmp_path / "tower.toml", tmp_path / "tower.tltl"
    level.write_text(TOWER)
    spec.write_text("import spatial entity exit spec leave { limit 200 steps reach near(exit) }")
    checked: Outcome = tltlc("check", spec, "--level", level)
    assert checked.status == 0
    title = "a jump may lead out of `tower`: the player can jump from 1.75 m up to 2.72 m, and the bounds end at 2.5 m"
    assert f"warning[TLT0806]: {title}\n  help: make the bounds end above 2.73 m\n" in checked.err
    result: Outcome = tltlc("demonstrate", level, "--spec", spec, "-o", tmp_path)
    assert result.status == 1
    assert result.err.startswith("error[TLT0806]: level tower v0, step ")
    assert "is outside the level's bounds\n  help: make its bounds higher" in result.err


TOWER = """doc = "A leap leads out of the level."

[bounds]
at = [6.0, 3.0, -0.5]
size = [12.0, 6.0, 3.0]

[start]
at = [1.5, 3.0, 0.0]

[[stairs]]
from = [2.5, 3.0, 0.0]
to = [4.6, 3.0, 1.75]
width = 2.0
steps = 7

[[platform]]
at = [5.6, 3.0, 0.0]
size = [2.0, 2.0, 1.75]

[[platform]]
at = [9.1, 3.0, 0.0]
size = [2.0, 2.0, 1.75]

[[exit]]
name = "exit"
at = [9.1, 3.0, 1.75]
"""


def test_nothing_to_report_is_not_printed_next_to_a_warning(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    spec = tmp_path / "never.tltl"
    spec.write_text("import spatial entity exit spec never { limit 9 steps keep near(exit) keep not near(exit) }")
    result: Outcome = tltlc("check", spec, "--level", "navigation:v0")
    assert "warning[TLT0410]" in result.err
    assert "navigation:v0 supplies exit, level_size = 27.39 m\n" in result.err
    assert "nothing to report" not in result.err


def test_a_spec_may_need_nothing_of_a_level(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    spec = tmp_path / "nothing.tltl"
    spec.write_text("spec nothing { limit 9 steps require true }")
    result: Outcome = tltlc("check", spec, "--level", "navigation:v0")
    assert "navigation:v0 has nothing to supply\n" in result.err


def test_an_unwritable_plan_is_reported(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("check", "--level", "navigation:v0", "--plan", "no/such.png")
    assert result.status == 3
    assert "help: name another place with --plan\n" in result.err
