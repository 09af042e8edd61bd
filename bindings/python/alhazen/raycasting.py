"""The interface of Open3D's ``RaycastingScene``, on numpy arrays instead of tensors.

Source: the documentation of Open3D, ``open3d.t.geometry.RaycastingScene``; compared with Open3D 0.16.1 by
``open3d_parity_test``.

Differs:

- Results are numpy arrays. Arguments may be tensors of Open3D, arrays of numbers of any type, or lists; a single ray
  (6,) or point (3,) is accepted. Computations are in float64; t_hit, uvs, points and distances are float32 for float32
  rays or points, else float64.
- Invalid calls raise ``UsageError`` (a ``ValueError``) and invalid meshes ``SceneError``, not ``RuntimeError``. Cameras
  for which Open3D returns NaN rays are errors.
- ``list_intersections`` sorts the hits of a ray. Coincident triangles are separate hits.
- On an edge or corner a ray hits exactly one of the triangles there: the number of crossings of a closed mesh is even.
  Of several triangles equally near to a point the first is returned.
- A point on the surface of a closed mesh is inside. Without triangles distances are infinite; for points that are not
  finite they are NaN.
"""
from __future__ import annotations

import operator
from typing import Any, Dict, Optional, Tuple, overload

import numpy as np

from ._arrays import array_of
from ._errors import UsageError
from ._scene import INVALID_ID, Scene

__all__ = ["RaycastingScene"]


class RaycastingScene:
    """Triangle meshes for ray casting.

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
        # Number of meshes it is valid for, number of closed ones, and a scene of the open ones.
        self._sorted: Optional[Tuple[int, int, Optional[Scene]]] = None

    @overload
    def add_triangles(self, vertex_positions: Any, triangle_indices: Any) -> int: ...

    @overload
    def add_triangles(self, mesh: Any, /) -> int: ...

    @overload
    def add_triangles(self, *, mesh: Any) -> int: ...

    def add_triangles(self, vertex_positions: Any = None, triangle_indices: Any = None, *, mesh: Any = None) -> int:
        """Adds a mesh and returns its geometry id: vertices (n, 3), scene units, and triangles (m, 3), or one mesh: of
        Open3D, tensor-based or legacy, or an object with ``vertices`` and ``triangles`` or ``faces``."""
        if mesh is None and triangle_indices is None:
            vertex_positions, mesh = None, vertex_positions
        if (mesh is None) == (vertex_positions is None) or (vertex_positions is None) != (triangle_indices is None):
            raise UsageError("add_triangles: expected vertex_positions, triangle_indices, or mesh")
        if mesh is not None:
            vertex_positions, triangle_indices = _triangles_of(mesh)
        self._scene.add_mesh(_array(vertex_positions), _array(triangle_indices))
        self._count += 1
        return self._count - 1

    def cast_rays(self, rays: Any, nthreads: int = 0) -> Dict[str, np.ndarray]:
        """The first hits of rays (..., 6): t_hit, geometry_ids, primitive_ids (uint32), primitive_uvs (..., 2) and
        primitive_normals (..., 3)."""
        hits = self._scene.intersect(_rows(rays, 6, "rays"), threads=nthreads)
        hits["primitive_uvs"] = hits.pop("uvs")
        hits["primitive_normals"] = hits.pop("normals")
        return hits

    def test_occlusions(self, rays: Any, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0) -> np.ndarray:
        """Tests whether rays (..., 6) hit anything from tnear to tfar: bool (...)."""
        rays = _rows(rays, 6, "rays")
        if tnear == 0.0 and tfar == np.inf:
            return self._scene.occluded(rays, threads=nthreads)
        limited = np.empty(rays.shape[:-1] + (8,), dtype=rays.dtype if rays.dtype == np.float32 else np.float64)
        limited[..., :6] = rays
        limited[..., 6] = tnear
        limited[..., 7] = tfar
        return self._scene.occluded(limited, threads=nthreads)

    def count_intersections(self, rays: Any, nthreads: int = 0) -> np.ndarray:
        """The number of hits of each ray (..., 6): int32 (...)."""
        return self._scene.count_intersections(_rows(rays, 6, "rays"), threads=nthreads).astype(np.int32)

    def list_intersections(self, rays: Any, nthreads: int = 0) -> Dict[str, np.ndarray]:
        """All hits of rays (..., 6), those of each ray sorted by t: ray_splits (rays + 1), ray_ids (h,),
        geometry_ids, primitive_ids (all uint32), t_hit (h,) and primitive_uvs (h, 2). Hits of ray i are
        [ray_splits[i], ray_splits[i + 1])."""
        hits = self._scene.all_hits(_rows(rays, 6, "rays"), threads=nthreads)
        for name in ("ray_splits", "ray_ids"):
            hits[name] = hits[name].astype(np.uint32)
        hits["primitive_uvs"] = hits.pop("uvs")
        return hits

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> np.ndarray:
        """1 for points (..., 3) inside an odd number of meshes, else 0: float32 (...). Closed meshes are tested
        exactly. For open ones ``nsamples`` (odd) rays vote: inside if they cross an odd number of triangles. The
        directions of these rays are those of Open3D 0.17 and later. Points on the surface of a closed mesh are inside."""
        return self._inside(query_points, nthreads, nsamples).astype(np.float32)

    def compute_closest_points(self, query_points: Any, nthreads: int = 0) -> Dict[str, np.ndarray]:
        """The nearest points of the meshes to points (..., 3): points (..., 3), geometry_ids, primitive_ids (uint32),
        primitive_uvs (..., 2) and primitive_normals (..., 3); see ``Scene.closest_points``."""
        found = self._scene.closest_points(_rows(query_points, 3, "query_points"), threads=nthreads)
        del found["distance"]
        found["primitive_uvs"] = found.pop("uvs")
        found["primitive_normals"] = found.pop("normals")
        return found

    def compute_distance(self, query_points: Any, nthreads: int = 0) -> np.ndarray:
        """The distance of points (..., 3) from the meshes, scene units: real (...)."""
        return self._scene.closest_points(_rows(query_points, 3, "query_points"), threads=nthreads)["distance"]

    def compute_signed_distance(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> np.ndarray:
        """The distance of points (..., 3), negative inside as in ``compute_occupancy``: real (...)."""
        distance = self.compute_distance(query_points, nthreads)
        inside = self._inside(query_points, nthreads, nsamples)
        return np.negative(distance, out=distance, where=inside & (distance > 0))

    def _inside(self, query_points: Any, nthreads: int, nsamples: int) -> np.ndarray:
        if nsamples < 1 or nsamples % 2 != 1:
            raise UsageError(f"nsamples: expected an odd number from 1, found {nsamples}")
        points = _rows(query_points, 3, "query_points")
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
        a picture whose row 0 is the top. The component of directions along the view is 1.

        Or ``intrinsic_matrix, extrinsic_matrix, width_px, height_px``: a matrix (3, 3) from camera space to pixels,
        and a matrix (4, 4) from world to camera space; the camera looks along its z axis.
        """
        names = next((names for names in _PINHOLE_ARGUMENTS if len(arguments) <= len(names)
                      and set(names[len(arguments):]) == set(named)), None)
        if names is None:
            given = f"found {len(arguments)} by position" + (f" and {', '.join(named)}" if named else "")
            raise UsageError("create_rays_pinhole: expected " + ", or ".join(map(", ".join, _PINHOLE_ARGUMENTS))
                             + "; " + given)
        values = {**dict(zip(names, arguments)), **named}
        width, height = (_pixels(values.pop(name), name) for name in ("width_px", "height_px"))
        if "fov_deg" in values:
            intrinsic, extrinsic = _camera_at(width=width, height=height, **values)
        else:
            intrinsic = _shaped(values["intrinsic_matrix"], (3, 3), "intrinsic_matrix")
            extrinsic = _shaped(values["extrinsic_matrix"], (4, 4), "extrinsic_matrix")
        rays = np.empty((height, width, 6), dtype=np.float32)
        if not rays.size:
            return rays
        world_from_camera = extrinsic[:3, :3].T
        try:
            world_from_pixel = world_from_camera @ np.linalg.inv(intrinsic)
        except np.linalg.LinAlgError:
            raise UsageError("intrinsic_matrix: it has no inverse") from None
        origin = -world_from_camera @ extrinsic[:3, 3]
        if not max(np.abs(origin).max(), np.abs(world_from_pixel).max()) <= _LARGEST:
            raise UsageError("create_rays_pinhole: the rays are beyond the numbers of float32")
        rays[..., :3] = origin
        x, y = np.arange(width) + 0.5, np.arange(height) + 0.5
        rays[..., 3:] = (x[None, :, None] * world_from_pixel[:, 0] + y[:, None, None] * world_from_pixel[:, 1]
                         + world_from_pixel[:, 2])
        return rays


def _array(values: Any) -> Any:
    """Converts tensors of Open3D, which numpy does not accept, to arrays; returns other values unchanged."""
    return values.numpy() if hasattr(values, "numpy") and not hasattr(values, "__array__") else values


def _rows(values: Any, columns: int, name: str) -> np.ndarray:
    """The values as an array (..., columns)."""
    try:
        array = array_of(_array(values), name)
    except UsageError:
        raise
    except ValueError:
        raise UsageError(f"{name}: expected an array of numbers") from None
    if array.shape[-1:] != (columns,):
        raise UsageError(f"{name}: expected the shape (..., {columns}), found {array.shape}")
    return array


def _triangles_of(mesh: Any) -> Tuple[Any, Any]:
    """Vertices (n, 3) and triangles (m, 3) of a mesh."""
    if hasattr(mesh, "vertex") and hasattr(mesh, "triangle"):  # of Open3D, with tensors
        return mesh.vertex["positions"], mesh.triangle["indices"]
    if not hasattr(mesh, "vertices") or not (hasattr(mesh, "triangles") or hasattr(mesh, "faces")):
        raise UsageError(f"add_triangles: {type(mesh).__name__} is no mesh: expected vertices and triangles or faces")
    triangles = mesh.triangles if hasattr(mesh, "triangles") else mesh.faces
    return array_of(mesh.vertices, "vertices"), array_of(triangles, "triangles")


def _votes(scene: Scene, points: np.ndarray, nthreads: int, nsamples: int) -> np.ndarray:
    """Tests whether most of ``nsamples`` rays from each point (..., 3) cross an odd number of triangles: bool (...)."""
    points = points.astype(np.float64, copy=False)
    votes = np.zeros(points.shape[:-1], dtype=np.int64)
    for direction in _vote_directions(nsamples):
        rays = np.concatenate([points, np.broadcast_to(direction, points.shape)], axis=-1)
        votes += scene.count_intersections(rays, threads=nthreads) % 2
    return votes > nsamples // 2


def _vote_directions(count: int) -> np.ndarray:
    """Directions (count, 3), float32, near (1, 1, 1), the same for each call. They are those of Open3D with GNU's C++
    library: std::mt19937 of seed 42, and std::uniform_real_distribution<float> from -0.001 to 0.001."""
    drawn = np.random.RandomState(42).randint(0, 2**32, (count, 3), dtype=np.uint32)
    lo, hi, one = np.array([-0.001, 0.001, 1], dtype=np.float32)
    return one + (drawn.astype(np.float32) / np.float32(2**32) * (hi - lo) + lo)


_LARGEST = float(np.finfo(np.float32).max)
_PINHOLE_ARGUMENTS = (("fov_deg", "center", "eye", "up", "width_px", "height_px"),
                      ("intrinsic_matrix", "extrinsic_matrix", "width_px", "height_px"))


def _shaped(numbers: Any, shape: Tuple[int, ...], name: str) -> np.ndarray:
    try:
        array = array_of(_array(numbers), name, np.float64)
    except UsageError:
        raise
    except (TypeError, ValueError):
        raise UsageError(f"{name}: expected an array of numbers") from None
    if array.shape != shape:
        raise UsageError(f"{name}: expected the shape {shape}, found {array.shape}")
    if not (np.abs(array) <= _LARGEST).all():
        raise UsageError(f"{name}: expected finite numbers of float32")
    return array


def _pixels(number: Any, name: str) -> int:
    try:
        count = operator.index(number)
    except TypeError:
        count = -1
    if count < 0:
        raise UsageError(f"{name}: expected a whole number from 0, found {number!r}")
    return count


def _camera_at(fov_deg: float, center: Any, eye: Any, up: Any, width: int, height: int
               ) -> Tuple[np.ndarray, np.ndarray]:
    """The intrinsic and the extrinsic matrix; the rows of the rotation are the camera's axes."""
    fov_deg = float(_shaped(fov_deg, (), "fov_deg"))
    eye, center, up = (_shaped(v, (3,), name) for v, name in ((eye, "eye"), (center, "center"), (up, "up")))
    z = center - eye
    if not np.linalg.norm(z) > 0:
        raise UsageError("create_rays_pinhole: eye and center are the same")
    z /= np.linalg.norm(z)
    x = np.cross(up, z)
    if not np.linalg.norm(x) > 0:
        raise UsageError("create_rays_pinhole: up is parallel to the view")
    x /= np.linalg.norm(x)
    with np.errstate(divide="ignore"):  # an angle of 0: all rays are parallel to the view
        focal = 0.5 * width / np.tan(0.5 * np.radians(fov_deg))
    extrinsic = np.eye(4)
    extrinsic[:3, :3] = x, np.cross(z, x), z
    extrinsic[:3, 3] = -extrinsic[:3, :3] @ eye
    return np.array([[focal, 0, 0.5 * width], [0, focal, 0.5 * height], [0, 0, 1]]), extrinsic
