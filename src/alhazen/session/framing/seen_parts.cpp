#include "alhazen/session/framing/seen_parts.h"

#include <algorithm>
#include <cmath>
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

/// Shapes that are all of the patches of their tree.
template <class S>
constexpr bool kIsPatches = std::is_same_v<S, BezierPatch> || std::is_same_v<S, PatchMesh>;

bool is_patches(const PrimitiveTable& table, std::uint32_t kind) {
    return with_column(table.columns, kind,
                       []<class S>(const ShapeColumn<S>&) { return kIsPatches<S>; });
}

/// The farthest corner of the parts of patches. A part lies in the hull of its control points; the
/// part that reaches farthest is halved until it reaches no farther than the best corner.
std::optional<Vec3> farthest_of_patches(const PatchPieces& pieces, const Vec3& direction,
                                        double least) {
    // Reached only by patches that have nearly one height in much of their area.
    constexpr std::size_t kMostParts = 8000;
    constexpr double kPrecision = 1e-6;
    struct Candidate {
        double reach;
        std::size_t part;  ///< a piece or, after those, one of the halves
        bool operator<(const Candidate& other) const { return reach < other.reach; }
    };
    std::vector<BezierNet> halves;
    std::vector<Candidate> candidates;
    std::optional<Vec3> best;
    double lowest = kInfinity;
    const auto height = [&](const HomogeneousPoint& p) { return dot(direction, projected(p)); };
    const auto consider = [&](const BezierView& net, std::size_t part) {
        double reach = -kInfinity;
        for (int k = 0; k < net.count(); ++k) {
            reach = std::max(reach, height(net.points[k]));
            lowest = std::min(lowest, height(net.points[k]));
        }
        if (!(reach > least)) return;
        for (const int i : {0, net.degree_u}) {
            for (const int j : {0, net.degree_v}) {
                if (!(height(net.at(i, j)) > least)) continue;
                best = projected(net.at(i, j));
                least = height(net.at(i, j));
            }
        }
        if (!(reach > least)) return;
        candidates.push_back({reach, part});
        std::push_heap(candidates.begin(), candidates.end());
    };
    for (std::size_t k = 0; k < pieces.size(); ++k) consider(pieces.net(k), k);
    while (!candidates.empty() && halves.size() < kMostParts) {
        const auto [reach, part] = candidates.front();
        const double rounding = 1e-14 * std::max(std::abs(reach), std::abs(lowest));
        if (!(reach - least > kPrecision * (reach - lowest) + rounding)) break;
        std::pop_heap(candidates.begin(), candidates.end());
        candidates.pop_back();
        const BezierNet net =
            part < pieces.size() ? pieces[part].net : halves[part - pieces.size()];
        // Across the direction in which the height changes more.
        double along_u = 0, along_v = 0;
        for (int i = 0; i <= net.degree_u; ++i) {
            for (int j = 0; j <= net.degree_v; ++j) {
                const double here = height(net.at(i, j));
                if (i > 0) along_u = std::max(along_u, std::abs(here - height(net.at(i - 1, j))));
                if (j > 0) along_v = std::max(along_v, std::abs(here - height(net.at(i, j - 1))));
            }
        }
        const auto [low, high] = along_u > along_v ? halved_u(net) : halved_v(net);
        for (const BezierNet& half : {low, high}) {
            halves.push_back(half);
            consider(half, pieces.size() + halves.size() - 1);
        }
    }
    return best;
}

/// The farthest point of a shape of patches.
std::optional<Vec3> farthest_of_patches(const PrimitiveTable& table, std::uint32_t id,
                                        const Vec3& direction, double least) {
    const std::uint32_t kind = table.kind(PrimitiveId{id});
    return with_column(
        table.columns, kind, [&]<class S>(const ShapeColumn<S>& c) -> std::optional<Vec3> {
            if constexpr (kIsPatches<S>) {
                const std::uint32_t j = id - table.first(kind);
                const PatchPieces& pieces = c.shapes[j].tree->pieces();
                if (c.placements[j] == kNoPlacement) {
                    return farthest_of_patches(pieces, direction, least);
                }
                const Affine& m = table.placements[c.placements[j]].outer_from_inner;
                const auto inner = farthest_of_patches(pieces, transpose_times(m.linear, direction),
                                                       least - dot(direction, m.translation));
                if (inner) return m.point(*inner);
            }
            return {};
        });
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
        const Sort sort = has_tight_extent(table, kind) ? Sort::TightShape
                          : is_patches(table, kind)     ? Sort::Patches
                                                        : Sort::OtherShape;
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
        case Sort::Patches:
            return farthest_of_patches(table, part.first, direction, least);
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
