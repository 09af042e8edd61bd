#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "alhazen/shapes/blobs/blob_lanes.h"
#include "alhazen/shapes/blobs/blob_pieces.h"
#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/core/first_hits.h"

namespace alhazen {

namespace {

using namespace blob;

/// Buffers for eight rays; kept between packets to avoid allocation.
struct FirstHitsWorkspace {
    std::vector<std::uint32_t> numbers;
    std::vector<BlobRow> rows;
    std::vector<Piece> pieces;
};

/// The most pieces of a component: one per region.
constexpr std::size_t kRegions = 3;

/// The indices of the components that the beam may intersect.
std::span<const std::uint32_t> near_components(const Blob& blob, const BlobKernels& kernels,
                                               const BlobRayLanes& rays, FirstHitsWorkspace& work) {
    if (blob.components.size() <= BlobTree::kFew) {
        work.numbers.resize(blob.components.size());
        return std::span(work.numbers).first(kernels.near(blob, rays, work.numbers.data()));
    }
    work.numbers.clear();
    blob.tree->for_line(rays.axis_origin, rays.axis_direction, rays.width,
                        [&](std::uint32_t i) { work.numbers.push_back(i); });
    return work.numbers;
}

/// True if tracing the rays one by one is faster: if there are many components and eight incoherent
/// rays intersect many of them.
bool better_alone(const Blob& blob, const BlobRayLanes& rays) {
    constexpr std::size_t kMany = 400;
    return blob.components.size() > kMany && !(rays.width <= blob.tree->mean_radius());
}

/// The search scans all rows for every span.
constexpr std::size_t kMostRows = 512;

/// Makes the rows of the components near eight rays.
class RowMaker {
  public:
    RowMaker(const Blob& blob, std::span<const Ray* const> rays, const BlobKernels& kernels,
             const BlobRayLanes& lanes, FirstHitsWorkspace& work)
        : blob_(blob), rays_(rays), kernels_(kernels), lanes_(lanes), work_(work) {}

    std::span<const BlobRow> rows() {
        std::span<const std::uint32_t> rest = near_components(blob_, kernels_, lanes_, work_);
        if (work_.rows.size() < kRegions * rest.size()) work_.rows.resize(kRegions * rest.size());
        while (!rest.empty()) {
            const auto is_rod = [&](std::uint32_t i) { return blob_.components[i].rod; };
            const auto rod = std::find_if(rest.begin(), rest.end(), is_rod);
            const auto balls = static_cast<std::size_t>(rod - rest.begin());
            count_ += kernels_.balls(blob_, lanes_, rest.first(balls), next());
            if (rod != rest.end()) add_rod_rows(*rod);
            rest = rest.subspan(std::min(balls + 1, rest.size()));
        }
        return std::span(work_.rows).first(count_);
    }

  private:
    BlobRow* next() { return work_.rows.data() + count_; }

    void add_rod_rows(std::uint32_t number) {
        BlobRow* const rows = next();
        std::array<bool, kRegions> met{};
        for (std::size_t i = 0; i < rays_.size(); ++i) {
            if (!local_[i]) local_[i].emplace(blob_, *rays_[i]);
            if (!is_finite(local_[i]->o)) continue;
            work_.pieces.clear();
            add_rod(*local_[i], number, work_.pieces);
            for (const Piece& piece : work_.pieces) {
                const auto region = static_cast<std::size_t>(piece.region);
                BlobRow& row = rows[region];
                if (!met[region]) clear(row, piece);
                met[region] = true;
                row.in[i] = piece.in;
                row.out[i] = piece.out;
                row.middle[i] = piece.bump.middle;
                row.peak[i] = piece.bump.peak;
                row.bend[i] = piece.bump.bend;
            }
        }
        for (std::size_t region = 0; region < kRegions; ++region) {
            if (!met[region]) continue;
            if (next() != &rows[region]) *next() = rows[region];
            ++count_;
        }
    }
    /// Marks a row of this piece as absent for every ray.
    void clear(BlobRow& row, const Piece& piece) const {
        const BlobComponent& c = blob_.components[piece.component];
        std::fill_n(row.in, kRayLanes, kInfinity);
        std::fill_n(row.out, kRayLanes, -kInfinity);
        std::fill_n(row.middle, kRayLanes, 0.0);
        std::fill_n(row.peak, kRayLanes, -1.0);
        std::fill_n(row.bend, kRayLanes, 0.0);
        row.set(c, piece.region == Region::Middle ? length(c.top - c.base) : 0.0);
    }

    const Blob& blob_;
    const std::span<const Ray* const> rays_;
    const BlobKernels& kernels_;
    const BlobRayLanes& lanes_;
    FirstHitsWorkspace& work_;
    std::size_t count_ = 0;
    std::array<std::optional<LocalRay>, kRayLanes> local_;  ///< created for the first rod
};

}  // namespace

std::uint32_t first_hits(const Blob& shape, std::span<const Ray* const> rays, ShapeHit* hits) {
    static thread_local FirstHitsWorkspace work;
    const BlobKernels& kernels = blob_kernels();
    RayLanes in;
    BlobRayLanes lanes;
    for (std::size_t i = 0; i < kRayLanes; ++i) in.set(i, *rays[i < rays.size() ? i : 0]);
    const std::uint32_t used = kAllRayLanes >> (kRayLanes - rays.size());
    kernels.begin(shape, in, lanes);
    BlobHitLanes found;
    found.hit = found.leave = 0;
    found.unsure = kAllRayLanes;
    if (!better_alone(shape, lanes)) {
        const auto rows = RowMaker(shape, rays, kernels, lanes, work).rows();
        if (rows.empty() && lanes.finite == kAllRayLanes) return 0;
        if (rows.size() <= kMostRows) kernels.search(shape, lanes, rows, found);
    }
    std::uint32_t hit = used & (found.hit | found.leave);
    for_each_lane(hit, [&](std::size_t i) {
        hits[i] = {found.t[i], 0, (found.leave >> i & 1) != 0 ? 1.0 : -1.0, 0};
    });
    for_each_lane(used & found.unsure, [&](std::size_t i) {
        if (find_first_hit(shape, *rays[i], hits[i])) hit |= 1u << i;
    });
    return hit;
}

}  // namespace alhazen
