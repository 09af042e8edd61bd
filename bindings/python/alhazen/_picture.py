"""Pictures as numpy arrays that notebooks display."""
from __future__ import annotations

import copy
import os
from typing import Any, Dict, Optional

import numpy as np

from . import _alhazen
from ._errors import FileError


class Picture(np.ndarray):
    """A picture: a float32 array (height, width, 3) of linear radiance; row 0 is the top.

    ``layers``: arrays of the other channels (height, width), by names such as ``depth.Z``; ``notes``: additions to the
    scene (a camera, a light); ``complete``, ``seconds`` and ``rays`` (total traced): figures of the render. Slices and
    results of arithmetic are pictures without layers.
    """

    layers: Dict[str, np.ndarray]
    notes: list
    complete: bool
    seconds: float
    rays: int

    def __array_finalize__(self, other: Any) -> None:
        self.layers = {}
        self.notes = []
        self.complete = True
        self.seconds = 0.0
        self.rays = 0

    @classmethod
    def of(cls, result: Dict[str, Any]) -> "Picture":
        """Creates a picture from the dict of the extension module."""
        picture = result["image"].view(cls)
        picture._keep(result)
        return picture

    def _keep(self, values: Dict[str, Any]) -> None:
        for name in ("layers", "notes", "complete", "seconds", "rays"):
            setattr(self, name, values[name])

    def __copy__(self) -> "Picture":
        other = self.copy()
        other._keep(vars(self))
        return other

    def __deepcopy__(self, memo: Optional[Dict[int, Any]] = None) -> "Picture":
        other = self.copy()
        other._keep(copy.deepcopy(vars(self), memo))
        return other

    def __reduce__(self) -> Any:
        reduced: Any = super().__reduce__()
        return reduced[0], reduced[1], (reduced[2], vars(self))

    def __setstate__(self, state: Any) -> None:
        super().__setstate__(state[0])
        self._keep(state[1])

    def save(self, path: "str | os.PathLike[str]") -> None:
        """Writes the picture by the suffix of the path: png, jpg (sRGB), exr, hdr, pfm (linear)."""
        suffix = os.path.splitext(os.fspath(path))[1][1:].lower()
        data = _alhazen.encode_picture(suffix, np.asarray(self))
        try:
            with open(path, "wb") as file:
                file.write(data)
        except OSError as error:
            raise FileError(f"{os.fspath(path)}: cannot write the file: {error.strerror}", os.fspath(path)) from error

    def _repr_png_(self) -> Optional[bytes]:
        if self.ndim not in (2, 3) or (self.ndim == 3 and self.shape[2] not in (1, 3)) or 0 in self.shape:
            return None
        return _alhazen.encode_picture("png", np.asarray(self))
