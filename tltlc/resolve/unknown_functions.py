"""Help with calls of functions that do not exist, or not with these arguments."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Fix, replacement_fix
from tltlc.grammar.past_words import FUNCTIONS, PastWord
from tltlc.grammar.tree import CallExpr, Expr, GroupExpr, NameExpr, NumberExpr, SignalDecl
from tltlc.resolve.values import Env

_CHANGES: Final = ("changed", "changes", "change", "has_changed", "did_change")
_DIFFERENCES: Final = ("delta", "diff", "difference")
_EDGES: Final = ("begins ", "ends ")
_LIKE: Final = 0.6
"""How like a name must be to that of a function, from 0 to 1."""
_AGGREGATES: Final = frozenset("mean average avg median sum integral std variance rms moving rolling".split())
"""Words in the names of functions that put many values together, as the language cannot."""
_WINDOWS: Final = frozenset("within window last past recent over sliding".split())
_PUT_TOGETHER: Final = frozenset("highest lowest max min maximum minimum peak total time duration held".split())
"""With a word for a window, these are functions of the last seconds: `total_time_within`, `max_in_last`."""
_OF_WINDOWS: Final = {
    "highest_within": frozenset(("highest", "max", "maximum", "peak")),
    "lowest_within": frozenset(("lowest", "min", "minimum")),
    "total_time_within": frozenset(("time", "duration", "held")),
}
"""Words in other names of the functions of the last seconds."""
_BETWEEN: Final = frozenset(("between", "apart", "gap", "interval"))
"""Words in the names of functions for the time between two events."""
_MOST_NAMED: Final = 2
"""The most functions that a help names with their meaning."""


def function_help(call: CallExpr, env: Env) -> tuple[str, tuple[Fix, ...]] | None:
    """Return the help for a call of an unknown function, and its fixes; None if a predicate may be meant.

    The arguments of a predicate that is still to be declared are mostly entities.
    """
    if not call.arguments or not any(_is_value(argument.value, env) for argument in call.arguments):
        return None
    written = _in_other_words(call, env)
    if written is not None:
        return f"write `{written}`", (replacement_fix(env.scope.source, call.span, written),)
    if _is_of_window(call):
        known = _known_within(call, env)
        fixes = (replacement_fix(env.scope.source, call.span, known),) if known else ()
        return (f"write `{known}`", fixes) if known else (_window_help(call, env), ())
    apart = _apart_help(call, env)
    if apart:
        return apart, ()
    near = _near(call.name)
    if near:
        return "; or ".join(f"`{word.forms[0]}` may be meant: {word.meaning.rstrip('.')}" for word in near), ()
    forms = ", ".join(f"`{word.forms[0]}`" for word in FUNCTIONS.values())
    return f"the functions of the trace so far are {forms}; p and q are true or false, and x is a number", ()


def _apart_help(call: CallExpr, env: Env) -> str:
    """Return the help for `time_between(a, b)`, the time between two events; "" for other functions."""
    words, count = set(call.name.lower().split("_")), len(call.arguments)
    if not words & _BETWEEN or count not in (1, 2):
        return ""
    first, second = (env.scope.source.slice(call.arguments[at].value.span) for at in (0, count - 1))
    if first == second:
        state = first if first.isidentifier() else f"({first})"
        event = first if first.startswith(_EDGES) else f"begins {state}"
        return (
            f"no function is the time between two `{first}`: for more than 3 s between them, write "
            f"`avoid ({event}) then within 3 s ({event})`, and for less `keep time_holding(not {state}) < 3 s`"
        )
    return (
        f"no function is the time between `{first}` and `{second}`: at `{second}`, `time_since({first})` is the time "
        "since the last step with it"
    )


def _is_of_window(call: CallExpr) -> bool:
    """Whether a name is that of a function of many values: `mean`, `total_time_within`, `max_in_last`."""
    words = set(call.name.lower().split("_"))
    return bool(words & _AGGREGATES or (words & _WINDOWS and words & _PUT_TOGETHER))


def _known_within(call: CallExpr, env: Env) -> str:
    """Return `highest_within(x, 5 s)` for a function of the same under another name, else ""."""
    words = set(call.name.lower().split("_"))
    length = call.arguments[1].value if len(call.arguments) == 2 else None
    name = next((name for name, others in _OF_WINDOWS.items() if words & others), "")
    if not name or words & _AGGREGATES or not isinstance(length, NumberExpr) or length.unit is None:
        return ""
    return f"{name}({', '.join(env.scope.source.slice(argument.value.span) for argument in call.arguments)})"


def _window_help(call: CallExpr, env: Env) -> str:
    argument, name = call.arguments[0].value, call.name.lower()
    of = argument.name if isinstance(argument, NameExpr) else ""
    signal = f"{of}_{name}" if of else name
    is_time = "time" in name or "duration" in name or "held" in name
    limit = (
        "no function puts the values of several steps together but `highest_within(x, 5 s)`, `lowest_within(x, 5 s)` "
        "and `total_time_within(p, 5 s)`"
    )
    range_ = ": time in [0 s, 60 s]" if is_time else _range_text(of, env) or " in [0, 100]"
    return f"{limit}: let the game record that number as a signal, such as `signal {signal}{range_}`, and compare that"


def _range_text(name: str, env: Env) -> str:
    """Return the type and the range of the signal with a name as they are declared; "" if it is no such signal."""
    binding = env.scope.names.get(name)
    declaration = binding.declaration if binding is not None else None
    if not isinstance(declaration, SignalDecl) or declaration.interval is None:
        return ""
    type_ = f": {declaration.type}" if declaration.type else ""
    return f"{type_} {env.scope.source.slice(declaration.interval.span)}"


def _is_value(argument: Expr, env: Env) -> bool:
    """Whether an argument is a number or a formula: anything but the name of an entity, or of nothing."""
    if not isinstance(argument, NameExpr):
        return True
    binding = env.scope.names.get(argument.name)
    return binding is not None and binding.kind not in ("entity", "group")


def _near(name: str) -> list[PastWord]:
    """Return the functions whose names are like a name, or share a word with it, best first."""
    from difflib import get_close_matches

    known = get_close_matches(name.lower(), FUNCTIONS, n=_MOST_NAMED, cutoff=_LIKE)
    words = set(name.lower().split("_"))
    known += [other for other in FUNCTIONS if other not in known and len(words & set(other.split("_"))) > 0]
    return [FUNCTIONS[other] for other in known[:_MOST_NAMED]]


def _in_other_words(call: CallExpr, env: Env) -> str | None:
    """Return what says the same as ``changed(x)`` or ``delta(x)`` of a signal; None for other functions."""
    if len(call.arguments) != 1:
        return None
    argument = call.arguments[0].value
    while isinstance(argument, GroupExpr):
        argument = argument.inner
    binding = env.scope.names.get(argument.name) if isinstance(argument, NameExpr) else None
    declared = None if binding is None else binding.declaration
    if not isinstance(declared, SignalDecl) or declared.values or not isinstance(argument, NameExpr):
        return None
    x = argument.name
    if call.name.lower() in _DIFFERENCES:
        return None if declared.type == "bool" else f"({x} - previous({x}))"
    if call.name.lower() not in _CHANGES:
        return None
    if declared.type == "bool":
        return f"(begins {x} or ends {x})"
    return f"{x} != previous({x})" if declared.type == "int" else f"({x} < previous({x}) or {x} > previous({x}))"
