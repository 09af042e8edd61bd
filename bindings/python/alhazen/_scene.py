"""The class Scene."""
from __future__ import annotations

import copy
import json
import operator
import os
import tempfile
import threading
import warnings
from typing import AbstractSet, Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _alhazen
from ._blocks import Block, Origin, _names_files
from ._errors import SceneWarning, UsageError
from ._picture import Picture

#: Id of geometry, primitive and material of a ray without a hit.
INVALID_ID = 0xFFFFFFFF

_DEFAULT_FIELDS = ("t_hit", "geometry_ids", "primitive_ids", "uvs", "normals")

Progress = Callable[[str, int, int], Any]


class Scene:
    """Geometry, materials, lights and cameras: traces rays, measures solids, renders pictures.

    ``Scene(vertices, faces)`` is a scene of one triangle mesh; ``Scene()`` is empty; ``alhazen.load(path)`` reads a
    file. ``add`` and ``add_mesh`` extend a scene. The first query builds the acceleration structure, as does the first
    query after an addition.

    Parameters
    ----------
    vertices : array (n, 3), float32 or float64, scene units
    faces : array (m, 3) of integers; counterclockwise from outside
    accelerator : a name of ``alhazen.accelerators()``, or "NAME:SETTING=VALUE,..."
    build : quality of the tree: "fast", "default" or "high" (``quality`` is its older name)
    csg : the evaluator of CSG solids
    threads : largest number of threads; 0: all cores
    folder : that file names in blocks are relative to; default: the current one when the scene is made
    allowed_folders : further folders that may contain such files
    strict : True: warnings are errors

    Copies (``copy.copy``, ``copy.deepcopy``) share built structures. A pickle contains all of the scene, also of the
    files that it was loaded from or that its blocks name, for which the scene is built; the unpickled scene is built
    again. An addition builds the scene again from its blocks, which read their files again.

    Conventions
    -----------
    Rays are arrays (..., 6) of origin x, y, z and direction x, y, z, or (..., 8) with t_min and t_max (default: 0 and
    infinity). Directions need not be unit: t is in units of their length. Results have the shape (...), and are
    float32 for float32 rays, else float64; all computations are in float64. Contiguous float32 and float64 arrays
    are not copied; aligned float64 arrays (..., 8) are traced in place. Queries release the interpreter's
    lock, use all cores, and end on Ctrl-C. Several threads may query a scene.

    >>> import alhazen, numpy as np
    >>> scene = alhazen.Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> scene.intersect([[0.25, 0.25, 1, 0, 0, -1]])["t_hit"]
    array([1.])
    """

    def __init__(self, vertices: Any = None, faces: Any = None, *, accelerator: str = "wide_bvh",
                 build: str = "default", csg: str = "event_heap", threads: int = 0,
                 folder: "str | os.PathLike[str]" = ".", allowed_folders: Sequence[str] = (),
                 strict: bool = False, quality: Optional[str] = None) -> None:
        self._threads = _checked_threads(threads)
        build = _renamed(build, "default", quality, "build", "quality")
        self._settings = {"accelerator": accelerator, "build": build, "csg": csg, "threads": self._threads,
                          "allowed_folders": [_absolute(f) for f in allowed_folders], "strict": strict}
        self._folder = _absolute(folder)
        self._base: Optional[_alhazen.BuiltScene] = None
        self._meshes: List[_alhazen.ArrayMesh] = []
        self._blocks: List[Block] = []
        self._built: Optional[_alhazen.BuiltScene] = None
        self._lock = threading.Lock()
        if (vertices is None) != (faces is None):
            raise UsageError("a mesh has vertices and faces: one of them is missing")
        if vertices is not None:
            self.add_mesh(vertices, faces)

    # ---- Contents.

    def add(self, *blocks: Block) -> "Scene":
        """Appends blocks (``alhazen.sphere(...)`` and so on), and returns the scene.

        Materials, textures and objects must be added before the blocks that name them. The first query reports
        errors, with the location in the program where the block was made.
        """
        for block in blocks:
            if not isinstance(block, Block):
                raise UsageError(f"{block!r} is no block; alhazen.sphere(...) makes one")
        self._spare({block.name for block in blocks if block.type == "geometry"})
        self._blocks.extend(blocks)
        self._built = None
        return self

    def add_mesh(self, vertices: Any, faces: Any, *, name: str = "", normals: Any = None, uvs: Any = None,
                 **keys: Any) -> "Scene":
        """Adds a triangle mesh, copied, and returns the scene.

        ``vertices`` (n, 3), real, scene units; ``faces`` (m, 3), integers. ``normals`` (n, 3)
        and ``uvs`` (n, 2) belong to the vertices; ``keys`` are those of a part: ``material``, ``transform``,
        ``visible_to``, ``motion``.
        """
        label = self._free_label()
        block = Block("mesh", name, geometry=label, **keys)
        self._meshes.append(_alhazen.ArrayMesh(label, vertices, faces, normals, uvs, block.origin))
        self._blocks.append(block)
        self._built = None
        return self

    def _free_label(self, others: AbstractSet[str] = frozenset()) -> str:
        """A name for the arrays of a mesh that no geometry of the scene has, nor one of the others."""
        taken = {mesh.name for mesh in self._meshes} | {b.name for b in self._blocks if b.type == "geometry"} | others
        if self._base is not None:
            taken |= set(self._base.mesh_names())
        number = len(self._meshes)
        while f"array_{number}" in taken:
            number += 1
        return f"array_{number}"

    def _spare(self, names: AbstractSet[str]) -> None:
        """Gives another label to arrays that have one of the names."""
        for i, mesh in enumerate(self._meshes):
            if mesh.name in names:
                label = self._free_label(names)
                self._meshes[i] = mesh.named(label)
                self._blocks = [block._with("geometry", label) if block.type == "mesh"
                                and block.keys.get("geometry") == mesh.name else block for block in self._blocks]

    def _only(self, parts: Sequence[int]) -> "Scene":
        """A scene of some of the meshes, for a scene made only by ``add_mesh``; the meshes are shared."""
        scene = Scene()
        scene._settings, scene._threads, scene._folder = self._settings, self._threads, self._folder
        scene._meshes = [self._meshes[i] for i in parts]
        scene._blocks = [self._blocks[i] for i in parts]
        return scene

    def _scene(self) -> _alhazen.BuiltScene:
        with self._lock:
            if self._built is None:
                lines: List[str] = []
                origins: List[Origin] = []
                for block in self._blocks:
                    for line, origin in block._lines():
                        lines.append(line)
                        origins.append(origin)
                self._built = _alhazen.BuiltScene.build(self._base, self._meshes, "\n".join(lines), origins,
                                                        self._folder, self._settings)
                _warn(self._built)
            return self._built

    def build(self) -> "Scene":
        """Builds the scene now, instead of with the first query."""
        self._scene()
        return self

    def save(self, path: "str | os.PathLike[str]", *, meshes_only: bool = False,
             strict: Optional[bool] = None) -> List[str]:
        """Writes the scene: .alhazen the whole scene (large meshes and pictures in files beside it); .ply, .obj and
        .stl scenes of meshes (.obj also patches), .bpt patches. ``meshes_only`` leaves out what these cannot hold,
        which is otherwise a ``UsageError``. What the file does not hold of the parts that it has is a
        ``SceneWarning``; with ``strict`` (None: as the scene) it is a ``SceneError`` instead, and nothing is written.
        Returns the names of the files written."""
        files, lost = self._scene().save(os.fspath(path), bool(meshes_only),
                                         bool(self._settings["strict"] if strict is None else strict))
        for line in lost:
            warnings.warn(line, SceneWarning, stacklevel=2)
        return files

    @property
    def geometry_names(self) -> List[str]:
        """[geometry id] the name of the part, or its kind."""
        return self._scene().geometry_names()

    @property
    def material_names(self) -> List[str]:
        """[material id] the name of the material."""
        return self._scene().material_names()

    @property
    def camera_names(self) -> List[str]:
        """The names of the cameras; ``render`` takes a name or a position."""
        return self._scene().camera_names()

    @property
    def solid_names(self) -> List[str]:
        """[solid id] the name of the solid: a closed shape or mesh, or a CSG solid."""
        return self._scene().solid_names()

    @property
    def bounds(self) -> np.ndarray:
        """The corners (2, 3) of the box of all geometry, over the whole of its motion, scene units; infinite if any
        part is unbounded."""
        return np.array(self._scene().bounds())

    @property
    def info(self) -> Dict[str, Any]:
        """Counts of shapes, triangles and instances, bytes, and seconds of the build."""
        return self._scene().counts()

    def __repr__(self) -> str:
        parts = len(self._blocks)
        state = "built" if self._built is not None else "not built"
        return f"<alhazen.Scene: {parts} added block{'' if parts == 1 else 's'}, {state}>"

    def __copy__(self) -> "Scene":
        other = type(self).__new__(type(self))
        vars(other).update(vars(self), _lock=threading.Lock(), _meshes=list(self._meshes), _blocks=list(self._blocks))
        return other

    def __deepcopy__(self, memo: Dict[int, Any]) -> "Scene":
        other = copy.copy(self)
        shared = ("_base", "_built", "_lock", "_meshes")  # immutable
        vars(other).update({k: copy.deepcopy(v, memo) for k, v in vars(self).items() if k not in shared})
        return other

    def __getstate__(self) -> Dict[str, Any]:
        state = {k: v for k, v in vars(self).items() if k not in ("_built", "_lock")}
        if any(map(_names_files, self._blocks)):
            state.update(_base=_packed(self._scene()), _blocks=[], _meshes=[])
        else:
            state["_base"] = None if self._base is None else _packed(self._base)
        return state

    def __setstate__(self, state: Dict[str, Any]) -> None:
        vars(self).update(state, _built=None, _lock=threading.Lock())
        if state["_base"] is not None:
            self._base = _unpacked(state["_base"], self._settings)
            self._built = None if self._blocks else self._base

    # ---- Rays.

    def intersect(self, rays: Any, *, fields: Union[str, Sequence[str]] = _DEFAULT_FIELDS, mask: int = 0xFFFFFFFF,
                  coherent: bool = False, threads: Optional[int] = None) -> Dict[str, np.ndarray]:
        """The nearest hit of each ray (..., 6) or (..., 8): a dict of arrays shaped like the rays.

        ===================  ==============  ==============================================================
        t_hit                (...) real      in units of the direction's length; infinite without a hit
        geometry_ids         (...) uint32    the part: 0, 1, ... in the order of addition, parts in objects after
                                             those of the scene; ``geometry_names``
        primitive_ids        (...) uint32    the triangle of a mesh; 0 for a shape
        uvs                  (..., 2) real   weights of a triangle's second and third vertex, or a shape's parameters
        normals              (..., 3) real   unit, geometric, outward of closed shapes
        points               (..., 3) real   the point hit
        shading_normals      (..., 3) real   unit, interpolated
        instance_ids         (...) uint32    the outermost part that contains it
        material_ids         (...) uint32    the material; ``material_names``
        ===================  ==============  ==============================================================

        Without a hit ids are INVALID_ID and the others 0. ``fields`` selects the arrays, by one or more names; the
        first four are the fastest.
        ``mask``: the kinds of the rays (``visible_to``): 1 eye, 2 shadow, 4 reflection, 8 refraction; 16, the light
        between two surfaces in path tracers, sees what 2 sees.
        ``coherent``: True if neighbours have similar directions and start or end near a common point. Camera rays are
        then traced faster; hits never change.
        """
        names = [fields] if isinstance(fields, str) else list(fields)
        if not all(isinstance(name, str) for name in names):
            raise UsageError(f"fields: expected names, found {names}")
        return self._scene().intersect(rays, names, _checked_mask(mask), coherent, self._at_most(threads))

    def occluded(self, rays: Any, *, mask: int = 0xFFFFFFFF, coherent: bool = False,
                 threads: Optional[int] = None) -> np.ndarray:
        """Tests whether each ray (..., 6) or (..., 8) hits anything: bool, shaped like the rays. Faster than
        ``intersect``."""
        return self._scene().occluded(rays, _checked_mask(mask), coherent, self._at_most(threads))

    def all_hits(self, rays: Any, *, mask: int = 0xFFFFFFFF, threads: Optional[int] = None) -> Dict[str, np.ndarray]:
        """Every hit of each ray (..., 6) or (..., 8), the nearest first: flat arrays t_hit, geometry_ids, primitive_ids
        and uvs of all hits, ray_ids (int64, the ray of each, in C order), and ray_splits (int64, rays + 1): hits of
        ray i are [ray_splits[i], ray_splits[i + 1])."""
        return self._scene().all_hits(rays, _checked_mask(mask), self._at_most(threads))

    list_intersections = all_hits

    def count_intersections(self, rays: Any, *, mask: int = 0xFFFFFFFF, threads: Optional[int] = None) -> np.ndarray:
        """The number of hits of each ray (..., 6) or (..., 8): int64, shaped like the rays."""
        return self._scene().count_intersections(rays, _checked_mask(mask), self._at_most(threads))

    # ---- Nearest points.

    def closest_points(self, points: Any, *, threads: Optional[int] = None) -> Dict[str, np.ndarray]:
        """The point of the scene's surfaces that is nearest to each point (..., 3): a dict of arrays shaped (...).

        ===================  ==============  ==============================================================
        distance             (...) real      scene units
        points               (..., 3) real   the nearest point
        geometry_ids         (...) uint32    the part, as in ``intersect``
        primitive_ids        (...) uint32    the triangle, the first of several equally near ones; 0 for a shape
        uvs                  (..., 2) real   weights of the triangle's second and third vertex; 0 for a shape
        normals              (..., 3) real   unit, outward of closed shapes and where a triangle turns counterclockwise
        ===================  ==============  ==============================================================

        Real is float32 for float32 points, else float64; all computations are in float64, and the distance to triangles
        is exact within 4e-15 of the largest coordinate. Supported shapes: planes, discs, rectangles, polygons, boxes,
        polyhedra, spheres, cylinders, cones, all quadrics, tori, and lathes of straight lines, in any placement (tori:
        without stretching). Other shapes, and CSG solids, are an error that names the first one. Without surfaces
        distances are infinite, for points that are not finite NaN; ids are then INVALID_ID. Instances are expanded, up
        to 5.5 GB in total: 2^25 triangles, fewer shapes.
        """
        return self._scene().closest_points(points, self._at_most(threads))

    # ---- Solids.

    def spans(self, rays: Any, *, threads: Optional[int] = None) -> Dict[str, np.ndarray]:
        """The parts of each ray (..., 6) or (..., 8) inside solids, by entry: flat arrays solid_ids (uint64), t_enter,
        t_exit, ray_ids, and ray_splits as in ``all_hits``. A span that contains an end of the ray is clipped there."""
        return self._scene().spans(rays, self._at_most(threads))

    def thickness(self, rays: Any, *, threads: Optional[int] = None) -> np.ndarray:
        """Length of each ray (..., 6) or (..., 8) inside any solid, overlaps counted once: real, shaped like the rays,
        scene units."""
        return self._scene().thickness(rays, self._at_most(threads))

    def inside(self, points: Any, *, threads: Optional[int] = None) -> np.ndarray:
        """Tests whether each point (..., 3) is in a solid or on its surface: bool, shaped (...)."""
        return self._scene().inside(points, self._at_most(threads))

    def solids_at(self, points: Any, *, threads: Optional[int] = None) -> Dict[str, np.ndarray]:
        """The solids that contain each point (..., 3), scene units: flat arrays solid_ids, on_surface (bool),
        point_ids, and point_splits."""
        return self._scene().solids_at(points, self._at_most(threads))

    def measure(self, *solids: Union[str, int], error: float = 1e-4, time_limit: float = 2.0, seed: int = 1,
                threads: Optional[int] = None, seconds: Optional[float] = None) -> List[Dict[str, Any]]:
        """Volume, area, centroid and inertia of solids, each {"value": v, "interval": [lo, hi]} with 95 % confidence.

        ``solids`` are names or ids; none: all. Work ends when the relative error of the volume is below ``error``, or
        after ``time_limit`` seconds for each solid (``seconds`` is its older name). Densities of materials give "mass".
        Scene units.
        """
        time_limit = _renamed(time_limit, 2.0, seconds, "time_limit", "seconds")
        words = [str(s) for s in solids]
        seed = _whole(seed, "seed", 2**64 - 1)
        text = self._scene().measure_json(words, error, time_limit, seed, self._at_most(threads))
        return json.loads(text)["solids"]

    def section(self, normal: Sequence[float] = (0, 0, 1), offset: float = 0.0, *solids: Union[str, int],
                tolerance: float = 1e-4, cells: int = 256, threads: Optional[int] = None) -> List[Dict[str, Any]]:
        """The outlines in which the plane dot(normal, p) = offset cuts solids: a dict for each solid that it cuts.

        "loops": closed polylines (k, 2) in the plane, with the solid on their left; "points": the same in space (k, 3);
        "area": the enclosed area; "unresolved": number of cells where the outline may be wrong. ``tolerance`` (scene
        units) is the largest distance of polyline and curve, ``cells`` the grid along the longer side.
        """
        return self._scene().section([float(x) for x in normal], float(offset), [str(s) for s in solids], tolerance,
                                     _whole(cells, "cells", 2**31 - 1), self._at_most(threads))

    # ---- Pictures.

    def render(self, width: Optional[int] = None, height: Optional[int] = None, *, spp: Optional[int] = None,
               renderer: str = "whitted", camera: Union[str, int] = "", view: Union[str, Sequence[float]] = "",
               layers: Union[str, Sequence[str]] = "", depth: Optional[int] = None, seed: int = 0,
               crop: Optional[Sequence[int]] = None, environment: str = "", sampler: str = "", filter: str = "",
               antialias: str = "",
               noise: Optional[float] = None, time_limit: Optional[float] = None, threads: Optional[int] = None,
               progress: Optional[Progress] = None, seconds: Optional[float] = None) -> Picture:
        """Renders a picture: a float32 array (height, width, 3), linear; see ``Picture``.

        Parameters
        ----------
        width, height : pixels; if one is given, the other follows; default: the scene's
        spp : samples per pixel; default: the renderer's
        renderer : a name of ``alhazen.renderers()``
        camera : name or position; default: the first
        view : (azimuth, elevation), degrees, of a camera that frames the scene, instead of ``camera``
        layers : names of ``alhazen.layers()``, or "all"; returned as ``picture.layers``
        depth : of reflections and refractions; path tracers scatter at most once more
        crop : (x0, y0, x1, y1), pixels from the top left
        environment : "sky", "studio", "none" or a picture file, for physically based renderers
        antialias : "whitted" or "exact", with settings as in ``alhazen render --antialias``
        sampler, filter : names as in ``alhazen list``
        noise, time_limit : stop rules; pixels with more noise get more samples; seconds (``seconds``: its older name)
        progress : called as progress(phase, done, total); an exception raised by it ends the render

        A scene without a camera or lights gets default ones; ``picture.notes`` lists them.
        """
        if not isinstance(view, str):
            view = ",".join(repr(a) for a in _two_angles(view))
        if not isinstance(layers, str):
            layers = ",".join(layers)
        wishes = {"renderer": renderer, "camera": str(camera), "width": width, "height": height, "depth": depth,
                  "seed": seed, "threads": self._at_most(threads), "layers": layers, "view": view, "spp": spp,
                  "crop": None if crop is None else tuple(crop), "environment": environment, "sampler": sampler,
                  "filter": filter, "antialias": antialias, "noise": noise,
                  "time_limit": _renamed(time_limit, None, seconds, "time_limit", "seconds")}
        return Picture.of(self._scene().render(wishes, progress))

    def _repr_png_(self) -> bytes:
        """The display in a notebook: a picture 320 pixels wide."""
        return self.render(width=320)._repr_png_()  # type: ignore[return-value]

    def _at_most(self, threads: Optional[int]) -> int:
        return self._threads if threads is None else _checked_threads(threads)


def _renamed(value: Any, usual: Any, older: Any, name: str, older_name: str) -> Any:
    """The value of an argument that may be given by its older name; a ``UsageError`` if it is given by both."""
    if older is None:
        return value
    if value is not usual and value != usual:
        raise UsageError(f"{older_name} is the older name of {name}: expected one of them")
    return older


def _whole(number: Any, name: str, most: int) -> int:
    """The number as an int; a ``UsageError`` unless it is a whole one from 0 to ``most``."""
    try:
        whole = operator.index(number)
    except TypeError:
        whole = -1
    if not 0 <= whole <= most:
        raise UsageError(f"{name}: expected a whole number from 0 to {most}, found {number!r}")
    return whole


def _two_angles(view: Any) -> Tuple[float, float]:
    try:
        azimuth, elevation = (float(angle) for angle in view)
    except (TypeError, ValueError):
        raise UsageError(f"view: expected (azimuth, elevation) in degrees, found {view!r}") from None
    return azimuth, elevation


def _checked_threads(threads: Any) -> int:
    return _whole(int(threads) if isinstance(threads, float) and threads.is_integer() else threads, "threads", 4096)


def _checked_mask(mask: Any) -> int:
    try:
        bits = operator.index(mask)
    except TypeError:
        bits = -1
    if not 0 <= bits <= 0xFFFFFFFF:
        raise UsageError(f"mask: expected 0 to 0xFFFFFFFF, found {mask!r}")
    return bits


def _absolute(path: "str | os.PathLike[str]") -> str:
    """The path, independent of later changes of the current folder."""
    try:
        return os.path.abspath(os.fspath(path))
    except OSError:  # the current folder has been deleted
        return os.fspath(path)


def _packed(built: _alhazen.BuiltScene) -> Tuple[str, Dict[str, bytes]]:
    """The path of the native file, and the contents of its files by name."""
    files = {}
    with tempfile.TemporaryDirectory() as top:
        built.save(os.path.join(top, "scene.alhazen"), False, False)
        for folder, _, names in os.walk(top):
            for path in (os.path.join(folder, name) for name in names):
                with open(path, "rb") as file:
                    files[os.path.relpath(path, top)] = file.read()
    return built.path(), files


def _unpacked(packed: Tuple[str, Dict[str, bytes]], settings: Dict[str, Any]) -> _alhazen.BuiltScene:
    path, files = packed
    with tempfile.TemporaryDirectory() as top:
        for name, data in files.items():
            target = os.path.join(top, name)
            os.makedirs(os.path.dirname(target), exist_ok=True)
            with open(target, "wb") as file:
                file.write(data)
        return _alhazen.BuiltScene.load(os.path.join(top, "scene.alhazen"), settings, path)


def _warn(built: _alhazen.BuiltScene) -> None:
    for line in built.warnings():
        warnings.warn(line, SceneWarning, stacklevel=4)


def load(path: "str | os.PathLike[str]", *, accelerator: str = "wide_bvh", build: str = "default",
         csg: str = "event_heap", threads: int = 0, allowed_folders: Sequence[str] = (), strict: bool = False,
         time: Optional[float] = None, quality: Optional[str] = None) -> Scene:
    """Reads a scene file of any format of ``alhazen list formats``. ``time``: moment of its animations, seconds; the
    other parameters are those of ``Scene``. Added blocks can name its materials, textures and objects."""
    scene = Scene(accelerator=accelerator, build=build, csg=csg, threads=threads, quality=quality,
                  folder=os.path.dirname(_absolute(path)), allowed_folders=allowed_folders, strict=strict)
    scene._base = _alhazen.BuiltScene.load(os.fspath(path), {**scene._settings, "time": time}, _absolute(path))
    scene._built = scene._base
    _warn(scene._base)
    return scene
