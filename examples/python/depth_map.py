"""Casts rays at a part: a depth map as a picture, and the points that a scanner would see as a PLY file."""
import sys

import numpy as np

import alhazen
from alhazen.raycasting import RaycastingScene

folder = sys.argv[1] if len(sys.argv) > 1 else "."
scene = alhazen.Scene().add(
    alhazen.difference(alhazen.box(lo=(-2, -1, 0), hi=(2, 1, 1)),
                       alhazen.cylinder(base=(-1, 0, -1), top=(-1, 0, 2), radius=0.5),
                       alhazen.sphere(center=(1, 0, 1), radius=0.7)),
    alhazen.plane(normal=(0, 0, 1)))

# Rows count towards `up`: from the top, since that is -z.
rays = RaycastingScene.create_rays_pinhole(fov_deg=45, center=[0, 0, 0.3], eye=[1, -5, 5], up=[0, 0, -1],
                                           width_px=320, height_px=240)
hits = scene.intersect(rays, fields=("t_hit", "points", "normals"), coherent=True)
depth = hits["t_hit"]
print(f"depth {depth.shape} {depth.dtype}, from {depth.min():.3f} to {depth.max():.3f}")

near = (depth.max() - depth) / (depth.max() - depth.min())
near.astype(np.float32).view(alhazen.Picture).save(f"{folder}/depth.png")

# Points of the part, without the floor.
on_part = hits["points"][..., 2] > 1e-6
cloud = np.concatenate([hits["points"][on_part], hits["normals"][on_part]], axis=1).astype("<f4")
header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(cloud)}\n"
header += "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz")) + "end_header\n"
with open(f"{folder}/cloud.ply", "wb") as file:
    file.write(header.encode() + cloud.tobytes())
print(f"{len(cloud)} of {depth.size} points lie on the part, the highest at z = {cloud[:, 2].max():.3f}")
