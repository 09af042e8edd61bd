#include "alhazen/csg/csg_truth_table.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>
#include <type_traits>

#include "alhazen/primitives/primitive_columns.h"

namespace alhazen {

namespace {

/// [kind] maximum number of crossings of a shape with a line.
constexpr auto kMaxHitsOfKind = []<class... S>(std::type_identity<ShapeTypes<S...>>) {
    return std::array<int, sizeof...(S)>{S::kMaxHits...};
}(std::type_identity<AnalyticShapes>{});

}  // namespace

/// The sorted crossings of a ray with the leaves, and the position of a query among them.
class CsgTruthTable::Events {
  public:
    void add(const CsgCrossing& crossing) {
        CsgCrossing* all = data();
        std::size_t place = size_++;
        for (; place > 0 && all[place - 1].t > crossing.t; --place) all[place] = all[place - 1];
        all[place] = crossing;
    }
    [[nodiscard]] bool at_end() const { return at_ == size_; }
    [[nodiscard]] const CsgCrossing& front() { return data()[at_]; }
    /// True if no other crossing follows the front one up to `t`.
    [[nodiscard]] bool is_alone(double t) { return at_ + 1 == size_ || data()[at_ + 1].t > t; }
    /// Takes the next crossing.
    const CsgCrossing& pass() {
        const CsgCrossing& crossing = data()[at_++];
        inside ^= LeafSet{1} << crossing.leaf;
        return crossing;
    }

    LeafSet inside = 0;  ///< the leaves that contain the current point

  private:
    CsgCrossing* data() { return reinterpret_cast<CsgCrossing*>(bytes_); }

    std::size_t size_ = 0, at_ = 0;
    // Bytes, to avoid initialisation for every ray.
    alignas(CsgCrossing) std::byte bytes_[kMaxLeaves * kMaxShapeHits * sizeof(CsgCrossing)];
};

bool CsgTruthTable::fits(const CsgSolid& solid) {
    if (solid.leaf_count() > kMaxLeaves || solid.tree().nodes().size() > kMaxNodes) return false;
    if (solid.has_media()) return false;
    const std::vector<PrimitiveId>& leaves = solid.expression().leaves;
    return std::all_of(leaves.begin(), leaves.end(), [&](PrimitiveId leaf) {
        const std::uint32_t kind = solid.table().kind(leaf);
        return kind < kTriangleKind && kMaxHitsOfKind[kind] <= kMaxShapeHits;
    });
}

CsgTruthTable::CsgTruthTable(const CsgSolid& solid) : solid_(solid) {
    const std::vector<CsgTree::Node>& nodes = solid.tree().nodes();
    const std::vector<CsgTree::Leaf>& leaves = solid.tree().leaves();
    const auto leaf_count = static_cast<std::uint32_t>(leaves.size());
    // Number of true operands of each node for a point inside these leaves.
    std::array<std::int32_t, kMaxNodes> usual{};
    for (LeafSet inside = 0; inside < LeafSet{1} << leaf_count; ++inside) {
        std::array<std::int32_t, kMaxNodes> count{};
        for (std::uint32_t leaf = 0; leaf < leaf_count; ++leaf) {
            count[leaves[leaf].parent] += ((inside >> leaf & 1) != 0) != leaves[leaf].complement;
        }
        // In reverse: children come after their parents.
        for (std::size_t i = nodes.size(); i-- > 0;) {
            if (inside == 0) usual[i] = count[i];
            if (count[i] - usual[i] < nodes[i].need) continue;
            tables_[i] |= std::uint64_t{1} << inside;
            if (i > 0) ++count[nodes[i].parent];
        }
    }
    for (std::uint32_t leaf = 0; leaf < leaf_count; ++leaf) {
        bool needed = true;
        for (LeafSet inside = 0; inside < LeafSet{1} << leaf_count; ++inside) {
            if ((inside >> leaf & 1) == 0 && is_solid(inside)) needed = false;
        }
        if (needed) needed_ |= LeafSet{1} << leaf;
        order_[leaf] = leaf;
        const PrimitiveId id = solid.expression().leaves[leaf];
        places_[leaf] = {solid.table().kind(id), solid.table().index(id)};
    }
    std::stable_partition(order_.begin(), order_.begin() + leaf_count,
                          [&](std::uint32_t leaf) { return (needed_ >> leaf & 1) != 0; });
    prepare_lanes();
}

void CsgTruthTable::prepare_lanes() {
    static_assert(CsgLanesSolid::kMaxLeaves >= kMaxLeaves);
    const std::uint32_t count = solid_.leaf_count();
    LeafSet place_of[kMaxLeaves];
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t number = order_[i];
        CsgLanesSolid::Leaf& leaf = lanes_.leaves[i];
        leaf.id = solid_.expression().leaves[number];
        leaf.needed = (needed_ >> number & 1) != 0;
        set_shape(places_[number], leaf);
        if (leaf.kind == CsgLanesSolid::Kind::None) return;
        place_of[number] = i;
    }
    for (LeafSet inside = 0; inside < LeafSet{1} << count; ++inside) {
        LeafSet places = 0;
        for (std::uint32_t number = 0; number < count; ++number) {
            places |= (inside >> number & 1) << place_of[number];
        }
        for (std::uint32_t number = 0; number < count; ++number) {
            const LeafSet own = LeafSet{1} << number;
            if ((inside & own) != 0 || is_solid(inside) == is_solid(inside | own)) continue;
            lanes_.leaves[place_of[number]].changes |= std::uint64_t{1} << places;
        }
    }
    lanes_.begins_with_first =
        std::has_single_bit(needed_) && (lanes_.leaves[0].changes & 1) != 0 && !has_huge_leaf();
    lanes_.center = solid_.center();
    lanes_.size = solid_.size();
    // Larger than tau, as the sums for it round differently.
    lanes_.apart = 4.0 * CsgSolid::kTolerance;
    lanes_.leaf_count = count;
    lanes_.visible_to = solid_.table().common_mask();
    first_in_lanes_ = csg_lanes_kernel().first;
}

/// True if a leaf is so much larger than the solid that the rounding of its crossings, at most
/// 2^-48 of its size, is not small relative to the minimum distance of crossings.
bool CsgTruthTable::has_huge_leaf() const {
    constexpr double kHuge = 0x1p10;
    const std::vector<PrimitiveId>& leaves = solid_.expression().leaves;
    return std::any_of(leaves.begin(), leaves.end(), [&](PrimitiveId leaf) {
        const Vec3 size = solid_.table().box(static_cast<std::size_t>(leaf)).size();
        return !(max_component(size) <= kHuge * solid_.size());
    });
}

/// Sets the shape of a supported leaf in the frame of the solid; others stay unset.
void CsgTruthTable::set_shape(const Place& place, CsgLanesSolid::Leaf& leaf) const {
    with_column(solid_.table().columns, place.kind, [&](const auto& column) {
        using S = typename ShapeOfColumn<decltype(column)>::Type;
        const S& shape = column.shapes[place.index];
        if (column.placements[place.index] != kNoPlacement) return;
        if constexpr (std::is_same_v<S, Sphere>) {
            leaf.kind = CsgLanesSolid::Kind::Sphere;
            leaf.shape = &shape;
        } else if constexpr (std::is_same_v<S, BoxShape>) {
            leaf.kind = CsgLanesSolid::Kind::Box;
            leaf.shape = &shape;
        } else if constexpr (std::is_same_v<S, Cylinder> || std::is_same_v<S, Cone>) {
            if (!shape.capped || !csg_lanes_kernel().knows_frusta) return;
            leaf.kind = CsgLanesSolid::Kind::Frustum;
            leaf.shape = &shape.frustum;
        }
    });
}

/// Writes the crossings in ascending order; `hits` has space for kMaxShapeHits.
CsgTruthTable::Crossings CsgTruthTable::cross(std::uint32_t leaf, const CsgRay& ray, ShapeHit* hits,
                                              TraversalStats* stats) const {
    const PrimitiveTable& table = solid_.table();
    if (!table.is_seen(solid_.expression().leaves[leaf], ray.mask)) return {};
    const Place place = places_[leaf];
    const Crossings found = with_column(table.columns, place.kind, [&](const auto& column) {
        const auto& shape = column.shapes[place.index];
        const auto cross_in_frame = [&](const Ray& line) -> Crossings {
            if constexpr (requires { int{shape.intersect(line, hits)}; }) {
                return {shape.intersect(line, hits), inside_at_minus_infinity(shape, line)};
            } else {
                return {};  // excluded by fits()
            }
        };
        const std::uint32_t placement = column.placements[place.index];
        if (placement == kNoPlacement) return cross_in_frame(ray.line);
        return cross_in_frame(transformed(table.placements[placement].inner_from_outer, ray.line));
    });
    if (stats != nullptr) {
        ++stats->primitive_tests;
        stats->primitive_hits += found.count > 0;
    }
    return found;
}

/// Collects the crossings in the ray's range; false if the ray cannot hit the solid.
bool CsgTruthTable::gather(const CsgRay& ray, Events& events, TraversalStats* stats) const {
    const double last = ray.t_max + ray.tau;
    for (std::uint32_t i = 0; i < solid_.leaf_count(); ++i) {
        const std::uint32_t leaf = order_[i];
        // Bytes, to avoid initialisation for every ray.
        alignas(ShapeHit) std::byte bytes[kMaxShapeHits * sizeof(ShapeHit)];
        ShapeHit* const hits = reinterpret_cast<ShapeHit*>(bytes);
        const Crossings crossings = cross(leaf, ray, hits, stats);
        bool inside = crossings.inside;
        bool any = false;
        for (const ShapeHit& hit : std::span(hits, static_cast<std::size_t>(crossings.count))) {
            if (hit.t < ray.t_min) {
                inside = !inside;
            } else if (hit.t <= last) {
                any = true;
                events.add({hit.t, hit.u, hit.v, hit.part, leaf});
            }
        }
        if (!any && !inside && (needed_ >> leaf & 1) != 0) return false;
        events.inside |= LeafSet{inside} << leaf;
    }
    return true;
}

/// Advances to the next transition, like the event heap.
bool CsgTruthTable::next(const CsgRay& ray, Events& events, CsgCrossing& found) const {
    while (!events.at_end()) {
        const double t = events.front().t;
        if (t > ray.t_max) return false;
        const LeafSet before = events.inside;
        if (events.is_alone(t + ray.tau)) {
            // A single leaf that changes the solid changes all nodes in between.
            const CsgCrossing& crossing = events.pass();
            if (is_solid(events.inside) == is_solid(before)) continue;
            found = crossing;
            return true;
        }
        // The crossings at t alone must change the solid to begin a transition.
        CsgCrossing cluster[kMaxLeaves * kMaxShapeHits];
        std::size_t count = 0;
        while (!events.at_end() && events.front().t <= t) cluster[count++] = events.pass();
        if (is_solid(events.inside) == is_solid(before)) continue;
        const double end = t + ray.tau;
        while (!events.at_end() && events.front().t <= end) cluster[count++] = events.pass();
        if (is_solid(events.inside) == is_solid(before)) continue;
        bool any = false;
        for (std::size_t i = 0; i < count; ++i) {
            if (any && cluster[i].leaf > found.leaf) continue;
            if (!changes_all_the_way(cluster[i].leaf, before, events.inside)) continue;
            found = cluster[i];  // the last one of a leaf
            any = true;
        }
        if (any && found.t <= ray.t_max) return true;
    }
    return false;
}

bool CsgTruthTable::changes_all_the_way(std::uint32_t leaf, LeafSet before, LeafSet after) const {
    if (((before ^ after) >> leaf & 1) == 0) return false;
    std::uint32_t node = solid_.tree().leaves()[leaf].parent;
    for (; node != CsgTree::kNone; node = solid_.tree().nodes()[node].parent) {
        if (((tables_[node] >> before ^ tables_[node] >> after) & 1) == 0) return false;
    }
    return true;
}

std::uint32_t CsgTruthTable::filling_leaf(LeafSet inside) const {
    for (std::uint32_t leaf = 0; leaf < solid_.leaf_count(); ++leaf) {
        const CsgTree::Leaf& l = solid_.tree().leaves()[leaf];
        if ((inside >> leaf & 1) == 0 || l.complement) continue;
        std::uint32_t node = l.parent;
        while (node != CsgTree::kNone && (tables_[node] >> inside & 1) != 0) {
            node = solid_.tree().nodes()[node].parent;
        }
        if (node == CsgTree::kNone) return leaf;
    }
    return CsgTree::kNone;
}

void CsgTruthTable::fill(const CsgCrossing& crossing, Hit& hit) const {
    static_cast<ShapeHit&>(hit) = {crossing.t, crossing.u, crossing.v, crossing.part};
    hit.primitive = solid_.expression().leaves[crossing.leaf];
    hit.path.clear();
}

[[gnu::flatten]] bool CsgTruthTable::first(const CsgRay& ray, Hit& hit,
                                           TraversalStats* stats) const {
    Events events;
    CsgCrossing found{};
    if (!gather(ray, events, stats) || !next(ray, events, found)) return false;
    fill(found, hit);
    return true;
}

std::uint32_t CsgTruthTable::closest_of_lanes(const RayLanes& rays, std::uint32_t wanted,
                                              LaneHits& hits, RayQuery query) const {
    if ((lanes_.visible_to & query.mask) == 0) return closest_of_each(rays, wanted, hits, query);
    CsgLanesReport report;
    std::uint32_t hit = first_in_lanes_(lanes_, rays, wanted, hits, report);
    if (query.stats != nullptr) {
        query.stats->primitive_tests += report.tests;
        query.stats->primitive_hits += report.tests_met;
    }
    if (report.unsure != 0) hit |= closest_of_each(rays, report.unsure, hits, query);
    return hit;
}

std::uint32_t CsgTruthTable::closest_of_each(const RayLanes& rays, std::uint32_t wanted,
                                             LaneHits& hits, RayQuery query) const {
    std::uint32_t hit = 0;
    for_each_lane(wanted, [&](std::size_t lane) {
        Hit alone;
        if (!first(solid_.prepare(rays.ray(lane), query.mask), alone, query.stats)) return;
        hits.set(lane, alone);
        hit |= 1u << lane;
    });
    return hit;
}

bool CsgTruthTable::all(const CsgRay& ray, std::vector<Hit>& hits, TraversalStats* stats) const {
    Events events;
    if (!gather(ray, events, stats)) return false;
    const bool begins_inside = is_solid(events.inside);
    CsgCrossing found{};
    while (next(ray, events, found)) fill(found, hits.emplace_back());
    return begins_inside;
}

CsgSides CsgTruthTable::sides(const CsgRay& ray, double t) const {
    // All crossings of one transition lie within tau of it.
    CsgRay near = ray;
    near.t_min = t - 2.0 * ray.tau;
    near.t_max = t + 2.0 * ray.tau;
    Events events;
    CsgSides sides;
    if (!gather(near, events, nullptr)) return sides;
    sides.before = filling_leaf(events.inside);
    while (!events.at_end() && events.front().t <= near.t_max) events.pass();
    sides.after = filling_leaf(events.inside);
    return sides;
}

}  // namespace alhazen
