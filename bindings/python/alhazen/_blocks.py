"""Blocks of the native scene format as Python objects, and their text.

The text format is described in docs/reference/formats/native.md; the reader supplies names and keys of blocks.
"""
from __future__ import annotations

import copy
import os
import re
import sys
from typing import Any, Dict, Iterator, List, Mapping, Sequence, Tuple

import numpy as np

from . import _alhazen
from ._errors import UsageError

_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*\Z")
_FOLDER = os.path.dirname(os.path.abspath(__file__))

Origin = Tuple[str, int]


class Call:
    """A value such as ``translate(1, 2, 3)`` or ``texture("bark", 0.5)``: see the functions of these names."""

    def __init__(self, name: str, *arguments: Any) -> None:
        self.name = name
        self.arguments = arguments

    def __repr__(self) -> str:
        return _text_of(self)


class Word(str):
    """A keyword of the format, written without quotes."""


def _caller() -> Origin:
    """The current statement outside this package."""
    frame = sys._getframe(1)
    while frame.f_back is not None and os.path.dirname(os.path.abspath(frame.f_code.co_filename)) == _FOLDER:
        frame = frame.f_back
    return frame.f_code.co_filename, frame.f_lineno


def _quoted(text: str) -> str:
    try:
        text.encode()
    except UnicodeEncodeError:
        raise UsageError(f"{text!a} is no text: it has half a pair of surrogates") from None
    escapes = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\r": "\\r", "\t": "\\t"}
    return '"' + "".join(escapes.get(c, c if c >= " " else f"\\x{ord(c):02x}") for c in text) + '"'


def _number(value: Any) -> str:
    if not np.isfinite(value):
        raise UsageError(f"{value} cannot be written: numbers of a scene are finite")
    return repr(float(value))


def _text_of(value: Any) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return _number(value)
    if isinstance(value, Word):
        return str(value)
    if isinstance(value, (str, os.PathLike)):
        return _quoted(os.fspath(value))
    if isinstance(value, Call):
        return value.name + "(" + ", ".join(_text_of(a) for a in value.arguments) + ")"
    if isinstance(value, Block):
        return value._body()
    if isinstance(value, Mapping):
        return "{ " + "; ".join(f"{_checked(k)} = {_text_of(v)}" for k, v in value.items()) + " }"
    if isinstance(value, np.ndarray):
        return _text_of(value.tolist())
    if isinstance(value, Sequence):
        return "(" + ", ".join(_text_of(v) for v in value) + ")"
    raise UsageError(f"{value!r} is no value of a scene: expected a number, text, a list, a dict or a block")


def _checked(word: str) -> str:
    if not _WORD.match(word):
        raise UsageError(f"{word!r} is no key: expected letters, digits and _")
    return word


class Block:
    """A block of a scene: ``Block("sphere", "ball", radius=2)`` is ``sphere "ball" { radius = 2 }``.

    The functions of this module (``alhazen.sphere`` and so on) make blocks. ``items`` are the nested blocks;
    ``repr`` is the text of the block. Values are numbers, texts, lists or arrays, dicts, other blocks and calls
    (``alhazen.translate``); a ``transform`` may be an array (3, 4) or (4, 4).
    """

    def __init__(self, type: str, name: str = "", *items: "Block", **keys: Any) -> None:
        self.type = _checked(type)
        self.name = name
        self.items: List[Block] = list(items)
        self.keys: Dict[str, Any] = {_checked(k): _prepared(type, k, v) for k, v in keys.items() if v is not None}
        self.origin = _caller()
        for item in self.items:
            if not isinstance(item, Block):
                raise UsageError(f"{type}: {item!r} is no block")

    def _with(self, key: str, value: Any) -> "Block":
        """A copy with another value of a key."""
        other = copy.copy(self)
        other.keys = {**self.keys, key: value}
        return other

    def _body(self) -> str:
        pairs = [f"{k} = {_text_of(v)}" for k, v in self.keys.items()]
        inner = "; ".join(pairs + [item._text() for item in self.items])
        return f"{{ {inner} }}" if inner else "{ }"

    def _head(self) -> str:
        return self.type + (" " + _quoted(self.name) if self.name else "")

    def _text(self) -> str:
        return self._head() + " " + self._body()

    def _lines(self) -> Iterator[Tuple[str, Origin]]:
        """The lines of its text, each with the location of the statement that made it."""
        if not self.items:
            yield self._text(), self.origin
            return
        pairs = "; ".join(f"{k} = {_text_of(v)}" for k, v in self.keys.items())
        yield f"{self._head()} {{ {pairs}", self.origin
        for item in self.items:
            yield from item._lines()
        yield "}", self.origin

    def __repr__(self) -> str:
        return self._text()


def _names_files(value: Any) -> bool:
    """Tests whether a block, or a value of one, names a file."""
    if isinstance(value, Block):
        return _names_files(value.keys) or any(map(_names_files, value.items))
    if isinstance(value, Mapping):
        return any(k in ("file", "profile") and isinstance(v, (str, os.PathLike)) or _names_files(v) or
                   k == "point_keys" and _has_text(v) for k, v in value.items())
    if isinstance(value, Call):
        return any(map(_names_files, value.arguments))
    return isinstance(value, (list, tuple)) and any(map(_names_files, value))


def _has_text(value: Any) -> bool:
    """Tests whether a value of point_keys is, or holds, the name of a mesh file."""
    return isinstance(value, (str, os.PathLike)) or isinstance(value, (list, tuple)) and any(map(_has_text, value))


def _transform(value: Any) -> Any:
    if isinstance(value, np.ndarray) and value.shape in ((3, 4), (4, 4)):
        if value.shape == (4, 4) and not np.array_equal(value[3], (0, 0, 0, 1)):
            raise UsageError("a transform (4, 4) has the last row 0, 0, 0, 1")
        return Call("matrix", *value[:3].tolist())
    return value


def _prepared(type: str, key: str, value: Any) -> Any:
    """The value of a key: keywords without quotes, transform arrays as matrices."""
    if key == "transform":
        return _transform(value)
    if key == "motion" and isinstance(value, Sequence):
        return [(time, _transform(transform)) for time, transform in value]
    words = KEYWORDS.get((type, key))
    if key == "visible_to":
        if isinstance(value, str):
            return Word(_checked(value))
        return [Word(_checked(v)) for v in value]
    if words and isinstance(value, str):
        if value not in words:
            raise UsageError(f"{type}: {key} is {value!r}; expected one of {', '.join(words)}")
        return Word(value)
    return value


#: The blocks of the format: (name, is_shape, [(key, keywords, required, unit, default)]).
VOCABULARY: List[Tuple[str, bool, List[Tuple[str, List[str], bool, str, str]]]] = _alhazen.vocabulary()
KEYWORDS: Dict[Tuple[str, str], List[str]] = {
    (block, key): words for block, _, keys in VOCABULARY for key, words, *_ in keys if words}
