"""Errors for files that are damaged, of another version, or inconsistent."""

from __future__ import annotations

from tltlc.api import Diagnostic, TltlError, record


@record
class Refusals:
    """The errors of files that contain what ``article`` and ``noun`` name, such as "a" and "policy".

    There is a code for a file that is something else or damaged, one for another version, and one
    for invalid content. ``again`` says how to make the file anew, such as "train the policy again".
    """

    article: str
    noun: str
    unreadable_code: str
    version_code: str
    broken_code: str
    again: str

    def unreadable(self, name: str, why: str) -> TltlError:
        """Return the error that the file ``name`` is something else or damaged."""
        return self._error(self.unreadable_code, f"`{name}` cannot be read as {self.article} {self.noun}: {why}")

    def broken(self, name: str, why: str) -> TltlError:
        """Return the error that something in the file ``name`` is invalid."""
        return self._error(self.broken_code, f"`{name}` is a broken {self.noun}: {why}")

    def check_version(self, name: str, found: object, known: int) -> None:
        """Raise TltlError if the version ``found`` in a file is not the ``known`` one."""
        if type(found) is int and found == known:
            return
        help_ = "use a newer tltlc" if type(found) is int and found > known else self.again
        title = f"`{name}` has version {found!r:.20}, and only version {known} can be read"
        raise TltlError([Diagnostic(self.version_code, title, help=help_)])

    def _error(self, code: str, title: str) -> TltlError:
        return TltlError([Diagnostic(code, title, help=f"get a whole copy of the file, or {self.again}")])
