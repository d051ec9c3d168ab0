"""Match the arguments of a call to the declared parameters."""

from __future__ import annotations

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label, replacement_fix
from tltlc.grammar.tree import Argument, CallExpr, Expr, NameExpr, Parameter
from tltlc.grammar.typos import likely_name
from tltlc.resolve.problem import problem
from tltlc.resolve.scope import Binding, Scope


def match(
    use: NameExpr | CallExpr, binding: Binding, parameters: tuple[Parameter, ...], scope: Scope
) -> tuple[tuple[Parameter, Expr | None], ...]:
    """Return each declared parameter with the argument that a call passes for it.

    The pairs are in the order of declaration. The argument is None if the call leaves it out and the
    parameter has a default. ``use`` is the call, or a name without brackets, which passes nothing.

    Raises ResolutionError (TLT0210) for missing, surplus, repeated and unknown arguments.
    """
    arguments = use.arguments if isinstance(use, CallExpr) else ()
    values: dict[str, Expr] = {}
    for position, argument in enumerate(arguments):
        name = _parameter_for(argument, position, use, binding, parameters, scope)
        if name in values:
            raise problem("TLT0210", f"`{name}` is given twice", scope.source, argument.span, advice="leave one out")
        values[name] = argument.value
    for parameter in parameters:
        if parameter.name not in values and parameter.default is None:
            raise problem(
                "TLT0210",
                f"`{binding.name}` needs {_with_article(parameter)}: `{parameter.name}`",
                scope.source,
                use.span,
                f"write `{use.name}({', '.join(_placeholders(parameters))})`",
                related=(Label(binding.scope.source, binding.span, "declared here"),),
            )
    return tuple((parameter, values.get(parameter.name)) for parameter in parameters)


def _parameter_for(
    argument: Argument,
    position: int,
    use: NameExpr | CallExpr,
    binding: Binding,
    parameters: tuple[Parameter, ...],
    scope: Scope,
) -> str:
    names = [parameter.name for parameter in parameters]
    if argument.name is not None:
        if argument.name in names:
            return argument.name
        suggestion = likely_name(argument.name, names)
        hint = f"did you mean `{suggestion}`?" if suggestion else ""
        listed = ", ".join(f"`{name}`" for name in names)
        advice = None if suggestion else f"it takes {listed}" if names else "it takes no arguments"
        title = f"`{binding.name}` has no argument `{argument.name}`"
        place = Span(argument.span.start, argument.span.start + len(argument.name))
        fixes = (replacement_fix(scope.source, place, suggestion),) if suggestion else ()
        raise problem("TLT0210", title, scope.source, argument.span, hint, advice=advice, fixes=fixes)
    if position >= len(names):
        count = {0: "no arguments", 1: "one argument"}.get(len(names), f"{len(names)} arguments")
        raise problem(
            "TLT0210",
            f"`{binding.name}` takes {count}",
            scope.source,
            argument.span,
            "one too many",
            advice=f"write `{use.name}({', '.join(names)})`" if names else f"write `{use.name}`",
            related=(Label(binding.scope.source, binding.span, "declared here"),),
        )
    return names[position]


def _with_article(parameter: Parameter) -> str:
    if parameter.type is None:
        return "an argument"
    return f"{'an' if parameter.type[0] in 'aeiou' else 'a'} {parameter.type}"


def _placeholders(parameters: tuple[Parameter, ...]) -> list[str]:
    return [parameter.name for parameter in parameters if parameter.default is None]
