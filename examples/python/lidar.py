"""A lidar that drives along a street: one sweep, ranges and which things were seen."""
import numpy as np

import alhazen

random = np.random.default_rng(7)
street = alhazen.Scene().add(alhazen.plane("road", normal=(0, 0, 1)))
for i in range(12):
    x, depth, height = 8 * i - 48, random.uniform(4, 8), random.uniform(5, 15)
    street.add(alhazen.box(f"house {i}", lo=(x, 8, 0), hi=(x + 7, 8 + depth, height)))
    street.add(alhazen.cylinder(f"lamp {i}", base=(x, -5, 0), top=(x, -5, 6), radius=0.1))

# 16 beams between -15 and 15 degrees, turned in steps of half a degree, at 1.8 m.
elevation = np.radians(np.linspace(-15, 15, 16))[:, None]
azimuth = np.radians(np.arange(0, 360, 0.5))[None, :]
rays = np.zeros((16, azimuth.size, 8))
rays[..., 2] = 1.8
rays[..., 3] = np.cos(elevation) * np.cos(azimuth)
rays[..., 4] = np.cos(elevation) * np.sin(azimuth)
rays[..., 5] = np.sin(elevation)
rays[..., 6], rays[..., 7] = 0.5, 60  # the range of the instrument, metres

hits = street.intersect(rays, fields=("t_hit", "geometry_ids", "points"))
seen = np.isfinite(hits["t_hit"])
print(f"{rays.shape[0] * rays.shape[1]} beams, {seen.sum()} came back, from {hits['t_hit'][seen].min():.2f} m on")
names = np.array(street.geometry_names)
things, counts = np.unique(hits["geometry_ids"][seen], return_counts=True)
kinds = np.array([name.split()[0] for name in names[things]])
for kind in ("road", "house", "lamp"):
    print(f"{kind}: {counts[kinds == kind].sum()} points on {np.sum(kinds == kind)} of {sum(n.startswith(kind) for n in names)}")
