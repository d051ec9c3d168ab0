"""Read clauses that are written as English sentences: ``when died, respawned within 5 s``.

The parts of a sentence are read on their own and put together: conditions (:mod:`.states`), what follows
them (:mod:`.answers`), rules (:mod:`.rules`) and goals (:mod:`.goals`). A sentence with two readings has
none here.
"""
