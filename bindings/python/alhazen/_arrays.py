"""Arrays that callers give."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._errors import UsageError


def array_of(values: Any, name: str, dtype: Any = None) -> np.ndarray:
    """The values as an array. Masked ones are an error: a plain array has no mask."""
    if np.ma.is_masked(values):
        raise UsageError(f"{name}: some numbers are masked; expected an array without a mask, as of numpy.ma.filled")
    return np.asarray(values, dtype=dtype)
