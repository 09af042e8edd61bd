"""Wall thickness of a hollow part, seen from above: where a mould would fill badly."""
import sys

import numpy as np

import alhazen

folder = sys.argv[1] if len(sys.argv) > 1 else "."
part = alhazen.Scene().add(alhazen.difference(
    "cup",
    alhazen.cone(base=(0, 0, 0), top=(0, 0, 4), base_radius=1.5, top_radius=2),
    # The core stands askew.
    alhazen.cone(base=(0.1, 0, 0.3), top=(0.1, 0, 4.1), base_radius=1.2, top_radius=1.8)))

# Level rays towards the axis, all around (columns) and from bottom to top (rows).
angle = np.radians(np.arange(0, 360, 5))
height = np.linspace(0.02, 3.98, 100)
rays = np.zeros((len(height), len(angle), 8))
rays[..., 0], rays[..., 1], rays[..., 2] = 3 * np.cos(angle), 3 * np.sin(angle), height[:, None]
rays[..., 3], rays[..., 4] = -np.cos(angle), -np.sin(angle)
rays[..., 7] = 3  # to the axis, no further
wall = part.thickness(rays)

above = height > 0.3
print(f"base {wall[~above].min():.3f}, wall {wall[above].min():.3f} to {wall[above].max():.3f}")
row, column = np.unravel_index(wall.argmin(), wall.shape)
print(f"thinnest at z = {height[row]:.2f}, {np.degrees(angle[column]):.0f} degrees")
# White is 0.5 and more; a pixel is 4 by 2.
picture = np.kron(np.clip(wall[::-1] / 0.5, 0, 1), np.ones((2, 4)))
picture.astype(np.float32).view(alhazen.Picture).save(f"{folder}/thickness.png")
