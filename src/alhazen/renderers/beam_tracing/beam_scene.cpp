#include "alhazen/renderers/beam_tracing/beam_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/geometry/repair/repaired_polygon.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/scene_model/part_traversal.h"
#include "alhazen/scene_model/unsupported_parts.h"
#include "alhazen/shapes/polygons/face_loops.h"

namespace alhazen {

namespace {

class BeamGatherer {
  public:
    BeamGatherer(const SceneDescription& description, const Scene& scene)
        : d_(description), scene_(scene) {}

    BeamScene gather() {
        visit_parts(
            d_, kAllRays, [&](const WorldPart& placed) { add_part(placed); },
            [&](const ObjectDescription& solid) { unsupported_.add(solid); });
        unsupported_.throw_if_any(
            "beams support only planar facets: polygons, rectangles, boxes, polyhedra and "
            "triangle meshes, of materials without alpha (with a tolerance other bounded shapes "
            "are tessellated)");
        // Tessellated solids have other parts than the compiled scene.
        if (!scene_.closed_parts.empty()) {
            result_.closed_parts = closed_parts_of(d_, scene_.materials);
        }
        result_.tree = FacetTree(std::move(pool_), std::move(pieces_));
        return std::move(result_);
    }

  private:
    void note(const std::string& mended) {
        if (++mendings_ > kMostNamed) {
            if (mendings_ == kMostNamed + 1) result_.notes.push_back("and others");
            return;
        }
        const std::string name = part_->name.empty() ? "" : " '" + part_->name + "'";
        const std::string where = to_string(part_->location);
        result_.notes.push_back((where.empty() ? "" : where + ": ") + "polygon" + name + ": " +
                                mended);
    }

    void add_part(const WorldPart& placed) {
        const Part& part = placed.part;
        part_ = &part;
        BeamSource source;
        source.placement = {placed.world_from_part, inverse(placed.world_from_part)};
        source.placed = placed.world_from_part != Affine{};
        source.material = part.material;
        source.part = placed.number;
        source.instance = placed.instance;
        source.visible_to = placed.visible_to;
        mirrored_ = determinant(placed.world_from_part.linear) < 0.0;
        if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
            add_shape(*shape, part, std::move(source));
        } else {
            const MeshDescription& mesh =
                d_.meshes[static_cast<std::size_t>(std::get<MeshIndex>(part.what))];
            add_mesh(mesh.mesh.get(), part, std::move(source));
        }
    }

    [[nodiscard]] const Material& material_of(MaterialId id) const {
        return scene_.materials[static_cast<std::size_t>(id)];
    }
    /// Sets the common properties of facets of the material; false if beams cannot render it.
    bool take_material(const Material& material, BeamFacet& facet) const {
        if (material.alpha_mode != AlphaMode::Opaque) return false;
        facet.one_sided = !material.double_sided && is_unseen_from_behind(evaluate(
                                                        material, scene_.textures, Vec2{0.5, 0.5}));
        facet.blocks_light = material.is_opaque();
        return true;
    }

    void add_mesh(const TriangleMesh* mesh, const Part& part, BeamSource source) {
        // A non-owning pointer: the description outlives the picture.
        source.mesh.mesh = std::shared_ptr<const TriangleMesh>(std::shared_ptr<void>(), mesh);
        source.mesh.material = source.material;
        source.smooth = !mesh->normals.empty();
        std::vector<BeamFacet> kinds;
        const std::vector<std::uint32_t>& own = mesh->vertex_materials;
        std::vector<bool> has_alpha;
        for (std::size_t k = 0; k < (own.empty() ? 1 : scene_.materials.size()); ++k) {
            kinds.emplace_back();
            has_alpha.push_back(!take_material(
                own.empty() ? material_of(source.material) : scene_.materials[k], kinds[k]));
        }
        if (own.empty() ? has_alpha[0] : std::any_of(own.begin(), own.end(), [&](std::uint32_t id) {
                return has_alpha[id];
            })) {
            unsupported_.add("mesh with alpha", part.name, part.location);
            return;
        }
        const Affine world = source.placement.outer_from_inner;
        const auto number = static_cast<std::uint32_t>(result_.sources.size());
        for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t) {
            const auto& corners = mesh->triangles[t];
            BeamFacet facet = kinds[own.empty() ? 0 : own[corners[0]]];
            facet.source = number;
            facet.part = t;
            std::array<Vec3, 3> loop;
            for (std::size_t k = 0; k < 3; ++k) loop[k] = world.point(mesh->positions[corners[k]]);
            add_facet(facet, loop, {});
        }
        result_.sources.push_back(std::move(source));
    }

    void add_shape(const AnyShape& shape, const Part& part, BeamSource source) {
        auto prepared = std::make_shared<AnyShape>(shape);
        std::visit([](auto& s) { s.prepare(); }, *prepared);
        source.shape = prepared;
        source.smooth = material_of(part.material).normal_map.texture != kNoTexture;
        BeamFacet facet;
        facet.source = static_cast<std::uint32_t>(result_.sources.size());
        const bool plain = take_material(material_of(part.material), facet);
        world_ = source.placement.outer_from_inner;
        const std::string name = std::visit(
            [&]<class S>(const S& s) -> std::string {
                if (!plain) return std::string(S::kName) + " with alpha";
                if constexpr (requires { add_kind(s, facet); }) {
                    if (add_kind(s, facet)) return "";
                }
                return S::kName;
            },
            *prepared);
        if (!name.empty()) unsupported_.add(name, part.name, part.location);
        result_.sources.push_back(std::move(source));
    }

    bool add_kind(const Polygon& s, BeamFacet facet) {
        add_placed(facet, s.vertices, s.loop_ends, s.normal);
        return true;
    }
    bool add_kind(const Rectangle& s, BeamFacet facet) {
        const std::array<Vec3, 4> loop{s.corner, s.corner + s.edge_u,
                                       s.corner + s.edge_u + s.edge_v, s.corner + s.edge_v};
        add_placed(facet, loop, {});
        return true;
    }
    bool add_kind(const BoxShape& s, const BeamFacet& facet) {
        add_solid(face_loops(s), facet);
        return true;
    }
    bool add_kind(const Polyhedron& s, const BeamFacet& facet) {
        const auto loops = face_loops(s);
        if (loops) add_solid(*loops, facet);
        return loops.has_value();
    }

    void add_solid(const std::vector<FaceLoop>& loops, BeamFacet facet) {
        for (const FaceLoop& loop : loops) {
            facet.part = loop.face;
            add_placed(facet, loop.corners, {});
        }
    }

    /// `side`: a normal on the front side; 0: corners run counter-clockwise seen from there.
    void add_placed(const BeamFacet& facet, std::span<const Vec3> corners,
                    std::span<const std::uint32_t> ends, const Vec3& side = {}) {
        std::vector<Vec3> placed;
        for (const Vec3& p : corners) placed.push_back(world_.point(p));
        add_facet(facet, placed, ends, transpose_times(inverse(world_).linear, side));
    }
    void add_facet(const BeamFacet& facet, std::span<const Vec3> corners,
                   std::span<const std::uint32_t> ends, const Vec3& side = {}) {
        Vec3 normal = unit_or(corners.size() == 3 ? newell_normal_of_loops(corners, ends)
                                                  : plane_normal_of_loops(corners, ends),
                              {0, 0, 0});
        if (!(length_squared(normal) > 0.0)) return;
        if (mirrored_) normal = -normal;
        if (dot(normal, side) < 0.0) normal = -normal;
        double offset = 0.0;
        for (const Vec3& p : corners) offset += dot(normal, p);
        const auto number = static_cast<std::uint32_t>(result_.facets.size());
        pool_.planes.push_back({normal, offset / static_cast<double>(corners.size())});
        result_.facets.push_back(facet);
        if (corners.size() == 3) {
            pieces_.push_back(pool_.add(number, corners));
            return;
        }
        const RepairedPolygon polygon = repaired_polygon(corners, ends, pool_.planes.back());
        for (const std::vector<Vec3>& part : polygon.parts) {
            pieces_.push_back(pool_.add(number, part));
        }
        if (!polygon.mended.empty()) note(polygon.mended);
        if (!polygon.refused.empty())
            unsupported_.add(polygon.refused, part_->name, part_->location);
    }

    static constexpr int kMostNamed = 20;
    const SceneDescription& d_;
    const Scene& scene_;
    BeamScene result_;
    FacetPool pool_;
    std::vector<FacetPiece> pieces_;
    Affine world_;
    bool mirrored_ = false;       ///< the placement reverses orientation
    const Part* part_ = nullptr;  ///< part of the current facets
    int mendings_ = 0;
    UnsupportedParts unsupported_;
};

}  // namespace

BeamScene beam_scene(const SceneDescription& description, const Scene& scene) {
    return BeamGatherer(description, scene).gather();
}

}  // namespace alhazen
