"""The interface of Open3D's ``RaycastingScene``, on numpy arrays instead of tensors.

Source: the documentation of Open3D, ``open3d.t.geometry.RaycastingScene``. Differs: results are numpy arrays; all is
computed in float64, and t_hit, uvs, points and distances are of the type of the rays or points.
"""
from __future__ import annotations

from typing import Any, Dict, Optional, Tuple, overload

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
        # Of how many meshes: the number of those that are closed, and a scene of the others.
        self._sorted: Optional[Tuple[int, int, Optional[Scene]]] = None

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
        """The number of hits of each ray (..., 6): int32 (...)."""
        return self._scene.count_intersections(rays, threads=nthreads).astype(np.int32)

    def list_intersections(self, rays: Any, nthreads: int = 0) -> Dict[str, np.ndarray]:
        """All hits of rays (..., 6), flat: ray_splits (rays + 1), ray_ids (both int64), t_hit (h,), geometry_ids,
        primitive_ids (uint32), primitive_uvs (h, 2)."""
        hits = self._scene.all_hits(rays, threads=nthreads)
        hits["primitive_uvs"] = hits.pop("uvs")
        return hits

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> np.ndarray:
        """1 for points (..., 3) inside of an odd number of meshes, else 0: float32 (...). Each mesh that is closed is
        asked whether it holds the point; ``nsamples`` (odd) rays vote on those that are open, inside where they cross
        an odd number of their triangles. Points on the surface of a closed mesh are inside."""
        return self._inside(query_points, nthreads, nsamples).astype(np.float32)

    def compute_closest_points(self, query_points: Any, nthreads: int = 0) -> Dict[str, np.ndarray]:
        """The nearest points of the meshes to points (..., 3): points (..., 3), geometry_ids, primitive_ids (uint32),
        primitive_uvs (..., 2) and primitive_normals (..., 3); see ``Scene.closest_points``."""
        found = self._scene.closest_points(query_points, threads=nthreads)
        del found["distance"]
        found["primitive_uvs"] = found.pop("uvs")
        found["primitive_normals"] = found.pop("normals")
        return found

    def compute_distance(self, query_points: Any, nthreads: int = 0) -> np.ndarray:
        """The distance of points (..., 3) from the meshes, scene units: real (...)."""
        return self._scene.closest_points(query_points, threads=nthreads)["distance"]

    def compute_signed_distance(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> np.ndarray:
        """The distance of points (..., 3), negative for those inside, as ``compute_occupancy`` has it: real (...)."""
        distance = self.compute_distance(query_points, nthreads)
        inside = self._inside(query_points, nthreads, nsamples)
        return np.negative(distance, out=distance, where=inside & (distance > 0))

    def _inside(self, query_points: Any, nthreads: int, nsamples: int) -> np.ndarray:
        if nsamples < 1 or nsamples % 2 != 1:
            raise UsageError(f"nsamples: expected an odd number from 1, found {nsamples}")
        points = np.asarray(query_points)
        if points.shape[-1:] != (3,):
            raise UsageError(f"query_points: expected the shape (..., 3), found {points.shape}")
        solids, open_meshes = self._closed_and_open()
        if solids == 1 and open_meshes is None:
            return self._scene.inside(points, threads=nthreads)
        inside = np.zeros(points.shape[:-1], dtype=bool)
        if open_meshes is not None:
            inside = _votes(open_meshes, points, nthreads, nsamples)
        if solids:
            held = self._scene.solids_at(points, threads=nthreads)
            inside ^= (np.diff(held["point_splits"]) % 2 == 1).reshape(inside.shape)
            inside.reshape(-1)[held["point_ids"][held["on_surface"]]] = True
        return inside

    def _closed_and_open(self) -> Tuple[int, Optional[Scene]]:
        """The number of closed meshes, and a scene of the others, if there are any."""
        if self._sorted is None or self._sorted[0] != self._count:
            closed = set(self._scene.solid_names)
            others = [i for i, name in enumerate(self._scene.geometry_names) if name not in closed]
            self._sorted = self._count, len(closed), self._scene._only(others) if others else None
        return self._sorted[1:]

    @overload
    @staticmethod
    def create_rays_pinhole(fov_deg: float, center: Any, eye: Any, up: Any, width_px: int,
                            height_px: int) -> np.ndarray: ...

    @overload
    @staticmethod
    def create_rays_pinhole(intrinsic_matrix: Any, extrinsic_matrix: Any, width_px: int,
                            height_px: int) -> np.ndarray: ...

    @staticmethod
    def create_rays_pinhole(*arguments: Any, **named: Any) -> np.ndarray:
        """The rays (height, width, 6), float32, of a camera, through the middles of its pixels.

        Either ``fov_deg, center, eye, up, width_px, height_px``: from ``eye`` to ``center``, scene units; ``fov_deg``
        is the horizontal field of view. Rows count towards ``up`` and columns to the left, as in Open3D: pass -up for
        a picture whose row 0 is the top. Along the view directions have length 1.

        Or ``intrinsic_matrix, extrinsic_matrix, width_px, height_px``: a matrix (3, 3) that takes points of the camera
        to pixels, and one (4, 4) that takes points of the world to the camera, which looks along its z axis.
        """
        names = next((names for names in _PINHOLE_ARGUMENTS if len(arguments) <= len(names)
                      and set(names[len(arguments):]) == set(named)), None)
        if names is None:
            given = f"found {len(arguments)} by position" + (f" and {', '.join(named)}" if named else "")
            raise UsageError("create_rays_pinhole: expected " + ", or ".join(map(", ".join, _PINHOLE_ARGUMENTS))
                             + "; " + given)
        values = {**dict(zip(names, arguments)), **named}
        width, height = (int(values.pop(name)) for name in ("width_px", "height_px"))
        if width < 1 or height < 1:
            raise UsageError(f"create_rays_pinhole: {width} x {height} pixels; expected 1 x 1 or more")
        if "fov_deg" in values:
            intrinsic, extrinsic = _camera_at(width=width, height=height, **values)
        else:
            intrinsic = _matrix(values["intrinsic_matrix"], 3, "intrinsic_matrix")
            extrinsic = _matrix(values["extrinsic_matrix"], 4, "extrinsic_matrix")
        world_from_camera = extrinsic[:3, :3].T
        world_from_pixel = world_from_camera @ np.linalg.inv(intrinsic)
        rays = np.empty((height, width, 6), dtype=np.float32)
        rays[..., :3] = -world_from_camera @ extrinsic[:3, 3]
        x, y = np.arange(width) + 0.5, np.arange(height) + 0.5
        rays[..., 3:] = (x[None, :, None] * world_from_pixel[:, 0] + y[:, None, None] * world_from_pixel[:, 1]
                         + world_from_pixel[:, 2])
        return rays


def _votes(scene: Scene, points: np.ndarray, nthreads: int, nsamples: int) -> np.ndarray:
    """Whether most of ``nsamples`` rays from each point (..., 3) cross an odd number of triangles: bool (...)."""
    points = points.astype(np.float64, copy=False)
    votes = np.zeros(points.shape[:-1], dtype=np.int64)
    # About the direction (1, 1, 1), the same for each call.
    for direction in 1 + np.random.default_rng(42).uniform(-0.001, 0.001, (nsamples, 3)):
        rays = np.concatenate([points, np.broadcast_to(direction, points.shape)], axis=-1)
        votes += scene.count_intersections(rays, threads=nthreads) % 2
    return votes > nsamples // 2


_PINHOLE_ARGUMENTS = (("fov_deg", "center", "eye", "up", "width_px", "height_px"),
                      ("intrinsic_matrix", "extrinsic_matrix", "width_px", "height_px"))


def _matrix(numbers: Any, size: int, name: str) -> np.ndarray:
    matrix = np.asarray(numbers, dtype=np.float64)
    if matrix.shape != (size, size):
        raise UsageError(f"{name}: expected the shape ({size}, {size}), found {matrix.shape}")
    return matrix


def _camera_at(fov_deg: float, center: Any, eye: Any, up: Any, width: int, height: int
               ) -> Tuple[np.ndarray, np.ndarray]:
    """The intrinsic and the extrinsic matrix; the rows of the rotation are the camera's axes."""
    eye, center, up = (np.asarray(v, dtype=np.float64) for v in (eye, center, up))
    z = (center - eye) / np.linalg.norm(center - eye)
    x = np.cross(up, z)
    if not np.linalg.norm(x) > 0:
        raise UsageError("create_rays_pinhole: up is parallel to the view")
    x /= np.linalg.norm(x)
    focal = 0.5 * width / np.tan(0.5 * np.radians(fov_deg))
    extrinsic = np.eye(4)
    extrinsic[:3, :3] = x, np.cross(z, x), z
    extrinsic[:3, 3] = -extrinsic[:3, :3] @ eye
    return np.array([[focal, 0, 0.5 * width], [0, focal, 0.5 * height], [0, 0, 1]]), extrinsic
