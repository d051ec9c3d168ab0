"""Errors for files that are damaged, of another version, or inconsistent."""

from __future__ import annotations

from tltlc.api import Diagnostic, TltlError, record


@record
class LoadErrors:
    """The errors of one kind of file, such as policies.

    In messages, ``article`` and ``noun`` name the kind, such as "a" and "policy".
    ``unreadable_code`` is the code for a file that is damaged or of another format,
    ``version_code`` for another version, and ``broken_code`` for invalid content. ``again`` says
    how to make the file again, such as "train the policy again".
    """

    article: str
    noun: str
    unreadable_code: str
    version_code: str
    broken_code: str
    again: str

    def unreadable_error(self, name: str, why: str) -> TltlError:
        """Return the error for a file that is damaged or of another format.

        ``name`` is the name of the file in the message, and ``why`` the reason.
        """
        return self._error(self.unreadable_code, f"`{name}` cannot be read as {self.article} {self.noun}: {why}")

    def broken_error(self, name: str, why: str) -> TltlError:
        """Return the error for a file with invalid content.

        ``name`` is the name of the file in the message, and ``why`` the reason.
        """
        return self._error(self.broken_code, f"`{name}` is a broken {self.noun}: {why}")

    def check_version(self, name: str, version: object, supported: int) -> None:
        """Raise TltlError if the version in a file is not ``supported``.

        ``version`` was read from the file and may have any type. ``name`` is the name of the file
        in the message.
        """
        if type(version) is int and version == supported:
            return
        help_ = "use a newer tltlc" if type(version) is int and version > supported else self.again
        title = f"`{name}` has version {version!r:.20}, and only version {supported} can be read"
        raise TltlError([Diagnostic(self.version_code, title, help=help_)])

    def _error(self, code: str, title: str) -> TltlError:
        return TltlError([Diagnostic(code, title, help=f"get a whole copy of the file, or {self.again}")])
