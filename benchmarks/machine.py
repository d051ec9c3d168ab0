"""Describe the machine of the measurements: processor, memory, system and versions, but no host or folder names."""

from __future__ import annotations

import os
import platform
import re
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PEERS = ("ltlf2dfa", "rtamt", "reelay")


def facts() -> dict[str, str]:
    """Return what a reader needs to judge the absolute figures, in the order of a table."""
    return {
        "processor": f"{_processor()}, {os.cpu_count()} cores",
        "memory": f"{os.sysconf('SC_PAGE_SIZE') * os.sysconf('SC_PHYS_PAGES') / 2**30:.0f} GiB",
        "system": f"{platform.system()} {platform.machine()}",
        "Python": f"{platform.python_implementation()} {platform.python_version()}",
        "MONA": _mona(),
        **{name: _version(name) for name in PEERS},
    }


def _processor() -> str:
    try:
        match = re.search(r"model name\s*:\s*(.+)", Path("/proc/cpuinfo").read_text(encoding="utf-8"))
    except OSError:
        match = None
    return match.group(1) if match else platform.processor() or "unknown"


def _mona() -> str:
    try:
        text = subprocess.run(["mona"], capture_output=True, text=True, check=False).stdout
    except FileNotFoundError:
        return "not installed"
    return (re.search(r"MONA v(\S+)", text) or ["", "unknown"])[1]


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"
