"""Check whether a policy fits a level and a spec."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import isclose
from typing import Any, Final

from gymnasium import spaces

from tltl_runtime.game.level import Level
from tltl_runtime.policies.card import OBSERVATION, Card
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.policies.spaces.layouts import SpaceLayouts, space_layouts
from tltl_runtime.policies.spaces.observation_layout import ObservationPart
from tltl_runtime.support.number_text import short_list
from tltlc.api import Diagnostic, Fspa, TltlError, label_text, monitors

_MOST: Final = 3
"""A message names at most this many differences."""

_OWN_GAME: Final = "let it play its own game, or train a policy for this one"


def check_policy(card: Card, level: Level, fspa: Fspa | None = None) -> None:
    """Check that a policy can play ``level`` by the spec ``fspa``.

    If ``fspa`` is None, the policy plays by the spec that it was trained for. Any variant of the
    policy's own level fits. Another level fits if it has everything that the policy observes.
    Another spec fits if it judges episodes in the same way as that of the training; its name does
    not matter.

    Raises:
        TltlError: TLT0843, the policy does not fit; the message says what differs.
    """
    if card.observation != OBSERVATION:
        age = "a newer" if card.observation > OBSERVATION else "an older"
        suggestion = "use that tltlc, or train a policy with this one"
        raise _unfit_error(f"the policy was trained with {age} tltlc, whose agents observe other things", suggestion)
    game = level.game
    if card.spaces is None and game.branches and card.branches != game.branches:
        own, sizes = _sizes(card.branches), _sizes(game.branches)
        raise _unfit_error(f"the policy chooses among {own} actions, and the game has {sizes}")
    clock_s = game.clock_s(level)
    if clock_s and card.fspa.clock_s and not isclose(clock_s, card.fspa.clock_s, rel_tol=1e-9):
        raise other_clock_error(card, level, f"{monitors.number_text(clock_s)} s")
    missing = [*game.missing_sensors(level, card.sensors)]
    if missing:
        title = f"the policy senses {short_list(missing, _MOST)}, which the level `{level.name}` does not have"
        suggestion = f"let it play `{card.level}`, where it was trained"
        if card.level == level.name:
            suggestion = "put back what was there when it was trained"
        raise _unfit_error(title, f"{suggestion}, or train one for `{level.name}`")
    if fspa is not None and spec_hash(fspa) != spec_hash(card.fspa):
        title = f"the policy was trained for another spec than `{fspa.name}`: {differences(card.fspa, fspa)}"
        raise _unfit_error(title, "let it play its own spec, or train one for this spec")


def other_clock_error(card: Card, level: Level, step: str = "another time") -> TltlError:
    """Return the error TLT0843 for a level whose steps take another time than those of the training.

    ``step`` says how long a step of the level takes.
    """
    own = "" if card.fspa.clock_s is None else f", whose steps take {monitors.number_text(card.fspa.clock_s)} s"
    title = f"the policy was trained for `{card.level}:{card.variant}`{own}"
    return _unfit_error(f"{title}; it cannot play `{level.name}:{level.variant}`, whose steps take {step}", _OWN_GAME)


def check_spaces(card: Card, observation: spaces.Space[Any], action: spaces.Space[Any]) -> None:
    """Check that a policy can play in an environment with these spaces.

    Raises:
        TltlError: TLT0843, the policy was trained with other spaces; the message names what
            differs. TLT0844, policies do not support one of the spaces.
    """
    layouts = space_layouts(observation, action, card.sensors)
    if layouts is None and card.spaces is None:
        assert isinstance(observation, spaces.Dict)
        assert isinstance(action, spaces.MultiDiscrete)
        own = {key: space.shape for key, space in observation.items()}, action.nvec.tolist()
        if own == (dict(card.shapes), list(card.branches)):
            return
    if layouts is None or card.spaces is None:
        title = f"the policy was trained for `{card.level}` of another game"
        raise _unfit_error(f"{title}, whose observations or actions are of other kinds", _OWN_GAME)
    before, after = _parts_by_key(card.spaces), _parts_by_key(layouts)
    wrong = [f"another observation `{key}`" for key in {**before, **after} if before.get(key) != after.get(key)]
    wrong += ["another action"] if card.spaces.action != layouts.action else []
    if wrong:
        title = f"the policy was trained for `{card.level}` of another game: {short_list(wrong, _MOST)}"
        raise _unfit_error(title, _OWN_GAME)


def _parts_by_key(layouts: SpaceLayouts) -> dict[str, ObservationPart]:
    return {part.key: part for part in layouts.observation}


def differences(own: Fspa, fspa: Fspa) -> str:
    """Describe how the spec ``fspa`` differs from the spec ``own``, for a message.

    The two specs must judge episodes differently. Differences in what a designer wrote, such as the
    limit or an atom, come before differences in the automaton.
    """
    return short_list([*_differences(own, fspa)], _MOST)


def _differences(own: Fspa, fspa: Fspa) -> Iterator[str]:
    if own.judge != fspa.judge:
        yield f"it is judged at the {fspa.judge}, and was judged at the {own.judge}"
    if own.limit_steps != fspa.limit_steps:
        yield f"its limit is {_limit(fspa)}, and was {_limit(own)}"
    if (own.clock_s, own.clock_varies) != (fspa.clock_s, fspa.clock_varies):
        yield "its clock is different"
    yield from _differing("signal", _field_by_name(own.signals, "name"), _field_by_name(fspa.signals, "name"))
    yield from _differing("param", _field_by_name(own.params, "value"), _field_by_name(fspa.params, "value"))
    before, after = _field_by_name(own.atoms, "expression"), _field_by_name(fspa.atoms, "expression")
    yield from _differing("atom", before, after)
    memory = [{register.name: register for register in spec.registers} for spec in (own, fspa)]
    yield from _differing("register", *memory)
    if len(own.states) != len(fspa.states):
        yield f"its automaton has {len(fspa.states)} states, and had {len(own.states)}"
    elif list(before) != list(after):
        yield "its atoms are in another order"
    elif list(memory[0]) != list(memory[1]):
        yield "its registers are in another order"
    elif before == after:
        yield from _states(own, fspa)


def _field_by_name(parts: Iterable[Any], field: str) -> dict[str, Any]:
    return {part.name: getattr(part, field) for part in parts}


def _differing(kind: str, before: Mapping[str, Any], after: Mapping[str, Any]) -> Iterator[str]:
    yield from (f"the {kind} `{name}` is new" for name in after if name not in before)
    yield from (f"the {kind} `{name}` is gone" for name in before if name not in after)
    for name in after:
        if name in before and before[name] != after[name]:
            is_number = isinstance(after[name], float)
            change = f"is {after[name]!r}, and was {before[name]!r}" if is_number else "means something else"
            yield f"the {kind} `{name}` {change}"


def _states(before: Fspa, after: Fspa) -> Iterator[str]:
    """Yield a text for each automaton state that is judged differently, or has other edges, in ``after``.

    Yield one more text if the two specs declare different atoms as exclusive. Their automata must
    have the same number of states.
    """
    for old, new in zip(before.states, after.states, strict=True):
        judged = (old.accepting, old.verdict, old.distance) == (new.accepting, new.verdict, new.distance)
        primes = [[(edge.target, edge.guard.primes) for edge in fspa.edges_from(new.id)] for fspa in (before, after)]
        if not judged or primes[0] != primes[1]:
            yield f"the state {new.id} (`{label_text(after, new.id)}`) is different"
    if before.exclusive != after.exclusive:
        yield "other atoms are exclusive"


def _limit(fspa: Fspa) -> str:
    return "none" if fspa.limit_steps is None else f"{fspa.limit_steps} steps"


def _sizes(branches: tuple[int, ...]) -> str:
    return " x ".join(map(str, branches))


def _unfit_error(title: str, help_: str = "train a policy with this tltlc") -> TltlError:
    return TltlError([Diagnostic("TLT0843", title, help=help_)])
