#pragma once
/// The geometry that a `Tracer` is built over, collected piece by piece.
///
/// Conventions: lengths are in any one unit, coordinates double; triangles are counter-clockwise
/// from outside. What is added is checked at once: Error (Scene) lists what is wrong with it, and
/// the scene is then as it was before.
/// Complexity and threads: O(size of what is added); one thread at a time. Copies share meshes.

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "alhazen/geometry/ray_mask.h"
#include "alhazen/math/affine.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

class Tracer;

/// One call of an `add` function: 0 for the first, then 1 and so on.
enum class GeometryId : std::uint32_t {};

struct GeometryOptions {
    /// Where it stands: any affine transform that can be inverted.
    Affine world_from_geometry{};
    /// Which rays see it: those whose mask has a bit in common with this one. What the bits mean is
    /// up to the program; 0: none sees it.
    RayMask visible_to = kAllRays;
};

class TracerScene {
  public:
    /// A mesh, copied. positions[vertex]; triangles[triangle] are three indices of vertices.
    /// Triangles without area are kept and never hit.
    GeometryId add_mesh(std::span<const Vec3> positions,
                        std::span<const std::array<std::uint32_t, 3>> triangles,
                        const GeometryOptions& options = {});
    /// The same of flat arrays: coordinates[3 * vertex + axis], indices[3 * triangle + corner].
    /// Throws Error (Usage) where a length is no multiple of three.
    GeometryId add_mesh(std::span<const float> coordinates, std::span<const std::uint32_t> indices,
                        const GeometryOptions& options = {});
    /// A mesh with all that a vertex may carry but materials. Without a transform it is not copied,
    /// and must not be changed any more.
    GeometryId add_mesh(std::shared_ptr<const TriangleMesh> mesh,
                        const GeometryOptions& options = {});

    GeometryId add_sphere(const Vec3& center, double radius, const GeometryOptions& options = {});
    /// Any shape of shapes/shape_list.h, exact and not tessellated: add(Cylinder{...}).
    GeometryId add(const AnyShape& shape, const GeometryOptions& options = {});
    /// All that `inner` traces, once more in another place, without a copy: instances of instances
    /// may be `kMaxInstanceDepth` deep.
    GeometryId add_instance(const Tracer& inner, const GeometryOptions& options = {});

    [[nodiscard]] std::size_t geometry_count() const { return count_; }

  private:
    friend class Tracer;
    /// Puts a mesh that was checked into the table.
    GeometryId place_mesh(std::shared_ptr<const TriangleMesh> mesh, bool mirrored,
                          RayMask visible_to);

    PrimitiveTable table_;  ///< `part` of what is in it is the GeometryId
    std::uint32_t count_ = 0;
    std::size_t depth_ = 0;  ///< levels of instances
};

}  // namespace alhazen
