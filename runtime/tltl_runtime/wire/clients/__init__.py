"""Clients of the protocol ``tltl/1``, one file for each language, that users copy into their games."""
