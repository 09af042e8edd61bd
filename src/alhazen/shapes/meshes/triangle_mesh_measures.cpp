// Measures of whole meshes: closedness, area, volume.

#include "alhazen/shapes/meshes/mesh_edges.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

namespace {

/// A compensated sum (Neumaier).
class CompensatedSum {
  public:
    void add(double x) {
        const double total = sum_ + x;
        lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - total) + x : (x - total) + sum_;
        sum_ = total;
    }
    [[nodiscard]] double value() const { return sum_ + lost_; }

  private:
    double sum_ = 0, lost_ = 0;
};

}  // namespace

bool TriangleMesh::closed() const {
    return mesh_edges(*this).closed();
}

double area(const TriangleMesh& mesh) {
    CompensatedSum twice;
    for (const auto& triangle : mesh.triangles) {
        const Vec3& p0 = mesh.positions[triangle[0]];
        twice.add(
            length(cross(mesh.positions[triangle[1]] - p0, mesh.positions[triangle[2]] - p0)));
    }
    return 0.5 * twice.value();
}

double signed_volume(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) return 0.0;
    // Tetrahedra from a point of the mesh: from a distant point large volumes would cancel.
    const Vec3 origin = mesh.positions[mesh.triangles.front()[0]];
    CompensatedSum six_times;
    for (const auto& triangle : mesh.triangles) {
        const Vec3 a = mesh.positions[triangle[0]] - origin;
        const Vec3 b = mesh.positions[triangle[1]] - origin;
        const Vec3 c = mesh.positions[triangle[2]] - origin;
        six_times.add(dot(a, cross(b, c)));
    }
    return six_times.value() / 6.0;
}

}  // namespace alhazen
