#include "alhazen/geometry/polygon_sets/weiler_atherton.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "alhazen/geometry/polygon_sets/region_tracer.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kNoNode = 0xffffffff;

/// A node of a boundary list: a vertex of the polygon, or a crossing, which is in both lists.
struct BoundaryNode {
    LatticePlace place;
    std::uint32_t next = kNoNode;
    std::uint32_t previous = kNoNode;
    std::uint32_t twin = kNoNode;  ///< of a crossing: its node in the other list
    std::uint32_t edge = 0;        ///< the edge that leaves it
    std::uint32_t loop = 0;
    bool enters = false;   ///< true for a crossing at which the subject enters the clip polygon
    bool visited = false;  ///< true once the walk has visited it
};

/// A contour and its first node.
struct BoundaryLoop {
    std::uint32_t first = kNoNode;
    bool of_clip = false;
    bool crossed = false;
};

class BoundaryLists {
  public:
    BoundaryLists(const PolygonSet& subject, const PolygonSet& clip)
        : subject_(subject), clip_(clip) {
        add(subject, false);
        clip_begin_ = static_cast<std::uint32_t>(nodes_.size());
        add(clip, true);
        vertices_ = static_cast<std::uint32_t>(nodes_.size());
    }

    /// Links all crossings into both lists; false if a vertex lies on the other boundary.
    bool cross_all();

    enum class Region : std::uint8_t { Inside, Outside, Merged };
    void write(Region region, PolygonSet& set);

  private:
    void add(const PolygonSet& set, bool of_clip);
    bool cross(std::uint32_t s, std::uint32_t c);
    void insert_crossings(bool of_clip);
    void walk(std::uint32_t start, bool clip_backward);
    void keep_uncrossed(Region region);
    void keep_loop(const BoundaryLoop& loop, bool reversed);
    void keep(std::uint32_t from, std::uint32_t to, std::uint32_t edge);
    void sort_points();
    [[nodiscard]] LatticePoint vertex(std::uint32_t node) const { return nodes_[node].place.from; }
    [[nodiscard]] LatticePoint edge_end(std::uint32_t node) const { return edge_ends_[node]; }

    const PolygonSet& subject_;
    const PolygonSet& clip_;
    std::vector<BoundaryNode> nodes_;  ///< vertices, then pairs of crossings: subject, clip
    std::vector<LatticePoint> edge_ends_;
    std::vector<BoundaryLoop> loops_;
    std::uint32_t clip_begin_ = 0;
    std::uint32_t vertices_ = 0;
    std::vector<std::uint32_t> rank_;  ///< [node] its point in the arrangement
    Arrangement arrangement_;
};

void BoundaryLists::add(const PolygonSet& set, bool of_clip) {
    for (std::size_t i = 0; i < set.loop_count(); ++i) {
        const std::span<const LatticePoint> loop = set.loop(i);
        const auto first = static_cast<std::uint32_t>(nodes_.size());
        const auto n = static_cast<std::uint32_t>(loop.size());
        for (std::uint32_t k = 0; k < n; ++k) {
            const LatticePoint next = loop[(k + 1) % n];
            nodes_.push_back({.place = place_of(loop[k]),
                              .next = first + (k + 1) % n,
                              .previous = first + (k + n - 1) % n,
                              .edge = first + k,
                              .loop = static_cast<std::uint32_t>(loops_.size())});
            edge_ends_.push_back(next);
            arrangement_.edges.push_back({std::min(loop[k], next), std::max(loop[k], next)});
        }
        loops_.push_back({first, of_clip, false});
    }
}

/// 1 if the ends of c-d lie on opposite sides of a-b, 0 if on the same side, -1 if one lies on its
/// line.
int parts(std::int64_t of_c, std::int64_t of_d) {
    return of_c == 0 || of_d == 0 ? -1 : ((of_c > 0) != (of_d > 0) ? 1 : 0);
}

bool BoundaryLists::cross(std::uint32_t s, std::uint32_t c) {
    const LatticePoint s0 = vertex(s);
    const LatticePoint s1 = edge_end(s);
    const LatticePoint c0 = vertex(c);
    const LatticePoint c1 = edge_end(c);
    LatticeBox s_box;
    s_box.extend(s0);
    s_box.extend(s1);
    LatticeBox c_box;
    c_box.extend(c0);
    c_box.extend(c1);
    if (!s_box.meets(c_box)) {
        return true;
    }
    const std::int64_t s_to_c1 = turn(c0, c1, s1);
    const int by_clip = parts(turn(c0, c1, s0), s_to_c1);
    const int by_subject = parts(turn(s0, s1, c0), turn(s0, s1, c1));
    if (by_clip == 0 || by_subject == 0) {
        return true;
    }
    if (by_clip < 0 || by_subject < 0) {
        return false;
    }
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({.place = crossing(s0, s1, c0, c1),
                      .twin = node + 1,
                      .edge = s,
                      .loop = nodes_[s].loop,
                      .enters = s_to_c1 > 0});
    nodes_.push_back(
        {.place = crossing(c0, c1, s0, s1), .twin = node, .edge = c, .loop = nodes_[c].loop});
    loops_[nodes_[s].loop].crossed = true;
    loops_[nodes_[c].loop].crossed = true;
    return true;
}

bool BoundaryLists::cross_all() {
    for (std::uint32_t s = 0; s < clip_begin_; ++s) {
        for (std::uint32_t c = clip_begin_; c < vertices_; ++c) {
            if (!cross(s, c)) {
                return false;
            }
        }
    }
    insert_crossings(false);
    insert_crossings(true);
    return true;
}

// Inserts the crossings of each edge behind its first vertex, in the order along the edge.
void BoundaryLists::insert_crossings(bool of_clip) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = vertices_ + (of_clip ? 1 : 0); i < nodes_.size(); i += 2) {
        order.push_back(i);
    }
    std::ranges::sort(order, [this](std::uint32_t a, std::uint32_t b) {
        const BoundaryNode& na = nodes_[a];
        const BoundaryNode& nb = nodes_[b];
        if (na.edge != nb.edge) {
            return na.edge < nb.edge;
        }
        return Int128{na.place.num} * nb.place.den < Int128{nb.place.num} * na.place.den;
    });
    std::uint32_t before = kNoNode;
    for (const std::uint32_t i : order) {
        const bool same_edge = before != kNoNode && nodes_[before].edge == nodes_[i].edge;
        const std::uint32_t last = same_edge ? before : nodes_[i].edge;
        nodes_[i].previous = last;
        nodes_[i].next = nodes_[last].next;
        nodes_[nodes_[i].next].previous = i;
        nodes_[last].next = i;
        before = i;
    }
}

// Sorts the points of the arrangement: all nodes in order, a crossing once.
void BoundaryLists::sort_points() {
    std::vector<std::uint32_t> order(nodes_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::erase_if(order,
                  [this](std::uint32_t i) { return i > vertices_ && (i - vertices_) % 2 == 1; });
    std::ranges::sort(order, [this](std::uint32_t a, std::uint32_t b) {
        return compare(nodes_[a].place, nodes_[b].place) < 0;
    });
    rank_.resize(nodes_.size());
    arrangement_.points.clear();
    for (const std::uint32_t i : order) {
        rank_[i] = static_cast<std::uint32_t>(arrangement_.points.size());
        if (nodes_[i].twin != kNoNode) {
            rank_[nodes_[i].twin] = rank_[i];
            arrangement_.rounds = arrangement_.rounds || !on_lattice(nodes_[i].place);
        }
        arrangement_.points.push_back(nodes_[i].place);
    }
}

// Keeps a piece of the outline; the region lies to its left.
void BoundaryLists::keep(std::uint32_t from, std::uint32_t to, std::uint32_t edge) {
    const std::uint32_t a = rank_[from];
    const std::uint32_t b = rank_[to];
    arrangement_.sub_edges.push_back({std::min(a, b), std::max(a, b), edge,
                                      a < b ? std::uint8_t{0} : kInFirst,
                                      a < b ? kInFirst : std::uint8_t{0}});
}

// Walks from a crossing along the subject to the next crossing, from there along the clip polygon
// to the next, and so on until the start.
void BoundaryLists::walk(std::uint32_t start, bool clip_backward) {
    std::uint32_t at = start;
    do {
        nodes_[at].visited = true;
        do {
            const std::uint32_t next = nodes_[at].next;
            keep(at, next, nodes_[at].edge);
            at = next;
        } while (nodes_[at].twin == kNoNode);
        at = nodes_[at].twin;
        do {
            const std::uint32_t next = clip_backward ? nodes_[at].previous : nodes_[at].next;
            keep(at, next, clip_backward ? nodes_[next].edge : nodes_[at].edge);
            at = next;
        } while (nodes_[at].twin == kNoNode);
        at = nodes_[at].twin;
    } while (at != start);
}

void BoundaryLists::keep_loop(const BoundaryLoop& loop, bool reversed) {
    std::uint32_t at = loop.first;
    do {
        const std::uint32_t next = nodes_[at].next;
        reversed ? keep(next, at, nodes_[at].edge) : keep(at, next, nodes_[at].edge);
        at = next;
    } while (at != loop.first);
}

// Keeps loops without crossings, which lie inside or outside the other operand as a whole.
void BoundaryLists::keep_uncrossed(Region region) {
    for (const BoundaryLoop& loop : loops_) {
        if (loop.crossed) {
            continue;
        }
        const bool within = contains(loop.of_clip ? subject_ : clip_, vertex(loop.first));
        const bool wanted_within =
            region == Region::Inside || (region == Region::Outside && loop.of_clip);
        if (within == wanted_within) {
            keep_loop(loop, region == Region::Outside && loop.of_clip);
        }
    }
}

void BoundaryLists::write(Region region, PolygonSet& set) {
    sort_points();
    arrangement_.sub_edges.clear();
    for (BoundaryNode& node : nodes_) {
        node.visited = false;
    }
    for (std::uint32_t i = vertices_; i < nodes_.size(); i += 2) {
        if (!nodes_[i].visited && nodes_[i].enters == (region == Region::Inside)) {
            walk(i, region == Region::Outside);
        }
    }
    keep_uncrossed(region);
    RegionTracer tracer;
    tracer.prepare(arrangement_);
    tracer.trace({false, true, false, false}, set);
}

}  // namespace

std::optional<WeilerAtherton> weiler_atherton(const PolygonSet& subject, const PolygonSet& clip,
                                              GeneralPosition* position) {
    GeneralPosition found = GeneralPosition::Holds;
    BoundaryLists lists(subject, clip);
    if (subject.touching() || clip.touching()) {
        found = GeneralPosition::OperandTouchesItself;
    } else if (!lists.cross_all()) {
        found = GeneralPosition::VertexOnBoundary;
    }
    if (position != nullptr) {
        *position = found;
    }
    if (found != GeneralPosition::Holds) {
        return std::nullopt;
    }
    WeilerAtherton result;
    lists.write(BoundaryLists::Region::Inside, result.inside);
    lists.write(BoundaryLists::Region::Outside, result.outside);
    lists.write(BoundaryLists::Region::Merged, result.merged);
    return result;
}

}  // namespace alhazen
