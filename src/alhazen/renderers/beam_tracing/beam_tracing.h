#pragma once
/// Beam tracing: visible surfaces, mirror images and shadows as exact polygons, computed once for
/// all resolutions.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984; Atherton, Weiler
/// and Greenberg, "Polygon Shadow Generation", SIGGRAPH 1978; Dadoun, Kirkpatrick and Walsh, "The
/// Geometry of Beam Tracing", Computational Geometry 1985.
/// Differs: docs/design/beam_tracing.md. Supports planar facets (beam_scene.h) and refuses other
/// shapes by name. Pixels are shaded at their sample points, or by the exact coverage of each piece
/// (`--antialias exact`).

#include "alhazen/renderers/beam_tracing/beam_tree.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

class BeamTracing final : public Renderer {
  public:
    /// `tolerance`: of tessellations that the caller substitutes for exact shapes; 0: none.
    explicit BeamTracing(const BeamTreeOptions& options = {}, double tolerance = 0)
        : options_(options), tolerance_(tolerance) {}

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    /// Geometry is read from RenderJob::description.
    [[nodiscard]] bool needs_aggregate() const override { return false; }
    [[nodiscard]] bool takes_wide_cameras() const override { return false; }
    [[nodiscard]] bool gives_exact_areas() const override { return true; }
    [[nodiscard]] double takes_triangles_within() const override { return tolerance_; }

  private:
    BeamTreeOptions options_;
    double tolerance_;
};

}  // namespace alhazen
