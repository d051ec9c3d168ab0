"""Random texts of the language, generated word by word from the grammar."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random

NAMES = [
    "a",
    "b",
    "near",
    "x",
    "in",
    "at",
    "as",
    "step",
    "expect",
    "within",
    "for",
    "after",
    "since",
    "s",
    "m",
    "position.x",
]
"""Names. Most of them are keywords or units in other places."""

PREFIXES = {
    **dict.fromkeys(("not", "!", "¬"), ()),
    **dict.fromkeys(("eventually", "F", "<>", "◇"), ("within 3 steps", "within 1 step", "[0,20]", "[ 2 , 3 s ]")),
    **dict.fromkeys(("always", "G", "[]", "□"), ("for 3 steps", "for 1 step", "for 2 s", "[0,0]", "[0 ,19 steps]")),
    "once": ("within 3 steps", "within 2 s"),
    "historically": ("for 3 steps", "for 2 s"),
    **dict.fromkeys(("previously", "begins", "ends"), ()),
    **dict.fromkeys(("next", "X", "○", "weak_next", "N"), ("after 3 steps",)),
}
INFIXES = (
    *("and", "&", "&&", "∧", "or", "|", "||", "∨", "implies", "->", "⇒", "→", "iff", "<->", "⇔", "↔"),
    *("until", "U", "𝒰", "weak_until", "W", "release", "R", "strong_release", "M", "since"),
)
ARITHMETIC = ("+", "-", "*", "/", "^")
NUMBERS = ["1", "0.5", "2e-3", "20 m", "5%", "20 m / s", "3 km/h", "9.81 m/s^2"]
GAPS = [" "] * 24 + ["\n", "\n\n\n\n", "\t", " // a remark\n", "\n  // alone\n", "\n/// said\n", " /// behind\r\n"]
GAPS_WITH_ALLOW = [*GAPS, " // tltlc: allow TLT0412\n", "\n// tltlc: allow TLT0425\n"]


def module(random: Random, gaps: Sequence[str] = GAPS) -> str:
    """Return the text of a module without errors."""
    return join(random, [word for _ in range(random.randint(0, 4)) for word in declaration(random)], gaps)


def join(random: Random, words: list[str], gaps: Sequence[str] = GAPS) -> str:
    """Join words with blanks, line breaks and comments from ``gaps``. A word may contain blanks."""
    return "".join(random.choice(gaps) + word for word in words) + random.choice(gaps)


def declaration(random: Random) -> list[str]:
    name = random.choice(NAMES)
    match random.randrange(10):
        case 0:
            return ["import", random.choice(["stealth", '"a.tltl"', "stealth ( near, alive )", "core as c"])]
        case 1:
            parameters = random.choice([[], ["(", *commas(["q : entity"] * random.randint(1, 9)), ")"]])
            if random.random() < 0.3:
                return ["signal", name, *parameters, ":", "(", *names(random), ")"]
            return ["signal", name, *parameters, *random.choice([[":", "length"], []]), *interval(random)]
        case 2:
            return ["entity", *names(random)]
        case 3:
            return ["param", name, ":", "length", *interval(random), "=", *number(random, 2)]
        case 4:
            return ["clock", random.choice(["20 Hz", "0.05s"])]
        case 5:
            parameters = ["(", *commas(["q", "r : length"]), "=", "1 m", ")"]
            return ["predicate", name, *parameters, *interval(random), "=", *random.choice([number, when])(random, 4)]
        case 6:
            return ["let", name, "(", *commas(["p", "q: formula"]), ")", "=", *formula(random, 4)]
        case 7:
            atoms = random.choices(["near(s1)", "at", "x>3", "long_name"], k=random.randint(1, 20))
            return ["exclusive", *commas(atoms)]
        case 8:
            if random.random() < 0.4:
                return ["spec", "plan", "=", *formula(random, 5)]
            clauses = [word for _ in range(random.randint(0, 4)) for word in clause(random)]
            return ["spec", "plan", "{", *clauses, "keep", *formula(random, 3), "}"]
        case _:
            items = [word for _ in range(random.randint(0, 4)) for word in item(random)]
            return ["test", '"// it"', "for", "plan", "{", *items, "}"]


def clause(random: Random) -> list[str]:
    match random.randrange(8):
        case 0:
            sequence = [["(", *formula(random, 3), ")"] for _ in range(random.randint(1, 5))]
            return ["reach", *commas(sequence, "then")]
        case 1:
            return ["judge", "at", random.choice(["goal", "limit"])]
        case 2:
            return ["limit", "400 steps"]
        case 3:
            return ["tag", *names(random)]
        case 4:
            return ["level", random.choice(NAMES)]
        case _:
            return [random.choice(["keep", "avoid", "require"]), *formula(random, 5)]


def item(random: Random) -> list[str]:
    match random.randrange(4):
        case 0:
            return ["expect", "progress", random.choice(["<", "<=", "≥"]), random.choice(["0.5", "50 %", "5%", "1e-3"])]
        case 1:
            return ["expect", random.choice(["holding", 'state "F  a // b"', 'state ""'])]
        case _:
            atoms = [formula(random, 1) for _ in range(random.randint(1, 9))]
            if random.random() < 0.3:
                atoms.insert(0, ["x", "=", *number(random, 1)])
            return ["step", *random.choice([[], ["3", "x"], ["12x"]]), *commas(atoms)]


def formula(random: Random, depth: int) -> list[str]:
    """Return the words of a formula, with brackets around each part that could be read differently."""
    match random.randrange(9) if depth else 0:
        case 0:
            return atom(random)
        case 1 | 2:
            prefix = random.choice([*PREFIXES])
            bounds = PREFIXES[prefix]
            bound = [random.choice(bounds)] if bounds and random.random() < 0.4 else []
            return [prefix, *bound, *formula(random, depth - 1)]
        case 3 | 4:
            infix = random.choice(INFIXES)
            operands = [formula(random, depth - 1) for _ in range(random.randint(2, 5))]
            return commas([["(", *operand, ")"] for operand in operands], infix)
        case 5:
            head = [random.choice(["all", "any"]), "q", "in", "(", *names(random), ")", ":"]
            return ["(", *head, *formula(random, depth - 1), ")"]
        case 6:
            operands = [["(", *formula(random, depth - 1), ")"] for _ in range(random.randint(2, 4))]
            return ["(", *commas(operands, "then"), ")"]
        case _:
            return ["(", *formula(random, depth - 1), ")"]


def atom(random: Random) -> list[str]:
    name = random.choice(NAMES)
    match random.randrange(6):
        case 5:
            operand = random.choice([[name], [name, "(", *names(random), ")"]])
            return [*operand, "is", *random.choice([[], ["not"], ["!"]]), "a_rather_long_value"]
        case 0:
            arguments = [random.choice([["s1"], ["close", "=", *number(random, 1)], number(random, 2)])]
            return [name, "(", *commas(arguments * random.randint(1, 3)), ")"]
        case 1:
            return [*number(random, 2), random.choice(["<", "<=", ">", ">=", "≤", "≥", "==", "!="]), *number(random, 2)]
        case 2:
            return [random.choice(["true", "⊤", "false", "⊥"])]
        case _:
            return [name]


def number(random: Random, depth: int) -> list[str]:
    match random.randrange(6) if depth else 0:
        case 0:
            return [random.choice(NUMBERS)]
        case 1:
            return [random.choice(NAMES)]
        case 2:
            return ["-", *number(random, 0)]
        case 3:
            arguments = [number(random, depth - 1) for _ in range(random.randint(1, 4))]
            return [random.choice(["min", "clamp", "previous"]), "(", *commas(arguments), ")"]
        case 4:
            return ["(", *number(random, depth - 1), ")"]
        case _:
            operands = [["(", *number(random, depth - 1), ")"] for _ in range(random.randint(2, 4))]
            return commas(operands, random.choice(ARITHMETIC))


def when(random: Random, depth: int) -> list[str]:
    cases = [["when", *atom(random), ":", *number(random, depth)] for _ in range(random.randint(1, 3))]
    return [*(word for case in cases for word in case), "otherwise", ":", *number(random, depth)]


def interval(random: Random) -> list[str]:
    return ["in", "[", *random.choice([["-1", ",", "1"], ["0 m", ",", "inf"], ["- ", "180deg", ",", "2*3"]]), "]"]


def names(random: Random) -> list[str]:
    return commas(random.choices(["exit", "door", "a_rather_long_name_of_something"], k=random.randint(1, 6)))


def commas(items: Sequence[str | list[str]], sign: str = ",") -> list[str]:
    """Return the items with a sign between them."""
    words: list[str] = []
    for place, item_ in enumerate(items):
        words += [sign] * bool(place) + ([item_] if isinstance(item_, str) else item_)
    return words
