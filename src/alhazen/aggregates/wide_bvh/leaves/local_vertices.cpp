#include "alhazen/aggregates/wide_bvh/leaves/local_vertices.h"

#include "alhazen/aggregates/wide_bvh/leaves/lane_triangles.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {
namespace {

constexpr std::size_t kVerticesAtOnce = 8192;

}  // namespace

bool LocalVertices::can_number(const PrimitiveTable& table) {
    std::uint64_t count = 0;
    for (const PlacedMesh& placed : table.meshes) count += placed.mesh->positions.size();
    return count < std::uint64_t{1} << 32;
}

LocalVertices::LocalVertices(const PrimitiveTable& table, const LocalFrame& frame) {
    std::uint32_t count = 0;
    for (const PlacedMesh& placed : table.meshes) {
        firsts_.push_back(count);
        count += static_cast<std::uint32_t>(placed.mesh->positions.size());
    }
    all_ = make_huge_array<Float4>(count);
    const LaneKernels& kernels = lane_kernels();
    for (std::size_t i = 0; i < table.meshes.size(); ++i) {
        const std::vector<Vec3>& positions = table.meshes[i].mesh->positions;
        parallel_for(positions.size(), kVerticesAtOnce, [&](std::size_t begin, std::size_t end) {
            const Vec3* const from = positions.data();
            Float4* const to = all_.get() + firsts_[i];
            kernels.round(frame, from + begin, end - begin, to + begin);
        });
    }
    // As TriangleBounds::pad and its rounding, for the largest coordinate; and a step of the least
    // floats.
    pad_ = static_cast<float>(9.5e-16 * (1.0 + frame.offset) + 1e-37);
}

}  // namespace alhazen
