"""Wrong uses of past operators, counts and times are errors with a code, and the fixes that they offer help."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.resolve.helpers import write
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.spec_tests import run_tests
from tltlc.pipeline import CompileOptions, Session, compile_source, compile_text, with_params

NAMES = "signal p: bool signal q: bool signal hp in [0, 10] signal d: length in [0 m, 9 m]\n"
CLOCK = f"clock 10 Hz {NAMES}"


def errors(text: str, name: str = "<test>") -> list[Diagnostic]:
    """Return the errors of a text that does not compile."""
    with pytest.raises(TltlError) as raised:
        Session(SourceFile(name, text)).compiled()
    return [diagnostic for diagnostic in raised.value.diagnostics if diagnostic.severity == "error"]


def fixed(text: str, diagnostic: Diagnostic) -> str:
    """Return the text after the only fix of a diagnostic."""
    (fix,) = diagnostic.fixes
    for edit in sorted(fix.edits, key=lambda edit: -edit.span.start):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    return text


@pytest.mark.parametrize(
    ("formula", "code"),
    [
        ("once F p", "TLT0320"),
        ("once (p U q)", "TLT0320"),
        ("p since X q", "TLT0320"),
        ("previously eventually within 3 steps p", "TLT0320"),
        ("times(G p) > 3", "TLT0320"),
        ("hp - times(p) > 3", "TLT0321"),
        ("-time_since(p) > -3 s", "TLT0321"),
        ("times(p) > times(q)", "TLT0321"),
        ("highest(times(p)) > 3", "TLT0321"),
        ("once for 3 s p", "TLT0111"),
        ("historically within 3 s p", "TLT0111"),
        ("previously within 3 s p", "TLT0111"),
        ("begins for 3 s p", "TLT0111"),
        ("ends after 3 s p", "TLT0111"),
        ("once[0,5] p", "TLT0111"),
        ("historically for 3 p", "TLT0111"),
        ("times(p, 3, 4) > 3", "TLT0210"),
        ("times(f = p) > 3", "TLT0210"),
        ("previous(hp, 3) > 3", "TLT0210"),
        ("times_since(p) > 3", "TLT0210"),
        ("times_since(p, p, 3, 4) > 3", "TLT0210"),
        ("times_since(p, eventually p) > 3", "TLT0320"),
        ("times_since(p, p, 0) > 3", "TLT0303"),
        ("times_within(p) > 3", "TLT0210"),
        ("times_within(p, 3) > 3", "TLT0210"),
        ("times_within(p, hp) > 3", "TLT0210"),
        ("times_within(p, 1 m) > 3", "TLT0312"),
        ("times_within(p, 1.5 steps) > 3", "TLT0312"),
        ("times_within(p, 1 s, 3, 4) > 3", "TLT0210"),
        ("times_within(p, 1 s) > 50", "TLT0303"),
        ("times_within(p, 1 s, 101) > 3", "TLT0303"),
        ("times_within(eventually p, 1 s) > 3", "TLT0320"),
        ("value_at(hp) > 3", "TLT0210"),
        ("total_time_since(p) > 3 s", "TLT0210"),
        ("highest_since(hp) > 3", "TLT0210"),
        ("lowest_since(hp, eventually p) > 3", "TLT0320"),
        ("value_at(hp, p, 3) > 3", "TLT0210"),
        ("value_at(hp, next p) > 3", "TLT0320"),
        ("value_at(3, p) > 3", "TLT0302"),
        ("times > 3", "TLT0201"),
        ("previous > 3", "TLT0201"),
        ("times() > 3", "TLT0101"),
        ("previous(3) > 3", "TLT0302"),
        ("previous(previously p) > 0.5", "TLT0302"),
        ("times(p, hp) > 3", "TLT0302"),
        ("times(hp) > 3", "TLT0301"),
        ("previously hp", "TLT0301"),
        ("times(p)", "TLT0301"),
        ("previous(hp)", "TLT0301"),
        ("times(p, 0) > 3", "TLT0303"),
        ("times(p, -1) > 3", "TLT0303"),
        ("times(p, 2.5) > 1", "TLT0303"),
        ("time_since(p, 0 s) > 3 s", "TLT0303"),
        ("times(p) > 1e300", "TLT0303"),
        ("times(p) > 1e308", "TLT0303"),
        ("time_holding(p, 1e308 s) > 3 s", "TLT0303"),
        ("times(p, 3) < 0", "TLT0310"),
        ("times(p, 3) >= 0", "TLT0310"),
        ("once within 0.5 steps p", "TLT0312"),
        ("historically for 0 steps p", "TLT0312"),
        ("historically for 0 s p", "TLT0312"),
        ("once within 3 m p", "TLT0312"),
        ("time_since(p) > 3 steps", "TLT0304"),
    ],
)
def test_a_wrong_use_is_an_error(formula: str, code: str) -> None:
    assert [error.code for error in errors(f"{CLOCK} spec s = G ({formula})")] == [code]


@pytest.mark.parametrize(
    "formula", ["once within 3 s p", "historically for 3 s p", "time_since(p) > 3 s", "time_holding(p, 3 s) > 1 s"]
)
def test_a_time_needs_a_clock(formula: str) -> None:
    (error,) = errors(f"{NAMES} spec s = G ({formula})")
    assert error.code == "TLT0313"
    assert compile_text(f"clock 60 Hz {NAMES} spec s = G ({formula})")


@pytest.mark.parametrize(
    ("wrong", "code", "right"),
    [
        ("times(p, 3) > 3", "TLT0322", "times(p, 7) > 3"),
        ("times(p, 3) <= 10", "TLT0322", "times(p, 21) <= 10"),
        ("times(p, 3) > 3.3", "TLT0322", "times(p, 8) > 3.3"),
        ("3 < times(p, 1)", "TLT0322", "3 < times(p, 7)"),
        ("time_since(p, 2 s) > 2.5 s", "TLT0322", "time_since(p, 5 s) > 2.5 s"),
        ("time_since(p, 10 ms) > 3 s", "TLT0322", "time_since(p, 6 s) > 3 s"),
        ("time_since(p) > 2", "TLT0305", "time_since(p) > 2 s"),
        ("times(p) > 2 s", "TLT0305", "times(p) > 2"),
        ("times(p, 2 s) > 1", "TLT0305", "times(p, 2) > 1"),
        ("previous(d) > 3", "TLT0305", "previous(d) > 3 m"),
    ],
)
def test_the_fix_of_an_error_gives_what_was_meant(wrong: str, code: str, right: str) -> None:
    text = f"{CLOCK} spec s = G ({wrong})"
    (error,) = errors(text)
    assert error.code == code
    assert fixed(text, error) == f"{CLOCK} spec s = G ({right})"
    assert compile_text(fixed(text, error))


@pytest.mark.parametrize(
    "definitions",
    [
        "".join(f"let l{i + 1} = once (l{i} or previously l{i})\n" for i in range(60)) + "spec s = l60",
        "".join(f"let l{i + 1} = begins l{i}\n" for i in range(60)) + "spec s = l60",
        "".join(f"let l{i + 1} = times(l{i}) > times(l{i}, 5)\n" for i in range(60)) + "spec s = l60",
        f"spec s = {'begins ' * 60} l0",
    ],
)
def test_formulas_that_double_at_each_level_are_an_error(definitions: str) -> None:
    assert {error.code for error in errors(f"{CLOCK} let l0 = p or q\n{definitions}")} <= {"TLT0315", "TLT0317"}


@pytest.mark.parametrize(
    "formula",
    [
        "times(" * 17 + "p" + ") > 1" * 17,
        "previous(" * 17 + "hp" + ") + 1" * 17 + " > 3",
        "times(" * 15 + "p" + ", 5) + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 > 12" * 15,
        f"once ({' iff '.join('pq' * 60)})",
    ],
)
def test_what_nests_too_deep_is_an_error(formula: str) -> None:
    assert [error.code for error in errors(f"{CLOCK} spec s = {formula}")] == ["TLT0317"]


def test_operators_may_nest_hundreds_of_levels_deep() -> None:
    (fspa,) = compile_text(f"{NAMES} spec s = F ({'once ' * 300} p)")
    monitor = Monitor(fspa)
    assert [monitor.step({"p": p}).verdict for p in (False, True, False)] == ["pending", "satisfied", "satisfied"]
    (fspa,) = compile_text(f"{NAMES} spec s = F ({'previously ' * 300} p)")
    monitor = Monitor(fspa)
    verdicts = [monitor.step({"p": number == 0}).verdict for number in range(302)]
    assert verdicts == ["pending"] * 300 + ["satisfied"] * 2


# --- names ------------------------------------------------------------------------------------------


def atoms_and_registers(fspa: Fspa) -> tuple[list[str], list[str]]:
    """Return the names of the atoms and registers of an automaton."""
    return [atom.name for atom in fspa.atoms], [register.name for register in fspa.registers]


@pytest.mark.parametrize(
    ("text", "atoms", "registers"),
    [
        ("entity p signal previous(t: entity): bool spec s = F previous(p)", ["previous(p)"], []),
        ("predicate times(t: number) = clamp(t, -1, 1) spec s = F times(0.3)", ["times(0.3)"], []),
        ("signal q: bool let times(t) = once t spec s = F times(q)", ["once q", "q"], ["once q"]),
        ("signal times in [0, 3] spec s = F times > 1", ["times > 1"], []),
        (
            "signal last: bool spec s = F previously last",
            ["previously last", "last"],
            ["last last", "previously last"],
        ),
    ],
)
def test_a_declaration_may_take_the_name_of_a_function(text: str, atoms: list[str], registers: list[str]) -> None:
    (fspa,) = compile_text(text)
    assert atoms_and_registers(fspa) == (atoms, registers)


LIBRARY = """
entity guard
signal times(t: entity) in [0, 5]
signal previous(t: entity): bool
let many = times(guard) > 3
let was = previous(guard)
"""


@pytest.mark.parametrize(
    "spec",
    [
        "F l.many & G times(guard) > 3",
        "F times(guard) > 3 & G l.many",
        "F l.was & G previous(guard)",
        "F previous(guard) & G l.was",
    ],
)
def test_a_signal_of_a_library_with_the_name_of_a_register_is_an_error(spec: str, tmp_path: Path) -> None:
    write(tmp_path, lib=LIBRARY)
    main = str(tmp_path / "main.tltl")
    (error,) = errors(f"import lib as l signal guard: bool spec s = {spec}", main)
    assert error.code == "TLT0216"
    write(tmp_path, lib=LIBRARY.replace("times", "hits").replace("previous", "before"))
    spec = spec.replace("l.times", "l.hits").replace("l.previous", "l.before")
    assert Session(SourceFile(main, f"import lib as l signal guard: bool spec s = {spec}")).automata


@pytest.mark.parametrize(
    "use", ["previous(near(g)) > 0.5", "once near(g)", "highest(near(g)) > 0", "times(near(g)) > 1"]
)
def test_predicates_of_two_libraries_with_one_name_are_not_mixed(use: str, tmp_path: Path) -> None:
    library = "entity g signal x(t: entity) in [-1, 1] predicate near(t: entity) in [-1, 1] = {} x(t) let l = {}"
    write(tmp_path, one=library.format("", use), two=library.format("-", use))
    main = str(tmp_path / "main.tltl")
    (error,) = errors("import one as a import two as b spec s = F a.l & F b.l", main)
    assert error.code == "TLT0216"
    (fspa,) = Session(SourceFile(main, "import one as a import two as b spec s = F b.l")).automata
    assert Monitor(fspa).step({"x(g)": -1}).verdict == ("pending" if "times" in use else "satisfied")


def test_the_check_of_an_unused_definition_leaves_no_register_without_a_range() -> None:
    text = f"{CLOCK} let l(e: number) = previous(hp) > e predicate w in [0, 1] = previous(hp) / 10 spec s = G hp > 1"
    assert Session(SourceFile("<test>", text)).compiled().diagnostics == ()


# --- params and tests -------------------------------------------------------------------------------


def test_a_param_may_change_the_number_to_which_a_count_is_compared() -> None:
    text = f"{NAMES} param most in [1, 5] = 2 spec s = G times(p) <= most"
    (fspa,) = compile_text(text)
    (given,) = compile_text(text, options=CompileOptions(params={"most": "4"}))
    for changed, monitor in (
        (4, Monitor(given)),
        (4, Monitor(with_params(fspa, {"most": "4"}))),
        (5, Monitor(fspa, {"most": 5.0})),
        (2, Monitor(fspa)),
    ):
        verdicts = [monitor.step({"p": number % 2 == 0}).verdict for number in range(20)]
        assert verdicts.index("violated") == 2 * changed


def test_a_test_gives_the_atoms_from_which_others_follow() -> None:
    text = f"""{CLOCK}
    spec s {{ keep times(p) <= 2 reach time_holding(q) >= 3 s }}
    test "counts" for s {{
        step p step 3x not p step p step not p expect pending
        step p expect violated
    }}
    test "holds" for s {{ step 30x q expect pending step q expect holding }}
    """
    compiled = compile_source(SourceFile("<test>", text))
    assert [result.failure for result in run_tests(compiled.program, compiled.automata)] == [None, None]


def test_a_test_cannot_give_what_follows_from_other_atoms() -> None:
    (error,) = errors(f'{CLOCK} spec s = F times(p) > 2 test "t" for s {{ step times(p) > 2 expect satisfied }}')
    assert (error.code, error.help) == ("TLT0218", "leave it out, and say in each step whether `p` holds")


def test_a_time_within_a_number_of_steps_needs_a_fixed_clock() -> None:
    (error,) = errors("clock varies signal p: bool spec s = G (total_time_within(p, 4 steps) <= 3 s)")
    assert (error.code, error.title) == ("TLT0323", "`total_time_within` needs a fixed clock")
