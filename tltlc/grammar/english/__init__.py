"""Read English sentences about games as clauses: a grammar of the words that designers use, and what they mean.

Begin with :mod:`tltlc.grammar.english.readings`.
"""
