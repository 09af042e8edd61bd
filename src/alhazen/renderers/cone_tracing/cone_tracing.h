#pragma once
/// Ray tracing with cones: a pixel is one cone, and so are its reflections, refractions and
/// shadows.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984; Kirk, "The Simulation of Natural
/// Features Using Cone Tracing", The Visual Computer 3(2), 1987 (tables, apertures of textures).
/// Differs: docs/design/cone_tracing.md. Supports spheres, planes, polygons with holes, boxes,
/// polyhedra, rectangles and triangle meshes, and refuses other shapes by name. Several samples per
/// pixel are as many narrower cones.

#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

struct ConeTracingOptions {
    bool tables = false;  ///< Kirk's tables for the coverage of spheres, instead of the formulas
};

class ConeTracing final : public Renderer {
  public:
    explicit ConeTracing(const ConeTracingOptions& options = {}) : options_(options) {}

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    /// Geometry is read from RenderJob::description.
    [[nodiscard]] bool needs_aggregate() const override { return false; }
    [[nodiscard]] bool lights_have_extent() const override { return true; }

  private:
    ConeTracingOptions options_;
};

}  // namespace alhazen
