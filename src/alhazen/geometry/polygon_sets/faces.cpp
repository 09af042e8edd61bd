// Pieces and triangles of a set, from the intervals of its sweep: each interval lies between two
// edges of one piece of the region.

#include <algorithm>
#include <numeric>

#include "alhazen/geometry/polygon_sets/edge_sweep.h"
#include "alhazen/geometry/polygon_sets/polygon_set.h"

namespace alhazen {

namespace {

const Arrangement& sweep_faces(const PolygonSet& set) {
    thread_local EdgeSweep sweep;
    sweep.clear();
    for (std::size_t i = 0; i < set.loop_count(); ++i) {
        sweep.add_loop(set.loop(i), kInFirst);
    }
    sweep.run_with_intervals();
    return sweep.result();
}

/// [edge] its loop, in the order in which the sweep added the edges.
std::vector<std::uint32_t> loops_of_edges(const PolygonSet& set) {
    std::vector<std::uint32_t> loops;
    loops.reserve(set.vertex_count());
    for (std::uint32_t i = 0; i < set.loop_count(); ++i) {
        loops.insert(loops.end(), set.loop(i).size(), i);
    }
    return loops;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t i) {
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/// The triangles between an edge and the points above (or below) it that the sweep passes.
class Mountains {
  public:
    explicit Mountains(const Arrangement& arrangement)
        : arrangement_(arrangement), chains_(arrangement.sub_edges.size()) {
        for (std::size_t i = 0; i < chains_.size(); ++i) {
            chains_[i].push_back(arrangement.sub_edges[i].begin);
        }
    }

    void pass(std::uint32_t sub_edge, std::uint32_t point, std::vector<LatticeTriangle>& out) {
        std::vector<std::uint32_t>& chain = chains_[sub_edge];
        if (chain.back() == point) {
            return;
        }
        const bool region_above = (arrangement_.sub_edges[sub_edge].above & kInFirst) != 0;
        const LatticePoint c = at(point);
        while (chain.size() > 1) {
            const LatticePoint a = at(chain[chain.size() - 2]);
            const LatticePoint b = at(chain.back());
            const std::int64_t t = turn(a, b, c);
            if (region_above ? t >= 0 : t <= 0) {
                break;
            }
            out.push_back(region_above ? LatticeTriangle{a, c, b} : LatticeTriangle{a, b, c});
            chain.pop_back();
        }
        chain.push_back(point);
    }

  private:
    [[nodiscard]] LatticePoint at(std::uint32_t point) const {
        return arrangement_.points[point].from;
    }

    const Arrangement& arrangement_;
    std::vector<std::vector<std::uint32_t>> chains_;
};

}  // namespace

std::vector<OuterLoop> loops_with_holes(const PolygonSet& set) {
    const Arrangement& faces = sweep_faces(set);
    const std::vector<std::uint32_t> loops = loops_of_edges(set);
    std::vector<std::uint32_t> parents(set.loop_count());
    std::iota(parents.begin(), parents.end(), 0U);
    for (const EdgeInterval& interval : faces.intervals) {
        const std::uint32_t lower = loops[faces.sub_edges[interval.lower].edge];
        const std::uint32_t upper = loops[faces.sub_edges[interval.upper].edge];
        parents[root_of(parents, lower)] = root_of(parents, upper);
    }
    std::vector<OuterLoop> pieces;
    std::vector<std::uint32_t> piece_of(set.loop_count());
    for (std::uint32_t i = 0; i < set.loop_count(); ++i) {
        if (twice_area(set.loop(i)) > 0) {
            piece_of[root_of(parents, i)] = static_cast<std::uint32_t>(pieces.size());
            pieces.push_back({i, {}});
        }
    }
    for (std::uint32_t i = 0; i < set.loop_count(); ++i) {
        if (twice_area(set.loop(i)) < 0) {
            pieces[piece_of[root_of(parents, i)]].holes.push_back(i);
        }
    }
    return pieces;
}

std::vector<LatticeTriangle> triangulate(const PolygonSet& set) {
    const Arrangement& faces = sweep_faces(set);
    std::vector<LatticeTriangle> triangles;
    triangles.reserve(set.vertex_count() + 2 * set.loop_count());
    Mountains mountains(faces);
    for (const EdgeInterval& interval : faces.intervals) {
        mountains.pass(interval.lower, interval.point, triangles);
        mountains.pass(interval.upper, interval.point, triangles);
    }
    return triangles;
}

}  // namespace alhazen
