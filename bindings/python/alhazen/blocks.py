"""All blocks of the native scene format, one function each, and the values specific to the format.

``alhazen.sphere("ball", center=(0, 0, 1), radius=0.5)`` makes a block for ``Scene.add``. The functions are generated
from the tables of the reader of the format; docs/reference/formats/native.md describes the keys.
"""
from __future__ import annotations

import inspect
from typing import Any, Callable, List, Sequence, Union

from ._blocks import VOCABULARY, Block, Call, Word

__all__ = ["Block", "Call", "Word", "translate", "rotate", "scale", "matrix", "texture_input"]


def translate(x: float, y: float, z: float) -> Call:
    """A transform: moves by (x, y, z), in scene units."""
    return Call("translate", x, y, z)


def rotate(axis: Sequence[float], degrees: float) -> Call:
    """A transform: turns right-handed about the axis, by degrees."""
    return Call("rotate", axis, degrees)


def scale(*factors: float) -> Call:
    """A transform: scales by one factor, or by one for each axis."""
    return Call("scale", *factors)


def matrix(rows: Any) -> Call:
    """A transform: three rows of four numbers, of a matrix that acts on columns."""
    return Call("matrix", *[list(row) for row in rows][:3])


def texture_input(name: str, factor: Any = 1.0, channel: str = "") -> Call:
    """A colour or number input of a material: a texture by name, times a factor; ``channel``, for numbers, is one of
    mean, red, green, blue, alpha."""
    return Call("texture", name, factor, *([Word(channel)] if channel else []))


_UNITS = {"point": "point, scene units", "vector": "vector, scene units", "direction": "vector of any length",
          "length": "scene units", "number": "number", "count": "whole number", "bool": "bool", "text": "text",
          "list": "list", "": ""}


def _describe(name: str, is_shape: bool, keys: List[Any]) -> str:
    lines = [f"{'A shape' if is_shape else 'A block'} ``{name}`` of a scene; keys:", ""]
    for key, words, required, unit, default in keys:
        notes = [_UNITS[unit]] if unit else []
        if words:
            notes.append("one of " + ", ".join(words))
        if required:
            notes.append("required")
        if default:
            notes.append("default " + default)
        lines.append(f"- {key}" + (": " + "; ".join(notes) if notes else ""))
    return "\n".join(lines)


def _function(name: str, is_shape: bool, keys: List[Any]) -> Callable[..., Block]:
    def make(label: str = "", *items: Block, **values: Any) -> Block:
        if isinstance(label, Block):  # difference(box(), sphere())
            items, label = (label, *items), ""
        return Block(name, label, *items, **values)

    make.__name__ = make.__qualname__ = name
    make.__doc__ = _describe(name, is_shape, keys)
    kind = inspect.Parameter
    parameters = [kind("label", kind.POSITIONAL_ONLY, default=""), kind("items", kind.VAR_POSITIONAL)]
    parameters += [kind(key, kind.KEYWORD_ONLY, default=None) for key, *_ in keys if key.isidentifier()]
    make.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return make


for _name, _is_shape, _keys in VOCABULARY:
    globals()[_name] = _function(_name, _is_shape, _keys)
    __all__.append(_name)
