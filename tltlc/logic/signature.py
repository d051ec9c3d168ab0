"""The truth of a formula on a few fixed traces, to prove quickly that one formula does not imply another.

The traces are 64 pseudo-random traces of three samples, and their suffixes of two samples and of one.
"""

from __future__ import annotations

from functools import reduce
from operator import and_, or_
from typing import Final
from weakref import WeakKeyDictionary
from zlib import crc32

from tltlc.logic.formula import Formula

_WIDTH: Final = 64
_WORD: Final = (1 << _WIDTH) - 1
_LAST: Final = _WORD << 2 * _WIDTH
_ALL: Final = (1 << 3 * _WIDTH) - 1

_cache: WeakKeyDictionary[Formula, int] = WeakKeyDictionary()


def signature(formula: Formula) -> int:
    """Return the truth values of a formula at the three positions of 64 fixed pseudo-random traces, as 192 bits.

    The lowest 64 bits are the truth values at the first position, one bit for each trace. If ``a``
    implies ``b`` on every finite trace, then ``signature(a) & ~signature(b)`` is 0.
    """
    bits = _cache.get(formula)
    if bits is not None:
        return bits
    stack = [formula]
    while stack:
        node = stack[-1]
        missing = [argument for argument in node.args if argument not in _cache]
        if missing:
            stack.extend(missing)
        else:
            stack.pop()
            _cache[node] = _bits(node, [_cache[argument] for argument in node.args])
    return _cache[formula]


def _bits(node: Formula, operands: list[int]) -> int:
    a = operands[0] if operands else 0
    b = operands[-1] if operands else 0
    match node.op:
        case "true":
            return _ALL
        case "false":
            return 0
        case "atom":
            return _random_bits(node.name)
        case "not":
            return _ALL ^ a
        case "and":
            return reduce(and_, operands)
        case "or":
            return reduce(or_, operands)
        case "implies":
            return _ALL ^ a | b
        case "iff":
            return _ALL ^ a ^ b
        case "X":
            return a >> _WIDTH
        case "N":
            return _weak_next(a)
        case "F":
            return a | a >> _WIDTH | a >> 2 * _WIDTH
        case "G":
            return a & _weak_next(a & _weak_next(a))
        case "U":
            return b | a & (b | a & b >> _WIDTH) >> _WIDTH
        case "M":
            return b & (a | (b & (a | (a & b) >> _WIDTH)) >> _WIDTH)
        case "W":
            return b | a & _weak_next(b | a & _weak_next(a | b))
        case "R":
            return b & (a | _weak_next(b & (a | _weak_next(b))))
        case _:
            raise ValueError(f"{node} still has a bound")


def _weak_next(bits: int) -> int:
    return bits >> _WIDTH | _LAST


def _random_bits(name: str) -> int:
    """Return 192 pseudo-random bits for the name of an atom; equal names have equal bits.

    The generator is splitmix64 (Steele et al. 2014).
    """
    state, bits = crc32(name.encode()), 0
    for _ in range(3):
        state = (state + 0x9E3779B97F4A7C15) & _WORD
        mixed = ((state ^ state >> 30) * 0xBF58476D1CE4E5B9) & _WORD
        mixed = ((mixed ^ mixed >> 27) * 0x94D049BB133111EB) & _WORD
        bits = bits << _WIDTH | mixed ^ mixed >> 31
    return bits
