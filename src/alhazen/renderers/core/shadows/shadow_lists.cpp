#include "alhazen/renderers/core/shadows/shadow_lists.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/base/overloaded.h"
#include "alhazen/primitives/bounded_primitives.h"
#include "alhazen/primitives/primitive_columns.h"

namespace alhazen {

namespace {

/// A list looks at all primitives of the outermost aggregate.
constexpr std::size_t kMostPrimitives = 256;
constexpr std::size_t kMostLights = 16;
/// Cells along the edges of cubes and squares.
constexpr int kResolution = 64;
constexpr auto kSide = static_cast<std::size_t>(kResolution);

/// How far a ray may pass its light, in units of the largest coordinate. Bodies are larger by the
/// room, so that the ray that ends exactly at the light meets them where the true one does.
constexpr double kDeviation = 1e-10, kRoom = 1e-5;
/// Widens cells: far more than their rounding.
constexpr double kSlack = 1e-9;
/// Lights and origins farther away, in units of the largest coordinate of the bodies, round too
/// much.
constexpr double kFarthest = 16;
/// Of heights above flat bodies, in the units of Body::rounded.
constexpr double kHeightSlack = 64 * 0x1p-53;

const DirectionCube kCube(kResolution);

/// The unit normal of a flat shape in its own frame; zero of others.
Vec3 own_normal_of(const PrimitiveTable& table, std::uint32_t kind, std::uint32_t i) {
    return with_column(table.columns, kind, [&](const auto& column) {
        using S = std::remove_cvref_t<decltype(column.shapes[i])>;
        if constexpr (requires(const S& s) { s.unit_normal; }) {
            return column.shapes[i].unit_normal;
        } else if constexpr (std::is_same_v<S, Polygon>) {
            return column.shapes[i].normal;
        } else {
            return Vec3{};
        }
    });
}

/// Whether all coordinates are within `most` of 0; not where one is not a number.
bool is_within(const Vec3& v, double most) {
    return std::abs(v.x) <= most && std::abs(v.y) <= most && std::abs(v.z) <= most;
}

/// DirectionCube::cell_of, up to rounding.
std::size_t cell_of(const Vec3& d) {
    const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
    const auto index = [](double slope) {
        const int i = static_cast<int>(0.5 * (slope + 1.0) * kResolution);
        return static_cast<std::size_t>(i < kResolution ? i : kResolution - 1);
    };
    const auto number = [&](std::size_t axis, double depth, double u, double v) {
        const std::size_t face = 2 * axis + (depth > 0.0 ? 0 : 1);
        const double inverse = 1.0 / std::abs(depth);
        return (face * kSide + index(v * inverse)) * kSide + index(u * inverse);
    };
    if (x >= y && x >= z) return number(0, d.x, d.y, d.z);
    return y >= z ? number(1, d.y, d.z, d.x) : number(2, d.z, d.x, d.y);
}

double largest(const Vec3& v) {
    return max_component(abs(v));
}

/// The column and row of a cell of a face or a square.
std::array<int, 2> place_in_square(std::size_t cell) {
    return {static_cast<int>(cell % kSide), static_cast<int>(cell / kSide % kSide)};
}

}  // namespace

std::unique_ptr<ShadowLists> ShadowLists::make(const Scene& scene) {
    const bool suits = scene.aggregate != nullptr && scene.accelerator == "wide_bvh" &&
                       !scene.has_motion && scene.lights.size() <= kMostLights &&
                       scene.aggregate->primitives().size() <= kMostPrimitives;
    if (!suits) return nullptr;
    std::unique_ptr<ShadowLists> lists(new ShadowLists(scene));
    return lists->size_ > 0.0 ? std::move(lists) : nullptr;
}

ShadowLists::ShadowLists(const Scene& scene)
    : table_(scene.aggregate->primitives()), lights_(scene.lights.size()) {
    const BoundedPrimitives bounded(table_);
    outside_ = UnboundedParts(table_, bounded.unbounded());
    for (std::size_t i = 0; i < bounded.size(); ++i) add_body(bounded.id(i));
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        Cells& cells = lights_[i];
        std::visit(Overloaded{[](const AmbientLight&) {},
                              [&](const DirectionalLight& l) {
                                  cells.parallel = true;
                                  cells.place = l.to_light;
                              },
                              [&](const AreaLight& l) { cells.place = l.surface->center(); },
                              [&](const auto& l) { cells.place = l.position; }},
                   scene.lights[i]);
    }
    const double of_bodies = size_;
    for (const Cells& cells : lights_) {
        const double farthest = cells.parallel ? 0.0 : largest(cells.place);
        size_ = std::max(size_, farthest);
        if (!(farthest <= kFarthest * of_bodies)) {
            size_ = 0.0;
            return;
        }
    }
    room_ = kRoom * size_;
}

void ShadowLists::add_body(std::uint32_t id) {
    Body body{.id = PrimitiveId{id}, .box = table_.box(id)};
    if (body.box.empty()) return;
    const BoundingSphere sphere = table_.sphere(id);
    body.center = sphere.center;
    body.radius = sphere.radius;
    body.opaque = table_.is_opaque(body.id);
    body.triangle = table_.kind(body.id) == kTriangleKind;
    if (table_.kind(body.id) == column_of<Sphere>() && table_.placement_of(body.id) == nullptr) {
        body.sphere = &std::get<ShapeColumn<Sphere>>(table_.columns).shapes[table_.index(body.id)];
    }
    set_flat(body);
    size_ = std::max(
        {size_, largest(body.box.lo), largest(body.box.hi), largest(body.center) + body.radius});
    bodies_.push_back(body);
}

void ShadowLists::set_flat(Body& body) const {
    const std::uint32_t kind = table_.kind(body.id);
    if (kind >= kTriangleKind) return;
    const Vec3 own = own_normal_of(table_, kind, table_.index(body.id));
    if (own == Vec3{}) return;
    const Placement* placement = table_.placement_of(body.id);
    const Affine inner = placement != nullptr ? placement->inner_from_outer : Affine{};
    const Vec3 normal = transpose_times(inner.linear, own);
    const double scale = length(normal);
    if (!(scale > 0.0)) return;
    body.flat = true;
    body.normal = normal / scale;
    body.height = table_.extent(static_cast<std::uint32_t>(body.id), body.normal);
    const Box3 box = table_.inner_box(body.id);
    const Mat3& m = inner.linear;
    const Mat3 absolute{abs(m.x_axis), abs(m.y_axis), abs(m.z_axis)};
    body.rounded = transpose_times(absolute, abs(own)) / scale + abs(body.normal);
    body.rounded_offset =
        dot(abs(own), abs(inner.translation) + abs(box.lo) + abs(box.hi)) / scale +
        std::max(std::abs(body.height.lo), std::abs(body.height.hi));
}

bool ShadowLists::may_meet(const Body& body, const Ray& ray) const {
    if (body.flat) {
        const double start = dot(body.normal, ray.origin);
        const double slope = dot(body.normal, ray.direction);
        const double above = start - body.height.hi, below = body.height.lo - start;
        const double slack =
            kHeightSlack * (dot(body.rounded, abs(ray.origin)) + body.rounded_offset);
        const double least_slope =
            kHeightSlack * (body.rounded.x + body.rounded.y + body.rounded.z);
        if (above > slack) return !(slope > least_slope || above + ray.t_max * slope > room_);
        if (below > slack) return !(slope < -least_slope || below - ray.t_max * slope > room_);
        return true;
    }
    const Vec3 to_center = body.center - ray.origin;
    const double along = dot(to_center, ray.direction);
    const double squared = length_squared(to_center);
    const double radius = body.radius + room_;
    // NaN is not passed over.
    return !(squared > radius * radius &&
             (along < 0.0 || squared - along * along > radius * radius));
}

std::optional<bool> ShadowLists::shadowed(const Ray& ray, std::size_t light, RayMask mask,
                                          std::vector<Hit>& crossings) {
    double reach = 0;
    const List* list = list_of(ray, light, reach);
    if (list == nullptr) return std::nullopt;
    if (outside_.shadowed(table_, ray, crossings, {nullptr, mask})) return true;
    for (const Entry& entry : *list) {
        const Body& body = bodies_[entry.body];
        if (entry.least_reach > reach || !may_meet(body, ray)) continue;
        if (shadowed_by(body, ray, mask, crossings)) return true;
    }
    if (crossings.size() > 1) sort_appended(crossings, 0);
    return false;
}

bool ShadowLists::occluded_by(const Body& body, const Ray& ray, RayMask mask) const {
    if (body.sphere != nullptr) {
        ShapeHit hits[Sphere::kMaxHits];
        return table_.is_seen(body.id, mask) && body.sphere->intersect(ray, hits) > 0;
    }
    if (body.triangle) {
        return table_.occluded(body.id, ray, RayShear(ray.direction), NoStats{}, mask);
    }
    return table_.occluded(body.id, ray, kUnusedShear, NoStats{}, mask);
}

bool ShadowLists::shadowed_by(const Body& body, const Ray& ray, RayMask mask,
                              std::vector<Hit>& crossings) const {
    if (body.opaque) return occluded_by(body, ray, mask);
    if (body.sphere != nullptr) {
        if (!table_.is_seen(body.id, mask)) return false;
        ShapeHit hits[Sphere::kMaxHits];
        const int count = body.sphere->intersect(ray, hits);
        for (int i = 0; i < count; ++i) append_hit(crossings, hits[i], body.id);
        return false;
    }
    if (body.triangle) {
        return table_.shadowed(body.id, ray, RayShear(ray.direction), crossings, NoStats{}, mask);
    }
    return table_.shadowed(body.id, ray, kUnusedShear, crossings, NoStats{}, mask);
}

const ShadowLists::List* ShadowLists::list_of(const Ray& ray, std::size_t light, double& reach) {
    Cells& cells = lights_[light];
    if (cells.parallel) {
        if (!is_within(ray.origin, kFarthest * size_) ||
            !is_within(ray.direction - cells.place, kDeviation)) {
            return nullptr;
        }
        if (cells.number.empty()) begin(cells);
        reach = -dot(ray.origin, cells.place);
        const double column = (dot(ray.origin, cells.u) - cells.corner.x) / cells.edge;
        const double row = (dot(ray.origin, cells.v) - cells.corner.y) / cells.edge;
        if (!(column >= 0.0 && column < kResolution && row >= 0.0 && row < kResolution)) {
            return &nothing_;
        }
        return list_in(cells,
                       static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column));
    }
    const Vec3 beside = (cells.place - ray.origin) - ray.t_max * ray.direction;
    if (!is_within(beside, kDeviation * size_) || !(ray.t_max <= kFarthest * size_)) return nullptr;
    if (cells.number.empty()) begin(cells);
    reach = ray.t_max;
    return list_in(cells, cell_of(-ray.direction));
}

const ShadowLists::List* ShadowLists::list_in(Cells& cells, std::size_t cell) {
    std::uint32_t& number = cells.number[cell];
    if (number == 0) {
        number = static_cast<std::uint32_t>(lists_.size());
        // What blocks light is tested first.
        List list = cells.parallel ? list_of_square(cells, cell) : list_of_directions(cells, cell);
        std::stable_partition(list.begin(), list.end(),
                              [&](const Entry& e) { return bodies_[e.body].opaque; });
        lists_.push_back(std::make_unique<const List>(std::move(list)));
    }
    return lists_[number].get();
}

void ShadowLists::begin(Cells& cells) const {
    if (cells.parallel) {
        begin_square(cells);
    } else {
        begin_point(cells);
    }
}

void ShadowLists::begin_point(Cells& cells) const {
    cells.number.assign(kCube.size(), 0);
    const Vec3 wider{room_, room_, room_};
    for (const Body& body : bodies_) {
        Seen& seen = cells.seen.emplace_back();
        seen.distance = length(body.center - cells.place);
        const double radius = body.radius + room_;
        seen.around = !(seen.distance > radius);
        if (seen.around) continue;
        seen.sine = radius / seen.distance;
        seen.cosine = std::sqrt(1.0 - seen.sine * seen.sine);
        const Box3 box{body.box.lo - cells.place - wider, body.box.hi - cells.place + wider};
        for (int face = 0; face < 6; ++face) {
            seen.slopes[static_cast<std::size_t>(face)] = DirectionWindows::slopes_of(box, face);
        }
    }
}

void ShadowLists::begin_square(Cells& cells) const {
    cells.number.assign(kSide * kSide, 0);
    cells.u = perpendicular(cells.place);
    cells.v = cross(cells.place, cells.u);
    Interval across[2];
    for (const Body& body : bodies_) {
        const Vec2 middle{dot(body.center, cells.u), dot(body.center, cells.v)};
        const double radius = body.radius + room_;
        across[0].include(middle.x - radius);
        across[0].include(middle.x + radius);
        across[1].include(middle.y - radius);
        across[1].include(middle.y + radius);
        cells.middles.push_back(middle);
    }
    if (bodies_.empty()) return;
    cells.corner = {across[0].lo, across[1].lo};
    cells.edge = std::max({across[0].width(), across[1].width(), kRoom}) / kResolution;
}

ShadowLists::List ShadowLists::list_of_directions(const Cells& cells, std::size_t cell) const {
    const auto face = static_cast<int>(cell / (kSide * kSide));
    const auto [column, row] = place_in_square(cell);
    const Interval u{kCube.bound(column) - kSlack, kCube.bound(column + 1) + kSlack};
    const Interval v{kCube.bound(row) - kSlack, kCube.bound(row + 1) + kSlack};
    // The cone of the cell.
    const Vec3 axis =
        normalize(DirectionCube::direction(face, 0.5 * (u.lo + u.hi), 0.5 * (v.lo + v.hi)));
    double cosine = 1.0;
    for (const Vec3& corner : kCube.corners(face, column, row)) {
        cosine = std::min(cosine, dot(axis, corner) / length(corner));
    }
    cosine = std::max(0.0, cosine - kSlack);
    const double sine = std::sqrt(1.0 - cosine * cosine);

    List list;
    for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
        const Seen& seen = cells.seen[i];
        const Body& body = bodies_[i];
        if (!seen.around) {
            // cos(a + b) of half the angles of the cone and of the sphere.
            const double least = cosine * seen.cosine - sine * seen.sine - kSlack;
            if (dot(axis, body.center - cells.place) < seen.distance * least) continue;
            const auto& slopes = seen.slopes[static_cast<std::size_t>(face)];
            if (!slopes || intersection((*slopes)[0], u).empty() ||
                intersection((*slopes)[1], v).empty()) {
                continue;
            }
        }
        list.push_back({i, seen.distance - body.radius - 2 * room_});
    }
    return list;
}

ShadowLists::List ShadowLists::list_of_square(const Cells& cells, std::size_t cell) const {
    const auto [column, row] = place_in_square(cell);
    const double slack = room_;
    const Interval u{cells.corner.x + column * cells.edge - slack,
                     cells.corner.x + (column + 1) * cells.edge + slack};
    const Interval v{cells.corner.y + row * cells.edge - slack,
                     cells.corner.y + (row + 1) * cells.edge + slack};
    List list;
    for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
        const Body& body = bodies_[i];
        const double radius = body.radius + room_;
        const Vec2& middle = cells.middles[i];
        const double beside_u = std::max({0.0, u.lo - middle.x, middle.x - u.hi});
        const double beside_v = std::max({0.0, v.lo - middle.y, middle.y - v.hi});
        if (beside_u * beside_u + beside_v * beside_v > radius * radius) continue;
        list.push_back({i, -(dot(body.center, cells.place) + radius + room_)});
    }
    return list;
}

}  // namespace alhazen
