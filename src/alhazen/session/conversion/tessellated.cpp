#include "alhazen/session/conversion/tessellated.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/materials/texture_inputs.h"
#include "alhazen/shapes/shape_tessellation.h"
#include "alhazen/solids/triangles/solid_triangles.h"

namespace alhazen {

namespace {

/// Largest factor by which a transform stretches a vector: the square root of the largest
/// eigenvalue of its matrix times its transpose, by Jacobi's rotations.
double exact_stretch(const Affine& placement) {
    const Vec3 columns[3] = {placement.vector({1, 0, 0}), placement.vector({0, 1, 0}),
                             placement.vector({0, 0, 1})};
    double m[3][3];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) m[i][j] = dot(columns[i], columns[j]);
    }
    constexpr int kSweeps = 30;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                const double angle = 0.5 * std::atan2(2.0 * m[p][q], m[q][q] - m[p][p]);
                const double c = std::cos(angle), s = std::sin(angle);
                for (auto& row : m) {
                    const double x = row[p], y = row[q];
                    row[p] = c * x - s * y;
                    row[q] = s * x + c * y;
                }
                for (int k = 0; k < 3; ++k) {
                    const double x = m[p][k], y = m[q][k];
                    m[p][k] = c * x - s * y;
                    m[q][k] = s * x + c * y;
                }
            }
        }
    }
    // Rounding must not make the result too small.
    return std::sqrt(std::max({m[0][0], m[1][1], m[2][2]})) * (1.0 + 1e-12);
}

/// The largest stretch of all placements of each object; 0 for objects that are not placed.
class ObjectStretches {
  public:
    explicit ObjectStretches(const SceneDescription& scene)
        : scene_(scene), stretches_(scene.objects.size()), waiting_(scene.objects.size()) {
        count_users(static_cast<std::size_t>(scene.root));
        stretches_[static_cast<std::size_t>(scene.root)] = 1.0;
        std::vector<std::size_t> ready{static_cast<std::size_t>(scene.root)};
        while (!ready.empty()) {
            const std::size_t object = ready.back();
            ready.pop_back();
            for (const Part& part : scene.objects[object].parts) {
                const auto* child = std::get_if<ObjectIndex>(&part.what);
                if (child == nullptr) continue;
                const auto c = static_cast<std::size_t>(*child);
                stretches_[c] = std::max(stretches_[c],
                                         stretches_[object] * exact_stretch(part.object_from_part));
                if (--waiting_[c] == 0) ready.push_back(c);
            }
        }
    }
    [[nodiscard]] double operator[](std::size_t object) const { return stretches_[object]; }

  private:
    /// Counts the placements of each object in placed objects.
    void count_users(std::size_t root) {
        std::vector<std::size_t> open{root};
        std::vector<bool> seen(scene_.objects.size());
        seen[root] = true;
        while (!open.empty()) {
            const std::size_t object = open.back();
            open.pop_back();
            for (const Part& part : scene_.objects[object].parts) {
                const auto* child = std::get_if<ObjectIndex>(&part.what);
                if (child == nullptr) continue;
                const auto c = static_cast<std::size_t>(*child);
                ++waiting_[c];
                if (!seen[c]) open.push_back(c);
                seen[c] = true;
            }
        }
    }

    const SceneDescription& scene_;
    std::vector<double> stretches_;
    std::vector<std::uint64_t> waiting_;
};

/// A scene of one shape.
SceneDescription shape_alone(const AnyShape& shape) {
    SceneDescription alone;
    alone.materials.emplace_back();
    alone.objects.emplace_back();
    alone.objects[0].parts.push_back({.what = shape});
    alone.root = ObjectIndex{0};
    return alone;
}

/// A scene of one object and its contents.
SceneDescription object_alone(const SceneDescription& scene, std::size_t index) {
    SceneDescription alone;
    alone.materials = scene.materials;
    alone.textures = scene.textures;
    alone.meshes = scene.meshes;
    alone.objects.emplace_back();
    alone.root = ObjectIndex{0};
    std::map<std::size_t, std::size_t> number;
    std::vector<std::size_t> taken;
    const auto number_of = [&](std::size_t object) {
        const auto [found, is_new] = number.try_emplace(object, taken.size() + 1);
        if (is_new) taken.push_back(object);
        return static_cast<ObjectIndex>(found->second);
    };
    alone.objects[0].parts.push_back({.what = number_of(index)});
    for (std::size_t k = 0; k < taken.size(); ++k) {
        ObjectDescription object = scene.objects[taken[k]];
        for (Part& part : object.parts) {
            if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
                part.what = number_of(static_cast<std::size_t>(*child));
            }
        }
        alone.objects.push_back(std::move(object));
    }
    return alone;
}

/// True if a texture on a part is looked up by texture coordinates.
bool any_part_reads_coordinates(const SceneDescription& scene) {
    const auto reads = [&](std::size_t material) {
        return reads_coordinates(scene.materials[material].material);
    };
    for (const ObjectDescription& object : scene.objects) {
        for (const Part& part : object.parts) {
            if (std::holds_alternative<ObjectIndex>(part.what)) continue;
            if (reads(static_cast<std::size_t>(part.material))) return true;
            const auto* index = std::get_if<MeshIndex>(&part.what);
            if (index == nullptr) continue;
            const TriangleMesh& mesh = *scene.meshes[static_cast<std::size_t>(*index)].mesh;
            for (const std::uint32_t id : mesh.vertex_materials) {
                if (reads(id)) return true;
            }
        }
    }
    return false;
}

/// What triangles of a solid do not have of its meshes; empty if that is nothing.
std::string lost_of_meshes(const SceneDescription& solid) {
    bool coordinates = false, colors = false;
    for (const ObjectDescription& object : solid.objects) {
        for (const Part& part : object.parts) {
            const auto* index = std::get_if<MeshIndex>(&part.what);
            if (index == nullptr) continue;
            const TriangleMesh& mesh = *solid.meshes[static_cast<std::size_t>(*index)].mesh;
            coordinates = coordinates || !mesh.uvs2.empty();
            colors = colors || !mesh.colors.empty();
        }
    }
    constexpr const char* kSecond = "the second texture coordinates";
    if (coordinates && colors) return fmt::format("{} and the colours of its meshes", kSecond);
    if (coordinates) return fmt::format("{} of its meshes", kSecond);
    return colors ? "the vertex colours of its meshes" : "";
}

class Tessellation {
  public:
    Tessellation(SceneDescription& scene, double tolerance, bool keep_others,
                 std::uint64_t max_triangles)
        : scene_(scene),
          tolerance_(tolerance),
          keep_others_(keep_others),
          max_triangles_(max_triangles) {}

    TessellationReport run() {
        const ObjectStretches stretches(scene_);
        std::vector<std::size_t> groups, solids;
        find_pictured(groups, solids);
        // All solids before any is replaced: a solid may also be an operand of another.
        std::vector<std::pair<std::size_t, ObjectDescription>> replaced;
        for (const std::size_t k : solids) {
            if (auto object = tessellated_solid(k, stretches[k])) {
                replaced.emplace_back(k, *std::move(object));
            }
        }
        for (auto& [k, object] : replaced) scene_.objects[k] = std::move(object);
        for (const std::size_t k : groups) {
            for (Part& part : scene_.objects[k].parts) replace(part, stretches[k]);
        }
        if (!refused_.empty() && !keep_others_) {
            throw Error(ErrorKind::Scene, "not all shapes have triangles:\n" + refused_);
        }
        return report_;
    }

  private:
    /// Finds the groups placed other than as operands of solids, and the solids in them.
    void find_pictured(std::vector<std::size_t>& groups, std::vector<std::size_t>& solids) const {
        std::vector<bool> seen(scene_.objects.size());
        std::vector<std::size_t> open{static_cast<std::size_t>(scene_.root)};
        seen[open[0]] = true;
        while (!open.empty()) {
            const std::size_t k = open.back();
            open.pop_back();
            if (scene_.objects[k].combine != Combine::Group) {
                solids.push_back(k);
                continue;
            }
            groups.push_back(k);
            for (const Part& part : scene_.objects[k].parts) {
                const auto* child = std::get_if<ObjectIndex>(&part.what);
                if (child == nullptr || seen[static_cast<std::size_t>(*child)]) continue;
                seen[static_cast<std::size_t>(*child)] = true;
                open.push_back(static_cast<std::size_t>(*child));
            }
        }
        std::sort(groups.begin(), groups.end());
        std::sort(solids.begin(), solids.end());
    }

    /// Tessellates a closed shape or a solid by its crossings with lines. Returns why that failed;
    /// empty on success.
    std::string append_by_lines(const SceneDescription& alone, double tolerance, bool with_uvs,
                                TriangleMesh& mesh) {
        lost_parts_ = 0;
        larger_tolerance_ = 0;
        const SolidList solids(compile(alone, {.own_accelerators = false}).aggregate);
        if (solids.count() != 1) return "bounds no volume";
        const IsolatedSolid solid(solids, SolidId{0});
        if (!solid.box().empty() && !solid.box().bounded()) {
            return "has no bounded box; if it is bounded, intersect it with a box";
        }
        const std::uint64_t most = max_triangles_ - report_.triangles;
        SolidTrianglesReport report;
        const bool made = make_solid_triangles(solid, tolerance, most, mesh, with_uvs, &report);
        lost_parts_ = report.lost_parts;
        larger_tolerance_ = report.larger_tolerance * (tolerance_ / tolerance);
        return made ? "" : kTooManyTriangles;
    }

    /// The solid as a group of its mesh; none if it is refused.
    std::optional<ObjectDescription> tessellated_solid(std::size_t index, double stretch) {
        const ObjectDescription& object = scene_.objects[index];
        auto mesh = std::make_shared<TriangleMesh>();
        const SceneDescription alone = object_alone(scene_, index);
        const std::string failed =
            append_by_lines(alone, tolerance_ / stretch, any_part_reads_coordinates(alone), *mesh);
        if (!accept(failed, object.location, object.name, "the solid ", *mesh)) return {};
        const std::string lost = lost_of_meshes(alone);
        if (!lost.empty()) {
            report_.lost.push_back(fmt::format("{}: the solid {}: its triangles do not have {}",
                                               to_string(object.location), object.name, lost));
        }
        Part part{.what = MeshIndex{0}, .name = object.name, .location = object.location};
        std::vector<std::uint32_t>& materials = mesh->vertex_materials;
        if (!materials.empty()) part.material = MaterialId{materials[0]};
        if (std::all_of(materials.begin(), materials.end(),
                        [&](std::uint32_t m) { return m == materials[0]; })) {
            materials.clear();
        }
        place(std::move(mesh), part);
        ObjectDescription group = object;
        group.parts = {part};
        group.combine = Combine::Group;
        return group;
    }

    /// True if there is a mesh, which may be empty; otherwise reports why not.
    bool accept(const std::string& failed, const FileLocation& where, const std::string& name,
                const char* what, const TriangleMesh& mesh) {
        if (failed == kTooManyTriangles) {
            throw Error(ErrorKind::Resource,
                        fmt::format("{}: {}: with a tolerance of {:g} the scene has more than {} "
                                    "triangles{}",
                                    to_string(where), name, tolerance_, max_triangles_,
                                    larger_tolerance_ > 0
                                        ? fmt::format("; {:.2g} may do", larger_tolerance_)
                                        : "; a larger one leaves fewer"));
        }
        if (!failed.empty()) {
            refuse(where, name, what + failed);
            return false;
        }
        if (mesh.triangles.empty()) {
            report_.lost.push_back(
                fmt::format("{}: {}: no triangles: {}is empty or thinner than the tolerance",
                            to_string(where), name, what));
            return true;
        }
        if (lost_parts_ > 0) {
            report_.lost.push_back(fmt::format(
                "{}: {}: {} of its parts and gaps {} thinner than the tolerance and left out",
                to_string(where), name, lost_parts_, lost_parts_ == 1 ? "is" : "are"));
        }
        ++report_.shapes;
        report_.triangles += mesh.triangles.size();
        return true;
    }
    void place(std::shared_ptr<TriangleMesh> mesh, Part& part) {
        scene_.meshes.push_back({part.name, std::move(mesh), part.location});
        part.what = static_cast<MeshIndex>(scene_.meshes.size() - 1);
    }

    void replace(Part& part, double stretch) {
        const auto* shape = std::get_if<AnyShape>(&part.what);
        if (shape == nullptr) return;
        AnyShape prepared = *shape;
        const char* kind = std::visit(
            [](auto& s) {
                s.prepare();
                return s.kName;
            },
            prepared);
        lost_parts_ = 0;
        larger_tolerance_ = 0;
        auto mesh = std::make_shared<TriangleMesh>();
        const double tolerance = tolerance_ / (stretch * exact_stretch(part.object_from_part));
        std::string failed =
            append_triangles(prepared, tolerance, max_triangles_ - report_.triangles, *mesh);
        if (failed == kNeedsLines) {
            const Material& material =
                scene_.materials[static_cast<std::size_t>(part.material)].material;
            failed =
                append_by_lines(shape_alone(*shape), tolerance, reads_coordinates(material), *mesh);
            mesh->vertex_materials.clear();
        }
        const std::string name = part.name.empty() ? kind : kind + (" '" + part.name + "'");
        if (accept(failed, part.location, name, "the shape ", *mesh)) place(std::move(mesh), part);
    }

    void refuse(const FileLocation& where, const std::string& what, const std::string& why) {
        if (keep_others_) {
            report_.kept.push_back(
                fmt::format("{}: {}: no triangles: {}", to_string(where), what, why));
            return;
        }
        constexpr int kMostLines = 50;
        if (++refusals_ > kMostLines) return;
        refused_ += fmt::format("{}: error: {}: no triangles: {}\n", to_string(where), what, why);
    }

    SceneDescription& scene_;
    double tolerance_;
    bool keep_others_;
    std::uint64_t max_triangles_;
    TessellationReport report_;
    std::string refused_;
    int refusals_ = 0;
    /// Of the shape that was made last, by lines (solid_triangles.h).
    std::uint64_t lost_parts_ = 0;
    double larger_tolerance_ = 0;
};

}  // namespace

TessellationReport tessellate(SceneDescription& description, double tolerance, bool keep_others,
                              std::uint64_t max_triangles, int threads) {
    if (!(tolerance > 0.0) || !std::isfinite(tolerance)) {
        throw Error(ErrorKind::Usage,
                    fmt::format("the tolerance must be a positive number, not {}", tolerance));
    }
    TessellationReport report;
    ThreadLimit(threads).run(
        [&] { report = Tessellation(description, tolerance, keep_others, max_triangles).run(); });
    return report;
}

}  // namespace alhazen
