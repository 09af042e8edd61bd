#include "alhazen/solids/isolated_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/solids/stratified_chords.h"

namespace alhazen {

namespace {

/// Extents of more parts would take longer than the lines they save.
constexpr std::size_t kMostParts = 4096;
/// Instanced solids beyond this many leaves count as one leaf each: nested ones can have billions.
constexpr std::size_t kMostNestedParts = 65536;

/// Copies a shape of a table into a separate table; returns its placement there.
Placement take_shape(const PrimitiveTable& from, PrimitiveId id, PrimitiveTable& alone) {
    Placement placement;
    const std::uint32_t kind = from.kind(id);
    const std::uint32_t index = from.index(id);
    std::uint32_t k = 0;
    const auto take = [&](const auto& column, auto& own) {
        if (k++ != kind) return;
        own.shapes.push_back(column.shapes[index]);
        own.placements.push_back(kNoPlacement);
        own.materials.push_back(MaterialId{0});
        if (column.placements[index] != kNoPlacement) {
            placement = from.placements[column.placements[index]];
        }
    };
    std::apply(
        [&](const auto&... column) {
            (take(column, std::get<std::remove_cvref_t<decltype(column)>>(alone.columns)), ...);
        },
        from.columns);
    return placement;
}

/// The largest distance by which crossings may lie outside of patches of the table, in its frame.
double reach_of_patches(const PrimitiveTable& table) {
    double reach = 0;
    const auto widen = [&](const auto& column) {
        for (std::size_t i = 0; i < column.shapes.size(); ++i) {
            if constexpr (requires { column.shapes[i].tree->reach(); }) {
                double scale = 1;
                if (column.placements[i] != kNoPlacement) {
                    scale = stretch_bound(
                        table.placements[column.placements[i]].outer_from_inner.linear);
                }
                reach = std::max(reach, scale * column.shapes[i].tree->reach());
            }
        }
    };
    std::apply([&](const auto&... column) { (widen(column), ...); }, table.columns);
    return reach;
}

Ray whole_line(const Affine& inner_from_outer, const Ray& ray) {
    Ray line = transformed(inner_from_outer, ray);
    line.t_min = -kInfinity;
    line.t_max = kInfinity;
    return line;
}

Box3 common_box(const Box3& a, const Box3& b) {
    Box3 both;
    for (int k = 0; k < 3; ++k) {
        both.lo[k] = std::max(a.lo[k], b.lo[k]);
        both.hi[k] = std::min(a.hi[k], b.hi[k]);
    }
    return both;
}

double largest_coordinate(const Box3& box) {
    return std::max(max_component(abs(box.lo)), max_component(abs(box.hi)));
}

/// Bound of the coordinates of m p for |p| <= `p`, without cancellation.
Vec3 magnitude_of(const Affine& m, const Vec3& p) {
    return p.x * abs(m.linear.x_axis) + p.y * abs(m.linear.y_axis) + p.z * abs(m.linear.z_axis) +
           abs(m.translation);
}

}  // namespace

IsolatedSolid::IsolatedSolid(const SolidList& solids, SolidId id)
    : place_(solids.place(id)), world_(place_.world) {
    const PrimitiveTable& table = place_.aggregate->primitives();
    if (place_.kind == SolidPlace::Kind::Csg) {
        aggregate_ = place_.aggregate;
        csg_ = dynamic_cast<const SolidAggregate*>(aggregate_.get());
    } else {
        PrimitiveTable alone;
        alone.material_opacity = {Opacity::Opaque};
        const char* accelerator = "list";
        if (place_.kind == SolidPlace::Kind::Shape) {
            const Placement own = take_shape(table, place_.shape, alone);
            world_ = {world_.outer_from_inner * own.outer_from_inner,
                      own.inner_from_outer * world_.inner_from_outer};
        } else if (table.size() == table.meshes[place_.mesh].mesh->triangles.size() &&
                   table.meshes[place_.mesh].visible_to == kAllRays) {
            aggregate_ = place_.aggregate;
        } else {
            PlacedMesh mesh = table.meshes[place_.mesh];
            mesh.material = MaterialId{0};
            mesh.visible_to = kAllRays;
            alone.meshes.push_back(std::move(mesh));
            accelerator = kDefaultAccelerator;
        }
        if (!aggregate_) {
            alone.finish();
            aggregate_ = make_aggregate(accelerator, std::move(alone), {});
        }
    }
    if (const auto* csg = dynamic_cast<const CsgAggregate*>(aggregate_.get())) {
        has_walls_ = csg->solid().has_media();
    }
    box_ = transformed(world_.outer_from_inner, aggregate_->box());
}

double Measurable::magnitude() const {
    return largest_coordinate(box());
}

double IsolatedSolid::magnitude() const {
    const Box3 box = aggregate_->box();
    Vec3 inner;
    for (int k = 0; k < 3; ++k) inner[k] = std::max(std::abs(box.lo[k]), std::abs(box.hi[k]));
    if (csg_ != nullptr) {
        const PrimitiveTable& table = aggregate_->primitives();
        for (std::size_t i = 0; i < table.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                Vec3 axis;
                axis[k] = 1;
                const Interval extent = table.extent(i, axis);
                for (const double end : {std::abs(extent.lo), std::abs(extent.hi)}) {
                    if (std::isfinite(end)) inner[k] = std::max(inner[k], end);
                }
            }
        }
    }
    // Lines are transformed into the frame of the solid and back: bounds the numbers on the way.
    const Affine& out = world_.outer_from_inner;
    const Affine& in = world_.inner_from_outer;
    const Vec3 world = magnitude_of(out, inner);
    // Lines fill a box that exceeds the patches by their reach on either side.
    const double reach = stretch_bound(out.linear) * reach_of_patches(aggregate_->primitives());
    return max_component(magnitude_of(out, magnitude_of(in, world))) + 2 * reach / kRounding;
}

Interval IsolatedSolid::extent(const Vec3& axis) const {
    const Affine& m = world_.outer_from_inner;
    const Vec3 inner_axis = transpose_times(m.linear, axis);
    const PrimitiveTable& table = aggregate_->primitives();
    Interval inner;
    if (csg_ != nullptr) {
        inner = alhazen::extent(aggregate_->box(), inner_axis);
    } else {
        for (std::size_t i = 0; i < table.size(); ++i) {
            inner = hull(inner, table.extent(i, inner_axis));
        }
    }
    const double shift = dot(axis, m.translation);
    const double pad = 4e-15 * (dot(abs(axis), abs(m.translation)) +
                                std::max(std::abs(inner.lo), std::abs(inner.hi)));
    const Interval own{inner.lo + shift - pad, inner.hi + shift + pad};
    return intersection(own, alhazen::extent(box_, axis));
}

void IsolatedSolid::part_extents(const Vec3& axis, std::vector<Interval>& parts) const {
    const PrimitiveTable& table = aggregate_->primitives();
    const auto* csg = dynamic_cast<const CsgAggregate*>(csg_);
    if (table.size() > kMostParts || (csg == nullptr && csg_ != nullptr)) {
        return Measurable::part_extents(axis, parts);
    }
    const Affine& m = world_.outer_from_inner;
    const Vec3 inner_axis = transpose_times(m.linear, axis);
    const double shift = dot(axis, m.translation);
    const double rounding = 4e-15 * dot(abs(axis), abs(m.translation));
    const Interval whole = extent(axis);
    const auto add = [&](const Interval& inner, double beyond) {
        const double pad =
            beyond + rounding + 4e-15 * std::max(std::abs(inner.lo), std::abs(inner.hi));
        parts.push_back(
            intersection(Interval{inner.lo + shift - pad, inner.hi + shift + pad}, whole));
    };
    if (csg == nullptr) {
        for (std::size_t i = 0; i < table.size(); ++i) add(table.extent(i, inner_axis), 0.0);
        return;
    }
    // The solid is bounded: where it is, at least one leaf that is not complemented is.
    const CsgSolid& solid = csg->solid();
    const double beyond = 8 * solid.tolerance() * length(inner_axis);
    for (std::uint32_t leaf = 0; leaf < solid.leaf_count(); ++leaf) {
        const Box3& bound = solid.tree().bounds()[leaf];
        if (solid.tree().leaves()[leaf].complement || bound.empty()) continue;
        const auto primitive = static_cast<std::size_t>(solid.expression().leaves[leaf]);
        add(intersection(table.extent(primitive, inner_axis), alhazen::extent(bound, inner_axis)),
            beyond);
    }
}

namespace {

/// Perpendicular unit vectors, turned about each other while that makes the box smaller that holds
/// a body between its `extent` along them: Jacobi's rotations of the form that gives the squares of
/// the widths.
template <class Extent>
void turn_to_body(std::array<Vec3, 3>& axes, const Extent& extent) {
    const auto square = [&](const Vec3& axis) {
        const Interval range = extent(axis);
        const double width = std::max(0.0, range.hi - range.lo);
        return width * width;
    };
    constexpr int kSweeps = 4;
    for (int round = 0; round < 3 * kSweeps; ++round) {
        Vec3 &u = axes[static_cast<std::size_t>(round % 3)],
             &v = axes[static_cast<std::size_t>((round + 1) % 3)];
        const double half = std::sqrt(0.5), of_u = square(u), of_v = square(v);
        const double mixed = square(half * (u + v)) - square(half * (u - v));
        const double angle = 0.5 * std::atan2(mixed, of_u - of_v);
        const double c = std::cos(angle), s = std::sin(angle);
        const Vec3 next_u = c * u + s * v, next_v = c * v - s * u;
        if (!(square(next_u) * square(next_v) < (1 - 1e-9) * of_u * of_v)) continue;
        u = next_u, v = next_v;
    }
}

/// Perpendicular unit vectors, the first two in the plane of a frame's first two axes.
std::array<Vec3, 3> axes_of(const Affine& frame) {
    const Vec3 x = unit_or(frame.linear.x_axis, {1, 0, 0});
    const Vec3 y = frame.linear.y_axis - dot(frame.linear.y_axis, x) * x;
    const Vec3 own = unit_or(y, perpendicular(x));
    return {x, own, cross(x, own)};
}

/// Appends the leaves of an aggregate within a box of the world.
void append_leaves(const Aggregate& aggregate, const Affine& outer, const Box3& within,
                   std::vector<IsolatedSolid::SurfacePart>& parts) {
    const auto* csg = dynamic_cast<const CsgAggregate*>(&aggregate);
    const PrimitiveTable& table = aggregate.primitives();
    const auto append = [&](const Affine& frame, const Box3& box, const auto& inner_extent) {
        const auto extent = [&](const Vec3& axis) {
            const Interval inner = inner_extent(transpose_times(outer.linear, axis));
            const double shift = dot(axis, outer.translation);
            return intersection(Interval{inner.lo + shift, inner.hi + shift},
                                alhazen::extent(box, axis));
        };
        IsolatedSolid::SurfacePart part{axes_of(frame), {}, box};
        turn_to_body(part.axes, extent);
        for (int k = 0; k < 3; ++k) {
            const Interval range = extent(part.axes[static_cast<std::size_t>(k)]);
            part.own.lo[k] = range.lo;
            part.own.hi[k] = range.hi;
        }
        parts.push_back(part);
    };
    const auto append_primitive = [&](std::size_t i, const Box3& box) {
        const Placement* own = table.placement_of(PrimitiveId(i));
        append(own == nullptr ? outer : outer * own->outer_from_inner, box,
               [&](const Vec3& axis) { return table.extent(i, axis); });
    };
    if (csg == nullptr && table.size() == 1) return append_primitive(0, within);
    if (csg == nullptr) {
        const Box3 box = aggregate.box();
        return append(outer, within, [&](const Vec3& axis) { return alhazen::extent(box, axis); });
    }
    const CsgSolid& solid = csg->solid();
    for (std::uint32_t leaf = 0; leaf < solid.leaf_count(); ++leaf) {
        const Box3 inner = common_box(solid.leaf_box(leaf), solid.tree().bounds()[leaf]);
        if (inner.empty()) continue;
        const Box3 box = common_box(transformed(outer, inner), within);
        if (box.empty()) continue;
        const PrimitiveId id = solid.expression().leaves[leaf];
        if (table.kind(id) == kInstanceKind && parts.size() < kMostNestedParts) {
            const Instance& instance = table.instances[table.index(id)];
            append_leaves(*instance.aggregate, outer * instance.placement.outer_from_inner, box,
                          parts);
        } else {
            append_primitive(static_cast<std::size_t>(id), box);
        }
    }
}

}  // namespace

std::vector<IsolatedSolid::SurfacePart> IsolatedSolid::surface_parts() const {
    std::vector<SurfacePart> parts;
    append_leaves(*aggregate_, world_.outer_from_inner, box_, parts);
    return parts;
}

namespace {

/// Removes surfaces between media inside a solid (an exit and an entry at the same place), which
/// are not part of its surface.
void drop_walls(std::vector<Hit>& hits) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const bool wall = kept % 2 == 0 && kept > 0 && hits[i].t == hits[kept - 1].t;
        if (wall) {
            --kept;
        } else {
            if (kept != i) hits[kept] = hits[i];
            ++kept;
        }
    }
    hits.resize(kept);
}

}  // namespace

void IsolatedSolid::cross(const Ray& ray, bool want_cosines, LineSpans& found) const {
    const Ray line = whole_line(world_.inner_from_outer, ray);
    found.hits.clear();
    found.spans.clear();
    found.cosines = 0;
    aggregate_->all_hits(line, found.hits, nullptr);
    found.consistent = found.hits.size() % 2 == 0;
    if (!found.consistent) return;
    if (has_walls_) drop_walls(found.hits);
    for (std::size_t i = 0; i < found.hits.size(); i += 2) {
        const Interval span{found.hits[i].t, found.hits[i + 1].t};
        if (span.lo < span.hi) found.spans.push_back(span);
    }
    if (!want_cosines) return;
    const double along = length(ray.direction);
    for (const Hit& hit : found.hits) {
        const Vec3 inner = surface_at(*aggregate_, line, hit).normal;
        const Vec3 normal = normalize(transpose_times(world_.inner_from_outer.linear, inner));
        found.cosines += std::abs(dot(normal, ray.direction)) / along;
    }
}

void IsolatedSolid::crossings(const Ray& ray, std::vector<SurfacePoint>& found,
                              std::vector<Hit>* hits) const {
    const Ray inner = transformed(world_.inner_from_outer, ray);
    std::vector<Hit> own;
    aggregate_->all_hits(inner, own, nullptr);
    const Mat3& m = world_.outer_from_inner.linear;
    if (hits != nullptr) hits->insert(hits->end(), own.begin(), own.end());
    for (const Hit& hit : own) {
        const Surface s = surface_at(*aggregate_, inner, hit);
        const Vec3 error =
            s.error.x * abs(m.x_axis) + s.error.y * abs(m.y_axis) + s.error.z * abs(m.z_axis);
        found.push_back({hit.t, world_.outer_from_inner.point(s.point),
                         normalize(transpose_times(world_.inner_from_outer.linear, s.normal)),
                         error, s.materials[0]});
    }
}

void IsolatedSolid::hits(const Ray& ray, std::vector<Hit>& found) const {
    aggregate_->all_hits(transformed(world_.inner_from_outer, ray), found, nullptr);
}

IsolatedSolid::Coordinates IsolatedSolid::coordinates(const Vec3& near, const Hit& hit) const {
    Hit there = hit;
    there.t = 0.0;
    const Ray ray{world_.inner_from_outer.point(near), {0, 0, 1}};
    const Surface s = surface_at(*aggregate_, ray, there);
    const Affine& outer = world_.outer_from_inner;
    return {s.uv, outer.point(s.point), outer.vector(s.dpdu), outer.vector(s.dpdv)};
}

namespace {

/// The boxes of the parts of a solid, in the order of `part_extents`.
std::vector<Box3> part_boxes(const IsolatedSolid& solid) {
    std::vector<Box3> boxes;
    for (int k = 0; k < 3; ++k) {
        Vec3 axis{0, 0, 0};
        axis[k] = 1;
        std::vector<Interval> ranges;
        solid.part_extents(axis, ranges);
        boxes.resize(ranges.size());
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            boxes[i].lo[k] = ranges[i].lo;
            boxes[i].hi[k] = ranges[i].hi;
        }
    }
    return boxes;
}

}  // namespace

Overlap::Overlap(const IsolatedSolid& a, const IsolatedSolid& b)
    : a_(a), b_(b), box_(common_box(a.box(), b.box())) {
    if (box_.empty() || !box_.bounded()) return;
    const std::vector<Box3> of_a = part_boxes(a), of_b = part_boxes(b);
    if (of_a.size() * of_b.size() == 1) return;
    constexpr std::size_t kMostTests = std::size_t{1} << 24;
    if (of_a.size() * of_b.size() > kMostTests) return;
    Box3 hull;
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
        for (std::uint32_t k = 0; k < of_b.size(); ++k) {
            const Box3 both = common_box(of_a[i], of_b[k]);
            if (both.empty()) continue;
            if (pairs_.size() == kMostParts) {
                pairs_.clear();
                return;
            }
            pairs_.push_back({i, k});
            hull.include(both);
        }
    }
    box_ = common_box(box_, hull);
}

void Overlap::part_extents(const Vec3& axis, std::vector<Interval>& parts) const {
    if (pairs_.empty()) return Measurable::part_extents(axis, parts);
    std::vector<Interval> of_a, of_b;
    a_.part_extents(axis, of_a);
    b_.part_extents(axis, of_b);
    const Interval whole = extent(axis);
    for (const auto& [i, k] : pairs_) {
        const Interval both = intersection(intersection(of_a[i], of_b[k]), whole);
        // Parts that are apart along this axis alone overlap nowhere.
        parts.push_back(both.empty() ? Interval{whole.lo, whole.lo} : both);
    }
}

double Overlap::magnitude() const {
    return std::max(a_.magnitude(), b_.magnitude());
}

Interval Overlap::extent(const Vec3& axis) const {
    return intersection(intersection(a_.extent(axis), b_.extent(axis)),
                        alhazen::extent(box_, axis));
}

void Overlap::cross(const Ray& line, bool, LineSpans& found) const {
    b_.cross(line, false, found);
    if (!found.consistent) return;
    std::swap(found.others, found.spans);
    if (found.others.empty()) {
        found.spans.clear();
        return;
    }
    a_.cross(line, false, found);
    if (!found.consistent) return;
    // Both lists ascend: the span that ends first cannot overlap later spans of the other list.
    std::vector<Interval>& shared = found.spans;
    const std::vector<Interval> a = shared;
    shared.clear();
    for (std::size_t i = 0, k = 0; i < a.size() && k < found.others.size();) {
        const Interval both = intersection(a[i], found.others[k]);
        if (both.lo < both.hi) shared.push_back(both);
        if (a[i].hi < found.others[k].hi) {
            ++i;
        } else {
            ++k;
        }
    }
}

}  // namespace alhazen
