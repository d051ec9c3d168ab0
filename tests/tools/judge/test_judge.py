from __future__ import annotations

import io
from collections.abc import Iterable
from random import Random

import pytest

from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.logic.text.printer import words_text
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.nearest_edge import nearest_edge
from tltlc.monitor.run import TraceOutcome, outcome, run
from tltlc.monitor.traces import read_trace
from tltlc.pipeline import Session
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.formulas import formula
from tltlc.tools.judge.clauses import Clauses, clauses_of
from tltlc.tools.judge.judge import Judge
from tltlc.tools.judge.measures import Measure
from tltlc.tools.judge.summary import trace_text
from tltlc.tools.judge.verdict import RejectionCause, TraceDetails, TraceVerdict

LAVA = """
clock 10 Hz
signal on_lava: bool
signal key: bool
signal out: bool
signal heat: number in [0, 10]
spec fetch { reach key then out  avoid on_lava  keep heat < 8  limit 60 s }
"""


def _compiled(text: str) -> tuple[Fspa, Clauses]:
    session = Session(SourceFile("x.tltl", text))
    compiled = session.compiled()
    return compiled.automata[0], clauses_of(compiled.automata[0], compiled.program.specs[0])


FSPA, CLAUSES = _compiled(LAVA)


def _trace(rows: Iterable[str], header: str = "on_lava,key,out,heat") -> bytes:
    return "\n".join([header, *rows, ""]).encode()


def _cause(*rows: str) -> RejectionCause | None:
    judged = Judge(FSPA, CLAUSES).judge("trace", _trace(rows))
    assert judged.verdict is not None
    assert not judged.diagnostics
    return judged.verdict.cause


def _verdict(judge: Judge, data: bytes) -> TraceVerdict:
    verdict = judge.judge("trace", data).verdict
    assert verdict is not None
    return verdict


def test_an_accepted_trace_has_no_cause() -> None:
    assert _cause("0,0,0,1", "0,1,0,1", "0,1,1,1") is None


def test_a_broken_clause_is_named_with_the_step_and_the_atoms() -> None:
    assert _cause("0,0,0,1", "0,1,0,1", "1,1,0,1", "0,1,1,1") == RejectionCause(
        "broken", 3, ("avoid on_lava",), ("on_lava",)
    )
    assert _cause("0,0,0,9") == RejectionCause(
        "broken", 1, ("keep heat < 8",), ("heat < 8",), Measure("heat", 9.0, 1.0, "")
    )


def test_all_clauses_that_break_at_the_same_step_are_named() -> None:
    cause = _cause("0,0,0,1", "1,0,0,9")
    assert cause is not None
    assert (cause.step, cause.clauses) == (2, ("avoid on_lava", "keep heat < 8"))


def test_an_unfinished_clause_is_named() -> None:
    assert _cause("0,0,0,1", "0,1,0,1") == RejectionCause("unfinished", 2, ("reach key then out",))


def test_a_clause_that_others_make_impossible_is_blocked() -> None:
    fspa, parts = _compiled(
        "signal a: bool\nsignal b: bool\nspec s { reach a  require always (b implies always not a) }"
    )
    verdict = _verdict(Judge(fspa, parts), b"a,b\n0,0\n0,1\n0,0\n")
    assert verdict.cause == RejectionCause("blocked", 2, ("reach a",), ("b",))


def test_an_artefact_blames_the_conjuncts_of_its_formula() -> None:
    parts = clauses_of(FSPA, None)
    assert [part.text for part in parts.parts] == ["reach key, then out", "avoid on_lava", "keep heat < 8"]
    verdict = _verdict(Judge(FSPA, parts), _trace(["1,0,0,1"]))
    assert verdict.cause == RejectionCause("broken", 1, ("avoid on_lava",), ("on_lava",))


def test_the_conjuncts_of_an_artefact_are_named_in_words() -> None:
    (fspa,) = compile_text("signal a: bool\nspec s = F(a & N false)")
    assert [part.text for part in clauses_of(fspa, None).parts] == ["reach a at a step that is the last"]
    (fspa,) = compile_text("""clock 60 Hz
        signal a: bool
        signal b: bool
        spec s { keep within 9 s of a, b  keep begins b implies next always for 9 s not a  avoid a and b }""")
    parts = clauses_of(fspa, None).parts
    assert [part.text for part in parts] == [
        "whenever a, reach b within 9 s",
        "whenever b begins, avoid a for the next 9 s",
        "whenever b begins, the play must not end at that step",
        "avoid (a and b)",
    ]


def test_a_deadline_that_is_missed_is_told_in_words() -> None:
    judge = Judge(*_compiled("clock 60 Hz signal a: bool signal b: bool spec s { keep within 9 s of a, b }"))
    judged = judge.judge("t.csv", _trace(["1,0"] * 542, "a,b"))
    assert trace_text(judged) == (
        "not accepted: breaks `keep within 9 s of a, b` at step 541 of 542: `b later than 9 s after a`"
    )


def test_only_clauses_that_have_become_impossible_are_blocked() -> None:
    signals = "signal a: bool\nsignal b: bool\nsignal c: bool\n"
    fspa, parts = _compiled(f"{signals}spec s {{ reach a  reach c  require always (b implies always not a) }}")
    verdict = _verdict(Judge(fspa, parts), b"a,b,c\n0,0,0\n0,1,0\n")
    assert verdict.cause == RejectionCause("blocked", 2, ("reach a",), ("b",))


def test_no_clause_is_blamed_if_one_of_them_is_too_large_for_an_automaton() -> None:
    text = "signal a: bool\nsignal b: bool\nspec s { reach a  require always (b implies always not a) }"
    fspa, parts = _compiled(text)
    some = replace(parts, parts=parts.parts[:1], are_all=False)
    assert _verdict(Judge(fspa, some), b"a,b\n0,1\n").cause == RejectionCause("broken", 1, (), ("b",))


def test_clauses_that_only_together_have_become_impossible_are_not_named() -> None:
    signals = "signal a: bool\nsignal b: bool\nsignal c: bool\nsignal d: bool\n"
    rule = "require always (b implies ((always not a) or (always not c)))"
    fspa, parts = _compiled(f"{signals}spec s {{ reach a  reach c  reach d  {rule} }}")
    assert _verdict(Judge(fspa, parts), b"a,b,c,d\n0,0,0,0\n0,1,0,0\n").cause == RejectionCause("broken", 2, (), ("b",))


def test_comments_are_not_part_of_a_clause() -> None:
    _, parts = _compiled("signal a: bool\nsignal b: bool\nspec s { reach a // first\n then b }")
    assert [part.text for part in parts.parts] == ["reach a then b"]


def test_a_spec_over_infinite_traces_is_judged() -> None:
    signals = "signal a: bool\nsignal b: bool\n"
    fspa, parts = _compiled(f"{signals}spec s {{ semantics infinite  require always eventually a  avoid b }}")
    assert _verdict(Judge(fspa, parts), b"a,b\n0,0\n1,0\n").outcome.accepted
    assert _verdict(Judge(fspa, parts), b"a,b\n1,0\n0,1\n").cause == RejectionCause("broken", 2, ("avoid b",), ("b",))


@pytest.mark.parametrize("formula", ["true", "false"])
def test_a_spec_without_signals_is_judged(formula: str) -> None:
    fspa, parts = _compiled(f"spec s = {formula}")
    assert _verdict(Judge(fspa, parts), b"x\n1\n").outcome.accepted == (formula == "true")


def test_a_clamped_value_is_a_warning_with_the_name_of_the_trace() -> None:
    judge = Judge(FSPA, CLAUSES)
    judged = judge.judge("run.csv", _trace(["0,1,0,1", "0,1,1,-5"]))
    assert judged.verdict is not None
    # Each trace has its own warning.
    for count in (1, 200):
        assert judge.judge("run.csv", _trace(["0,1,0,1", *["0,1,1,-5"] * count])).diagnostics == judged.diagnostics
    assert judged.verdict.outcome.accepted
    assert [(warning.code, warning.title.startswith("`run.csv`, step 2: ")) for warning in judged.diagnostics] == [
        ("TLT0615", True)
    ]


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"on_lava,key,out\n0,0,0\n", "TLT0621"),
        (b"on_lava,key,out,heat\n", "TLT0620"),
        (_trace(["0,0,0,warm"]), "TLT0622"),
        (_trace(["0,0,0,1e999"]), "TLT0612"),
        (_trace(["0,0,0,1,0.0", "0,0,0,1,0.3"], "on_lava,key,out,heat,time"), "TLT0623"),
        (b'{"on_lava": 0}\n', "TLT0611"),
    ],
)
def test_a_trace_that_cannot_be_judged_is_an_error(data: bytes, code: str) -> None:
    judged = Judge(FSPA, CLAUSES).judge("trace", data)
    assert judged.verdict is None
    assert [diagnostic.code for diagnostic in judged.diagnostics] == [code]
    assert judged.so_far is None


def test_an_error_after_the_end_of_an_episode_does_not_count() -> None:
    fspa, parts = _compiled(EPISODES)
    for end in ("0", "x,y", "0,nan"):
        for before in ("", "0,0\n"):
            verdict = _verdict(Judge(fspa, parts, episodes=True), f"a,b\n1,0\n{before}{end}\n".encode())
            assert (verdict.outcome.accepted, verdict.outcome.steps) == (True, 1)
    unread = Judge(fspa, parts, episodes=True).judge("trace", b"a,b\n0,0\n0\n")
    assert unread.verdict is None


@pytest.mark.parametrize("end", ["0,1,0", "0,0,0,warm", "0,0,0,nan"])
def test_the_cause_is_known_if_the_samples_before_an_error_break_the_spec(end: str) -> None:
    judged = Judge(FSPA, CLAUSES).judge("trace", _trace(["0,0,0,1", "1,0,0,1", "0,0,0,1", end]))
    assert judged.verdict is None
    assert judged.so_far == RejectionCause("broken", 2, ("avoid on_lava",), ("on_lava",))


EPISODES = "signal a: bool\nsignal b: bool\nspec s { reach a  avoid b  limit 3 steps }"


@pytest.mark.parametrize(
    ("rows", "accepted", "cause"),
    [
        ("00 10 01", True, None),
        ("00 00 00 10", False, RejectionCause("late", 3, ("reach a",))),
        ("00 00 10", True, None),
        ("00 01 10", False, RejectionCause("broken", 2, ("avoid b",), ("b",))),
        ("00 00", False, RejectionCause("unfinished", 2, ("reach a",))),
    ],
)
def test_an_episode_ends_at_its_goal_at_a_violation_or_at_the_limit(
    rows: str, accepted: bool, cause: RejectionCause | None
) -> None:
    fspa, parts = _compiled(EPISODES)
    data = "a,b\n" + "".join(f"{row[0]},{row[1]}\n" for row in rows.split())
    verdict = _verdict(Judge(fspa, parts, episodes=True), data.encode())
    assert (verdict.outcome.accepted, verdict.cause) == (accepted, cause)


@pytest.mark.parametrize(("rows", "accepted"), [("00", False), ("000", True), ("0001", True), ("001", False)])
def test_an_episode_that_is_judged_at_its_limit_has_to_last_until_then(rows: str, accepted: bool) -> None:
    fspa, parts = _compiled("signal b: bool\nspec s { avoid b  limit 3 steps }")
    verdict = _verdict(Judge(fspa, parts, episodes=True), ("b\n" + "\n".join(rows)).encode())
    assert verdict.outcome.accepted == accepted
    assert _verdict(Judge(fspa, parts), ("b\n" + "\n".join(rows)).encode()).outcome.accepted == ("1" not in rows)


@pytest.mark.parametrize("judged_at", ["goal", "limit"])
@pytest.mark.parametrize("semantics", ["finite", "infinite"])
@pytest.mark.parametrize("seed", range(6))
def test_judging_whole_traces_equals_judging_step_by_step(seed: int, semantics: str, judged_at: str) -> None:
    """The fast way, in CSV, and the slow way, in JSON lines, give what :class:`Monitor` gives."""
    random = Random(seed)
    rule = words_text(formula(Draw(seed), ("a", "b", "d"), 5))
    text = "signal a: bool\nsignal b: bool\nsignal c: number in [-1, 1]\npredicate d = c\nexclusive a, b\n"
    options = f"limit 9 steps  semantics {semantics}  judge at {judged_at}"
    fspa, parts = _compiled(f"{text}spec s {{ require {rule}  {options} }}")
    judge, episodes = Judge(fspa, parts), Judge(fspa, parts, episodes=True)
    for _ in range(10):
        samples = [
            {"a": holds == 0, "b": holds == 1, "c": random.uniform(-1.0, 1.2)}
            for holds in random.choices(range(3), k=random.randint(1, 12))
        ]
        csv = "a,b,c\n" + "".join(f"{x['a']},{x['b']},{x['c']!r}\n" for x in samples)
        lines = "".join(
            f'{{"a": {str(x["a"]).lower()}, "b": {str(x["b"]).lower()}, "c": {x["c"]!r}}}\n' for x in samples
        )
        expected = outcome(run(Monitor(fspa), read_trace(io.BytesIO(csv.encode()), "trace", fspa.signals)))
        for data in (csv, lines):
            assert _verdict(judge, data.encode()).outcome == expected
            assert _verdict(episodes, data.encode()).outcome == _episode(fspa, samples)


def _episode(fspa: Fspa, samples: list[dict[str, float]]) -> TraceOutcome:
    """Return the outcome of the samples as an episode, which ends with the last one at the latest."""
    monitor, total = Monitor(fspa), 0.0
    for number, sample in enumerate(samples, start=1):
        step = monitor.step(sample, last=number == len(samples))
        total += step.reward
        if step.done:
            break
    return TraceOutcome(monitor.success, step.verdict, number, step.progress, total)


# --- details --------------------------------------------------------------------------------------


def _details(*rows: str, episodes: bool = False) -> TraceDetails:
    judged = Judge(FSPA, CLAUSES, episodes=episodes, details=True).judge("trace", _trace(rows))
    assert judged.verdict is not None
    assert judged.verdict.details is not None
    return judged.verdict.details


def test_verdicts_have_no_details_unless_asked_for() -> None:
    judged = Judge(FSPA, CLAUSES).judge("trace", _trace(["0,0,0,1"]))
    assert judged.verdict is not None
    assert judged.verdict.details is None


def test_the_details_have_the_states_and_the_nearest_sample() -> None:
    """Before the violation, the trace waits for ``out``; no sample of this stay comes nearer than the others."""
    details = _details("0,0,0,1", "0,1,0,1", "0,1,0,1", "0,1,0,9", "0,1,1,1")
    (start, at_start), (waiting, since), (violated, at) = details.arrivals
    assert (start, at_start, since, at) == (0, 0, 2, 4)
    assert FSPA.states[violated].verdict == "violated"
    assert details.unmet == waiting
    assert details.nearest is not None
    assert (FSPA.atoms[details.nearest.atom].name, details.nearest.wanted, details.nearest.row) == ("out", True, 1)


def test_an_accepted_trace_has_no_nearest_sample() -> None:
    details = _details("0,1,0,1", "0,0,1,1")
    assert details.nearest is None
    assert FSPA.states[details.unmet].accepting


@pytest.mark.parametrize("part", range(4))
def test_the_arrivals_are_those_of_the_monitor(part: int) -> None:
    """Both ways of running a trace, step by step and generated, report the states that the monitor enters."""
    random = Random(part)
    rows = [",".join(str(int(random.random() < share)) for share in (0.02, 0.1, 0.1)) + ",1" for _ in range(40)]
    monitor = Monitor(FSPA)
    states = [0, *(monitor.step(sample).state for sample in _samples(rows))]
    expected = tuple((state, at) for at, state in enumerate(states) if at == 0 or states[at - 1] != state)
    judge = Judge(FSPA, CLAUSES, details=True)
    for _ in range(6):
        judged = judge.judge("trace", _trace(rows))
        assert judged.verdict is not None
        assert judged.verdict.details is not None
        assert judged.verdict.details.arrivals == expected


def _samples(rows: Iterable[str]) -> Iterable[dict[str, float]]:
    return read_trace(io.BytesIO(_trace(rows)), "trace", FSPA.signals, None)


def test_the_nearest_sample_is_the_last_of_equally_near_ones() -> None:
    """The door stays shut although both crystals are taken: the door is missing, not the first crystal."""
    signals = "".join(f"signal {name}: bool\n" for name in ("red", "blue", "door"))
    text = signals + "spec go { limit 9 steps\n reach red and blue and door }"
    (fspa,) = compile_text(text)
    rows = [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, -1.0]]
    nearest = nearest_edge(fspa, 0, rows)
    assert nearest is not None
    assert (nearest.row, fspa.atoms[nearest.atom].name, nearest.wanted, nearest.reached) == (2, "door", True, False)
    swapped = nearest_edge(fspa, 0, [[1.0, -1.0, 1.0], [-1.0, 1.0, 1.0]])
    assert swapped is not None and (fspa.atoms[swapped.atom].name, swapped.reached) == ("red", True)


MEMORY = """
clock 10 Hz
signal seen: bool
signal hidden: bool
spec sneak { keep times(seen) <= 1  reach time_holding(hidden) >= 0.5 s  reach once seen }
"""


def test_clauses_about_the_trace_so_far_are_judged_from_its_first_sample() -> None:
    judge = Judge(*_compiled(MEMORY), details=True)
    rows = ["1,0", "0,1", "1,1", "0,0"]
    cause = _verdict(judge, _trace(rows, "seen,hidden")).cause
    assert cause == RejectionCause(
        "broken",
        3,
        ("keep times(seen) <= 1",),
        ("times(seen) > 1",),
        Measure("times(seen)", 2.0, 1.0, ""),
        ("seen more than once",),
    )
    verdict = _verdict(judge, _trace(["1,0", *["0,1"] * 4, "0,0"], "seen,hidden"))
    assert verdict.cause == RejectionCause("unfinished", 6, ("reach time_holding(hidden) >= 0.5 s",))
    assert verdict.details is not None
    assert verdict.details.missed is not None
    assert verdict.details.missed == Measure("time_holding(hidden)", 0.3, verdict.details.missed.gap, "s")
    assert verdict.details.missed.gap == pytest.approx(0.2)
