"""Meshes and rays whose hits are known."""
import numpy as np


def cube(lo=0.0, hi=1.0):
    """Vertices (8, 3) and faces (12, 3) of a closed cube, counterclockwise from outside."""
    vertices = np.array([[x, y, z] for x in (lo, hi) for y in (lo, hi) for z in (lo, hi)], dtype=np.float64)
    faces = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                      [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]], dtype=np.int64)
    return vertices, faces


def random_rays(count, seed=1, radius=3.0):
    """Rays (count, 6) from a sphere towards points near its middle."""
    random = np.random.default_rng(seed)
    origins = random.normal(size=(count, 3))
    origins *= radius / np.linalg.norm(origins, axis=1, keepdims=True)
    return np.concatenate([origins, random.uniform(-0.8, 0.8, (count, 3)) - origins], axis=1)


def cube_interval(rays, lo, hi):
    """t of entry and exit (count,) of the cube by slabs; entry > exit: missed."""
    with np.errstate(divide="ignore", invalid="ignore"):
        t0, t1 = (lo - rays[:, :3]) / rays[:, 3:], (hi - rays[:, :3]) / rays[:, 3:]
    return np.minimum(t0, t1).max(axis=1), np.maximum(t0, t1).min(axis=1)
