"""Compares all accelerators on one mesh: the same hits to the last bit; times go to stderr."""
import sys
import time

import numpy as np

import alhazen

# A torus of 5000 triangles.
u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 51), np.linspace(0, 2 * np.pi, 51))
vertices = np.stack([(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)], axis=-1).reshape(-1, 3)
i = (np.arange(50)[:, None] * 51 + np.arange(50)).ravel()
faces = np.concatenate([np.stack([i, i + 1, i + 51], -1), np.stack([i + 1, i + 52, i + 51], -1)])

random = np.random.default_rng(1)
rays = np.concatenate([random.uniform(-4, 4, (2000, 3)), random.normal(size=(2000, 3))], axis=1)
expected = alhazen.Scene(vertices, faces, accelerator="list").intersect(rays)
print(f"{len(faces)} triangles, {len(rays)} rays, {np.isfinite(expected['t_hit']).sum()} hits")
for name in alhazen.accelerators():
    scene = alhazen.Scene(vertices, faces, accelerator=name, threads=1).build()
    seconds = []
    for _ in range(3):
        start = time.perf_counter()
        found = scene.intersect(rays)
        seconds.append(time.perf_counter() - start)
    same = all(np.array_equal(expected[field], found[field]) for field in expected)
    print(f"{name}: {'the same bits' if same else 'DIFFERENT'}")
    print(f"{name}: {1e6 * min(seconds) / len(rays):.2f} us a ray, {scene.info['accelerator_bytes']} bytes", file=sys.stderr)
