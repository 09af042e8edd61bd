// Whole-mesh questions: does it close, how large is it, what does it hold.

#include <algorithm>
#include <bit>

#include "alhazen/shapes/triangle_mesh.h"

namespace alhazen {

namespace {

/// A position as bits, 0 and -0 made one: ordered whatever it holds, NaN included.
struct PositionKey {
    std::array<std::uint64_t, 3> bits;
    std::uint32_t vertex;
};

/// For each vertex the lowest vertex of equal position. By sorting: no input makes it slow.
std::vector<std::uint32_t> merged_vertices(const std::vector<Vec3>& positions) {
    std::vector<PositionKey> keys(positions.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const Vec3 p = positions[i] + Vec3{};
        keys[i] = {{std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y),
                    std::bit_cast<std::uint64_t>(p.z)},
                   static_cast<std::uint32_t>(i)};
    }
    std::sort(keys.begin(), keys.end(), [](const PositionKey& a, const PositionKey& b) {
        return a.bits != b.bits ? a.bits < b.bits : a.vertex < b.vertex;
    });
    std::vector<std::uint32_t> merged(positions.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const bool same = i > 0 && keys[i].bits == keys[i - 1].bits;
        merged[keys[i].vertex] = same ? merged[keys[i - 1].vertex] : keys[i].vertex;
    }
    return merged;
}

/// A sum with the roundings carried along (Neumaier).
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
    const std::vector<std::uint32_t> merged = merged_vertices(positions);
    std::vector<std::uint64_t> edges;
    edges.reserve(3 * triangles.size());
    for (const auto& triangle : triangles) {
        const std::uint32_t v[3] = {merged[triangle[0]], merged[triangle[1]], merged[triangle[2]]};
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;  // a segment: never hit
        for (int k = 0; k < 3; ++k) {
            const auto [lo, hi] = std::minmax(v[k], v[k == 2 ? 0 : k + 1]);
            edges.push_back(std::uint64_t{lo} << 32 | hi);
        }
    }
    if (edges.empty() || edges.size() % 2 != 0) return false;
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size(); i += 2) {
        if (edges[i] != edges[i + 1]) return false;
        if (i + 2 < edges.size() && edges[i + 2] == edges[i]) return false;
    }
    return true;
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
    // Tetrahedra from a point of the mesh: from a far one, large volumes would cancel.
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
