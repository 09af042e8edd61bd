"""The interface of trimesh's queries: ``RayMeshIntersector`` and ``ProximityQuery``, with their names, arguments and
results.

Source: the documentation of trimesh, ``trimesh.ray.ray_triangle.RayMeshIntersector`` and
``trimesh.proximity.ProximityQuery``.
Differs: hits and distances are computed in float64; hits are in the order of the rays, the nearest first; points on the
surface are inside for ``contains_points``; in closed meshes ``ProximityQuery.signed_distance`` has the sign of
``contains_points`` whatever the orientation of the triangles; there is no ``ProximityQuery.vertex``.
trimesh itself is not needed: a mesh is any object with ``vertices`` and ``faces``. Queries follow changes of the mesh:
arrays with a hash, such as trimesh's, are compared by it; others are compared with a copy, which takes their memory.

    mesh.ray = alhazen.trimesh.RayMeshIntersector(mesh)
    mesh.nearest = alhazen.trimesh.ProximityQuery(mesh)
"""
from __future__ import annotations

from typing import Any, Dict, Tuple, Union

import numpy as np

from ._arrays import array_of
from ._errors import UsageError
from ._scene import INVALID_ID, Scene

__all__ = ["ProximityQuery", "RayMeshIntersector"]


def _rays(origins: Any, directions: Any) -> np.ndarray:
    origins, directions = array_of(origins, "ray_origins"), array_of(directions, "ray_directions")
    if origins.ndim != 2 or origins.shape[1:] != (3,) or origins.shape != directions.shape:
        raise UsageError(f"ray_origins and ray_directions: expected the shape (n, 3) of both, found {origins.shape} "
                         f"and {directions.shape}")
    return np.concatenate([origins, directions], axis=1).astype(np.float64, copy=False)


def _known_by(array: Any) -> Union[int, np.ndarray]:
    """A value that differs when the array has changed."""
    hashed = isinstance(array, np.ndarray) and type(array).__hash__ is not None
    return hash(array) if hashed else np.array(array)


class _MeshQueries:
    """A scene of a mesh that may change."""

    def __init__(self, geometry: Any, **kwargs: Any) -> None:
        self.mesh = geometry
        self._settings = kwargs
        self._built: Tuple[Tuple[Any, Any], Scene] = self._build()

    def _build(self) -> Tuple[Tuple[Any, Any], Scene]:
        vertices, faces = self.mesh.vertices, self.mesh.faces
        return (_known_by(vertices), _known_by(faces)), Scene(vertices, faces, **self._settings).build()

    @property
    def _scene(self) -> Scene:
        """The scene of the current mesh."""
        known, scene = self._built
        if not all(np.array_equal(old, _known_by(new) if isinstance(old, int) else np.asarray(new))
                   for old, new in zip(known, (self.mesh.vertices, self.mesh.faces))):
            self._built = self._build()
            scene = self._built[1]
        return scene

    def contains_points(self, points: Any) -> np.ndarray:
        """Tests whether each point (n, 3) is inside the mesh: (n,) bool. For a mesh with open edges, whether a line
        through the point crosses it an odd number of times on both sides."""
        points = array_of(points, "points", np.float64)
        if points.shape[-1:] != (3,):
            raise UsageError(f"points: expected the shape (n, 3), found {points.shape}")
        scene = self._scene
        if scene.solid_names:
            return scene.inside(points)
        # A direction of no axis and no diagonal.
        direction = np.broadcast_to([0.4395064455, 0.617598629942, 0.652231566745], points.shape)
        ahead, behind = (scene.count_intersections(np.concatenate([points, d], axis=-1)) % 2 == 1
                         for d in (direction, -direction))
        return ahead & behind


class RayMeshIntersector(_MeshQueries):
    """Ray queries of one mesh. ``geometry``: an object with ``vertices`` (n, 3) and ``faces`` (m, 3).

    >>> from types import SimpleNamespace
    >>> import numpy as np
    >>> mesh = SimpleNamespace(vertices=np.array([[0., 0, 0], [1, 0, 0], [0, 1, 0]]), faces=np.array([[0, 1, 2]]))
    >>> ray = RayMeshIntersector(mesh)
    >>> ray.intersects_location([[0.25, 0.25, 1]], [[0, 0, -1]])
    (array([[0.25, 0.25, 0.  ]]), array([0]), array([0]))
    """

    def intersects_id(self, ray_origins: Any, ray_directions: Any, return_locations: bool = False,
                      multiple_hits: bool = True, **kwargs: Any
                      ) -> Union[Tuple[np.ndarray, np.ndarray], Tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """The triangles that rays hit: index_tri (h,) and index_ray (h,), int64, and with ``return_locations``
        locations (h, 3). ``multiple_hits`` False: only the first hit of each ray."""
        rays = _rays(ray_origins, ray_directions)
        if multiple_hits:
            hits = self._scene.all_hits(rays)
            index_ray = hits["ray_ids"]
            index_tri = hits["primitive_ids"].astype(np.int64)
            t = hits["t_hit"]
        else:
            first = self._scene.intersect(rays, fields=("t_hit", "primitive_ids"))
            index_ray = np.flatnonzero(np.isfinite(first["t_hit"]))
            index_tri = first["primitive_ids"][index_ray].astype(np.int64)
            t = first["t_hit"][index_ray]
        if not return_locations:
            return index_tri, index_ray
        return index_tri, index_ray, rays[index_ray, :3] + t[:, None] * rays[index_ray, 3:]

    def intersects_location(self, ray_origins: Any, ray_directions: Any, multiple_hits: bool = True,
                            **kwargs: Any) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The hits of rays on the mesh: locations (h, 3), index_ray (h,), index_tri (h,)."""
        index_tri, index_ray, locations = self.intersects_id(  # type: ignore[misc]
            ray_origins, ray_directions, return_locations=True, multiple_hits=multiple_hits)
        return locations, index_ray, index_tri

    def intersects_first(self, ray_origins: Any, ray_directions: Any, **kwargs: Any) -> np.ndarray:
        """The first triangle that each ray hits: (n,) int64; -1 without a hit."""
        first = self._scene.intersect(_rays(ray_origins, ray_directions), fields=("t_hit", "primitive_ids"))
        return np.where(np.isfinite(first["t_hit"]), first["primitive_ids"].astype(np.int64), -1)

    def intersects_any(self, ray_origins: Any, ray_directions: Any, **kwargs: Any) -> np.ndarray:
        """Tests whether each ray hits the mesh: (n,) bool."""
        return self._scene.occluded(_rays(ray_origins, ray_directions))


class ProximityQuery(_MeshQueries):
    """Distances from one mesh. ``geometry``: an object with ``vertices`` (n, 3) and ``faces`` (m, 3).

    >>> from types import SimpleNamespace
    >>> import numpy as np
    >>> mesh = SimpleNamespace(vertices=np.array([[0., 0, 0], [1, 0, 0], [0, 1, 0]]), faces=np.array([[0, 1, 2]]))
    >>> ProximityQuery(mesh).on_surface([[0.25, 0.25, 2]])
    (array([[0.25, 0.25, 0.  ]]), array([2.]), array([0]))
    """

    def on_surface(self, points: Any) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The nearest points of the mesh to points (n, 3): closest (n, 3), distance (n,) and triangle_id (n,), int64;
        -1 if the mesh has no triangle."""
        found = self._scene.closest_points(array_of(points, "points", np.float64))
        triangle = found["primitive_ids"]
        return found["points"], found["distance"], np.where(triangle == INVALID_ID, -1, triangle.astype(np.int64))

    def signed_distance(self, points: Any) -> np.ndarray:
        """The distance of points (n, 3) from the mesh, positive inside, negative outside: (n,). In a mesh with open
        edges, points that project onto their nearest triangle are outside if its normal points towards them; for others
        ``contains_points`` decides."""
        points = array_of(points, "points", np.float64)
        found = self._scene.closest_points(points)
        distance = found["distance"]
        if self._scene.solid_names:
            outside = ~self.contains_points(points)
        else:
            offset = points - found["points"]
            height = np.einsum("ij,ij->i", offset, found["normals"])
            outside = height > 0
            aside = ~self._is_above(points, offset, found)
            if aside.any():
                outside[aside] = ~self.contains_points(points[aside])
        return np.negative(distance, out=distance, where=(distance > 0) & outside)

    def _is_above(self, points: np.ndarray, offset: np.ndarray, found: Dict[str, np.ndarray]) -> np.ndarray:
        """Tests whether each point lies above or below its nearest triangle, within 1e-8 of the triangle's size:
        (n,) bool. ``offset`` (n, 3): difference from the nearest point."""
        known = found["primitive_ids"] != INVALID_ID
        result = np.zeros(len(points), dtype=bool)
        corners = np.asarray(self.mesh.vertices, dtype=np.float64)[
            np.asarray(self.mesh.faces)[found["primitive_ids"][known]]]
        size = np.ptp(corners, axis=1).max(axis=1)
        # Rounding error of the differences, relative to the coordinates.
        rounding = 1e-15 * np.maximum(np.abs(points[known]).max(axis=1), np.abs(corners).max(axis=(1, 2)))
        normals = found["normals"][known]
        aside = np.linalg.norm(np.cross(offset[known], normals), axis=1)
        result[known] = (aside <= 1e-8 * size + rounding) & normals.any(axis=1)
        return result
