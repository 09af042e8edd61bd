#include "alhazen/session/scene_info/mesh_figures.h"

#include <cmath>

namespace alhazen {

namespace {

/// Limit of steps: a triangle is one step, a part several.
constexpr std::uint64_t kMaxSteps = 100'000'000;
constexpr std::uint64_t kStepsOfPart = 20;

/// The scale factor of a uniformly scaling transform.
std::optional<double> even_scale(const Mat3& m) {
    const double x = length(m.x_axis), y = length(m.y_axis), z = length(m.z_axis);
    const double tolerance = 1e-12 * x;
    if (!(std::abs(y - x) <= tolerance) || !(std::abs(z - x) <= tolerance) ||
        !(std::abs(dot(m.x_axis, m.y_axis)) <= tolerance * x) ||
        !(std::abs(dot(m.y_axis, m.z_axis)) <= tolerance * x) ||
        !(std::abs(dot(m.z_axis, m.x_axis)) <= tolerance * x)) {
        return std::nullopt;
    }
    return x;
}

double area_under(const TriangleMesh& mesh, const Mat3& m) {
    double twice = 0;
    for (const auto& triangle : mesh.triangles) {
        const Vec3& p = mesh.positions[triangle[0]];
        twice += length(
            cross(m * (mesh.positions[triangle[1]] - p), m * (mesh.positions[triangle[2]] - p)));
    }
    return 0.5 * twice;
}

/// Uniformly scaled objects are summed once and scaled; others part by part, because their area
/// depends on the orientation of each triangle.
class Summer {
  public:
    Summer(const SceneDescription& description, const std::vector<MeshFigures>& meshes)
        : d_(description), meshes_(meshes), objects_(description.objects.size()) {}

    /// Validation bounds the nesting: recursion is safe here.
    std::optional<PlacedFigures> object(std::size_t index) {
        if (!objects_[index]) {
            const auto sum = parts(index, Mat3{});
            if (!sum) return std::nullopt;
            objects_[index] = sum;
        }
        return objects_[index];
    }

  private:
    std::optional<PlacedFigures> parts(std::size_t index, const Mat3& outer) {
        PlacedFigures sum;
        for (const Part& part : d_.objects[index].parts) {
            steps_ += kStepsOfPart;
            if (steps_ > kMaxSteps) return std::nullopt;
            if (std::holds_alternative<AnyShape>(part.what)) continue;
            const auto figures = placed(part, outer * part.object_from_part.linear);
            if (!figures) return std::nullopt;
            sum.area += figures->area;
            sum.volume += figures->volume;
        }
        return sum;
    }

    std::optional<PlacedFigures> placed(const Part& part, const Mat3& outer) {
        const std::optional<double> scale = even_scale(outer);
        const double enlarged = std::abs(determinant(outer));
        if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
            const std::size_t i = static_cast<std::size_t>(*mesh);
            const MeshFigures& own = meshes_[i];
            if (scale) return PlacedFigures{*scale * *scale * own.area, enlarged * own.volume};
            steps_ += own.triangles;
            if (steps_ > kMaxSteps) return std::nullopt;
            return PlacedFigures{area_under(*d_.meshes[i].mesh, outer), enlarged * own.volume};
        }
        const std::size_t child = static_cast<std::size_t>(std::get<ObjectIndex>(part.what));
        if (!scale) return parts(child, outer);
        const auto own = object(child);
        if (!own) return std::nullopt;
        return PlacedFigures{*scale * *scale * own->area, enlarged * own->volume};
    }

    const SceneDescription& d_;
    const std::vector<MeshFigures>& meshes_;
    std::vector<std::optional<PlacedFigures>> objects_;
    std::uint64_t steps_ = 0;
};

}  // namespace

MeshFigures figures_of(const TriangleMesh& mesh, bool look_if_closed) {
    MeshFigures figures;
    figures.triangles = mesh.triangles.size();
    figures.vertices = mesh.positions.size();
    std::vector<bool> used(mesh.positions.size());
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) used[corner] = true;
    }
    for (const bool u : used) figures.unused_vertices += u ? 0 : 1;
    figures.area = area(mesh);
    figures.volume = signed_volume(mesh);
    if (look_if_closed) figures.edges = mesh_edges(mesh);
    return figures;
}

std::optional<PlacedFigures> placed_figures(const SceneDescription& description,
                                            const std::vector<MeshFigures>& meshes) {
    return Summer(description, meshes).object(static_cast<std::size_t>(description.root));
}

}  // namespace alhazen
