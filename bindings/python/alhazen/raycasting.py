"""The interface of Open3D's ``RaycastingScene``, on numpy arrays instead of tensors.

Source: the documentation of Open3D, ``open3d.t.geometry.RaycastingScene``. Differs: results are numpy arrays; hits are
computed in float64, and t_hit and uvs are of the rays' type. Not there, because the library answers no such
question: compute_closest_points, compute_distance, compute_signed_distance.
"""
from __future__ import annotations

from typing import Any, Dict, Optional

import numpy as np

from ._errors import UsageError
from ._scene import INVALID_ID, Scene

__all__ = ["RaycastingScene"]


class RaycastingScene:
    """Triangle meshes that rays are cast at.

    >>> scene = RaycastingScene()
    >>> scene.add_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    0
    >>> import numpy as np
    >>> scene.cast_rays(np.float32([[0.25, 0.25, 1, 0, 0, -1]]))["primitive_uvs"]
    array([[0.25, 0.25]], dtype=float32)
    """

    INVALID_ID = INVALID_ID

    def __init__(self, nthreads: int = 0) -> None:
        self._scene = Scene(threads=nthreads)
        self._count = 0

    def add_triangles(self, vertex_positions: Any, triangle_indices: Any = None) -> int:
        """Adds a mesh and returns its geometry id: vertices (n, 3) and triangles (m, 3), or one object with
        ``vertices`` and ``triangles`` or ``faces``."""
        if triangle_indices is None:
            mesh = vertex_positions
            vertex_positions = np.asarray(mesh.vertices)
            triangle_indices = np.asarray(mesh.triangles if hasattr(mesh, "triangles") else mesh.faces)
        self._scene.add_mesh(vertex_positions, triangle_indices)
        self._count += 1
        return self._count - 1

    def cast_rays(self, rays: Any, nthreads: int = 0) -> Dict[str, np.ndarray]:
        """The first hits of rays (..., 6): t_hit, geometry_ids, primitive_ids (uint32), primitive_uvs (..., 2) and
        primitive_normals (..., 3)."""
        hits = self._scene.intersect(rays, threads=nthreads)
        hits["primitive_uvs"] = hits.pop("uvs")
        hits["primitive_normals"] = hits.pop("normals")
        return hits

    def test_occlusions(self, rays: Any, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0) -> np.ndarray:
        """Whether rays (..., 6) hit anything from tnear to tfar: bool (...)."""
        rays = np.asarray(rays)
        if rays.shape[-1:] != (6,):
            raise UsageError(f"rays: expected the shape (..., 6), found {rays.shape}")
        if tnear == 0.0 and tfar == np.inf:
            return self._scene.occluded(rays, threads=nthreads)
        limited = np.empty(rays.shape[:-1] + (8,), dtype=rays.dtype if rays.dtype == np.float32 else np.float64)
        limited[..., :6] = rays
        limited[..., 6] = tnear
        limited[..., 7] = tfar
        return self._scene.occluded(limited, threads=nthreads)

    def count_intersections(self, rays: Any, nthreads: int = 0) -> np.ndarray:
        """The number of hits of each ray: int32 (...)."""
        return self._scene.count_intersections(rays, threads=nthreads).astype(np.int32)

    def list_intersections(self, rays: Any, nthreads: int = 0) -> Dict[str, np.ndarray]:
        """All hits: ray_splits (rays + 1), ray_ids, t_hit, geometry_ids, primitive_ids, primitive_uvs."""
        hits = self._scene.all_hits(rays, threads=nthreads)
        hits["primitive_uvs"] = hits.pop("uvs")
        return hits

    def compute_occupancy(self, query_points: Any, nthreads: int = 0) -> np.ndarray:
        """1 for points (..., 3) inside of a closed mesh, else 0: float32 (...)."""
        return self._scene.inside(query_points, threads=nthreads).astype(np.float32)

    @staticmethod
    def create_rays_pinhole(fov_deg: float, center: Any, eye: Any, up: Any, width_px: int,
                            height_px: int) -> np.ndarray:
        """The rays (height, width, 6), float32, of a camera at ``eye`` that looks at ``center``; ``fov_deg`` is the
        horizontal field of view. Rays go through the middles of the pixels; along the view directions have length 1."""
        eye, center, up = (np.asarray(v, dtype=np.float64) for v in (eye, center, up))
        view = center - eye
        view = view / np.linalg.norm(view)
        right = np.cross(view, up)
        right /= np.linalg.norm(right)
        down = np.cross(view, right)
        half = np.tan(np.radians(fov_deg) / 2) / (width_px / 2)
        x = (np.arange(width_px) + 0.5 - width_px / 2) * half
        y = (np.arange(height_px) + 0.5 - height_px / 2) * half
        rays = np.empty((height_px, width_px, 6), dtype=np.float32)
        rays[..., :3] = eye
        rays[..., 3:] = view + x[None, :, None] * right + y[:, None, None] * down
        return rays
