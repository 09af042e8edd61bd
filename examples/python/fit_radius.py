"""Fits a parameter of a solid by its volume: the drill that takes a third of a ball."""
import numpy as np

import alhazen


def volume(radius):
    """Volume of a unit ball with a hole through its middle, and half the width of its interval."""
    solid = alhazen.Scene().add(alhazen.difference(
        alhazen.sphere(radius=1), alhazen.cylinder(base=(0, 0, -2), top=(0, 0, 2), radius=radius)))
    (lo, hi) = solid.measure(error=1e-4, time_limit=5)[0]["volume"]["interval"]
    return (lo + hi) / 2, (hi - lo) / 2


target = 2 / 3 * 4 / 3 * np.pi
low, high = 0.01, 0.99
while True:
    radius = (low + high) / 2
    value, error = volume(radius)
    if abs(value - target) <= error:
        break
    low, high = (radius, high) if value > target else (low, radius)

# The ring that is left is as large as a ball of diameter 2 sqrt(1 - radius^2).
exact = np.sqrt(1 - (2 / 3) ** (2 / 3))
print(f"radius {radius:.3f}, exact {exact:.3f}; the difference is below 0.001: {abs(radius - exact) < 1e-3}")
