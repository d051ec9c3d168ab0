"""Find the atoms of traces.

With a library, the atoms are its predicates, applied to entities. Without one, they are the columns
that have only the values true and false, and the columns of robustness values: there an atom is a
comparison, such as ``near(s1) > 0``. In both cases, a source text declares the atoms, and the
compiler resolves them.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import islice, product
from typing import Final

from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.names import full_name, split_name
from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError, stop_at_errors
from tltlc.expression.tree import AtomValue, Before, Expression, SignalValue, nodes
from tltlc.grammar.module import Module
from tltlc.grammar.tree import Parameter, SignalDecl, SpecDecl, TestDecl
from tltlc.io.limits import WORK
from tltlc.logic.formula import TRUE
from tltlc.pipeline import CompileOptions, Session
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.resolution import resolve_atoms
from tltlc.resolve.scope import Binding
from tltlc.resolve.spec import Atom, Vocabulary
from tltlc.tools.mine.column_diagnostics import first_names
from tltlc.tools.mine.columns import ColumnKind

_WORD: Final = re.compile(r"[A-Za-z_][\w.]*\Z", re.ASCII)
_BRACKETS_AND_COMMAS: Final = re.compile(r"\s*([(),])\s*")
_MOST: Final = WORK["mined columns"]
_MOST_INSTANCES: Final = WORK["mined instances"]


@record
class MiningVocabulary:
    """The atoms of the traces, and the declarations of all names that specs over them need.

    ``library`` is a source text that declares all names. ``entities`` are the entities of the
    traces that the user's library does not declare. ``reader`` is an automaton that accepts every
    trace and has all atoms; it serves only to compute their values. ``robust`` lists the columns of
    robustness values that are atoms. ``left_out`` lists the columns that are not atoms.
    ``misnamed`` has those of them whose values could be those of an atom, but whose names no atom
    can have. ``unread_count`` is the number of possible atoms that are left out because there are
    too many.
    """

    library: SourceFile
    entities: tuple[str, ...]
    reader: Fspa
    robust: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
    misnamed: frozenset[str] = frozenset()
    unread_count: int = 0


def vocabulary_of_library(library: SourceFile, columns: Collection[str], options: ResolveOptions) -> MiningVocabulary:
    """Return the atoms of a library that can be computed from the columns of the traces.

    Candidates are the predicates and `bool` signals of the library, with entities as arguments, and
    the atoms of the library's own specs, such as `times(seen) > 3`.

    Raises:
        TltlError: the library has an error; TLT0760, none of its atoms can be read.
    """
    session = Session(library, CompileOptions(library_dirs=options.library_dirs, params=options.params))
    stop_at_errors(session.syntax_errors)
    stop_at_errors(session.resolution.diagnostics)
    names = session.resolution.env.scope.names
    missing = tuple(name for name in _entities(columns) if name not in names and _declares(f"entity {name}\n"))
    own = [name for name, binding in names.items() if binding.kind == "entity"]
    spec_atoms = [atom.name for spec in session.resolution.program.specs for atom in spec.atoms]

    extended = _with_entities(library, missing)
    module = _module(extended)
    module = replace(
        module,
        declarations=tuple(
            declaration for declaration in module.declarations if not isinstance(declaration, (SpecDecl, TestDecl))
        ),
    )
    entities = dict.fromkeys((*own, *missing))
    instances, unread_count = _instances(names.values(), entities)
    texts = list(dict.fromkeys((*spec_atoms, *instances)))
    # The order of the atoms does not matter to the search.
    texts, unread_count = texts[:_MOST], unread_count + len(texts[_MOST:])
    readable = _readable_atoms(module, texts, columns, options)
    if readable is None:
        raise _no_readable_atom(library, _resolve(module, texts, options), columns)
    return MiningVocabulary(extended, missing, _reader(readable), unread_count=unread_count)


def _no_readable_atom(library: SourceFile, vocabulary: Vocabulary | None, columns: Collection[str]) -> TltlError:
    """Return the error TLT0760 for a library if none of its atoms can be computed."""
    title = f"no predicate of `{library.name.strip('<>')}` can be computed from the columns of the traces"
    missing = [signal.name for signal in vocabulary.signals if signal.name not in columns] if vocabulary else []
    help_ = (
        f"record the signals that its predicates use: {first_names(missing)}"
        if missing
        else "declare a predicate in it"
    )
    return TltlError([Diagnostic("TLT0760", title, help=help_)])


def vocabulary_of_columns(columns: Mapping[str, ColumnKind], clock: str = "") -> MiningVocabulary:
    """Return a vocabulary in which each column of true and false, or of robustness values, is an atom.

    ``columns`` maps the name of each column to its kind. ``clock`` is the declaration of the clock; empty
    without one.

    Raises:
        TltlError: TLT0760, no column is an atom.
    """
    kinds = (ColumnKind.TRUTHS, ColumnKind.ROBUSTNESS)
    candidates = [name for name, kind in columns.items() if kind in kinds]
    names, unread = candidates[:_MOST], frozenset(candidates[_MOST:])
    simple = {name: None for name in names if _WORD.match(name) and _declares(f"signal {name}: bool\n")}
    calls = _calls(names, simple)
    robust = {name for name in names if columns[name] == ColumnKind.ROBUSTNESS}
    signals = signal_declarations(
        [*calls.values(), *((name, ()) for name in simple)],
        {calls[name][0] if name in calls else name for name in robust},
    )
    library = SourceFile("<traces>", clock + signals, "text")
    texts = {name: f"{name} > 0" if name in robust else name for name in names if name in simple or name in calls}
    readable = _readable_atoms(_module(library), [*texts.values()], columns)
    if readable is None:
        raise _no_columns(names)
    reader = _reader(readable)
    signal_names = {signal.name for signal in reader.signals}
    left_out = tuple(name for name in columns if name not in signal_names and name not in unread)
    return MiningVocabulary(
        library=library,
        entities=(),
        reader=reader,
        robust=tuple(name for name in columns if name in robust & signal_names),
        left_out=left_out,
        misnamed=frozenset(left_out).intersection(names),
        unread_count=len(unread),
    )


def _no_columns(truths: Sequence[str]) -> TltlError:
    """Return the error TLT0760: no column is an atom.

    ``truths`` lists the columns of true and false. Their names are names that no atom can have.
    """
    title = "no column of the traces contains only `true` and `false`"
    help_ = "use `--predicates LIB` to compute atoms from columns of numbers"
    if truths:
        columns, contain, their = "column", "contains", "its name"
        if len(truths) > 1:
            columns, contain, their = "columns", "contain", "their names"
        title = f"the {columns} {first_names(truths)} {contain} only truth values, but no atom can have {their}"
        help_ = "write a name that an atom can have, e.g. `seen` or `at(key)`: letters, digits and `_`, but "
        help_ += "no word of the language"
    return TltlError([Diagnostic("TLT0760", title, help=help_)])


def _calls(names: Iterable[str], taken: Collection[str]) -> dict[str, tuple[str, tuple[str, ...]]]:
    """Map each column such as `near(s1)` to its signal and its entities: ``("near", ("s1",))``.

    Other columns are left out. ``taken`` has the names of other signals. A column is also left out if
    the declarations of its signal and its entities would conflict with one of these signals, or with
    the declarations for an earlier column.
    """
    lengths: dict[str, int] = {}
    entities: set[str] = set()
    calls: dict[str, tuple[str, tuple[str, ...]]] = {}
    for name in names:
        call = _call(name)
        if call is None:
            continue
        signal, arguments = call
        if signal in taken or signal in entities or signal in arguments:
            continue
        if any(argument in taken or argument in lengths for argument in arguments):
            continue
        if lengths.get(signal, len(arguments)) == len(arguments) and _declares(signal_declarations([call])):
            lengths[signal] = len(arguments)
            entities.update(arguments)
            calls[name] = call
    return calls


def _reader(vocabulary: Vocabulary) -> Fspa:
    """Return an automaton that accepts every trace and has the atoms of ``vocabulary``."""
    spec = replace(
        spec_from_formula(TRUE, "reader"),
        atoms=vocabulary.atoms,
        signals=vocabulary.signals,
        params=vocabulary.params,
        exclusive=vocabulary.exclusive,
        clock_s=vocabulary.clock_s,
        clock_varies=vocabulary.clock_varies,
        registers=vocabulary.registers,
    )
    return build(spec)


def _module(source: SourceFile) -> Module:
    session = Session(source)
    stop_at_errors(session.syntax_errors)
    return session.module


def _with_entities(library: SourceFile, names: Sequence[str]) -> SourceFile:
    """Return the library with a declaration of further entities at its end, so that no other text moves."""
    return library.with_text(f"{library.text}\nentity {', '.join(names)}\n") if names else library


# --- instances ------------------------------------------------------------------------------------


def _instances(bindings: Iterable[Binding], entities: Collection[str]) -> tuple[list[str], int]:
    """Apply all predicates, `bool` signals and enums to all entities; return texts such as `near(s1)`.

    Also return how many texts are left out: there are at most ``_MOST_INSTANCES`` for each predicate.
    The result has texts, not atoms, because mined specs are written as source text.
    """
    instances: list[str] = []
    left_out = 0
    for name, parameters, endings in _predicates(bindings):
        chosen = islice(product(entities, repeat=parameters), _MOST_INSTANCES)
        instances += [full_name(name, arguments) + ending for arguments in chosen for ending in endings]
        left_out += max(0, len(entities) ** parameters - _MOST_INSTANCES) * len(endings)
    return instances, left_out


def _predicates(bindings: Iterable[Binding]) -> Iterator[tuple[str, int, Sequence[str]]]:
    """Yield the names of the predicates, `bool` signals and enums whose required parameters are all entities.

    Each comes with the number of its required parameters, which are those without a default, and with
    the texts after it that make it an atom: ` is idle`, ` is alert` for an enum, an empty text for others.
    """
    for binding in bindings:
        declaration = binding.declaration
        is_truth = binding.kind == "signal" and getattr(declaration, "type", None) == "bool"
        values = declaration.values if isinstance(declaration, SignalDecl) else ()
        if binding.kind != "predicate" and not is_truth and not values:
            continue
        parameters: tuple[Parameter, ...] = getattr(declaration, "parameters", ())
        required = [parameter for parameter in parameters if parameter.default is None]
        if all(parameter.type == "entity" for parameter in required):
            yield binding.name, len(required), [f" is {value.name}" for value in values] or [""]


def _readable_atoms(
    module: Module, texts: Sequence[str], columns: Collection[str], options: ResolveOptions | None = None
) -> Vocabulary | None:
    """Return the atoms among ``texts``, such as `near(s1)`, whose signals are all columns of the traces.

    The signals of an atom are also those that it remembers. Return None if there is no atom left.
    """
    resolved = _resolve(module, texts, options)
    if resolved is None:
        return None
    names = [atom.name for atom in resolved.atoms if _signals_read(atom, resolved).issubset(columns)]
    if names == [atom.name for atom in resolved.atoms]:
        return resolved
    return _resolve(module, names, options) if names else None


def _signals_read(atom: Atom, vocabulary: Vocabulary) -> set[str]:
    """Return the names of the signals that an atom reads, at this sample or before."""
    updates = {register.name: register.update for register in vocabulary.registers}
    expressions = {other.name: other.expression for other in vocabulary.atoms}
    signals: set[str] = set()
    seen: set[Expression] = set()
    pending = [atom.expression]
    while pending:
        expression = pending.pop()
        if expression in seen:
            continue
        seen.add(expression)
        for node in nodes(expression):
            if isinstance(node, AtomValue):
                pending.append(expressions[node.name])
            elif isinstance(node, (SignalValue, Before)) and node.name in updates:
                pending.append(updates[node.name])
            elif isinstance(node, SignalValue):
                signals.add(node.name)
    return signals


def _resolve(module: Module, texts: Sequence[str], options: ResolveOptions | None) -> Vocabulary | None:
    """Return the atoms that ``texts`` such as `near(s1)` denote in a module.

    Texts that are not atoms, or that repeat an atom, are left out. Return None if no text is left.
    """
    sources = [SourceFile("<atom>", text, "text") for text in texts]
    while sources:
        vocabulary, _, problems = resolve_atoms(module, sources, options)
        if vocabulary is not None and not any(problem.severity == "error" for problem in problems):
            return vocabulary
        wrong = [label.source for problem in problems if problem.severity == "error" for label in problem.labels[:1]]
        remaining = [source for source in sources if not any(source is rejected for rejected in wrong)]
        if len(remaining) == len(sources):
            raise TltlError(problems)
        sources = remaining
    return None


# --- columns --------------------------------------------------------------------------------------


def _entities(columns: Iterable[str]) -> list[str]:
    """Return the names in the brackets of columns such as `distance(s1)`, in order, without duplicates."""
    calls = [call for call in map(_call, columns) if call is not None]
    return list(dict.fromkeys(name for _, arguments in calls for name in arguments))


def _call(column: str) -> tuple[str, tuple[str, ...]] | None:
    """Split a column such as `near(s1)` into its name and arguments: ``("near", ("s1",))``.

    Return None for a column without arguments. Blanks around brackets and commas do not matter.
    """
    name, arguments = split_name(_BRACKETS_AND_COMMAS.sub(r"\1", column.strip()).replace(",", ", "))
    return (name, arguments) if arguments and all(map(_WORD.match, (name, *arguments))) else None


def signal_declarations(signals: Iterable[tuple[str, tuple[str, ...]]], robust: Collection[str] = ()) -> str:
    """Return declarations of signals, and of the entities that are their arguments.

    The signals are `bool`, but robustness values in [-1, 1] if their names are in ``robust``. Each
    of ``signals`` is a name with its arguments. For ``("near", ("s1",))``, the result is ``entity
    s1`` and ``signal near(x1: entity): bool``. Signals with the same name must have the same number
    of arguments, and get one declaration.
    """
    lengths: dict[str, int] = {}
    entities: dict[str, None] = {}
    for name, arguments in signals:
        lengths[name] = len(arguments)
        entities |= dict.fromkeys(arguments)
    text = f"entity {', '.join(entities)}\n" if entities else ""
    for name, length in lengths.items():
        text += f"signal {name}{_parameters(length)}{' in [-1, 1]' if name in robust else ': bool'}\n"
    return text


def _parameters(count: int) -> str:
    """Return the parameters of a signal that takes ``count`` entities: ``(x1: entity)`` for 1, nothing for 0."""
    return f"({', '.join(f'x{number}: entity' for number in range(1, count + 1))})" if count else ""


def _declares(text: str) -> bool:
    """Whether a text such as ``signal seen: bool`` parses. It does not if a name in it is a keyword."""
    errors = Session(SourceFile("<column>", text, "text")).syntax_errors
    return not any(error.severity == "error" for error in errors)
