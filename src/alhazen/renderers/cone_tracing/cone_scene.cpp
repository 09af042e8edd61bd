#include "alhazen/renderers/cone_tracing/cone_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "alhazen/base/disjoint_sets.h"
#include "alhazen/geometry/repair/repaired_polygon.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/renderers/cone_tracing/cone_containment.h"
#include "alhazen/scene_model/part_traversal.h"
#include "alhazen/scene_model/unsupported_parts.h"
#include "alhazen/shading/materials/texture_inputs.h"
#include "alhazen/shapes/meshes/mesh_shells.h"
#include "alhazen/shapes/polygons/face_loops.h"
#include "alhazen/shapes/polygons/flat_vertices.h"

namespace alhazen {

namespace {

/// Of boxes of solids, relative to their coordinates.
constexpr double kSlack = 0x1p-26;
/// A search for a solid beside another that takes longer has found one.
constexpr std::size_t kMostVisits = 256;

/// The scale of a similarity transform; 0 for others.
double similarity_of(const Mat3& m) {
    const double a = length(m.x_axis), b = length(m.y_axis), c = length(m.z_axis);
    const double slack = 1e-9 * a;
    const bool square = std::abs(dot(m.x_axis, m.y_axis)) <= slack * a &&
                        std::abs(dot(m.y_axis, m.z_axis)) <= slack * a &&
                        std::abs(dot(m.z_axis, m.x_axis)) <= slack * a;
    return square && std::abs(b - a) <= slack && std::abs(c - a) <= slack ? a : 0.0;
}

/// Newell's normal; its length is twice the area.
Vec3 loop_normal(std::span<const Vec3> loop) {
    Vec3 sum;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        sum += cross(loop[k] - loop[0], loop[k + 1 == loop.size() ? 0 : k + 1] - loop[0]);
    }
    return sum;
}

/// True if a point in the plane of a normal lies in a loop, by the odd-even rule.
bool is_in_loop(const Vec3& p, std::span<const Vec3> loop, const Vec3& normal) {
    const int drop = dominant_axis(normal);
    const int a = (drop + 1) % 3, b = (drop + 2) % 3;
    bool in = false;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec3 &u = loop[k], &v = loop[k + 1 == loop.size() ? 0 : k + 1];
        if ((u[b] > p[b]) != (v[b] > p[b]) &&
            p[a] < u[a] + (p[b] - u[b]) / (v[b] - u[b]) * (v[a] - u[a])) {
            in = !in;
        }
    }
    return in;
}

/// Joins the surfaces of faces and meshes that share an edge.
class SharedEdges {
  public:
    explicit SharedEdges(std::size_t sources) : surfaces_(sources), count_(sources) {}
    void add(Vec3 a, Vec3 b, std::uint32_t source) {
        const auto key = [](const Vec3& p) { return std::array{p.x + 0.0, p.y + 0.0, p.z + 0.0}; };
        std::array<std::array<double, 3>, 2> edge{key(a), key(b)};
        if (edge[1] < edge[0]) std::swap(edge[0], edge[1]);
        edges_.push_back({edge, source});
    }
    [[nodiscard]] std::vector<std::uint32_t> surfaces() {
        std::sort(edges_.begin(), edges_.end());
        for (std::size_t k = 1; k < edges_.size(); ++k) {
            if (edges_[k].first != edges_[k - 1].first) continue;
            surfaces_.unite(edges_[k].second, edges_[k - 1].second);
        }
        std::vector<std::uint32_t> result(count_);
        for (std::uint32_t k = 0; k < result.size(); ++k) result[k] = surfaces_.find(k);
        return result;
    }

  private:
    std::vector<std::pair<std::array<std::array<double, 3>, 2>, std::uint32_t>> edges_;
    DisjointSets surfaces_;
    std::size_t count_;
};

class ConeGatherer {
  public:
    ConeGatherer(const SceneDescription& description, const Scene& scene)
        : d_(description), scene_(scene) {}

    ConeScene gather() {
        visit_parts(
            d_, kAllRays, [&](const WorldPart& placed) { add_part(placed); },
            [&](const ObjectDescription& solid) { unsupported_.add(solid); });
        unsupported_.throw_if_any(
            "cones support only spheres, planes, polygons, boxes, polyhedra, rectangles and "
            "triangle meshes");
        join_surfaces();
        build_tree();
        return std::move(result_);
    }

  private:
    struct MeshFacts {
        bool closed = false, inward = false;
    };

    void add_part(const WorldPart& placed) {
        const Part& part = placed.part;
        ConeSource source;
        source.placement = {placed.world_from_part, inverse(placed.world_from_part)};
        source.placed = placed.world_from_part != Affine{};
        source.material = part.material;
        source.part = placed.number;
        source.instance = placed.instance;
        source.visible_to = placed.visible_to;
        if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
            set_passage(material_of(part.material), source);
            auto prepared = std::make_shared<AnyShape>(*shape);
            add_shape(std::move(prepared), part, std::move(source));
        } else {
            add_mesh(d_.meshes[static_cast<std::size_t>(std::get<MeshIndex>(part.what))].mesh.get(),
                     std::move(source));
        }
    }

    [[nodiscard]] const Material& material_of(MaterialId id) const {
        return scene_.materials[static_cast<std::size_t>(id)];
    }

    static void set_passage(const Material& material, ConeSource& source) {
        source.may_pass = source.may_pass || material.may_be_passed();
        source.has_alpha = source.has_alpha || material.alpha_mode != AlphaMode::Opaque;
        source.varies = source.varies || reads_textures(material);
    }

    void add_mesh(const TriangleMesh* mesh, ConeSource source) {
        if (mesh->triangles.empty()) return;
        source.kind = ConeSource::Kind::Mesh;
        // A non-owning pointer: the description outlives the picture.
        source.mesh.mesh = std::shared_ptr<const TriangleMesh>(std::shared_ptr<void>(), mesh);
        source.mesh.material = source.material;
        const std::vector<std::uint32_t>& own = mesh->vertex_materials;
        if (own.empty()) set_passage(material_of(source.material), source);
        for (const std::uint32_t id : own) set_passage(material_of(MaterialId{id}), source);
        source.varies = source.varies || !own.empty() || !mesh->colors.empty();
        const MeshFacts& facts = facts_of(*mesh);
        source.closed = facts.closed;
        source.inward =
            facts.inward != (determinant(source.placement.outer_from_inner.linear) < 0.0);
        source.tree = result_.mesh_trees.at(mesh).get();
        if (const auto at = result_.turned.find(mesh); at != result_.turned.end()) {
            source.turned = &at->second;
        }
        result_.items.push_back({static_cast<std::uint32_t>(result_.sources.size())});
        result_.sources.push_back(std::move(source));
    }

    const MeshFacts& facts_of(const TriangleMesh& mesh) {
        const auto [at, is_new] = facts_.try_emplace(&mesh);
        if (!is_new) return at->second;
        MeshFacts& facts = at->second;
        facts.closed = mesh.closed();
        std::vector<Box3> boxes(mesh.triangles.size());
        for (std::size_t k = 0; k < boxes.size(); ++k) boxes[k] = mesh.triangle_box(k);
        result_.mesh_trees[&mesh] = std::make_unique<ConeTree>(boxes);
        if (facts.closed) orient(mesh, facts);
        return facts;
    }
    /// Finds which sides of a closed mesh face outward: of several shells for each.
    void orient(const TriangleMesh& mesh, MeshFacts& facts) {
        const MeshShells shells = mesh_shells(mesh);
        if (shells.count == 1) {
            facts.inward = signed_volume(mesh) < 0.0;
            return;
        }
        struct Largest {
            double area = 0;  ///< along x, where the shell is looked at
            std::uint32_t triangle = 0;
        };
        std::vector<Largest> largest(shells.count);
        for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
            const auto& t = mesh.triangles[k];
            const Vec3& a = mesh.positions[t[0]];
            const Vec3 normal = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
            Largest& found = largest[shells.of_triangle[k]];
            if (std::abs(normal.x) > found.area) found = {std::abs(normal.x), k};
        }
        std::vector<bool> inward;
        for (const Largest& found : largest) {
            inward.push_back(found.area > 0.0 &&
                             faces_inward(*result_.mesh_trees.at(&mesh), mesh, found.triangle));
        }
        if (std::find(inward.begin(), inward.end(), true) == inward.end()) return;
        std::vector<bool>& turned = result_.turned[&mesh];
        for (const std::uint32_t shell : shells.of_triangle) turned.push_back(inward[shell]);
    }

    void add_shape(std::shared_ptr<AnyShape> shape, const Part& part, ConeSource source) {
        std::visit([](auto& s) { s.prepare(); }, *shape);
        source.shape = shape;
        source.inward = determinant(source.placement.outer_from_inner.linear) < 0.0;
        const std::string name = std::visit(
            [&]<class S>(const S& s) -> std::string {
                if constexpr (requires { add_kind(s, source); }) {
                    if (add_kind(s, source)) return "";
                }
                if constexpr (std::is_same_v<S, Sphere>) return "stretched sphere";
                return S::kName;
            },
            *shape);
        if (!name.empty()) unsupported_.add(name, part.name, part.location);
    }

    bool add_kind(const Sphere& s, ConeSource& source) {
        const Affine& world = source.placement.outer_from_inner;
        const double scale = similarity_of(world.linear);
        if (!(scale > 0.0)) return false;
        source.kind = ConeSource::Kind::Sphere;
        source.closed = true;
        source.point = world.point(s.center);
        source.radius = scale * s.radius;
        result_.items.push_back({static_cast<std::uint32_t>(result_.sources.size())});
        result_.sources.push_back(source);
        return true;
    }
    bool add_kind(const Plane& s, ConeSource& source) {
        add_plane(s.point, s.unit_normal, source);
        return true;
    }
    bool add_kind(const HalfSpace& s, ConeSource& source) {
        source.closed = true;
        add_plane(s.face.point, s.face.unit_normal, source);
        return true;
    }
    void add_plane(const Vec3& point, const Vec3& normal, ConeSource& source) {
        source.kind = ConeSource::Kind::Plane;
        source.point = source.placement.outer_from_inner.point(point);
        source.normal =
            unit_or(transpose_times(source.placement.inner_from_outer.linear, normal), {0, 0, 1});
        result_.planes.push_back(static_cast<std::uint32_t>(result_.sources.size()));
        result_.sources.push_back(source);
    }
    bool add_kind(const Polygon& s, ConeSource& source) {
        begin_faces(source);
        const std::vector<Vec3> corners = flat_vertices(s);
        const RepairedPolygon repaired =
            repaired_polygon(corners, s.loop_ends, {s.normal, dot(s.normal, s.point)});
        if (!repaired.crosses) {
            add_face(0, corners, s.loop_ends);
            return true;
        }
        // Inside is odd-even: signed areas of a loop that meets itself may say otherwise.
        for (const std::vector<Vec3>& part : repaired.parts) add_face(0, part, {});
        return true;
    }
    bool add_kind(const Rectangle& s, ConeSource& source) {
        begin_faces(source);
        const std::array<Vec3, 4> loop{s.corner, s.corner + s.edge_u,
                                       s.corner + s.edge_u + s.edge_v, s.corner + s.edge_v};
        add_face(0, loop, {});
        return true;
    }
    bool add_kind(const BoxShape& s, ConeSource& source) {
        add_solid(face_loops(s), source);
        return true;
    }
    bool add_kind(const Polyhedron& s, ConeSource& source) {
        const auto loops = face_loops(s);
        if (loops) add_solid(*loops, source);
        return loops.has_value();
    }

    void add_solid(const std::vector<FaceLoop>& loops, ConeSource& source) {
        source.closed = true;
        begin_faces(source);
        for (const FaceLoop& loop : loops) add_face(loop.face, loop.corners, {});
    }
    void begin_faces(ConeSource& source) {
        source.kind = ConeSource::Kind::Faces;
        result_.sources.push_back(source);
    }
    void add_face(std::uint32_t part, std::span<const Vec3> vertices,
                  const std::vector<std::uint32_t>& loop_ends) {
        const ConeSource& source = result_.sources.back();
        ConeFace face;
        face.source = static_cast<std::uint32_t>(result_.sources.size() - 1);
        face.part = part;
        for (const Vec3& p : vertices) {
            face.vertices.push_back(source.placement.outer_from_inner.point(p));
        }
        face.loop_ends = loop_ends;
        orient(face);
        if (!(length_squared(face.normal) > 0.0)) return;
        result_.items.push_back({face.source, static_cast<std::uint32_t>(result_.faces.size())});
        result_.faces.push_back(std::move(face));
    }
    /// Orients loops so that their signed areas sum to the odd-even rule, and sets the plane.
    static void orient(ConeFace& face) {
        std::vector<std::span<Vec3>> loops;
        std::size_t first = 0;
        for (const std::size_t end : face.loop_ends) {
            loops.push_back(std::span(face.vertices).subspan(first, end - first));
            first = end;
        }
        if (loops.empty()) loops.emplace_back(face.vertices);
        const Vec3 outer = loop_normal(face.vertices.empty() ? std::span<Vec3>{} : loops[0]);
        for (std::size_t k = 0; k < loops.size(); ++k) {
            int depth = 0;
            for (std::size_t j = 0; j < loops.size(); ++j) {
                depth += j != k && is_in_loop(loops[k][0], loops[j], outer);
            }
            const bool along = dot(loop_normal(loops[k]), outer) >= 0.0;
            if (along != (depth % 2 == 0)) std::reverse(loops[k].begin(), loops[k].end());
        }
        face.normal = unit_or(outer, {0, 0, 0});
        for (const Vec3& p : loops[0]) face.point += p / static_cast<double>(loops[0].size());
    }

    void join_surfaces() {
        SharedEdges shared(result_.sources.size());
        for (const ConeFace& face : result_.faces) {
            std::size_t first = 0, end = 0;
            for (std::size_t k = 0; k < std::max<std::size_t>(face.loop_ends.size(), 1); ++k) {
                first = end;
                end = face.loop_ends.empty() ? face.vertices.size() : face.loop_ends[k];
                for (std::size_t i = first; i < end; ++i) {
                    shared.add(face.vertices[i], face.vertices[i + 1 == end ? first : i + 1],
                               face.source);
                }
            }
        }
        for (std::uint32_t k = 0; k < result_.sources.size(); ++k) {
            if (result_.sources[k].kind == ConeSource::Kind::Mesh && !result_.sources[k].closed) {
                add_borders(result_.sources[k], k, shared);
            }
        }
        const std::vector<std::uint32_t> surfaces = shared.surfaces();
        for (std::size_t k = 0; k < surfaces.size(); ++k) result_.sources[k].surface = surfaces[k];
    }
    /// Adds the edges of a mesh that belong to a single triangle.
    static void add_borders(const ConeSource& source, std::uint32_t number, SharedEdges& shared) {
        const TriangleMesh& mesh = *source.mesh.mesh;
        std::vector<std::array<std::uint32_t, 2>> edges;
        for (const auto& t : mesh.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k], b = t[(k + 1) % 3];
                edges.push_back({std::min(a, b), std::max(a, b)});
            }
        }
        std::sort(edges.begin(), edges.end());
        for (std::size_t k = 0; k < edges.size();) {
            std::size_t end = k + 1;
            while (end < edges.size() && edges[end] == edges[k]) ++end;
            if (end == k + 1) {
                const Affine& world = source.placement.outer_from_inner;
                shared.add(world.point(mesh.positions[edges[k][0]]),
                           world.point(mesh.positions[edges[k][1]]), number);
            }
            k = end;
        }
    }

    void build_tree() {
        std::vector<Box3> boxes, solid_boxes;
        for (const ConeItem& item : result_.items) {
            ConeSource& source = result_.sources[item.source];
            Box3 box;
            if (item.face != ConeItem::kNoFace) {
                for (const Vec3& p : result_.faces[item.face].vertices) box.include(p);
            } else if (source.kind == ConeSource::Kind::Sphere) {
                const Vec3 r{source.radius, source.radius, source.radius};
                box = {source.point - r, source.point + r};
            } else {
                for (const Vec3& p : source.mesh.mesh->positions) {
                    box.include(source.placement.outer_from_inner.point(p));
                }
            }
            boxes.push_back(box);
            if (!source.closed) continue;
            // The faces of a solid follow each other.
            const bool begins = item.face == ConeItem::kNoFace || result_.solids.empty() ||
                                result_.solids.back().source != item.source;
            if (begins) {
                source.solid = static_cast<std::uint32_t>(result_.solids.size());
                result_.solids.push_back({item.source, item.face, item.face, 0});
                solid_boxes.push_back(box);
            }
            solid_boxes.back().include(box);
            if (item.face != ConeItem::kNoFace) ++result_.solids.back().end_face;
        }
        for (std::size_t k = 0; k < solid_boxes.size(); ++k) {
            result_.solids[k].size = length(solid_boxes[k].hi - solid_boxes[k].lo);
        }
        result_.tree = ConeTree(boxes);
        result_.solid_tree = ConeTree(solid_boxes);
        const bool any_half_space =
            std::any_of(result_.planes.begin(), result_.planes.end(),
                        [&](std::uint32_t source) { return result_.sources[source].closed; });
        if (!any_half_space) find_solids_apart(solid_boxes);
    }

    /// `boxes`: of the solids.
    void find_solids_apart(std::span<const Box3> boxes) {
        std::vector<Box3> wide;
        for (std::size_t k = 0; k < boxes.size(); ++k) {
            // Far more than the rounding of the boxes and of tests for points inside.
            double coordinates =
                std::max(max_component(abs(boxes[k].lo)), max_component(abs(boxes[k].hi)));
            const ConeSource& source = result_.sources[result_.solids[k].source];
            if (source.placed && source.kind == ConeSource::Kind::Mesh) {
                for (const Vec3& p : source.mesh.mesh->positions) {
                    coordinates = std::max(coordinates, max_component(abs(p)));
                }
            }
            const double slack = kSlack * coordinates;
            const Vec3 margin{slack, slack, slack};
            wide.push_back({boxes[k].lo - margin, boxes[k].hi + margin});
            result_.solids[k].apart = 0.5 * slack;
        }
        const ConeTree tree(wide);
        for (std::uint32_t k = 0; k < wide.size(); ++k) {
            if (meets_another(tree, wide, k)) result_.solids[k].apart = 0;
        }
    }
    [[nodiscard]] static bool meets_another(const ConeTree& tree, std::span<const Box3> boxes,
                                            std::uint32_t own) {
        std::vector<std::uint32_t> waiting{0};
        for (std::size_t visits = 0; !waiting.empty(); ++visits) {
            if (visits == kMostVisits) return true;
            const ConeTree::Node& node = tree.node(waiting.back());
            waiting.pop_back();
            // Rounded: its items are inside but for the slack.
            const Box3 around{node.center - node.half, node.center + node.half};
            if (intersection(around, boxes[own]).empty()) continue;
            if (node.count == 0) waiting.insert(waiting.end(), {node.first, node.first + 1});
            for (std::uint32_t k = 0; k < node.count; ++k) {
                const std::uint32_t item = tree.item(node.first + k);
                if (item != own && !intersection(boxes[item], boxes[own]).empty()) return true;
            }
        }
        return false;
    }

    const SceneDescription& d_;
    const Scene& scene_;
    std::map<const TriangleMesh*, MeshFacts> facts_;
    ConeScene result_;
    UnsupportedParts unsupported_;
};

}  // namespace

ConeScene cone_scene(const SceneDescription& description, const Scene& scene) {
    return ConeGatherer(description, scene).gather();
}

}  // namespace alhazen
