from __future__ import annotations

import math
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fixtures import cover_and_hide
from tests.logic.strategies import formulas
from tests.monitor.strategies import atom_traces, automata, values
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.expression.tree import Const, Expression, Op, SignalValue
from tltlc.logic import formula as f
from tltlc.logic.oracle import holds as oracle
from tltlc.monitor import Monitor, MonitorError
from tltlc.monitor.guards import bounding_atom, holds, prime_robustness, robustness
from tltlc.resolve import spec

FAR = {"distance(s1)": 20.0, "distance(s2)": 20.0, "distance(exit)": 20.0, "health": 1.0}


def rejection(monitor: Monitor, sample: dict[str, object]) -> tuple[str, str]:
    """Return the code and title of the error for a sample, and assert that the monitor is unchanged."""
    before = (monitor.state, monitor.steps, monitor.progress, monitor.done)
    with pytest.raises(MonitorError) as caught:
        monitor.step(sample)  # type: ignore[arg-type]
    assert (monitor.state, monitor.steps, monitor.progress, monitor.done) == before
    (diagnostic,) = caught.value.diagnostics
    return diagnostic.code, diagnostic.title


def with_atom(expression: Expression) -> Fspa:
    """Return ``F p``, where p has this expression over the signal x."""
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    return replace(fspa, signals=(spec.Signal("x", "number", None, None),), atoms=(spec.Atom("p", expression),))


# --- laws -----------------------------------------------------------------------------------------


@given(formulas(), st.data())
def test_monitor_agrees_with_the_oracle(formula: f.Formula, data: st.DataObject) -> None:
    fspa = build(spec_from_formula(formula))
    monitor = Monitor(fspa)
    names = [atom.name for atom in fspa.atoms]
    trace = []
    for sample in data.draw(atom_traces(fspa)):
        step = monitor.step(dict(zip(names, sample, strict=True)))
        trace.append({name for name, value in zip(names, sample, strict=True) if value > 0})
        assert step.accepting == oracle(formula, trace)
        assert step.accepting == (step.verdict in ("satisfied", "holding"))


@given(automata(), st.data())
def test_exactly_one_guard_is_true_and_its_robustness_agrees(fspa: Fspa, data: st.DataObject) -> None:
    (sample,) = data.draw(atom_traces(fspa, max_size=1))
    for state in fspa.states:
        edges = fspa.edges_from(state.id)
        true = [edge for edge in edges if holds(edge.guard, sample)]
        assert len(true) == 1
        for edge in edges:
            if edge in true:
                assert robustness(edge.guard, sample) >= 0
            else:
                assert robustness(edge.guard, sample) <= 0


@given(automata(), st.data())
def test_the_limiting_atom_bounds_the_nearest_improving_edge(fspa: Fspa, data: st.DataObject) -> None:
    monitor = Monitor(fspa)
    for sample in data.draw(atom_traces(fspa)):
        source = monitor.state
        step = monitor.step_atoms(sample)
        distance = fspa.states[source].distance
        improving = [
            edge.guard
            for edge in fspa.edges_from(source)
            if distance and (fspa.states[edge.target].distance or 0) < distance
            if fspa.states[edge.target].distance is not None
        ]
        if step.state != source or not improving:
            assert step.limiting is None
            continue
        atom = next(index for index, atom in enumerate(fspa.atoms) if atom.name == step.limiting)
        nearest = max(robustness(guard, sample) for guard in improving)
        assert abs(sample[atom]) == abs(nearest)
        # A prime with the robustness of the nearest guard contains this atom.
        primes = [prime for guard in improving for prime in guard.primes if atom in dict(prime)]
        assert any(prime_robustness(prime, sample) == nearest for prime in primes)


def test_the_first_of_tied_atoms_is_limiting() -> None:
    fspa = build(spec_from_formula(f.eventually(f.and_(f.atom("a"), f.not_(f.atom("b"))))))
    guard = fspa.edges_from(0)[1].guard
    assert fspa.atoms[bounding_atom([guard], (-0.5, 0.5))].name == "a"


# --- steps ----------------------------------------------------------------------------------------


def test_health_of_zero_counts_as_death() -> None:
    """At 0 the robustness of `alive` equals that of `not alive`, but only `not alive` is true."""
    step = Monitor(cover_and_hide()).step({**FAR, "health": 0.0})
    assert (step.state, step.verdict, step.robustness) == (2, "violated", 0.0)
    assert math.copysign(1.0, step.robustness) == 1.0


def test_a_step_describes_the_state_the_edge_and_the_limiting_atom() -> None:
    step = Monitor(cover_and_hide()).step({**FAR, "distance(s1)": 10.5, "health": 0.875})
    assert step.label == str(cover_and_hide().states[0].label)
    assert (step.state, step.verdict, step.accepting, step.done) == (0, "pending", False, False)
    assert (step.robustness, step.limiting) == (0.75, "near(s1)")


def test_after_a_reset_the_same_samples_give_the_same_steps() -> None:
    monitor = Monitor(cover_and_hide())
    first = [monitor.step({**FAR, "distance(s1)": 0.5}), monitor.step({**FAR, "health": 0})]
    monitor.reset()
    assert [monitor.step({**FAR, "distance(s1)": 0.5}), monitor.step({**FAR, "health": 0})] == first


def test_unused_signals_and_other_number_types_are_accepted() -> None:
    monitor = Monitor(with_atom(SignalValue("x")))
    assert monitor.step({"x": True, "y": math.nan}).accepting
    assert Monitor(with_atom(SignalValue("x"))).step({"x": 1}).accepting


# --- invalid samples ------------------------------------------------------------------------------


def test_missing_signals_are_all_named() -> None:
    code, title = rejection(Monitor(cover_and_hide()), {"distance(s1)": 1.0, "health": 1.0})
    assert (code, title) == ("TLT0611", "step 1: no value for `distance(s2)` and `distance(exit)`")


@pytest.mark.parametrize(
    ("value", "remark"),
    [
        (math.nan, "is nan, not a finite number"),
        (-math.inf, "is -inf, not a finite number"),
        ("1.0", "is not a number"),
        (None, "is not a number"),
        (10**400, "is too large for a number"),
    ],
)
def test_a_signal_without_a_finite_value_is_named(value: object, remark: str) -> None:
    monitor = Monitor(cover_and_hide())
    monitor.step(FAR)
    assert rejection(monitor, {**FAR, "health": value}) == ("TLT0612", f"step 2: the signal `health` {remark}")


def test_a_bool_must_be_true_or_false() -> None:
    fspa = replace(with_atom(SignalValue("x")), signals=(spec.Signal("x", "bool", 0.0, 1.0),))
    monitor = Monitor(fspa)
    assert rejection(monitor, {"x": 0.5}) == ("TLT0612", "step 1: the signal `x` is 0.5, not true or false")
    assert not monitor.step({"x": False}).accepting
    assert monitor.step({"x": 1.0}).accepting


def test_values_out_of_range_are_clamped_and_reported_once() -> None:
    monitor = Monitor(cover_and_hide())
    steps = [monitor.step({**FAR, "health": health, "distance(s1)": -1.0}) for health in (1.5, 2.0)]
    exact = Monitor(cover_and_hide())
    assert steps == [exact.step({**FAR, "distance(s1)": 0.0}) for _ in range(2)]
    assert [notice.title for notice in monitor.notices] == [
        "step 1: the signal `distance(s1)` is -1, outside [0, inf]: it counts as 0",
        "step 1: the signal `health` is 1.5, outside [0, 1]: it counts as 1",
    ]
    assert {(notice.code, notice.severity) for notice in monitor.notices} == {("TLT0615", "warning")}


@pytest.mark.parametrize(
    ("expression", "remark"),
    [
        (Op("/", (Const(1.0), SignalValue("x"))), "divides by zero"),
        (Op("exp", (Const(1e4),)), "is too large to compute"),
        (Op("*", (Const(1e300), Const(1e300))), "is too large to compute"),
        (Op("sqrt", (Const(-1.0),)), "takes a root or power that does not exist"),
    ],
)
def test_an_atom_without_a_value_is_named(expression: Expression, remark: str) -> None:
    assert rejection(Monitor(with_atom(expression)), {"x": 0.0}) == ("TLT0613", f"step 1: the atom `p` {remark}")


def test_an_atom_out_of_its_range_is_clamped() -> None:
    monitor = Monitor(with_atom(Op("*", (Const(3.0), SignalValue("x")))))
    assert monitor.step({"x": -1.0}).robustness == 1.0
    assert monitor.step({"x": 1.0}).robustness == 1.0
    (notice,) = monitor.notices
    assert (notice.code, notice.title) == ("TLT0616", "step 1: the atom `p` is -3, outside [-1, 1]: it counts as -1")
    rounded = Monitor(with_atom(Op("+", (Const(1e-15), SignalValue("x")))))
    assert (rounded.step({"x": 1.0}).robustness, rounded.notices) == (1.0, [])


def test_exclusive_atoms_that_hold_at_once_are_named() -> None:
    sample = {**FAR, "distance(s1)": 0.0, "distance(exit)": 0.0}
    code, title = rejection(Monitor(cover_and_hide()), dict(sample))
    assert code == "TLT0614"
    assert title == (
        "step 1: `near(s1)` and `near(exit)` hold at once, against `exclusive near(s1), near(s2), near(exit)`"
    )


@pytest.mark.parametrize("sample", [(math.nan,), (math.inf,), (1.5,), (), (1.0, 1.0)])
def test_invalid_values_of_atoms_are_rejected(sample: tuple[float, ...]) -> None:
    monitor = Monitor(with_atom(SignalValue("x")))
    with pytest.raises(ValueError, match="one value in"):
        monitor.step_atoms(sample)
    assert monitor.steps == 0


# --- params ---------------------------------------------------------------------------------------


def test_params_override_the_values_of_the_spec() -> None:
    step = Monitor(cover_and_hide(), {"level_size": 10.0}).step({**FAR, "distance(s1)": 5.5})
    assert step.progress == pytest.approx(0.25 / 3)


@pytest.mark.parametrize(
    ("params", "code", "text"),
    [
        ({"size": 1.0}, "TLT0308", "there is no param `size` to set"),
        ({"level_size": 1.0}, "TLT0307", "the param `level_size` cannot be 1: its range is [2, 10000]"),
        ({"level_size": math.nan}, "TLT0308", "the param `level_size` cannot be nan"),
        ({"level_size": "3"}, "TLT0308", "the value given for the param `level_size` is not a number"),
    ],
)
def test_invalid_params_are_rejected(params: dict[str, float], code: str, text: str) -> None:
    with pytest.raises(MonitorError) as caught:
        Monitor(cover_and_hide(), params)
    assert [(diagnostic.code, diagnostic.title) for diagnostic in caught.value.diagnostics] == [(code, text)]
    assert caught.value.diagnostics[0].help


@given(st.tuples(values, values, values))
def test_a_guard_is_true_where_its_robustness_is_positive(sample: tuple[float, ...]) -> None:
    """This holds for every guard with one prime over three atoms."""
    fspa = build(spec_from_formula(f.eventually(f.and_(*map(f.atom, "abc")))))
    for signs in product([True, False], repeat=3):
        guard = replace(fspa.edges[0].guard, primes=(tuple(enumerate(signs)),))
        if robustness(guard, sample) != 0:
            assert holds(guard, sample) == (robustness(guard, sample) > 0)
