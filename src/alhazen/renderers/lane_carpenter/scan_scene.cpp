#include "alhazen/renderers/lane_carpenter/scan_scene.h"

#include <algorithm>

#include "alhazen/math/unit_vector.h"
#include "alhazen/scene_model/part_traversal.h"
#include "alhazen/scene_model/unsupported_parts.h"
#include "alhazen/shapes/patches/forms/exact_forms.h"
#include "alhazen/shapes/patches/nurbs/trim_region.h"
#include "alhazen/shapes/polygons/face_loops.h"

namespace alhazen {

namespace {

BezierNet placed_net(const BezierNet& net, const Affine& world_from_own) {
    BezierNet result = net;
    for (int k = 0; k < net.count(); ++k) {
        HomogeneousPoint& p = result.points[static_cast<std::size_t>(k)];
        const Vec3 v =
            world_from_own.linear * Vec3{p.x, p.y, p.z} + p.w * world_from_own.translation;
        p = {v.x, v.y, v.z, p.w};
    }
    return result;
}

/// Two unit vectors that span the plane of a normal.
std::array<Vec3, 2> plane_axes(const Vec3& normal) {
    const Vec3 a = perpendicular(normal);
    return {a, cross(normal, a)};
}

class ScanGatherer {
  public:
    ScanGatherer(const SceneDescription& description, const Scene& scene, const Vec3& eye)
        : d_(description), scene_(scene), eye_(eye) {}

    ScanScene gather() {
        visit_parts(
            d_, mask_of(RayKind::Eye), [&](const WorldPart& placed) { add_part(placed); },
            [&](const ObjectDescription& solid) { unsupported_.add(solid); });
        unsupported_.throw_if_any(
            "scan lines support only patches, the shapes that are patches, and polygons");
        return std::move(result_);
    }

  private:
    void add_part(const WorldPart& placed) {
        const Part& part = placed.part;
        ScanSource source;
        source.world_from_own = placed.world_from_part;
        source.placed = placed.world_from_part != Affine{};
        source.own_from_world = inverse(placed.world_from_part);
        source.mirrored = determinant(placed.world_from_part.linear) < 0.0;
        source.material = part.material;
        source.part = placed.number;
        source.instance = placed.instance;
        if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
            source.may_pass =
                scene_.materials[static_cast<std::size_t>(part.material)].may_be_passed();
            add_shape(*shape, part, std::move(source));
        } else {
            source.mesh =
                d_.meshes[static_cast<std::size_t>(std::get<MeshIndex>(part.what))].mesh.get();
            add_mesh(std::move(source));
        }
    }

    void add_mesh(ScanSource source) {
        const TriangleMesh& mesh = *source.mesh;
        const std::vector<std::uint32_t>& own = mesh.vertex_materials;
        if (own.empty()) {
            source.may_pass =
                scene_.materials[static_cast<std::size_t>(source.material)].may_be_passed();
        }
        source.may_pass = source.may_pass || std::any_of(own.begin(), own.end(), [&](auto id) {
                              return scene_.materials[id].may_be_passed();
                          });
        const auto index = static_cast<std::uint32_t>(result_.sources.size());
        for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
            result_.facets.push_back({.source = index, .part = static_cast<std::uint32_t>(k)});
        }
        for (const Vec3& p : mesh.positions) reach(source.world_from_own.point(p));
        result_.sources.push_back(std::move(source));
    }

    void add_shape(const AnyShape& shape, const Part& part, ScanSource source) {
        auto prepared = std::make_shared<AnyShape>(shape);
        if (must_prepare(shape, part.material)) {
            std::visit([](auto& s) { s.prepare(); }, *prepared);
        }
        source.shape = prepared.get();
        source.prepared = std::move(prepared);
        const AnyShape* own = source.shape;
        std::visit(
            [&]<class S>(const S& s) {
                source.is_patch = std::is_same_v<S, BezierPatch> || std::is_same_v<S, PatchMesh> ||
                                  std::is_same_v<S, NurbsSurface> ||
                                  std::is_same_v<S, BilinearPatch> ||
                                  std::is_same_v<S, SteinerPatch> || std::is_same_v<S, Rectangle>;
                source.is_triangle = std::is_same_v<S, SteinerPatch>;
                source.is_by_ray = std::is_same_v<S, Lathe>;
                result_.sources.push_back(std::move(source));
                if constexpr (HasPatchForm<S>) {
                    add_pieces(s);
                } else if (!add_facets(s)) {
                    result_.sources.pop_back();
                    unsupported_.add(S::kName, part.name, part.location);
                }
            },
            *own);
    }

    /// Preparation for rays takes longer than the picture: patches need it only if their outside
    /// matters.
    [[nodiscard]] bool must_prepare(const AnyShape& shape, MaterialId id) const {
        if (std::holds_alternative<BezierPatch>(shape)) return false;
        if (!std::holds_alternative<PatchMesh>(shape)) return true;
        const Material& material = scene_.materials[static_cast<std::size_t>(id)];
        return !material.double_sided || material.normal_map.texture != kNoTexture;
    }

    template <class S>
    void add_pieces(const S& shape) {
        std::vector<BezierPiece> pieces;
        append_pieces(shape, pieces);
        add_pieces(pieces, [](std::size_t) { return false; });
    }
    void add_pieces(const PatchMesh& mesh) {
        std::vector<BezierPiece> pieces;
        for (std::size_t k = 0; k < mesh.patch_count(); ++k) {
            pieces.push_back({.net = mesh.net(k), .part = static_cast<std::uint32_t>(k)});
        }
        add_pieces(pieces, [&](std::size_t k) { return mesh.is_closed && mesh.inward[k]; });
    }
    /// Maps parameters from the first to the last knot to the unit square.
    void add_pieces(const NurbsSurface& s) {
        std::vector<BezierPiece> pieces;
        append_pieces(s, pieces);
        const Vec2 lo{s.knots_u[s.degree_u], s.knots_v[s.degree_v]};
        const Vec2 size{s.knots_u[s.knots_u.size() - s.degree_u - 1] - lo.x,
                        s.knots_v[s.knots_v.size() - s.degree_v - 1] - lo.y};
        std::vector<bool> trimmed;
        for (BezierPiece& piece : pieces) {
            trimmed.push_back(s.region != nullptr &&
                              s.region->cover(piece.lo, piece.hi) != TrimRegion::Cover::All);
            for (Vec2* corner : {&piece.lo, &piece.hi}) {
                *corner = {(corner->x - lo.x) / size.x, (corner->y - lo.y) / size.y};
            }
        }
        const std::size_t first = result_.pieces.size();
        add_pieces(pieces, [](std::size_t) { return false; });
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            result_.pieces[first + k].trimmed = trimmed[k];
        }
    }
    template <class IsInward>
    void add_pieces(const std::vector<BezierPiece>& pieces, IsInward&& is_inward) {
        const ScanSource& source = result_.sources.back();
        const auto index = static_cast<std::uint32_t>(result_.sources.size() - 1);
        for (std::size_t n = 0; n < pieces.size(); ++n) {
            const BezierPiece& piece = pieces[n];
            result_.pieces.push_back({.net = placed_net(piece.net, source.world_from_own),
                                      .source = index,
                                      .part = piece.part,
                                      .lo = piece.lo,
                                      .hi = piece.hi,
                                      .inward = is_inward(n)});
            const BezierNet& net = result_.pieces.back().net;
            bool polynomial = true;
            for (int k = 0; k < net.count(); ++k) {
                polynomial = polynomial && net.points[static_cast<std::size_t>(k)].w == 1.0;
                reach(projected(net.points[static_cast<std::size_t>(k)]));
            }
            result_.pieces.back().polynomial = polynomial;
        }
    }

    // ---- facets: points and normals in the frame of the shape
    template <class S>
    bool add_facets(const S&) {
        return false;
    }
    bool add_facets(const Plane& s) {
        add_plane(s.point, s.unit_normal);
        return true;
    }
    bool add_facets(const HalfSpace& s) {
        add_plane(s.face.point, s.face.unit_normal);
        return true;
    }
    bool add_facets(const Polygon& s) {
        std::vector<std::vector<HomogeneousPoint>> loops;
        std::size_t first = 0;
        for (const std::size_t end : s.loop_ends) {
            loops.emplace_back();
            for (std::size_t k = first; k < end; ++k) {
                loops.back().push_back(homogeneous(s.vertices[k]));
            }
            first = end;
        }
        add_facet(s.point, s.normal, 0, loops);
        return true;
    }
    bool add_facets(const BoxShape& s) {
        for (const FaceLoop& loop : face_loops(s)) add_face(loop, loop.corners[0]);
        return true;
    }
    bool add_facets(const Polyhedron& s) {
        const auto loops = face_loops(s);
        if (!loops) return false;
        for (const FaceLoop& loop : *loops) add_face(loop, s.faces[loop.face].point);
        return true;
    }
    void add_face(const FaceLoop& loop, const Vec3& point) {
        std::vector<HomogeneousPoint> corners;
        for (const Vec3& p : loop.corners) corners.push_back(homogeneous(p));
        add_facet(point, loop.normal, loop.face, {corners});
    }

    /// Four quadrants with corners at infinity.
    void add_plane(const Vec3& point, const Vec3& normal) {
        const auto [a, b] = plane_axes(normal);
        const std::array<Vec3, 4> around{a, b, -a, -b};
        std::vector<std::vector<HomogeneousPoint>> loops;
        for (std::size_t k = 0; k < 4; ++k) {
            loops.push_back({homogeneous(point), homogeneous_direction(around[k]),
                             homogeneous_direction(around[(k + 1) % 4])});
        }
        for (const auto& loop : loops) add_facet(point, normal, 0, {loop});
    }
    static HomogeneousPoint homogeneous_direction(const Vec3& v) { return {v.x, v.y, v.z, 0.0}; }

    void add_facet(const Vec3& point, const Vec3& normal, std::uint32_t part,
                   const std::vector<std::vector<HomogeneousPoint>>& loops) {
        const ScanSource& source = result_.sources.back();
        ScanFacet facet;
        facet.source = static_cast<std::uint32_t>(result_.sources.size() - 1);
        facet.part = part;
        facet.first = static_cast<std::uint32_t>(result_.loops.size());
        facet.loops = static_cast<std::uint32_t>(loops.size());
        facet.point = source.world_from_own.point(point);
        facet.normal = unit_or(transpose_times(source.own_from_world.linear, normal), {0, 0, 1});
        for (const auto& loop : loops) {
            result_.loops.emplace_back();
            for (const HomogeneousPoint& p : loop) {
                const Vec3 v = source.world_from_own.linear * Vec3{p.x, p.y, p.z} +
                               p.w * source.world_from_own.translation;
                result_.loops.back().push_back({v.x, v.y, v.z, p.w});
                if (p.w != 0.0) reach(v / p.w);
            }
        }
        result_.facets.push_back(facet);
    }

    void reach(const Vec3& point) {
        result_.farthest = std::max(result_.farthest, length(point - eye_));
    }

    const SceneDescription& d_;
    const Scene& scene_;
    Vec3 eye_;
    ScanScene result_;
    UnsupportedParts unsupported_;
};

}  // namespace

ScanScene scan_scene(const SceneDescription& description, const Scene& scene, const Vec3& eye) {
    return ScanGatherer(description, scene, eye).gather();
}

std::array<Vec3, 3> triangle_corners(const ScanSource& source, std::uint32_t triangle) {
    const auto& corners = source.mesh->triangles[triangle];
    std::array<Vec3, 3> result;
    for (std::size_t k = 0; k < 3; ++k) {
        result[k] = source.world_from_own.point(source.mesh->positions[corners[k]]);
    }
    return result;
}

}  // namespace alhazen
