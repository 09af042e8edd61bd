#pragma once
/// Collects the geometry of a `Tracer`, piece by piece.
///
/// Conventions: any one unit of length, coordinates in double; triangles are counter-clockwise from
/// outside. Geometry is checked when it is added: Error (Scene) lists the findings, and the scene
/// is unchanged.
/// Complexity and threads: O(size of the geometry added); one thread at a time. Copies share
/// meshes.

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

/// Identifies one call of an `add` function: 0 for the first, then 1 and so on.
enum class GeometryId : std::uint32_t {};

struct GeometryOptions {
    /// Placement: any invertible affine transform.
    Affine world_from_geometry{};
    /// Visible to rays whose mask shares a bit with this one (meanings are the program's); 0:
    /// invisible.
    RayMask visible_to = kAllRays;
};

class TracerScene {
  public:
    /// Adds a mesh, copied. positions[vertex]; triangles[triangle] are three vertex indices.
    /// Triangles without area are kept and never hit.
    GeometryId add_mesh(std::span<const Vec3> positions,
                        std::span<const std::array<std::uint32_t, 3>> triangles,
                        const GeometryOptions& options = {});
    /// Adds a mesh from flat arrays: coordinates[3 * vertex + axis], indices[3 * triangle +
    /// corner]. Throws Error (Usage) when a length is not a multiple of three.
    GeometryId add_mesh(std::span<const float> coordinates, std::span<const std::uint32_t> indices,
                        const GeometryOptions& options = {});
    /// Adds a mesh with all vertex attributes except materials. Without a transform the mesh is
    /// shared, not copied, and must not change afterwards.
    GeometryId add_mesh(std::shared_ptr<const TriangleMesh> mesh,
                        const GeometryOptions& options = {});

    GeometryId add_sphere(const Vec3& center, double radius, const GeometryOptions& options = {});
    /// Adds any shape of shapes/shape_list.h, exact and not tessellated: add(Cylinder{...}).
    GeometryId add(const AnyShape& shape, const GeometryOptions& options = {});
    /// Adds all geometry of `inner` at a placement, without a copy. Instances may be nested
    /// `kMaxInstanceDepth` deep.
    GeometryId add_instance(const Tracer& inner, const GeometryOptions& options = {});

    [[nodiscard]] std::size_t geometry_count() const { return count_; }

  private:
    friend class Tracer;
    /// Adds a mesh that has passed its checks.
    GeometryId place_mesh(std::shared_ptr<const TriangleMesh> mesh, bool mirrored,
                          RayMask visible_to);

    PrimitiveTable table_;  ///< `part` of an entry is its GeometryId
    std::uint32_t count_ = 0;
    std::size_t depth_ = 0;  ///< levels of instancing
};

}  // namespace alhazen
