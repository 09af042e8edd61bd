#include <array>
#include <span>
#include <vector>

#include "alhazen/shapes/blob_lanes.h"
#include "alhazen/shapes/blob_pieces.h"
#include "alhazen/shapes/first_hit.h"
#include "alhazen/shapes/first_hits.h"

namespace alhazen {

namespace {

using namespace blob;

/// What eight rays need; kept from one eight to the next so that nothing is allocated.
struct Workspace {
    std::vector<std::uint32_t> numbers;
    std::vector<BlobRow> rows;
    std::vector<Piece> pieces;
};

/// A component has no more pieces than there are regions.
constexpr std::size_t kRegions = 3;

/// The numbers of the components that the beam may meet.
std::span<const std::uint32_t> near_components(const Blob& blob, const BlobKernels& kernels,
                                               const BlobRayLanes& rays, Workspace& work) {
    if (blob.components.size() <= Blob::kFewComponents) {
        work.numbers.resize(blob.components.size());
        return std::span(work.numbers).first(kernels.near(blob, rays, work.numbers.data()));
    }
    work.numbers.clear();
    blob.tree->for_line(rays.axis_origin, rays.axis_direction, rays.width,
                        [&](std::uint32_t i) { work.numbers.push_back(i); });
    return work.numbers;
}

/// Writes the rows of a rod; how many.
std::size_t rod_rows(const Blob& blob, std::uint32_t number, std::span<const Ray* const> rays,
                     std::vector<Piece>& pieces, BlobRow* rows) {
    const BlobComponent& c = blob.components[number];
    for (std::size_t k = 0; k < kRegions; ++k) {
        BlobRow& row = rows[k];
        std::fill_n(row.in, kRayLanes, kInfinity);
        std::fill_n(row.out, kRayLanes, -kInfinity);
        std::fill_n(row.middle, kRayLanes, 0.0);
        std::fill_n(row.peak, kRayLanes, -1.0);
        std::fill_n(row.bend, kRayLanes, 0.0);
        row.strength = c.strength;
        row.inverse_radius = 1.0 / c.radius;
        row.span = Region(k) == Region::Middle ? length(c.top - c.base) : 0.0;
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const LocalRay local(blob, *rays[i]);
        if (!is_finite(local.o)) continue;
        pieces.clear();
        add_pieces(local, number, pieces);
        for (const Piece& piece : pieces) {
            BlobRow& row = rows[static_cast<std::size_t>(piece.region)];
            row.in[i] = piece.in;
            row.out[i] = piece.out;
            row.middle[i] = piece.bump.middle;
            row.peak[i] = piece.bump.peak;
            row.bend[i] = piece.bump.bend;
        }
    }
    return kRegions;
}

/// The rows of all components near the rays.
std::span<const BlobRow> near_rows(const Blob& blob, std::span<const Ray* const> rays,
                                   const BlobKernels& kernels, const BlobRayLanes& lanes,
                                   Workspace& work) {
    std::span<const std::uint32_t> rest = near_components(blob, kernels, lanes, work);
    if (work.rows.size() < kRegions * rest.size()) work.rows.resize(kRegions * rest.size());
    std::size_t count = 0;
    while (!rest.empty()) {
        const auto is_rod = [&](std::uint32_t i) { return blob.components[i].rod; };
        const auto balls = static_cast<std::size_t>(
            std::find_if(rest.begin(), rest.end(), is_rod) - rest.begin());
        count += kernels.balls(blob, lanes, rest.first(balls), work.rows.data() + count);
        rest = rest.subspan(balls);
        if (rest.empty()) break;
        count += rod_rows(blob, rest.front(), rays, work.pieces, work.rows.data() + count);
        rest = rest.subspan(1);
    }
    return std::span(work.rows).first(count);
}

}  // namespace

std::uint32_t first_hits(const Blob& shape, std::span<const Ray* const> rays, ShapeHit* hits) {
    static thread_local Workspace work;
    const BlobKernels& kernels = blob_kernels();
    RayLanes in;
    BlobRayLanes lanes;
    for (std::size_t i = 0; i < kRayLanes; ++i) in.set(i, *rays[i < rays.size() ? i : 0]);
    const std::uint32_t used = kAllRayLanes >> (kRayLanes - rays.size());
    kernels.begin(shape, in, lanes);
    const std::span<const BlobRow> rows = near_rows(shape, rays, kernels, lanes, work);
    if (rows.empty() && lanes.finite == kAllRayLanes) return 0;
    BlobHitLanes found;
    kernels.search(shape, lanes, rows, found);
    std::uint32_t hit = used & found.hit;
    for_each_lane(hit, [&](std::size_t i) { hits[i] = {found.t[i], 0, -1.0, 0}; });
    for_each_lane(used & found.unsure, [&](std::size_t i) {
        if (find_first_hit(shape, *rays[i], hits[i])) hit |= 1u << i;
    });
    return hit;
}

}  // namespace alhazen
