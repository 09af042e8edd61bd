"""Times batches from numpy beside the C++ call and beside Embree by the same route.

Usage: PYTHONPATH=build/release/python:build/release/python_bench python3 bindings/python/bench/numpy_bench.py
           [MESH] [--rays N] [--rounds N] [--threads N] [--processor]
MESH is any file of triangles that alhazen reads; without one a sphere of 320 000 triangles. Rays go from a sphere
around the mesh to random points in its box. Each figure is the least of the rounds, which take turns; --processor
counts processor time, where others use the machine.
"""
import argparse
import os
import tempfile
import time

import numpy as np

import alhazen

import alhazen_peers


def sphere(side=400):
    """A bumpy sphere: vertices and 2 * side^2 triangles."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, side + 1), np.linspace(0, np.pi, side + 1))
    r = 1 + 0.05 * np.sin(9 * u) * np.sin(7 * v)
    vertices = np.stack([r * np.sin(v) * np.cos(u), r * np.sin(v) * np.sin(u), r * np.cos(v)], axis=-1).reshape(-1, 3)
    i = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    faces = np.concatenate([np.stack([i, i + side + 1, i + 1], -1), np.stack([i + 1, i + side + 1, i + side + 2], -1)])
    return vertices, faces


def read_ply(path):
    """Vertices and faces of a binary PLY that alhazen writes."""
    with open(path, "rb") as file:
        data = file.read()
    head, body = data.split(b"end_header\n", 1)
    lines = head.decode().splitlines()
    counts = [int(line.split()[2]) for line in lines if line.startswith("element")]
    properties = [line.split()[1:] for line in lines if line.startswith("property") and "list" not in line]
    kinds = {"float": "<f4", "double": "<f8", "uchar": "u1", "float32": "<f4", "float64": "<f8"}
    row = np.dtype([(name, kinds[kind]) for kind, name in properties])
    table = np.frombuffer(body, row, counts[0])
    vertices = np.stack([table[axis].astype(np.float64) for axis in "xyz"], axis=-1)
    rest = body[counts[0] * row.itemsize:]
    faces = np.frombuffer(rest, np.dtype([("n", "u1"), ("i", "<u4", 3)]), counts[1])
    return vertices, faces["i"].astype(np.int64)


def triangles_of(path):
    with tempfile.TemporaryDirectory() as folder:
        target = os.path.join(folder, "mesh.ply")
        alhazen.load(path).save(target)
        return read_ply(target)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("mesh", nargs="?")
    parser.add_argument("--rays", type=int, default=1000000)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--processor", action="store_true")
    args = parser.parse_args()
    vertices, faces = triangles_of(args.mesh) if args.mesh else sphere()
    lo, hi = vertices.min(axis=0), vertices.max(axis=0)
    random = np.random.default_rng(1)
    origins = random.normal(size=(args.rays, 3))
    origins *= np.linalg.norm(hi - lo) / np.linalg.norm(origins, axis=1, keepdims=True)
    rays = np.concatenate([(lo + hi) / 2 + origins, random.uniform(lo, hi, (args.rays, 3)) - (lo + hi) / 2 - origins],
                          axis=1)
    single = rays.astype(np.float32)
    aligned = alhazen.aligned_rays(args.rays)
    aligned[:, :6] = rays
    scene = alhazen.Scene(vertices, faces).build()
    direct = alhazen_peers.Direct(vertices, faces.astype(np.uint32))
    embree = alhazen_peers.Embree(vertices.astype(np.float32), faces.astype(np.uint32))
    plain = ("t_hit", "geometry_ids", "primitive_ids", "uvs")
    ways = {
        "Tracer::intersect, C++": lambda: direct.seconds(rays, args.threads, False, args.processor),
        "float64 (n, 8), in place": lambda: scene.intersect(aligned, fields=plain, threads=args.threads),
        "float64 (n, 6)": lambda: scene.intersect(rays, fields=plain, threads=args.threads),
        "float32 (n, 6)": lambda: scene.intersect(single, fields=plain, threads=args.threads),
        "C++, normals too": lambda: direct.seconds(rays, args.threads, True, args.processor),
        "float32 (n, 6), normals too": lambda: scene.intersect(single, threads=args.threads),
        "Embree, float32 (n, 6)": lambda: embree.intersect(single, args.threads),
    }
    best = dict.fromkeys(ways, np.inf)
    clock = time.process_time if args.processor else time.perf_counter
    for _ in range(args.rounds):
        for name, way in ways.items():
            start = clock()
            answer = way()
            seconds = answer if isinstance(answer, float) else clock() - start
            best[name] = min(best[name], seconds)
    ours, theirs = scene.intersect(single, fields=plain), embree.intersect(single, 1)
    differ = np.isfinite(ours["t_hit"]) != np.isfinite(theirs["t_hit"])
    print(f"{len(faces)} triangles, {args.rays} rays, {args.threads} thread(s), "
          f"{np.isfinite(ours['t_hit']).mean():.0%} hit; hit or not differs from Embree's for {differ.sum()}")
    base = best["Tracer::intersect, C++"]
    for name, seconds in best.items():
        print(f"{name:28} {1e9 * seconds / args.rays:7.1f} ns a ray   {seconds / base - 1:+.1%}")


main()
