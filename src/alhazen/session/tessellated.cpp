#include "alhazen/session/tessellated.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/shapes/shape_tessellation.h"

namespace alhazen {

namespace {

/// Largest factor by which a transform stretches a vector: the square root of the largest
/// eigenvalue of its matrix times its transpose, by Jacobi's rotations.
double largest_stretch(const Affine& placement) {
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
    // Rounding must not make it too small.
    return std::sqrt(std::max({m[0][0], m[1][1], m[2][2]})) * (1.0 + 1e-12);
}

/// The largest stretch of all placements of each object; 0 for one that is not placed.
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
                stretches_[c] = std::max(
                    stretches_[c], stretches_[object] * largest_stretch(part.object_from_part));
                if (--waiting_[c] == 0) ready.push_back(c);
            }
        }
    }
    [[nodiscard]] double operator[](std::size_t object) const { return stretches_[object]; }

  private:
    /// Number of placements of each object in those that are placed.
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

class Tessellation {
  public:
    Tessellation(SceneDescription& scene, double tolerance, std::uint64_t max_triangles)
        : scene_(scene), tolerance_(tolerance), max_triangles_(max_triangles) {}

    TessellationReport run() {
        const ObjectStretches stretches(scene_);
        for (std::size_t k = 0; k < scene_.objects.size(); ++k) {
            if (stretches[k] == 0.0) continue;
            ObjectDescription& object = scene_.objects[k];
            if (object.combine != Combine::Group) {
                refuse(object.location, object.name, "a solid made of others has none");
                continue;
            }
            for (Part& part : object.parts) replace(part, stretches[k]);
        }
        if (!refused_.empty()) {
            throw Error(ErrorKind::Scene, "not all shapes have triangles:\n" + refused_);
        }
        return report_;
    }

  private:
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
        auto mesh = std::make_shared<TriangleMesh>();
        const double tolerance = tolerance_ / (stretch * largest_stretch(part.object_from_part));
        const std::string failed =
            append_triangles(prepared, tolerance, max_triangles_ - report_.triangles, *mesh);
        if (failed == kTooManyTriangles) {
            throw Error(ErrorKind::Resource,
                        fmt::format("{}: with this tolerance the scene has more than {} triangles",
                                    to_string(part.location), max_triangles_));
        }
        if (!failed.empty()) {
            refuse(part.location, part.name.empty() ? kind : kind + (" '" + part.name + "'"),
                   "the shape " + failed);
            return;
        }
        ++report_.shapes;
        report_.triangles += mesh->triangles.size();
        scene_.meshes.push_back({part.name, std::move(mesh), part.location});
        part.what = static_cast<MeshIndex>(scene_.meshes.size() - 1);
    }

    void refuse(const FileLocation& where, const std::string& what, const std::string& why) {
        constexpr int kMostLines = 50;
        if (++refusals_ > kMostLines) return;
        refused_ += fmt::format("{}: error: {}: no triangles: {}\n", to_string(where), what, why);
    }

    SceneDescription& scene_;
    double tolerance_;
    std::uint64_t max_triangles_;
    TessellationReport report_;
    std::string refused_;
    int refusals_ = 0;
};

}  // namespace

TessellationReport tessellate(SceneDescription& description, double tolerance,
                              std::uint64_t max_triangles) {
    if (!(tolerance > 0.0) || !std::isfinite(tolerance)) {
        throw Error(ErrorKind::Usage,
                    fmt::format("the tolerance must be a positive number, not {}", tolerance));
    }
    return Tessellation(description, tolerance, max_triangles).run();
}

}  // namespace alhazen
