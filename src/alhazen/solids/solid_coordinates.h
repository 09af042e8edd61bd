#pragma once
/// Texture coordinates of the vertices of a tessellated solid (solid_triangles.h).
///
/// Conventions: a vertex has the coordinates of the surface that its triangle lies on, of a shape
/// or of an operand of a CSG object. Coordinates of vertices beside each other continue each other:
/// they may exceed the range of the surface by whole turns. Threads: used by one thread.

#include <cstdint>
#include <map>
#include <vector>

#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/solids/isolated_solid.h"

namespace alhazen {

class SolidCoordinates {
  public:
    static constexpr std::uint32_t kNoSurface = 0xFFFFFFFFu;

    /// A place on a surface: a part of a primitive, and its own parameters.
    struct Place {
        std::uint32_t surface = kNoSurface;
        double u = 0, v = 0;
    };

    explicit SolidCoordinates(const IsolatedSolid& solid) : solid_(solid) {}

    [[nodiscard]] Place place(const Hit& hit);
    /// The coordinates at a vertex near `at`, a point of the surface at `place`.
    [[nodiscard]] Vec2 uv(const Vec3& vertex, const Vec3& at, const Place& place) const;

    /// The vertex `own` or a copy of it that has these coordinates; `copy` makes a new one.
    template <class Copy>
    std::uint32_t vertex(std::uint32_t own, const Place& place, const Vec2& uv, TriangleMesh& mesh,
                         const Copy& copy) {
        if (uses_.size() <= own) uses_.resize(mesh.positions.size());
        std::uint32_t at = own;
        while (uses_[at].surface != kNoSurface) {
            if (uses_[at].surface == place.surface && are_near(mesh.uvs[at], uv)) return at;
            if (uses_[at].next == 0) {
                const std::uint32_t next = copy();
                uses_[at].next = next;
                uses_.resize(mesh.positions.size());
                at = next;
            } else {
                at = uses_[at].next;
            }
        }
        mesh.uvs[at] = uv;
        uses_[at].surface = place.surface;
        return at;
    }

  private:
    /// The surface of which a vertex has coordinates, and its next copy.
    struct Use {
        std::uint32_t surface = kNoSurface, next = 0;
    };

    static bool are_near(const Vec2& a, const Vec2& b);

    const IsolatedSolid& solid_;
    std::map<std::vector<std::uint32_t>, std::uint32_t> numbers_;
    std::vector<Hit> surfaces_;  ///< a hit of each
    std::vector<Use> uses_;      ///< [vertex]
};

}  // namespace alhazen
