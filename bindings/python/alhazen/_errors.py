"""Errors of the library as Python exceptions."""
from __future__ import annotations

from typing import Optional


class Error(Exception):
    """Base of all errors of alhazen.

    ``file``, ``line`` and ``column`` are the place in a scene file or a program that the error is about, from 1;
    None where it is not known. The message lists all findings, one a line.
    """

    def __init__(self, message: str, file: Optional[str] = None, line: Optional[int] = None,
                 column: Optional[int] = None) -> None:
        super().__init__(message)
        self.file = file
        self.line = line
        self.column = column


class RenderError(Error, RuntimeError):
    """A check did not hold, or the render failed."""


class UsageError(Error, ValueError):
    """The call is wrong: an unknown name, a bad option, an array of another shape."""


class SceneError(Error, ValueError):
    """The scene or its data is bad."""


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
    """Something in a scene was read otherwise than it is written."""
