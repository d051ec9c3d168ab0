"""Look names up and classify expressions as entities, numbers or formulas."""

from __future__ import annotations

import re
from typing import Literal

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Fix, replacement_fix
from tltlc.grammar import past_words, tree
from tltlc.grammar.keywords import CONDITIONS
from tltlc.grammar.mistakes.insertion import declaration_edit
from tltlc.grammar.tree import CallExpr, Expr, GroupDecl, GroupExpr, LetDecl, NameExpr, SignalDecl
from tltlc.grammar.walk import parts
from tltlc.resolve import units
from tltlc.resolve.enums import enum_as_formula_error, enum_of
from tltlc.resolve.imports import library_with
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.scope import FUNCTIONS, MEMORY_FUNCTIONS, Binding, BindingKind, closest_name
from tltlc.resolve.unknown_functions import function_help
from tltlc.resolve.values import Entity, Env, Quantity, Unknown

_FORMULA_OPERATORS = (
    *("and", "or", "implies", "iff", "U", "W", "R", "M", "since", "then", "within"),
    *("<", "<=", ">", ">=", "==", "!="),
)

_MOST_LETTERS = 4
"""The most operator letters that may stand directly in front of a name, as in ``FGgoal``."""
_MOST_NAMES = 5
"""The most entities that a message lists."""
_MOST_HINTS = 50
_SINCE = re.compile(r"\s+since\s+(?:the\s+)?(?:last\s+)?(\w+)")
"""After this many logged problems, unknown names get no suggestions, because finding them is slow."""
_DECLARATIONS = {
    "predicate": "signal {name}: bool",
    "signal or param": "signal {name} in [0, 100]",
    "entity": "entity {name}",
    "group": "entity {name} = a, b",
}
"""Maps what an unknown name is used as to the declaration that the error suggests.

The error suggests a declaration if the name resembles no known name.
"""


def lookup(use: NameExpr | CallExpr, env: Env, kinds: tuple[BindingKind, ...], noun: str) -> Binding:
    """Return the binding of a name: its declaration and scope.

    A binding of any kind is returned. Raises ResolutionError (TLT0201) if the name is unknown. The
    error suggests a similar name of one of ``kinds``, and calls the missing name a ``noun``: "no
    predicate `foo` here". If a failed import may have declared the name, the error has no diagnostic.
    """
    binding = env.scope.names.get(use.name)
    if binding is not None:
        return binding
    if env.scope.incomplete:
        raise ResolutionError(None)
    span = use.name_span if isinstance(use, CallExpr) else use.span
    if use.name in CONDITIONS and isinstance(use, CallExpr):
        raise problem(
            "TLT0201",
            f"the language has no word `{use.name}`",
            env.scope.source,
            span,
            advice="for `if a, then b`, write `a implies b`; if both must hold at the same step, write `a and b`",
        )
    title, source = f"no {noun} `{use.name}` here", env.scope.source
    if use.name in MEMORY_FUNCTIONS and isinstance(use, NameExpr):
        form = past_words.FUNCTIONS[use.name].forms[0]
        raise problem("TLT0201", title, source, span, advice=f"for the function, write `{form}`")
    if use.name == "time" and source.text[span.end :].lstrip().startswith("since "):
        advice = "`time_since` is one word: write it as in `time_since(p) < 5 s`"
        time_fixes: tuple[Fix, ...] = ()
        event = _SINCE.match(source.text, span.end)
        if event is not None and event[1] in env.scope.names:
            text = f"time_since({event[1]})"
            advice = f"`time_since` is one word: write `{text}`"
            time_fixes = (replacement_fix(source, Span(span.start, event.end()), text),)
        raise problem("TLT0201", title, source, span, advice=advice, fixes=time_fixes)
    if use.name == "time" and isinstance(use, NameExpr):
        advice = (
            "`total_time(true)` is the time so far; for a time that the game records, declare it: "
            "`signal time: time in [0 s, 600 s]`"
        )
        raise problem("TLT0201", title, source, span, advice=advice)
    gets_help = len(env.context.log) < _MOST_HINTS
    past = past_words.SYNONYMS.get(use.name) if isinstance(use, CallExpr) and 1 <= len(use.arguments) <= 2 else None
    if past and not closest_name(use.name, env.scope, kinds, env.local):
        word = past_words.FUNCTIONS.get(past) or past_words.OPERATORS[past]
        advice = f"`{word.forms[0]}` may be meant: {word.meaning}"
        raise problem("TLT0201", title, source, span, advice=advice, fixes=_past_fixes(use, past, noun, env))
    spaced = _split_operator_letters(use.name, env, kinds) if gets_help and noun == "predicate" else None
    if spaced:
        raise problem(
            "TLT0201", title, source, span, f"did you mean `{spaced}`?", fixes=(replacement_fix(source, span, spaced),)
        )
    if source.text[: span.start].endswith("-- "):
        raise problem("TLT0201", title, source, span, advice="comments begin with `//`")
    constant = use.name.lower()
    if noun == "predicate" and constant in ("true", "false"):
        hint = f"did you mean `{constant}`?"
        raise problem("TLT0201", title, source, span, hint, fixes=(replacement_fix(source, span, constant),))
    if noun == "predicate" and isinstance(use, NameExpr):
        _refuse_enum_value(use, title, env)
    suggestion = closest_name(use.name, env.scope, kinds, env.local) if gets_help else None
    if suggestion:
        binding = env.scope.names.get(suggestion)
        via = f" (from {binding.via})" if binding and binding.via else ""
        hint = f"did you mean `{suggestion}`{via}?"
        raise problem("TLT0201", title, source, span, hint, fixes=(replacement_fix(source, span, suggestion),))
    library = library_with(use.name)
    unknown = function_help(use, env) if isinstance(use, CallExpr) and not library else None
    if unknown is not None:
        title = f"there is no function `{use.name}`"
        raise problem("TLT0201", title, source, span, advice=unknown[0], fixes=unknown[1])
    line = f"import {library}" if library else _DECLARATIONS[noun].format(name=use.name)
    if library:
        advice = f"`{use.name}` is in the library {library}: add `{line}`"
    else:
        advice = f"declare it: `{line}`" if noun in ("entity", "group") else _OTHERWISE.format(line)
    fixes: tuple[Fix, ...] = ()
    # A call would need a declaration with parameters, which this fix does not offer.
    if gets_help and (library or isinstance(use, NameExpr)):
        fixes = (Fix(f"{'Add' if library else 'Declare'} `{line}`", (declaration_edit(env.scope.module, line),)),)
    raise problem("TLT0201", title, source, span, advice=advice, fixes=fixes)


def _past_fixes(use: NameExpr | CallExpr, word: str, noun: str, env: Env) -> tuple[Fix, ...]:
    """Return the fix for a function of another language: `previous(x)` for a number, `previously p` for a bool.

    A count has none: `count(p)` may count the samples with p.
    """
    argument = use.arguments[0].value if isinstance(use, CallExpr) else None
    if not isinstance(use, CallExpr) or not isinstance(argument, NameExpr) or word == "times":
        return ()
    binding, source = env.scope.names.get(argument.name), env.scope.source
    declaration = None if binding is None else binding.declaration
    if not isinstance(declaration, SignalDecl) or declaration.values:
        return ()
    if noun == "predicate":
        operator = "previously" if word == "previous" else word
        is_clear = declaration.type == "bool" and operator in past_words.OPERATORS
        return (replacement_fix(source, use.span, f"{operator} {argument.name}"),) if is_clear else ()
    is_number = declaration.type != "bool" and word in (
        "previous",
        "highest",
        "lowest",
        "highest_since",
        "lowest_since",
    )
    return (replacement_fix(source, use.name_span, word),) if is_number else ()


_OTHERWISE = "declare it, e.g. `{}`, or import the library that has it"


def _refuse_enum_value(use: NameExpr, title: str, env: Env) -> None:
    """Raise ResolutionError (TLT0201) if an unknown name is a value of an enum: for `alert`, write `mode is alert`."""
    enums = {
        name: binding.declaration
        for name, binding in env.scope.names.items()
        if isinstance(binding.declaration, SignalDecl)
        and use.name in (value.name for value in binding.declaration.values)
    }
    if not enums:
        return
    texts = [
        f"{name}({', '.join(parameter.name for parameter in enum.parameters)})" if enum.parameters else name
        for name, enum in enums.items()
    ]
    text, advice = f"{texts[0]} is {use.name}", f"`{use.name}` is a value of {' and of '.join(f'`{x}`' for x in texts)}"
    is_clear = len(enums) == 1 and "(" not in text
    before = env.scope.source.text[: use.span.start].split()
    if before[-4:-2] == ["is", "not"]:
        # `mode is not idle or alert` hardly means `mode is not idle or mode is alert`.
        name = texts[0]
        is_clear, text = False, f"{name} is not {before[-2]} and {name} is not {use.name}"
    fixes = (replacement_fix(env.scope.source, use.span, text),) if is_clear else ()
    raise problem("TLT0201", title, env.scope.source, use.span, advice=f"{advice}: write `{text}`", fixes=fixes)


def _split_operator_letters(name: str, env: Env, kinds: tuple[BindingKind, ...]) -> str | None:
    """Split temporal operators from a name: return ``F G a`` for ``FGa`` if ``a`` is a visible name, else None.

    A name that is not local must be of one of ``kinds``.
    """
    for letters in range(1, min(len(name), _MOST_LETTERS + 1)):
        if name[letters - 1] not in "FGXN":
            break
        rest = name[letters:]
        binding = env.scope.names.get(rest)
        if rest in env.local or (binding is not None and binding.kind in kinds):
            return " ".join((*name[:letters], rest))
    return None


def entity(expr: Expr, env: Env) -> Entity:
    """Return the entity (object of the level) that an argument names.

    Raises ResolutionError: TLT0201 if the name is unknown, TLT0302 if the argument is no entity.
    """
    while isinstance(expr, GroupExpr):
        expr = expr.inner
    if isinstance(expr, NameExpr):
        local = env.local.get(expr.name)
        if isinstance(local, Entity):
            return local
        if isinstance(local, Unknown):
            return Entity(local.name)
        if local is None:
            binding = lookup(expr, env, ("entity",), "entity")
            if binding.kind == "entity":
                return Entity(binding.name)
            if binding.kind == "group":
                raise _group_error(expr, env)
    raise problem(
        "TLT0302",
        f"expected an entity, found {kind_in_words(expr, env)}",
        env.scope.source,
        expr.span,
        advice=_entities_help(env) if not isinstance(expr, tree.BinaryExpr) else _ONE_ENTITY,
    )


def _group_error(expr: NameExpr, env: Env) -> ResolutionError:
    """Return the error for a group where one entity is needed."""
    title = f"expected an entity, found the group `{expr.name}`"
    advice = f"name one of its members, or write a condition for each: `all x in {expr.name}: …`"
    return problem("TLT0302", title, env.scope.source, expr.span, advice=advice)


_ONE_ENTITY = "name one entity here: write a condition for each entity, and join them with `and`, `or` or `then`"


def _entities_help(env: Env) -> str:
    """Return a help text that lists the visible entities, or says how to declare one."""
    known = [f"`{name}`" for name, binding in env.scope.names.items() if binding.kind == "entity"]
    listed = ", ".join(known[:_MOST_NAMES]) + (", …" if len(known) > _MOST_NAMES else "")
    if len(known) == 1:
        return f"the only entity is {listed}"
    return f"the entities are {listed}" if known else "declare one with `entity NAME`"


def entity_help(entity: str, env: Env, *, number: bool) -> str:
    """Return a help text that shows how to use an entity: in arithmetic if ``number``, else in a condition."""
    # Sorting by kind puts predicates before signals: predicates are declared to be used this way.
    for name, binding in sorted(env.scope.names.items(), key=lambda item: item[1].kind):
        declared = binding.declaration
        if isinstance(declared, (SignalDecl, tree.PredicateDecl)):
            is_number = isinstance(declared, SignalDecl) and declared.type != "bool"
            needed = [parameter for parameter in declared.parameters if parameter.default is None]
            of_entity = len(needed) == 1 and (needed[0].type == "entity" or isinstance(declared, SignalDecl))
            if of_entity and is_number == number:
                return f"{'measure it' if number else 'use it in a condition'}, e.g. `{name}({entity})`"
    example = "distance(x: entity): length in [0 m, 100 m]" if number else "at(x: entity): bool"
    lacks = "has no value" if number else "is not true or false"
    return f"an entity alone {lacks}: declare a signal, e.g. `signal {example}`"


def kind_of(expr: Expr, env: Env) -> Literal["entity", "number", "formula"]:
    """Guess from the outermost operator or name whether an expression is an entity, a number or a formula.

    Unknown names count as formulas.
    """
    while isinstance(expr, GroupExpr):
        expr = expr.inner
    if isinstance(expr, (tree.NumberExpr, tree.WhenExpr)):
        return "number"
    if isinstance(expr, tree.Unary):
        return "number" if expr.op == "-" else "formula"
    if isinstance(expr, tree.BinaryExpr):
        return "formula" if expr.op in _FORMULA_OPERATORS else "number"
    if isinstance(expr, (NameExpr, CallExpr)):
        local = env.local.get(expr.name)
        if local is not None:
            quantity = isinstance(local, Quantity) and not local.is_bool
            return "number" if quantity else "entity" if isinstance(local, Entity) else "formula"
        binding = env.scope.names.get(expr.name)
        if binding is None:
            is_function = isinstance(expr, CallExpr) and expr.name in (*FUNCTIONS, *MEMORY_FUNCTIONS)
            return "number" if is_function else "formula"
        if isinstance(binding.declaration, SignalDecl):
            return "formula" if binding.declaration.type == "bool" else "number"
        return "entity" if binding.kind in ("entity", "group") else "number" if binding.kind == "param" else "formula"
    return "formula"


def is_group(expr: Expr, env: Env) -> bool:
    """Whether an expression is the name of a group of entities."""
    if not isinstance(expr, NameExpr) or expr.name in env.local:
        return False
    binding = env.scope.names.get(expr.name)
    return binding is not None and isinstance(binding.declaration, GroupDecl)


def kind_in_words(expr: Expr, env: Env) -> str:
    """Return the kind of an expression in words, for ``expected a number, found …``."""
    while isinstance(expr, GroupExpr):
        expr = expr.inner
    if isinstance(expr, tree.Constant):
        return f"`{'true' if expr.value else 'false'}`"
    if isinstance(expr, tree.BinaryExpr) and expr.op in ("<", "<=", ">", ">=", "==", "!="):
        return "a comparison"
    if is_group(expr, env):
        return "a group of entities"
    kind = kind_of(expr, env)
    return {"entity": "an entity", "number": "a number", "formula": "a formula"}[kind]


def not_a_formula_error(expr: Expr, env: Env) -> ResolutionError:
    """Return the error for a number or an entity in place of a formula."""
    advice = None
    info = enum_of(expr, env)
    if info is not None:
        return enum_as_formula_error(expr, info, env)
    if kind_of(expr, env) == "number":
        advice = _comparison_help(expr, env)
    elif is_group(expr, env):
        advice = f"write a condition for each member: `all x in {env.scope.source.slice(expr.span)}: …`"
    elif kind_of(expr, env) == "entity":
        advice = entity_help(env.scope.source.slice(expr.span), env, number=False)
    kind = kind_in_words(expr, env)
    return problem("TLT0301", f"expected a formula, found {kind}", env.scope.source, expr.span, advice=advice)


def check_let(declaration: LetDecl, inside: Env) -> None:
    """Raise ResolutionError (TLT0301) if the body of a ``let`` is a number; ``inside`` is the body's environment."""
    body = declaration.body
    if kind_of(body, inside) != "number" or enum_of(body, inside) is not None:
        return
    if _is_literal(body):
        advice = "a `let` holds a formula; a fixed number with a name is a `param`, e.g. `param most: length = 3 m`"
    else:
        advice = (
            "a `let` holds a formula: compare the number here, write it in the clauses themselves, or let the game "
            "supply it as a signal"
        )
    title = "expected a formula, found a number"
    raise problem("TLT0301", title, inside.scope.source, body.span, advice=advice)


def _comparison_help(expr: Expr, env: Env) -> str:
    """Return a help text that shows how to turn a number into a condition."""
    text = env.scope.source.slice(expr.span)
    is_short = len(text) <= 40 and not isinstance(expr, tree.WhenExpr)
    if _is_literal(expr):
        return "compare a signal with it" + (f", as in `SIGNAL > {text}`" if is_short else "")
    return f"compare it, e.g. `{text} > {_threshold(expr, env)}`" if is_short else "compare it with a number"


def _is_literal(expr: Expr) -> bool:
    """Whether an expression consists of numbers only."""
    return not any(isinstance(part, (NameExpr, CallExpr, tree.WhenExpr)) for part in parts(expr))


def _threshold(expr: Expr, env: Env) -> str:
    """Return an example value to compare a signal or param with, in the unit of its type."""
    binding = env.scope.names.get(expr.name) if isinstance(expr, (NameExpr, CallExpr)) else None
    declaration = binding.declaration if binding else None
    type_ = declaration.type if isinstance(declaration, (SignalDecl, tree.ParamDecl)) else None
    if type_ == "int":
        return "1"
    unit = units.si_unit(units.TYPES[type_]) if type_ in units.TYPES else None
    return f"0.5 {unit}" if unit else "0.5"
