#pragma once
/// Recursive ray tracing: eye, shadow, reflection and refraction rays.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980; the
/// equation and the rules for interpolated normals of the UW CSE 457 Trace project:
///   I = ke + sum_j [ kd ILa_j + Ashadow Adist IL_j Bj (kd (N.L) + ks (N.H)+^ns) ] + kr I(Q,R) + kt
///   I(Q,T).
/// Differs: secondary rays start outside the error bound of the hit point instead of at a global
/// epsilon; shadow rays count every surface they cross once, in one query; what formats do
/// otherwise is read from ShadingConventions.

#include "alhazen/renderers/renderer.h"

namespace alhazen {

class Whitted final : public Renderer {
  public:
    void render_tile(const RenderJob& job, const PixelBox& tile, Film& film,
                     RayCounters& counters) const override;
};

}  // namespace alhazen
