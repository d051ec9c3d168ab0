"""A file in which sentences of designers are typed, and what the grammar of sentences reads from them."""

from __future__ import annotations

from tltlc.core.source import SourceFile
from tltlc.grammar.english.readings import Sentence, sentence
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.sentences.calls import with_own_calls
from tltlc.grammar.mistakes.sentences.vocabulary import ENGLISH
from tltlc.grammar.mistakes.sentences.words import Words, words_of

HEAD = """\
clock 10 Hz
signal fire: bool
signal spray: bool
signal boss_dead: bool
signal coins: int in [0, 99]
signal lap: int in [0, 9]
signal health in [0, 100]
signal phase: (menu, shift, results)
signal state: (Idle, Dead)
"""
VARIES = "ends (phase is menu) or ends (phase is shift) or ends (phase is results)"


def words_of_sentence(typed: str) -> Words:
    source = SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n")
    start = len(HEAD) + len("spec s {\n")
    tokens = [token for token in tokenize(source.text).tokens if start <= token.start < token.end <= start + len(typed)]
    return with_own_calls(words_of(source, declared_names(source), tokens, ENGLISH))


def read(typed: str) -> Sentence:
    return sentence(words_of_sentence(typed))


def spec(typed: str) -> SourceFile:
    return SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n")
