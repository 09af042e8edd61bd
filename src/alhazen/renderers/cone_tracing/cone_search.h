#pragma once
/// The pieces that a cone meets, nearest first: spheres, planes, faces and triangles, each with the
/// share of the cone that it covers.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 3 (a sorted list of objects
/// that partly cover the cone).
/// Differs: pieces are computed lazily, once no unvisited box is nearer, so that a fully covered
/// cone computes no more; the list of objects is kept by the renderer (cone_pieces.h).
/// Conventions: distances are along the centre line. Pieces at equal distance are sorted by source
/// and part. Only the side of a solid that faces the cone's start counts, its front from outside,
/// its back from inside; of solids that may be passed the far side follows as pieces of its own.
/// Threads: used by one thread; memory is reused.

#include <optional>
#include <vector>

#include "alhazen/geometry/cones/cone_coverage.h"
#include "alhazen/geometry/cones/cut_sphere.h"
#include "alhazen/geometry/ray_mask.h"
#include "alhazen/renderers/cone_tracing/cone_containment.h"

namespace alhazen {

struct ConePiece {
    std::uint32_t source = 0;
    std::uint32_t part = 0;  ///< face of the shape, or triangle of the mesh
    double z = 0;            ///< distance of its centroid along the centre line
    double share = 0;        ///< covered share of the cone
    Vec2 at{0, 0};           ///< its centroid in the disc of the cone
    double u = 0, v = 0;     ///< weights of the second and third corner of a triangle
    bool front = true;       ///< seen from the side of its outward normal
    bool far_side = false;   ///< of a solid, the side that does not face the cone's start
};

/// The start of a cone, and what it may see.
struct ConeStart {
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    RayKind kind = RayKind::Eye;
    std::uint32_t source = kNone, part = kNone;  ///< where it starts
    double clear = 0;  ///< pieces of that source at a smaller distance are ignored
    ConeRange range;
    std::optional<ConePlane> plane;  ///< of the surface where it starts
    SolidsAround inside;             ///< solids that contain its start

    [[nodiscard]] bool is_inside(std::uint32_t s) const {
        for (const std::uint32_t k : inside) {
            if (k == s) return true;
        }
        return false;
    }
    /// Adds a solid to those that contain the start, as the innermost, or removes it.
    void set_inside(std::uint32_t solid, bool contains) {
        SolidsAround around;
        for (const std::uint32_t k : inside) {
            if (k != solid) around.push_back(k);
        }
        if (contains && !around.full()) around.push_back(solid);
        inside = around;
    }
};

class ConeSearch {
  public:
    /// `tables`: use Kirk's tables for the coverage of spheres. The scene must outlive the object.
    ConeSearch(const ConeScene& scene, bool tables) : scene_(scene), tables_(tables) {}

    /// Starts a search. `cone` and `start` must outlive the calls of `next`.
    void begin(const ConeRay& cone, const ConeStart& start);
    /// Sets the next piece; false if there are no more.
    [[nodiscard]] bool next(ConePiece& piece);

  private:
    /// Traversal of the tree of the scene, or of a mesh.
    struct Level {
        const ConeTree* tree;
        ConeMap map;
        std::uint32_t source;
    };
    struct Waiting {
        double z;
        std::uint32_t level, node;
    };
    static constexpr std::uint32_t kScene = ConeStart::kNone;

    void push_node(std::uint32_t level, std::uint32_t node);
    void open(const Waiting& waiting);
    void add_item(const ConeItem& item);
    void add_plane(std::uint32_t source);
    void add_sphere(std::uint32_t number, const ConeSource& source);
    /// The coverage by a sphere around which the cone does not start; nothing if it does.
    [[nodiscard]] std::optional<ConeCover> sphere_cover(const ConeSource& source);
    void add_face(const ConeFace& face);
    void add_triangle(const Level& level, std::uint32_t triangle);
    [[nodiscard]] bool is_seen(const ConeSource& source) const;
    /// True for the side of a solid that does not face the cone's start.
    [[nodiscard]] bool is_far_side(const ConeSource& source, std::uint32_t number,
                                   bool front) const {
        return source.closed && front == start_->is_inside(number);
    }
    /// Adds a piece in the plane through `point`.
    void add_flat(std::uint32_t source, std::uint32_t part, const Vec3& point, const Vec3& normal,
                  const ConeCover& cover, bool front, bool far_side);
    void add(const ConePiece& piece);
    /// The line of the cone through a point of its disc; its direction has z = 1.
    [[nodiscard]] Ray line(const Vec2& at) const;

    const ConeScene& scene_;
    bool tables_;
    const ConeRay* cone_ = nullptr;
    const ConeStart* start_ = nullptr;
    Vec3 ex_, ey_;
    std::vector<Level> levels_;
    std::vector<Waiting> waiting_;   ///< a heap, nearest first
    std::vector<ConePiece> pieces_;  ///< a heap, nearest first
    ConeScratch scratch_;
};

}  // namespace alhazen
