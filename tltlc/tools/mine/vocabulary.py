"""The atoms that traces speak of: the predicates of a library over the entities of the traces, or columns that are
true or false.

Either way there is a source text that declares them, and everything else goes through the compiler.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import islice, product
from typing import Final

from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError, stop_at_errors
from tltlc.expression.tree import Signal, nodes
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Module, Parameter, SpecDecl, TestDecl
from tltlc.io.limits import WORK
from tltlc.logic.formula import TRUE
from tltlc.monitor.samples import listed
from tltlc.resolve.imports import load
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.problem import Log
from tltlc.resolve.program import resolve, resolve_atoms
from tltlc.resolve.scope import Binding, build_scopes
from tltlc.resolve.spec import Vocabulary
from tltlc.tools.mine.column_diagnostics import some

_CALL: Final = re.compile(r"([A-Za-z_][\w.]*)\s*\(([^()]*)\)\Z", re.ASCII)
_WORD: Final = re.compile(r"[A-Za-z_][\w.]*\Z", re.ASCII)
_MOST: Final = WORK["mined columns"]
_MOST_INSTANCES: Final = WORK["mined instances"]


@record
class Words:
    """What traces are read with and specs are written in.

    ``library`` declares everything; ``entities`` are those that it did not.  ``reader`` is an automaton that accepts
    everything and has all atoms: their expressions, signals and params.  ``left_out`` are columns that are no atoms, of
    which those in ``misnamed`` are true or false, and called as no atom can be.  ``unread`` counts what could be an
    atom, but is beyond the limits on work.
    """

    library: SourceFile
    entities: tuple[str, ...]
    reader: Fspa
    left_out: tuple[str, ...] = ()
    misnamed: frozenset[str] = frozenset()
    unread: int = 0


def of_library(library: SourceFile, columns: Collection[str], options: ResolveOptions) -> Words:
    """The atoms of a library whose signals are all among the columns of the traces.

    These are predicates and `bool` signals of entities, and the atoms of the library's own specs.

    Raises:
        TltlError: what is wrong with the library; TLT0760, none of its atoms can be read.
    """
    module = _parsed(library)
    names = _visible(module, options)
    missing = tuple(name for name in _entities(columns) if name not in names and _declares(f"entity {name}\n"))
    own = [name for name, binding in names.items() if binding.kind == "entity"]
    program, problems = resolve(module, options)
    stop_at_errors(problems)
    used = [atom.name for spec in program.specs for atom in spec.atoms]

    whole = _with_entities(library, missing)
    plain = _parsed(whole)
    plain = replace(
        plain, declarations=tuple(each for each in plain.declarations if not isinstance(each, (SpecDecl, TestDecl)))
    )
    every = dict.fromkeys((*own, *missing))
    instances, unread = _instances(names.values(), every)
    texts = list(dict.fromkeys((*used, *instances)))
    # The order in which atoms are found does not matter to the search.
    texts, unread = texts[:_MOST], unread + len(texts[_MOST:])
    found = _readable(plain, texts, columns, options)
    if found is None:
        raise _unreadable(library, _resolved(plain, texts, options), columns)
    return Words(whole, missing, _reader(found), unread=unread)


def _unreadable(library: SourceFile, words: Vocabulary | None, columns: Collection[str]) -> TltlError:
    """The error where none of the atoms can be computed."""
    title = f"no predicate of `{library.name.strip('<>')}` can be computed from the columns of the traces"
    missing = [signal.name for signal in words.signals if signal.name not in columns] if words else []
    way_out = f"record what its predicates use: {listed(missing[:3])}" if missing else "declare a predicate in it"
    return TltlError([Diagnostic("TLT0760", title, help=way_out)])


def of_columns(columns: Mapping[str, bool]) -> Words:
    """The columns that are true or false as atoms; ``left_out`` are the others, and those that are ``misnamed``.

    Raises:
        TltlError: TLT0760, there is none.
    """
    truths = [name for name, is_truth in columns.items() if is_truth]
    names, unread = truths[:_MOST], frozenset(truths[_MOST:])
    simple = {name: None for name in names if _WORD.match(name) and _declares(f"signal {name}: bool\n")}
    calls = _calls(names, simple)
    entities = list(dict.fromkeys(each for arguments in calls.values() for each in arguments))
    signals = {name.partition("(")[0].strip(): len(arguments) for name, arguments in calls.items()}
    text = f"entity {', '.join(entities)}\n" if entities else ""
    text += "".join(_signal(name, number) for name, number in signals.items())
    text += "".join(f"signal {name}: bool\n" for name in simple)
    library = SourceFile("<traces>", text)
    found = _readable(_parsed(library), [name for name in names if name in simple or name in calls], columns)
    if found is None:
        raise _no_columns(names)
    reader = _reader(found)
    read = {atom.name for atom in reader.atoms}
    left_out = tuple(name for name in columns if name not in read and name not in unread)
    return Words(library, (), reader, left_out, frozenset(left_out).intersection(names), len(unread))


def _no_columns(truths: Sequence[str]) -> TltlError:
    """The error where no column is an atom; those that are true or false are called like none."""
    title = "no column of the traces holds `true` and `false` alone"
    way_out = "with `--predicates LIB` atoms are computed from columns of numbers"
    if truths:
        columns = f"column {some(truths)} holds" if len(truths) == 1 else f"columns {some(truths)} hold"
        title = f"the {columns} `true` and `false` alone, but no atom can be called so"
        way_out = "call it as atoms are, e.g. `seen` or `at(key)`: letters, digits and `_`, and no word of the language"
    return TltlError([Diagnostic("TLT0760", title, help=way_out)])


def _calls(names: Iterable[str], taken: Collection[str]) -> dict[str, tuple[str, ...]]:
    """The columns such as `near(s1)` with their entities, as far as they can all be declared beside each other."""
    lengths: dict[str, int] = {}
    entities: set[str] = set()
    found: dict[str, tuple[str, ...]] = {}
    for name in names:
        call = _call(name)
        if call is None:
            continue
        signal, arguments = call
        if signal in taken or signal in entities or signal in arguments:
            continue
        if any(each in taken or each in lengths for each in arguments):
            continue
        declared = "".join(f"entity {each}\n" for each in dict.fromkeys(arguments)) + _signal(signal, len(arguments))
        if lengths.get(signal, len(arguments)) == len(arguments) and _declares(declared):
            lengths[signal] = len(arguments)
            entities.update(arguments)
            found[name] = arguments
    return found


def _reader(words: Vocabulary) -> Fspa:
    """An automaton that accepts everything, with these atoms."""
    spec = replace(
        spec_from_formula(TRUE, "reader"),
        atoms=words.atoms,
        signals=words.signals,
        params=words.params,
        exclusive=words.exclusive,
        clock_s=words.clock_s,
    )
    return build(spec)


def _parsed(source: SourceFile) -> Module:
    module, found = parse(source)
    stop_at_errors(found)
    return module


def _visible(module: Module, options: ResolveOptions) -> dict[str, Binding]:
    """The names that a module sees, its own and those of its imports."""
    log = Log()
    names = build_scopes(load(module, options, log), log)[-1].names
    stop_at_errors(log.all())
    return names


def _with_entities(library: SourceFile, names: Sequence[str]) -> SourceFile:
    """The library with more entities, declared behind its own text so that places in it stay."""
    return SourceFile(library.name, f"{library.text}\nentity {', '.join(names)}\n") if names else library


# --- instances ------------------------------------------------------------------------------------


def _instances(bindings: Iterable[Binding], entities: Collection[str]) -> tuple[list[str], int]:
    """The predicates and `bool` signals over all entities, as they are written, and how many more there are."""
    found: list[str] = []
    more = 0
    for name, parameters in _predicates(bindings):
        if not parameters:
            found.append(name)
            continue
        chosen = islice(product(entities, repeat=parameters), _MOST_INSTANCES)
        found += [f"{name}({', '.join(each)})" for each in chosen]
        more += max(0, len(entities) ** parameters - _MOST_INSTANCES)
    return found, more


def _predicates(bindings: Iterable[Binding]) -> Iterator[tuple[str, int]]:
    """The predicates and `bool` signals that entities alone are given, and how many of them each takes."""
    for binding in bindings:
        declaration = binding.declaration
        is_truth = binding.kind == "signal" and getattr(declaration, "type", None) == "bool"
        if binding.kind != "predicate" and not is_truth:
            continue
        parameters: tuple[Parameter, ...] = getattr(declaration, "parameters", ())
        asked = [each for each in parameters if each.default is None]
        if all(each.type == "entity" for each in asked):
            yield binding.name, len(asked)


def _readable(
    module: Module, texts: Sequence[str], columns: Collection[str], options: ResolveOptions | None = None
) -> Vocabulary | None:
    """The atoms of these texts whose signals are all columns, None where there is none."""
    every = _resolved(module, texts, options)
    if every is None:
        return None
    names = [
        atom.name
        for atom in every.atoms
        if all(node.name in columns for node in nodes(atom.expression) if isinstance(node, Signal))
    ]
    if names == list(texts):
        return every
    return _resolved(module, names, options) if names else None


def _resolved(module: Module, texts: Sequence[str], options: ResolveOptions | None) -> Vocabulary | None:
    """The atoms of these texts; those that are none, or stand for the same as another, are left out."""
    written = [SourceFile("<atom>", text) for text in texts]
    while written:
        words, _, found = resolve_atoms(module, written, options)
        if words is not None and not any(each.severity == "error" for each in found):
            return words
        wrong = [label.source for each in found if each.severity == "error" for label in each.labels[:1]]
        left = [source for source in written if not any(source is each for each in wrong)]
        if len(left) == len(written):
            raise TltlError(found)
        written = left
    return None


# --- columns --------------------------------------------------------------------------------------


def _entities(columns: Iterable[str]) -> list[str]:
    """What stands in the brackets of columns such as `distance(s1)`, in order."""
    calls = [call for call in map(_call, columns) if call is not None]
    return list(dict.fromkeys(name for _, arguments in calls for name in arguments))


def _call(column: str) -> tuple[str, tuple[str, ...]] | None:
    """The name and the arguments of `near(s1)`; None where a column is not of that form."""
    found = _CALL.match(column.strip())
    if found is None:
        return None
    arguments = tuple(each.strip() for each in found[2].split(","))
    return (found[1], arguments) if all(_WORD.match(each) for each in arguments) else None


def _signal(name: str, entities: int) -> str:
    """The declaration of a `bool` signal of so many entities."""
    parameters = ", ".join(f"x{number}: entity" for number in range(1, entities + 1))
    return f"signal {name}({parameters}): bool\n"


def _declares(text: str) -> bool:
    """Whether a text is a declaration of the language: a column may be called like a word of it."""
    _, found = parse(SourceFile("<column>", text))
    return not any(each.severity == "error" for each in found)
