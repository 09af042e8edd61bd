"""Errors of the library as Python exceptions."""
from __future__ import annotations

from typing import Optional


class Error(Exception):
    """Base of all errors of alhazen.

    ``file``, ``line`` and ``column`` (from 1) locate the error in a scene file or program; None if unknown. The
    message lists all findings, one per line.
    """

    def __init__(self, message: str, file: Optional[str] = None, line: Optional[int] = None,
                 column: Optional[int] = None) -> None:
        super().__init__(message)
        self.file = file
        self.line = line
        self.column = column


class RenderError(Error, RuntimeError):
    """A check or a render failed."""


class UsageError(Error, ValueError):
    """Invalid call: an unknown name, an invalid option, an array of the wrong shape."""


class SceneError(Error, ValueError):
    """The scene or its data is invalid."""


class FileError(Error, OSError):
    """A file could not be read or written."""

    def __init__(self, message: str, file: Optional[str] = None, line: Optional[int] = None,
                 column: Optional[int] = None) -> None:
        Error.__init__(self, message, file, line, column)

    def __str__(self) -> str:
        return str(self.args[0])


class ResourceError(Error, MemoryError):
    """Memory, a count, a depth or a limit was exceeded."""


class SceneWarning(UserWarning):
    """Part of a scene was not read literally."""
