#include "alhazen/session/framing/seen_parts.h"

#include <algorithm>
#include <type_traits>

#include "alhazen/csg/solid_aggregate.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/unused_shear.h"
#include "alhazen/session/framing/outline_search.h"

namespace alhazen {

namespace {

constexpr RayMask kEyeRays = mask_of(RayKind::Eye);
/// Number of triangles per box.
constexpr std::uint32_t kTrianglesOfPart = 1024;

/// Shapes whose `extent` is exact up to rounding.
template <class S>
constexpr bool kHasTightExtent =
    std::is_same_v<S, Sphere> || std::is_same_v<S, Disc> || std::is_same_v<S, Rectangle> ||
    std::is_same_v<S, BoxShape> || std::is_same_v<S, Cylinder> || std::is_same_v<S, Cone> ||
    std::is_same_v<S, Polygon> || std::is_same_v<S, Polyhedron> || std::is_same_v<S, Ellipsoid> ||
    std::is_same_v<S, EllipticCylinder> || std::is_same_v<S, EllipticCone> ||
    std::is_same_v<S, Tgc> || std::is_same_v<S, Hyperboloid>;

bool has_tight_extent(const PrimitiveTable& table, std::uint32_t kind) {
    return with_column(table.columns, kind,
                       []<class S>(const ShapeColumn<S>&) { return kHasTightExtent<S>; });
}

/// The largest dot(direction, p) over the box.
double reach(const Box3& box, const Vec3& direction) {
    return dot(direction,
               {direction.x > 0 ? box.hi.x : box.lo.x, direction.y > 0 ? box.hi.y : box.lo.y,
                direction.z > 0 ? box.hi.z : box.lo.z});
}

/// The point of a convex shape that reaches its extent: the gradient of the extent.
Vec3 extreme_point(const PrimitiveTable& table, std::uint32_t id, const Box3& box,
                   const Vec3& direction, double height) {
    constexpr double kStep = 1e-6;
    const double scale = length(direction);
    Vec3 point;
    for (int k = 0; k < 3; ++k) {
        Vec3 turned = direction;
        turned[k] += kStep * scale;
        const double slope = (table.extent(id, turned).hi - height) / (turned[k] - direction[k]);
        point[k] = std::clamp(slope, box.lo[k], box.hi[k]);
    }
    const Vec3 unit = direction / scale;
    return point + (height / scale - dot(unit, point)) * unit;
}

}  // namespace

SeenParts::SeenParts(const Aggregate& aggregate) : root_(group_of(aggregate)) {}

void SeenParts::add(Part part, Group& group) {
    if (part.box.empty() || !part.box.bounded()) return;
    group.box.include(part.box);
    group.parts.push_back(part);
}

void SeenParts::add_triangles(const PrimitiveTable& table, Group& group) {
    const std::uint32_t first = table.first(kTriangleKind);
    const std::uint32_t triangles = table.first(kTriangleKind + 1) - first;
    for (std::uint32_t begin = 0; begin < triangles; begin += kTrianglesOfPart) {
        const std::uint32_t count = std::min(kTrianglesOfPart, triangles - begin);
        Box3 box;
        for (std::uint32_t i = begin; i < begin + count; ++i) {
            const Box3 own = table.box(first + i);
            if (own.empty() || !table.is_seen(PrimitiveId{first + i}, kEyeRays)) continue;
            for (const Vec3& corner : table.triangle_vertices(i)) box.include(corner);
        }
        add({box, begin, count, Sort::Triangles, nullptr}, group);
    }
}

const SeenParts::Group* SeenParts::group_of(const Aggregate& aggregate) {
    std::unique_ptr<Group>& known = groups_[&aggregate];
    if (known != nullptr) return known.get();
    known = std::make_unique<Group>();
    Group& group = *known;
    group.aggregate = &aggregate;
    if (dynamic_cast<const SolidAggregate*>(&aggregate) != nullptr) {
        add({aggregate.box(), 0, 1, Sort::Solid, nullptr}, group);
        return &group;
    }
    const PrimitiveTable& table = aggregate.primitives();
    for (std::uint32_t kind = 0; kind < kTriangleKind; ++kind) {
        const Sort sort = has_tight_extent(table, kind) ? Sort::TightShape : Sort::OtherShape;
        for (std::uint32_t i = table.first(kind); i < table.first(kind + 1); ++i) {
            if (table.is_seen(PrimitiveId{i}, kEyeRays)) {
                add({table.box(i), i, 1, sort, nullptr}, group);
            }
        }
    }
    add_triangles(table, group);
    for (std::uint32_t i = 0; i < table.instances.size(); ++i) {
        const Instance& instance = table.instances[i];
        if ((instance.visible_to & kEyeRays) == 0) continue;
        // Nesting is bounded: compile refuses more than kMaxInstanceDepth.
        const Group* inner = group_of(*instance.aggregate);
        if (inner->box.empty()) continue;
        const Box3 box = transformed(instance.placement.outer_from_inner, inner->box);
        add({box, i, 1, Sort::Instance, inner}, group);
    }
    return &group;
}

std::optional<Vec3> SeenParts::farthest(const Vec3& direction, double least) const {
    return farthest_of(*root_, direction, least);
}

std::optional<Vec3> SeenParts::farthest_of(const Group& group, const Vec3& direction,
                                           double least) {
    struct Candidate {
        double reach;
        const Part* part;
        bool operator<(const Candidate& other) const { return reach < other.reach; }
    };
    if (group.box.empty() || !(reach(group.box, direction) > least)) return {};
    std::vector<Candidate> candidates;
    for (const Part& part : group.parts) {
        const double bound = reach(part.box, direction);
        if (bound > least) candidates.push_back({bound, &part});
    }
    std::make_heap(candidates.begin(), candidates.end());
    std::optional<Vec3> best;
    while (!candidates.empty() && candidates.front().reach > least) {
        const Part& part = *candidates.front().part;
        std::pop_heap(candidates.begin(), candidates.end());
        candidates.pop_back();
        if (const auto point = farthest_of(group, part, direction, least)) {
            best = point;
            least = std::max(least, dot(direction, *point));
        }
    }
    return best;
}

std::optional<Vec3> SeenParts::farthest_of(const Group& group, const Part& part,
                                           const Vec3& direction, double least) {
    const Aggregate& aggregate = *group.aggregate;
    const PrimitiveTable& table = aggregate.primitives();
    std::optional<Vec3> best;
    switch (part.sort) {
        case Sort::TightShape: {
            const double height = table.extent(part.first, direction).hi;
            if (height > least) {
                best = extreme_point(table, part.first, part.box, direction, height);
            }
            break;
        }
        case Sort::Triangles:
            for (std::uint32_t i = part.first; i < part.first + part.count; ++i) {
                const std::uint32_t id = table.first(kTriangleKind) + i;
                for (const Vec3& corner : table.triangle_vertices(i)) {
                    const double height = dot(direction, corner);
                    if (!(height > least) || table.box(id).empty() ||
                        !table.is_seen(PrimitiveId{id}, kEyeRays)) {
                        continue;
                    }
                    best = corner;
                    least = height;
                }
            }
            break;
        case Sort::Instance: {
            const Affine& to_outer = table.instances[part.first].placement.outer_from_inner;
            // dot(direction, M x + t) = dot(M^T direction, x) + dot(direction, t)
            const auto inner = farthest_of(*part.inner, transpose_times(to_outer.linear, direction),
                                           least - dot(direction, to_outer.translation));
            if (inner) best = to_outer.point(*inner);
            break;
        }
        case Sort::OtherShape:
            return OutlineSearch(part.box, direction,
                                 [&](const Ray& ray) {
                                     Hit hit;
                                     Ray shrinking = ray;
                                     table.closest(PrimitiveId{part.first}, shrinking, kUnusedShear,
                                                   hit, NoStats{}, kEyeRays);
                                     return hit.found() ? std::optional(hit.t) : std::nullopt;
                                 })
                .farthest(least);
        case Sort::Solid:
            return OutlineSearch(
                       part.box, direction,
                       [&](const Ray& ray) {
                           Hit hit;
                           const bool found = aggregate.closest(ray, hit, {nullptr, kEyeRays});
                           return found ? std::optional(hit.t) : std::nullopt;
                       })
                .farthest(least);
    }
    return best;
}

}  // namespace alhazen
