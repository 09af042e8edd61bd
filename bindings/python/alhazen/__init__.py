"""Alhazen: ray tracing of exact solids and meshes.

    import alhazen, numpy as np
    scene = alhazen.Scene(vertices, faces)              # a mesh; or alhazen.load("scene.alhazen")
    scene.add(alhazen.sphere(center=(0, 0, 1), radius=0.5))
    hits = scene.intersect(rays)                        # (..., 6) -> dict of arrays
    picture = scene.render(640, 480)                    # (480, 640, 3), linear

``Scene`` traces rays, measures solids and renders. Functions named as the blocks of the scene format (``sphere``,
``difference``, ``material`` ...) make its contents. ``alhazen.trimesh`` and ``alhazen.raycasting`` have the interfaces
of trimesh and Open3D. Errors are ``alhazen.Error``. The guide is docs/guide/python.md.
"""
from __future__ import annotations

from typing import Dict

import numpy as _numpy

from . import _alhazen
from ._errors import Error, FileError, RenderError, ResourceError, SceneError, SceneWarning, UsageError
from ._picture import Picture
from ._scene import INVALID_ID, Scene, load
from . import blocks
from .blocks import *  # noqa: F403

# The public module name, for messages and help().
for _public in (Error, FileError, Picture, RenderError, ResourceError, Scene, SceneError, SceneWarning, UsageError,
                blocks.Block, blocks.Call, blocks.Word, load):
    _public.__module__ = "alhazen"

__version__: str = _alhazen.version


def renderers() -> Dict[str, str]:
    """The renderers: name and description."""
    return dict(_alhazen.renderers())


def accelerators() -> Dict[str, str]:
    """The accelerators: name and description."""
    return dict(_alhazen.accelerators())


def layers() -> Dict[str, str]:
    """The layers that ``Scene.render`` can add: name and description."""
    return dict(_alhazen.layers())


def hit_fields() -> "list[str]":
    """The fields of ``Scene.intersect``."""
    return list(_alhazen.hit_fields())


def traced_in_place(rays: object) -> bool:
    """True if ``intersect`` and ``occluded`` read these rays in place: a contiguous float64 array (..., 8) that starts
    at a multiple of 64 bytes, as ``aligned_rays`` makes. Other rays are converted block by block."""
    return _alhazen.traced_in_place(rays)


def aligned_rays(*shape: int) -> _numpy.ndarray:
    """A float64 array (*shape, 8) for rays that are traced in place: t_min is 0, t_max infinite, all else 0.
    Raises ValueError for a negative size."""
    count = 8
    for n in shape:
        if n < 0:
            raise ValueError(f"aligned_rays: a size of {n} rays")
        count *= n
    memory = _numpy.zeros(count + 8)
    begin = (-memory.ctypes.data % 64) // 8
    rays = memory[begin:begin + count].reshape(*shape, 8)
    rays[..., 7] = _numpy.inf
    return rays


__all__ = ["Error", "FileError", "INVALID_ID", "Picture", "RenderError", "ResourceError", "Scene", "SceneError",
           "SceneWarning", "UsageError", "accelerators", "aligned_rays", "blocks", "hit_fields", "layers", "load",
           "renderers", "traced_in_place"] + [name for name in blocks.__all__ if name != "object"]
