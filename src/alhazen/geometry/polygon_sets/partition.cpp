#include "alhazen/geometry/polygon_sets/partition.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "alhazen/geometry/polygon_sets/edge_sweep.h"
#include "alhazen/geometry/polygon_sets/region_tracer.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kNoPart = 0xffffffff;
/// The operand of the whole; those of the parts follow.
constexpr std::uint32_t kWhole = 0;

class PartitionMaker {
  public:
    void make(const PolygonSet& whole, std::span<PolygonSet> parts) {
        sweep_.clear();
        add(whole, kWhole);
        for (std::uint32_t k = 0; k < parts.size(); ++k) add(parts[k], k + 1);
        sweep_.run_with_faces(faces_);
        choose_parts();
        fill_gaps();
        collect_links(parts.size());
        for (std::uint32_t k = 0; k < parts.size(); ++k) {
            tracer_.trace(std::span(links_).subspan(begins_[k], begins_[k + 1] - begins_[k]),
                          parts[k]);
        }
    }

  private:
    void add(const PolygonSet& set, std::uint32_t operand) {
        for (std::size_t i = 0; i < set.loop_count(); ++i) sweep_.add_loop_of(set.loop(i), operand);
    }

    /// Assigns each face to a part by the operands that hold it; `gaps_` are the faces in no part.
    void choose_parts() {
        const auto count = static_cast<std::uint32_t>(faces_.same.size());
        part_.assign(count, kNoPart);
        gap_.assign(count, false);
        for (std::uint32_t f = 0; f < count; ++f) {
            const std::span<const std::uint32_t> owners = faces_.owners_of(f);
            if (owners.empty() || owners[0] != kWhole) continue;
            gap_[f] = owners.size() == 1;
            if (!gap_[f]) part_[f] = owners[1] - 1;
        }
    }

    void fill_gaps() {
        std::map<std::uint32_t, std::map<std::uint32_t, std::int64_t>> beside;
        for (std::size_t i = 0; i < faces_.below.size(); ++i) {
            const std::uint32_t below = faces_.below[i], above = faces_.above[i];
            if (gap_[below] == gap_[above]) continue;
            const std::uint32_t gap = gap_[below] ? below : above;
            const std::uint32_t part = part_[gap_[below] ? above : below];
            auto& lengths = beside[faces_.root(gap)];
            if (part != kNoPart) lengths[part] += length_of(i);
        }
        for (std::uint32_t f = 0; f < gap_.size(); ++f) {
            if (!gap_[f]) continue;
            const auto found = beside.find(faces_.root(f));
            std::int64_t most = -1;
            part_[f] = 0;
            if (found == beside.end()) continue;
            for (const auto& [part, length] : found->second) {
                if (length > most) part_[f] = part;
                most = std::max(most, length);
            }
        }
    }
    /// Length in lattice steps.
    [[nodiscard]] std::int64_t length_of(std::size_t sub_edge) const {
        const Arrangement& a = sweep_.result();
        const LatticePlace& p = a.points[a.sub_edges[sub_edge].begin];
        const LatticePlace& q = a.points[a.sub_edges[sub_edge].end];
        return static_cast<std::int64_t>(std::abs(q.x - p.x) + std::abs(q.y - p.y));
    }

    /// The outlines of the parts, one part after the other.
    void collect_links(std::size_t parts) {
        const Arrangement& arrangement = sweep_.result();
        tracer_.prepare(arrangement);
        loose_.clear();
        begins_.assign(parts + 1, 0);
        for (std::size_t i = 0; i < arrangement.sub_edges.size(); ++i) {
            const std::uint32_t below = part_[faces_.below[i]], above = part_[faces_.above[i]];
            if (below == above) continue;
            const std::span<const std::uint32_t> way = tracer_.way_of(arrangement.sub_edges[i]);
            for (std::size_t k = 0; k + 1 < way.size(); ++k) {
                if (way[k] == way[k + 1]) continue;
                add_link(above, way[k], way[k + 1]);
                add_link(below, way[k + 1], way[k]);
            }
        }
        for (std::size_t k = 0; k < parts; ++k) begins_[k + 1] += begins_[k];
        links_.resize(loose_.size());
        std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
        for (const LooseLink& link : loose_) links_[next[link.part]++] = {link.from, link.to};
    }
    void add_link(std::uint32_t part, std::uint32_t from, std::uint32_t to) {
        if (part == kNoPart) return;
        loose_.push_back({part, from, to});
        ++begins_[part + 1];
    }

    struct LooseLink {
        std::uint32_t part, from, to;
    };
    EdgeSweep sweep_;
    ArrangementFaces faces_;
    RegionTracer tracer_;
    std::vector<std::uint32_t> part_;  ///< [number of a face]
    std::vector<bool> gap_;
    std::vector<LooseLink> loose_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> links_;
    std::vector<std::size_t> begins_;  ///< [part] its first index in `links_`
};

}  // namespace

void make_partition(const PolygonSet& whole, std::span<PolygonSet> parts) {
    if (parts.empty()) return;
    if (parts.size() == 1) {
        parts[0] = whole;
        return;
    }
    thread_local PartitionMaker maker;
    maker.make(whole, parts);
}

}  // namespace alhazen
