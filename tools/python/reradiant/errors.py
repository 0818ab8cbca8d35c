"""Exceptions of reradiant, each with the place in the file where there is one."""

from __future__ import annotations

from typing import Optional


class Error(Exception):
    """An error; its message says what is wrong, where, and what would be right.

    Attributes
    ----------
    file, line, column : str or int, or None where not known
        Place in the input; lines and columns count from 1.
    """

    def __init__(self, message: str, file: Optional[str] = None, line: Optional[int] = None,
                 column: Optional[int] = None) -> None:
        super().__init__(message)
        self.file = file
        self.line = line
        self.column = column


class InputError(Error, ValueError):
    """An argument or a file is wrong; the message says what would be right."""


class RunError(Error, RuntimeError):
    """A failure that no change of the input would cure: device, disk, a fit without result."""
