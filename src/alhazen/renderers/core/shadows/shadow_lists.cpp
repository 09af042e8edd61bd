#include "alhazen/renderers/core/shadows/shadow_lists.h"

#include <algorithm>
#include <cmath>

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
/// Origins farther away round too much.
constexpr double kFarthest = 100;
/// Rounding of heights above a flat body: leaving_ray starts farther away.
constexpr double kHeightSlack = 64 * 0x1p-53;

const DirectionCube kCube(kResolution);

/// The unit normal of a flat primitive; zero of others.
Vec3 normal_of(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id), i = table.index(id);
    if (kind == kInstanceKind) return {};
    if (kind == kTriangleKind) {
        const auto [a, b, c] = table.triangle_vertices(i);
        return unit_or(cross(b - a, c - a), {});
    }
    const Vec3 normal = with_column(table.columns, kind, [&](const auto& column) {
        if constexpr (requires { column.shapes[i].unit_normal; }) {
            return column.shapes[i].unit_normal;
        } else {
            return Vec3{};
        }
    });
    const Placement* placement = table.placement_of(id);
    if (placement == nullptr) return normal;
    return unit_or(transpose_times(placement->inner_from_outer.linear, normal), {});
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
    return suits ? std::unique_ptr<ShadowLists>(new ShadowLists(scene)) : nullptr;
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
        if (!cells.parallel) size_ = std::max(size_, largest(cells.place));
    }
    room_ = kRoom * size_;
    lists_.emplace_back();
}

void ShadowLists::add_body(std::uint32_t id) {
    Body body{.id = PrimitiveId{id}, .box = table_.box(id)};
    if (body.box.empty()) return;
    const BoundingSphere sphere = table_.sphere(id);
    body.center = sphere.center;
    body.radius = sphere.radius;
    body.opaque = table_.is_opaque(body.id);
    body.triangle = table_.kind(body.id) == kTriangleKind;
    body.normal = normal_of(table_, body.id);
    body.flat = body.normal != Vec3{};
    if (body.flat) body.height = table_.extent(id, body.normal);
    size_ = std::max(
        {size_, largest(body.box.lo), largest(body.box.hi), largest(body.center) + body.radius});
    bodies_.push_back(body);
}

bool ShadowLists::may_meet(const Body& body, const Ray& ray) const {
    if (body.flat) {
        const double start = dot(body.normal, ray.origin);
        const double slope = dot(body.normal, ray.direction);
        const double above = start - body.height.hi, below = body.height.lo - start;
        if (above > kHeightSlack * size_) {
            return slope < 0.0 && !(above + ray.t_max * slope > room_);
        }
        if (below > kHeightSlack * size_) {
            return slope > 0.0 && !(below - ray.t_max * slope > room_);
        }
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

std::optional<bool> ShadowLists::occluded(const Ray& ray, std::size_t light, RayMask mask) {
    double reach = 0;
    const List* list = list_of(ray, light, reach);
    if (list == nullptr) return std::nullopt;
    if (outside_.occluded(table_, ray, {nullptr, mask})) return true;
    for (const Entry& entry : *list) {
        const Body& body = bodies_[entry.body];
        if (entry.least_reach > reach || !may_meet(body, ray)) continue;
        const RayShear& shear = body.triangle ? RayShear(ray.direction) : kUnusedShear;
        if (table_.occluded(body.id, ray, shear, NoStats{}, mask)) return true;
    }
    return false;
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
        const RayShear& shear = body.triangle ? RayShear(ray.direction) : kUnusedShear;
        const bool blocked = body.opaque
                                 ? table_.occluded(body.id, ray, shear, NoStats{}, mask)
                                 : table_.shadowed(body.id, ray, shear, crossings, NoStats{}, mask);
        if (blocked) return true;
    }
    if (crossings.size() > 1) sort_appended(crossings, 0);
    return false;
}

const ShadowLists::List* ShadowLists::list_of(const Ray& ray, std::size_t light, double& reach) {
    Cells& cells = lights_[light];
    if (cells.parallel) {
        if (!(largest(ray.origin) <= kFarthest * size_)) return nullptr;
        if (!(largest(ray.direction - cells.place) <= kDeviation)) return nullptr;
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
    if (!(largest(beside) <= kDeviation * size_)) return nullptr;
    if (cells.number.empty()) begin(cells);
    reach = ray.t_max;
    return list_in(cells, kCube.cell_of(-ray.direction));
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
    const double slack = kSlack * kFarthest * size_;
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
