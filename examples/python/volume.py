"""Volume of a solid made of others, with its interval, beside the exact one."""
import numpy as np

import alhazen

steel = alhazen.material("steel", diffuse=0.6, density=7.85e-6)  # kg / mm^3
scene = alhazen.Scene().add(
    steel,
    alhazen.difference("flange",
                       alhazen.cylinder(base=(0, 0, 0), top=(0, 0, 10), radius=50),
                       alhazen.cylinder(base=(0, 0, -1), top=(0, 0, 11), radius=20),
                       *(alhazen.cylinder(base=(35 * np.cos(a), 35 * np.sin(a), -1),
                                          top=(35 * np.cos(a), 35 * np.sin(a), 11), radius=4)
                         for a in np.radians([0, 60, 120, 180, 240, 300])),
                       material="steel"))
exact = np.pi * 10 * (50**2 - 20**2 - 6 * 4**2)

report, = scene.measure("flange", error=1e-4, time_limit=10)
(lo, hi), value = report["volume"]["interval"], report["volume"]["value"]
print(f"exact {exact:.0f} mm^3 lies in the interval: {lo <= exact <= hi}")
print(f"the interval is narrower than 2e-4 of it: {hi - lo < 2e-4 * exact}")
print(f"mass {report['mass']['value']:.3f} kg")
