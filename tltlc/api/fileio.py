"""How do I read and write files so that every failure is a diagnostic?

The functions that read raise ``TltlError`` for files that are missing, too large or malformed;
``limits`` has the greatest sizes. The functions that write replace a file as a whole or not at all.
``try_lock`` locks a file until the process ends, even if the process is killed. ``temporary_folder``
makes a folder and removes it at the end; if the process is killed, a later process removes the folder.
"""

from tltlc.io import limits
from tltlc.io.access_log import descriptor_of
from tltlc.io.archive import Archive, unpack
from tltlc.io.child_interrupts import block_interrupts
from tltlc.io.files import (
    MAX_ARTEFACT_BYTES,
    exists,
    is_dir,
    is_file,
    may_be_file,
    read_bytes,
    read_source,
    reading_error,
    reason,
)
from tltlc.io.json_text import load as load_json
from tltlc.io.json_text import loads as parse_json
from tltlc.io.locking import try_lock
from tltlc.io.project import FILE_NAME as PROJECT_FILE
from tltlc.io.project import project_for
from tltlc.io.resources import resource_limits
from tltlc.io.spec_file import is_plain_name
from tltlc.io.spec_file import read as read_spec_file
from tltlc.io.spec_file import split as split_spec_name
from tltlc.io.temporary import temporary_folder
from tltlc.io.toml_text import parse as parse_toml
from tltlc.io.writing import check_not_read, remove_file, replace_file, write_file, write_files

__all__ = [
    "MAX_ARTEFACT_BYTES",
    "PROJECT_FILE",
    "Archive",
    "block_interrupts",
    "check_not_read",
    "descriptor_of",
    "exists",
    "is_dir",
    "is_file",
    "is_plain_name",
    "limits",
    "load_json",
    "may_be_file",
    "parse_json",
    "parse_toml",
    "project_for",
    "read_bytes",
    "read_source",
    "read_spec_file",
    "reading_error",
    "reason",
    "remove_file",
    "replace_file",
    "resource_limits",
    "split_spec_name",
    "temporary_folder",
    "try_lock",
    "unpack",
    "write_file",
    "write_files",
]
