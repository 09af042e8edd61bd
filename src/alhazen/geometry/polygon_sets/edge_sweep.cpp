#include "alhazen/geometry/polygon_sets/edge_sweep.h"

#include <algorithm>
#include <iterator>

namespace alhazen {

namespace {

std::uint64_t lattice_key(LatticePoint p) {
    return (static_cast<std::uint64_t>(p.x + 2 * kLatticeLimit) << 32) |
           static_cast<std::uint32_t>(p.y + 2 * kLatticeLimit);
}

LatticePoint lattice_point(std::uint64_t key) {
    return {static_cast<std::int32_t>(key >> 32) - 2 * kLatticeLimit,
            static_cast<std::int32_t>(key & 0xffffffff) - 2 * kLatticeLimit};
}

}  // namespace

void ArrangementFaces::clear() {
    below.clear();
    above.clear();
    owners.clear();
    owner_ends.assign(1, 0);
    same.assign(1, 0);
}

std::uint32_t ArrangementFaces::root(std::uint32_t number) const {
    while (same[number] != number) number = same[number];
    return number;
}

std::uint32_t ArrangementFaces::add_across(std::uint32_t number,
                                           std::span<const std::uint32_t> crossed) {
    const std::size_t begin = number == 0 ? 0 : owner_ends[number - 1];
    const std::size_t end = owner_ends[number];
    owners.reserve(owners.size() + (end - begin) + crossed.size());
    std::set_symmetric_difference(owners.begin() + static_cast<std::ptrdiff_t>(begin),
                                  owners.begin() + static_cast<std::ptrdiff_t>(end),
                                  crossed.begin(), crossed.end(), std::back_inserter(owners));
    const auto next = static_cast<std::uint32_t>(same.size());
    owner_ends.push_back(static_cast<std::uint32_t>(owners.size()));
    same.push_back(next);
    return next;
}

// Shortens both paths to the root, so that paths stay short.
void ArrangementFaces::unite(std::uint32_t a, std::uint32_t b) {
    const auto find = [this](std::uint32_t n) {
        while (same[n] != n) {
            same[n] = same[same[n]];
            n = same[n];
        }
        return n;
    };
    a = find(a);
    b = find(b);
    same[std::max(a, b)] = std::min(a, b);
}

void EdgeSweep::clear() {
    result_.clear();
    active_.clear();
    vertices_.clear();
    next_vertex_ = 0;
    crossings_.clear();
    heap_.clear();
    free_.clear();
    status_.clear();
    operands_.clear();
}

void EdgeSweep::add_loop_of(std::span<const LatticePoint> loop, std::uint32_t operand) {
    add_loop(loop, kInFirst);
    operands_.resize(result_.edges.size(), operand);
}

void EdgeSweep::add_loop(std::span<const LatticePoint> loop, std::uint8_t owner) {
    const auto first = static_cast<std::uint32_t>(result_.edges.size());
    if (loop.empty()) {
        return;
    }
    LatticePoint from = loop.back();
    for (const LatticePoint to : loop) {
        if (from == to) {
            continue;
        }
        // The edge that arrives at `to`, and the next one, which leaves it.
        const auto edge = static_cast<std::uint32_t>(result_.edges.size());
        result_.edges.push_back(from < to ? ArrangementEdge{from, to} : ArrangementEdge{to, from});
        active_.push_back({.owner = owner});
        vertices_.push_back({lattice_key(to), {edge, edge + 1}});
        from = to;
    }
    if (result_.edges.size() > first) {
        vertices_.back().edges[1] = first;
    }
}

void EdgeSweep::sort_vertices() {
    constexpr std::size_t kFew = 24;
    if (vertices_.size() > kFew) {
        std::ranges::sort(vertices_, {}, &Vertex::key);
        return;
    }
    for (std::size_t i = 1; i < vertices_.size(); ++i) {
        const Vertex v = vertices_[i];
        std::size_t j = i;
        for (; j > 0 && vertices_[j - 1].key > v.key; --j) {
            vertices_[j] = vertices_[j - 1];
        }
        vertices_[j] = v;
    }
}

void EdgeSweep::run_with_intervals() {
    with_intervals_ = true;
    run();
    with_intervals_ = false;
}

void EdgeSweep::run_with_faces(ArrangementFaces& faces) {
    faces.clear();
    faces_ = &faces;
    face_above_.assign(result_.edges.size(), 0);
    run();
    faces_ = nullptr;
}

void EdgeSweep::run() {
    sort_vertices();
    while (next_point()) {
        sweep_point();
    }
}

// Sets the place to the next point and the fan to the edges that begin there.
bool EdgeSweep::next_point() {
    fan_.clear();
    through_[0] = through_[1] = kNone;
    if (next_vertex_ == vertices_.size()) {
        return false;  // crossings lie before the ends of their edges
    }
    at_ = lattice_point(vertices_[next_vertex_].key);
    at_vertex_ = true;
    place_ = place_of(at_);
    if (!heap_.empty()) {
        const Crossing& first = crossings_[heap_.front()];
        const auto order = compare(first.place, place_);
        at_vertex_ = order >= 0;
        if (order < 0) {
            place_ = first.place;
            through_[0] = first.edges[0];
            through_[1] = first.edges[1];
        }
        if (order <= 0) {
            drop_crossings_at_place();
        }
    }
    if (at_vertex_) {
        take_vertices();
    } else {
        ++result_.crossings;
        result_.rounds = result_.rounds || !on_lattice(place_);
    }
    result_.points.push_back(place_);
    return true;
}

void EdgeSweep::take_vertices() {
    const std::uint64_t key = vertices_[next_vertex_].key;
    for (; next_vertex_ < vertices_.size() && vertices_[next_vertex_].key == key; ++next_vertex_) {
        for (const std::uint32_t edge : vertices_[next_vertex_].edges) {
            if (result_.edges[edge].lo == at_) {
                fan_.push_back(edge);
            }
        }
    }
}

void EdgeSweep::drop_crossings_at_place() {
    const auto later = [this](std::uint32_t a, std::uint32_t b) {
        return compare(crossings_[a].place, crossings_[b].place) > 0;
    };
    do {
        std::ranges::pop_heap(heap_, later);
        free_.push_back(heap_.back());
        heap_.pop_back();
    } while (!heap_.empty() && compare(crossings_[heap_.front()].place, place_) == 0);
}

// The sign of (edge x place): positive if the place is above the edge.
int EdgeSweep::side(std::uint32_t edge) const {
    const ArrangementEdge& e = result_.edges[edge];
    if (at_vertex_) {
        const std::int64_t s = turn(e.lo, e.hi, at_);
        return s > 0 ? 1 : (s < 0 ? -1 : 0);
    }
    if (edge == through_[0] || edge == through_[1]) {
        return 0;
    }
    return side_of(e.lo, e.hi, place_);
}

std::size_t EdgeSweep::first_not_below() const {
    std::size_t lo = 0;
    std::size_t hi = status_.size();
    while (lo < hi) {
        const std::size_t mid = (lo + hi) / 2;
        if (side(status_[mid]) > 0) {
            lo = mid + 1;
        } else {
            hi = mid;
        }
    }
    return lo;
}

void EdgeSweep::sweep_point() {
    const std::size_t lo = first_not_below();
    std::size_t hi = lo;
    while (hi < status_.size() && side(status_[hi]) == 0) {
        close_bundle(status_[hi++]);
    }
    if (with_intervals_) {
        record_intervals(lo, hi);
    }
    sort_fan();
    if (faces_ != nullptr) {
        const std::uint32_t lower = lo > 0 ? face_above_[status_[lo - 1]] : 0;
        bundle_fan_of_faces(lower, hi > lo ? face_above_[status_[hi - 1]] : lower);
    } else {
        bundle_fan(lo > 0 ? active_[status_[lo - 1]].above : std::uint8_t{0});
    }
    replace(lo, hi);
    const std::size_t end = lo + fan_.size();
    if (lo > 0 && lo < status_.size()) {
        test_neighbors(status_[lo - 1], status_[lo]);
    }
    if (end > lo && end < status_.size()) {
        test_neighbors(status_[end - 1], status_[end]);
    }
}

// Records the intervals that end at the point: below, between and above the bundles [lo, hi) of the
// status.
void EdgeSweep::record_intervals(std::size_t lo, std::size_t hi) {
    const auto point = static_cast<std::uint32_t>(result_.points.size() - 1);
    std::uint32_t lower = kNone;
    for (std::size_t i = lo; i-- > 0 && lower == kNone;) {
        lower = active_[status_[i]].sub_edge;
    }
    for (std::size_t i = lo; i < status_.size(); ++i) {
        const std::uint32_t upper = active_[status_[i]].sub_edge;
        if (upper == kNone) {
            continue;
        }
        if (lower != kNone && (result_.sub_edges[upper].below & kInFirst) != 0) {
            result_.intervals.push_back({point, lower, upper});
        }
        lower = upper;
        if (i >= hi) {
            break;
        }
    }
}

// Ends the piece of a bundle at the place; its members that continue join the fan.
void EdgeSweep::close_bundle(std::uint32_t leader) {
    const Active& bundle = active_[leader];
    if (bundle.sub_edge != kNone) {
        result_.sub_edges[bundle.sub_edge].end =
            static_cast<std::uint32_t>(result_.points.size() - 1);
    }
    if (bundle.next_member != kNone) {
        ++result_.overlaps;
    }
    for (std::uint32_t edge = leader; edge != kNone; edge = active_[edge].next_member) {
        if (!at_vertex_ || result_.edges[edge].hi != at_) {
            fan_.push_back(edge);
        }
    }
}

bool EdgeSweep::steeper(std::uint32_t a, std::uint32_t b) const {
    const ArrangementEdge& ea = result_.edges[a];
    const ArrangementEdge& eb = result_.edges[b];
    return cross_of(eb.lo, eb.hi, ea.lo, ea.hi) > 0;
}

void EdgeSweep::sort_fan() {
    constexpr std::size_t kFew = 16;
    if (fan_.size() > kFew) {
        std::ranges::sort(fan_, [this](std::uint32_t a, std::uint32_t b) { return steeper(b, a); });
        return;
    }
    for (std::size_t i = 1; i < fan_.size(); ++i) {
        const std::uint32_t edge = fan_[i];
        std::size_t j = i;
        for (; j > 0 && steeper(fan_[j - 1], edge); --j) {
            fan_[j] = fan_[j - 1];
        }
        fan_[j] = edge;
    }
}

// Makes bundles of the fan's edges of equal direction, each led by its first edge, and propagates
// the state upwards through them. The fan keeps the leaders.
void EdgeSweep::bundle_fan(std::uint8_t state) {
    const auto point = static_cast<std::uint32_t>(result_.points.size() - 1);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < fan_.size();) {
        const std::uint32_t leader = fan_[i];
        std::uint8_t parity = active_[leader].owner;
        std::uint32_t last = leader;
        for (++i; i < fan_.size() && !steeper(fan_[i], leader); ++i) {
            active_[last].next_member = fan_[i];
            last = fan_[i];
            parity ^= active_[last].owner;
        }
        active_[last].next_member = kNone;
        const std::uint8_t below = state;
        state ^= parity;
        active_[leader].above = state;
        active_[leader].sub_edge = kNone;
        if (parity != 0) {
            active_[leader].sub_edge = static_cast<std::uint32_t>(result_.sub_edges.size());
            result_.sub_edges.push_back({point, point, leader, below, state});
        }
        fan_[kept++] = leader;
    }
    fan_.resize(kept);
}

// Makes bundles for numbered faces: `lower` is the face below the fan, `upper` the one above it.
void EdgeSweep::bundle_fan_of_faces(std::uint32_t lower, std::uint32_t upper) {
    const auto point = static_cast<std::uint32_t>(result_.points.size() - 1);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < fan_.size();) {
        const std::uint32_t leader = fan_[i];
        std::uint32_t last = leader;
        crossed_.assign(1, operands_[leader]);
        for (++i; i < fan_.size() && !steeper(fan_[i], leader); ++i) {
            active_[last].next_member = fan_[i];
            last = fan_[i];
            crossed_.push_back(operands_[last]);
        }
        active_[last].next_member = kNone;
        // Two edges of the same operand cancel.
        std::ranges::sort(crossed_);
        std::size_t odd = 0;
        for (const std::uint32_t operand : crossed_) {
            if (odd > 0 && crossed_[odd - 1] == operand) {
                --odd;
            } else {
                crossed_[odd++] = operand;
            }
        }
        crossed_.resize(odd);
        active_[leader].sub_edge = kNone;
        if (odd > 0) {
            active_[leader].sub_edge = static_cast<std::uint32_t>(result_.sub_edges.size());
            result_.sub_edges.push_back({point, point, leader, 0, 0});
            faces_->below.push_back(lower);
            lower = faces_->add_across(lower, crossed_);
            faces_->above.push_back(lower);
        }
        face_above_[leader] = lower;
        fan_[kept++] = leader;
    }
    fan_.resize(kept);
    faces_->unite(lower, upper);
}

void EdgeSweep::replace(std::size_t lo, std::size_t hi) {
    const std::size_t common = std::min(hi - lo, fan_.size());
    std::copy_n(fan_.begin(), common, status_.begin() + static_cast<std::ptrdiff_t>(lo));
    const auto at = status_.begin() + static_cast<std::ptrdiff_t>(lo + common);
    if (fan_.size() > common) {
        status_.insert(at, fan_.begin() + static_cast<std::ptrdiff_t>(common), fan_.end());
    } else {
        status_.erase(at, status_.begin() + static_cast<std::ptrdiff_t>(hi));
    }
}

// Tests two neighbours that both exist to the right of the place, `lower` below `upper`: they cross
// if the one that ends first does so on the other side.
void EdgeSweep::test_neighbors(std::uint32_t lower, std::uint32_t upper) {
    const ArrangementEdge& a = result_.edges[lower];
    const ArrangementEdge& b = result_.edges[upper];
    const bool cross = b.hi < a.hi ? turn(a.lo, a.hi, b.hi) < 0 : turn(b.lo, b.hi, a.hi) > 0;
    if (cross) {
        push_crossing(lower, upper);
    }
}

void EdgeSweep::push_crossing(std::uint32_t a, std::uint32_t b) {
    const ArrangementEdge& ea = result_.edges[a];
    const ArrangementEdge& eb = result_.edges[b];
    const Crossing crossing_ab{crossing(ea.lo, ea.hi, eb.lo, eb.hi), {a, b}};
    std::uint32_t slot = static_cast<std::uint32_t>(crossings_.size());
    if (free_.empty()) {
        crossings_.push_back(crossing_ab);
    } else {
        slot = free_.back();
        free_.pop_back();
        crossings_[slot] = crossing_ab;
    }
    heap_.push_back(slot);
    std::ranges::push_heap(heap_, [this](std::uint32_t x, std::uint32_t y) {
        return compare(crossings_[x].place, crossings_[y].place) > 0;
    });
}

}  // namespace alhazen
