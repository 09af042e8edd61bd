#pragma once
/// Light buffers of scenes of few primitives: for each light cells of its rays, whose lists name
/// the primitives that may lie on them.
///
/// Source: Haines and Greenberg, "The Light Buffer: A Shadow-Testing Accelerator", IEEE CG&A 6(9),
/// 1986.
/// Differs: a list is made when the first ray needs it, from bounding spheres and boxes, by the
/// thread whose ray it is; parallel rays have cells of a square across them. The aggregate that
/// traces all other rays stays as it is (as an accelerator: accel/directions/light_buffer.h).
/// Conventions: what a list leaves out is not hit by the ray; answers are those of the aggregate,
/// bit for bit.
/// Complexity and threads: O(primitives) for each cell that is used. Used by one thread.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "alhazen/accel/directions/direction_cube.h"
#include "alhazen/accel/directions/direction_windows.h"
#include "alhazen/aggregates/wide_bvh/unbounded_parts.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

class ShadowLists {
  public:
    /// Null where they do not suit the scene: with many primitives or lights, where something
    /// moves, or where another accelerator was asked for.
    [[nodiscard]] static std::unique_ptr<ShadowLists> make(const Scene& scene);

    /// Aggregate::shadowed of a ray to the light of this number; `crossings` must be empty. Nothing
    /// where the ray does not end at the light: the aggregate must be asked.
    [[nodiscard]] std::optional<bool> shadowed(const Ray& ray, std::size_t light, RayMask mask,
                                               std::vector<Hit>& crossings);

  private:
    /// A primitive with bounds.
    struct Body {
        PrimitiveId id;
        bool opaque = false, flat = false, triangle = false;
        Vec3 center;  ///< of a sphere around it
        double radius = 0;
        const Sphere* sphere = nullptr;  ///< where it is one without a placement
        Vec3 normal;                     ///< unit, where it is flat
        Interval height;                 ///< along the normal
        /// Heights of points p above it are computed, also by its own test, within some units of
        /// dot(rounded, abs(p)) + rounded_offset.
        Vec3 rounded;
        double rounded_offset = 0;
        Box3 box;
    };
    struct Entry {
        std::uint32_t body;
        /// Rays that reach less far do not meet the body. To a point the reach is the length of the
        /// ray, of parallel rays minus their origin along the direction to the light.
        double least_reach;
    };
    using List = std::vector<Entry>;
    /// A body as seen from a point: half the angle of its sphere, and its box on each face.
    struct Seen {
        bool around = false;  ///< the point, or nearly: it is in all lists
        double distance = 0, sine = 0, cosine = 0;
        std::array<std::optional<DirectionWindows::Slopes>, 6> slopes;
    };
    /// The cells of one light: of a cube around it, or of a square.
    struct Cells {
        bool parallel = false;
        Vec3 place;                         ///< of the light, or the direction towards it
        std::vector<Seen> seen;             ///< [body]; of a point
        Vec3 u, v;                          ///< unit, across parallel rays
        std::vector<Vec2> middles;          ///< [body]; across parallel rays
        Vec2 corner;                        ///< of the square
        double edge = 1;                    ///< of its cells
        std::vector<std::uint32_t> number;  ///< [cell] of its list, 0: not made; empty: none is
    };

    explicit ShadowLists(const Scene& scene);
    void add_body(std::uint32_t id);
    /// Sets what is asked of flat bodies, where it is one.
    void set_flat(Body& body) const;
    [[nodiscard]] bool occluded_by(const Body& body, const Ray& ray, RayMask mask) const;
    [[nodiscard]] bool shadowed_by(const Body& body, const Ray& ray, RayMask mask,
                                   std::vector<Hit>& crossings) const;
    /// False where the ray passes by the body.
    [[nodiscard]] bool may_meet(const Body& body, const Ray& ray) const;
    void begin(Cells& cells) const;
    void begin_point(Cells& cells) const;
    void begin_square(Cells& cells) const;
    /// The bodies on the ray, and its reach; null where it does not end at the light.
    [[nodiscard]] const List* list_of(const Ray& ray, std::size_t light, double& reach);
    [[nodiscard]] const List* list_in(Cells& cells, std::size_t cell);
    [[nodiscard]] List list_of_directions(const Cells& cells, std::size_t cell) const;
    [[nodiscard]] List list_of_square(const Cells& cells, std::size_t cell) const;

    const PrimitiveTable& table_;
    UnboundedParts outside_;
    std::vector<Body> bodies_;
    double size_ = 0;  ///< the largest coordinate of bodies and lights; 0: a light is too far
    double room_ = 0;  ///< by which bodies are larger
    std::vector<Cells> lights_;
    std::vector<std::unique_ptr<const List>> lists_{1};  ///< [number]; of number 0: null
    const List nothing_;
};

}  // namespace alhazen
