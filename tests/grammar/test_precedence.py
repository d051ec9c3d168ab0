import pytest

from tests.grammar.reading import brackets, read

TABLE = [
    # unary operators bind more loosely than comparisons, comparisons than arithmetic
    ("F a > 0", "(F (a > 0))"),
    ("not a > 0", "(not (a > 0))"),
    ("a + b * c ^ d > e - f", "((a + (b * (c ^ d))) > (e - f))"),
    ("a - b - c", "((a - b) - c)"),
    ("a / b * c", "((a / b) * c)"),
    ("a ^ b ^ c", "(a ^ (b ^ c))"),
    ("-a ^ 2", "(- (a ^ 2))"),
    ("2 ^ -a", "(2 ^ (- a))"),
    ("-a * b", "((- a) * b)"),
    ("--a", "(- (- a))"),
    ("a <-1", "(a < (- 1))"),
    # U W R M (right), and, or, implies (right), iff
    ("F a U b", "((F a) U b)"),
    ("not a U G b", "((not a) U (G b))"),
    ("a U b W c R d M e", "(a U (b W (c R (d M e))))"),
    ("a U b & c U d", "((a U b) and (c U d))"),
    ("a & b | c & d", "((a and b) or (c and d))"),
    ("a | b & c", "(a or (b and c))"),
    ("a & b & c", "((a and b) and c)"),
    ("a -> b -> c", "(a implies (b implies c))"),
    ("a | b -> c & d", "((a or b) implies (c and d))"),
    ("a <-> b -> c", "(a iff (b implies c))"),
    ("a -> b <-> c", "((a implies b) iff c)"),
    ("F a & G b", "((F a) and (G b))"),
    ("X F ! a", "(X (F (not a)))"),
    # then is the loosest and needs plain operands
    ("a then !b then c > 1", "(a then ((not b) then (c > 1)))"),
    ("(a & b) then (F c)", "(<(a and b)> then <(F c)>)"),
    # a quantifier extends as far to the right as possible
    ("all x in (s, t): F p(x) & q", "(all x s t: ((F p(x)) and q))"),
    ("a & any x in (s): p(x) | b -> c", "(a and (any x s: ((p(x) or b) implies c)))"),
    ("a U !F all x in (s): b <-> c", "(a U (not (F (all x s: (b iff c)))))"),
    ("all x in (s): p(x) then q", "(all x s: (p(x) then q))"),
    ("(all x in (s): p) & q", "(<(all x s: p)> and q)"),
    ("when a > 1: 2 when b: 3 otherwise: 4 + 5", "(when (a > 1): 2 b: 3 otherwise (4 + 5))"),
    ("when a: when b: 1 otherwise: 2 when c: 3 otherwise: 4", "(when a: (when b: 1 otherwise 2) c: 3 otherwise 4)"),
    # bounds
    ("eventually within 20 steps p & q", "((F[,20steps] p) and q)"),
    ("F[0,20] p U q", "((F[0,20] p) U q)"),
    ("always for 2 s X after 3 steps p", "(G[,2s] (X[,3steps] p))"),
    ("G[1 s, 2 s] p", "(G[1s,2s] p)"),
    ("weak_next after 1 step p", "(N[,1steps] p)"),
    # calls
    ("near(s1, close = 3 m + x)", "near(s1, close=(3m + x))"),
    ("min(a, b) > max(a, F b)", "(min(a, b) > max(a, (F b)))"),
]


@pytest.mark.parametrize(("text", "structure"), TABLE)
def test_operators_bind_in_the_documented_order(text: str, structure: str) -> None:
    assert brackets(read(text)) == structure


@pytest.mark.parametrize(
    ("text", "structure"),
    [
        ("m", "m"),
        ("s & min & deg", "((s and min) and deg)"),
        ("3 m > s", "(3m > s)"),
        ("F within & G for & X after", "(((F within) and (G for)) and (X after))"),
        ("F within 3 s within", "(F[,3s] within)"),
        ("F within// a comment\n3 s p", "(F[,3s] p)"),
        ("step | expect | at | in | as | x | inf", "((((((step or expect) or at) or in) or as) or x) or inf)"),
        ("all in in (as): in", "(all in as: in)"),
        ("FG & XX", "(FG and XX)"),
        ("a.b.F", "a.b.F"),
    ],
)
def test_unreserved_words_are_names(text: str, structure: str) -> None:
    assert brackets(read(text)) == structure
