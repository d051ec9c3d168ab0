"""Read clauses that are written as English sentences: ``when died, respawned within 5 s``.

The parts of a sentence are read on their own and put together:

- conditions (:mod:`tltlc.grammar.mistakes.sentences.states`),
- what follows them (:mod:`tltlc.grammar.mistakes.sentences.answers`),
- rules (:mod:`tltlc.grammar.mistakes.sentences.rules`),
- goals (:mod:`tltlc.grammar.mistakes.sentences.goals`).

A sentence with two readings has none here.
"""
