#include "alhazen/aggregates/motion/motion_aggregate.h"

#include <vector>

#include "alhazen/primitives/primitive_lanes.h"
#include "alhazen/primitives/unused_shear.h"
#include "alhazen/shapes/core/first_hit.h"

namespace alhazen {

namespace {

/// Largest deviation of a slide from its line, relative to the coordinates. Bounds of points are
/// padded by 1e-13.
constexpr double kEven = 1e-12;

/// True if the line of the ray certainly misses the ball; rounding is far below the margin.
bool passes_by(const Ray& ray, const Sphere& ball) {
    constexpr double kMargin = 1e-12;
    const Vec3 f = ray.origin - ball.center;
    const double along = dot(f, ray.direction), away = length_squared(f);
    const double beyond = (1.0 - kMargin) * away - (1.0 + kMargin) * (ball.radius * ball.radius);
    return along * along < length_squared(ray.direction) * beyond;
}

}  // namespace

MotionAggregate::MotionAggregate(PrimitiveTable table, std::optional<std::size_t> resting)
    : table_(std::move(table)) {
    if (resting) {
        resting_ = PrimitiveId{table_.first(kInstanceKind) + static_cast<std::uint32_t>(*resting)};
        const Box3 still = table_.instances[*resting].aggregate->box();
        box_ = {still, still};
    }
    std::vector<MovingBox> boxes(table_.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (resting_ == PrimitiveId{i}) continue;
        boxes[i] = box_of(i);
        box_.include(boxes[i]);
    }
    tree_ = MotionBvh(boxes);
    for (const Instance& instance : table_.instances) movers_.push_back(mover_of(instance));
    if (!resting_) return;
    const PrimitiveTable* alone = movers_[table_.index(*resting_)].lone;
    rests_alone_ = alone != nullptr && !takes_lanes(*alone, PrimitiveId{0});
}

MotionAggregate::Mover MotionAggregate::mover_of(const Instance& instance) {
    Mover mover;
    const Box3 box = instance.aggregate->box();
    if (instance.motion && box.bounded()) mover.slide = slide_of(*instance.motion, box);
    if (!instance.holds_one_shape) return mover;
    mover.lone = &instance.aggregate->primitives();
    const auto& balls = std::get<ShapeColumn<Sphere>>(mover.lone->columns);
    if (balls.shapes.size() == 1 && balls.placements[0] == kNoPlacement &&
        mover.lone->common_mask() == kAllRays) {
        mover.ball = balls.shapes[0];
    }
    return mover;
}

/// A motion is a slide if the moving bounds of points, which hold at every time, are the points
/// themselves at both ends; four points suffice for affine maps. `inner`: bounds of the content.
std::optional<MotionAggregate::Slide> MotionAggregate::slide_of(const TransformMotion& motion,
                                                                const Box3& inner) {
    const Affine open = motion.at(0.0).outer_from_inner, close = motion.at(1.0).outer_from_inner;
    if (inner.empty() || open.linear != Mat3{} || close.linear != Mat3{}) return std::nullopt;
    const double size = max_component(inner.size());
    const Vec3 origin = inner.lo, steps[] = {{}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
    const double reach = max_component(abs(open.translation)) +
                         max_component(abs(close.translation)) + max_component(abs(origin)) + size;
    for (const Vec3& step : steps) {
        const Vec3 p = origin + step;
        const MovingBox box = motion.bounds({p, p});
        const auto is_at = [&](const Box3& b, const Vec3& place) {
            return max_component(abs(b.lo - place)) <= kEven * reach &&
                   max_component(abs(b.hi - place)) <= kEven * reach;
        };
        if (!is_at(box.at_open, open.point(p)) || !is_at(box.at_close, close.point(p))) {
            return std::nullopt;
        }
    }
    return Slide{open.translation, close.translation};
}

Ray MotionAggregate::inner_ray_of(std::size_t instance, const Ray& ray, double time) const {
    if (const std::optional<Slide>& slide = movers_[instance].slide) {
        const Vec3 translation = (1.0 - time) * slide->from + time * slide->to;
        return {ray.origin - translation, ray.direction, ray.t_min, ray.t_max};
    }
    return transformed(placement_at(table_.instances[instance], time).inner_from_outer, ray);
}

MovingBox MotionAggregate::box_of(std::uint32_t primitive) const {
    const PrimitiveId id{primitive};
    const std::uint32_t index = table_.index(id);
    if (is_triangle(id)) {
        return table_.mesh_of(index).motion->box(*table_.triangle_corners(index));
    }
    const Instance& instance = table_.instances[index];
    const MovingBox inner = instance.aggregate->moving_box();
    if (instance.motion) return instance.motion->bounds(inner.swept());
    const Affine& outer = instance.placement.outer_from_inner;
    return {padded(transformed(outer, inner.at_open), 1e-13),
            padded(transformed(outer, inner.at_close), 1e-13)};
}

const Instance& MotionAggregate::resting_instance() const {
    return table_.instances[table_.index(*resting_)];
}

bool MotionAggregate::hits_triangle(PrimitiveId id, const Ray& ray, const RayShear& shear,
                                    float time, ShapeHit& hit) const {
    const std::uint32_t index = table_.index(id);
    const auto [a, b, c] =
        table_.mesh_of(index).motion->positions_at(*table_.triangle_corners(index), time);
    return intersect_triangle(ray, shear, a, b, c, hit);
}

PrimitiveTable::ShadowEffect MotionAggregate::effect_of(PrimitiveId id, const Ray& ray,
                                                        float time) const {
    using enum PrimitiveTable::ShadowEffect;
    if (table_.opacity(id) == Opacity::Opaque) return Blocks;
    if (table_.opacity(id) == Opacity::Transparent) return Tints;
    const std::uint32_t index = table_.index(id);
    const PlacedMesh& mesh = table_.mesh_of(index);
    const auto [a, b, c] = mesh.motion->positions_at(*table_.triangle_corners(index), time);
    const double side = dot(cross(b - a, c - a), ray.direction);
    return (mesh.mirrored ? side < 0.0 : side > 0.0) ? Blocks : None;
}

template <MotionBvh::Order kOrder, class Reach, class OnTriangle, class OnInstance>
void MotionAggregate::visit(const Ray& ray, RayQuery query, Reach&& t_max, OnTriangle&& on_triangle,
                            OnInstance&& on_instance) const {
    const bool has_triangles = table_.first(kInstanceKind) > 0;
    const RayShear shear = has_triangles ? RayShear(ray.direction) : kUnusedShear;
    with_stats(query.stats, [&](auto stats) {
        tree_.traverse<kOrder>(
            ray, query.time, t_max,
            [&](std::uint32_t i) {
                const PrimitiveId id{i};
                if (!table_.is_seen(id, query.mask)) return false;
                if (is_triangle(id)) {
                    stats.primitives(1);
                    ShapeHit hit;
                    Ray reaching = ray;
                    reaching.t_max = t_max();
                    if (!hits_triangle(id, reaching, shear, query.time, hit)) return false;
                    stats.primitive_hits(1);
                    return on_triangle(id, hit);
                }
                const std::size_t index = i - table_.first(kInstanceKind);
                Ray inner = inner_ray_of(index, ray, query.time);
                const std::optional<Sphere>& ball = movers_[index].ball;
                if (ball && passes_by(inner, *ball)) {
                    stats.primitives(1);
                    return false;
                }
                inner.t_max = t_max();
                return on_instance(id, index, inner);
            },
            stats);
    });
}

bool MotionAggregate::closest_in(std::size_t instance, const Ray& ray, Hit& hit,
                                 RayQuery query) const {
    const Mover& mover = movers_[instance];
    if (mover.lone == nullptr) {
        return table_.instances[instance].aggregate->closest(ray, hit, query);
    }
    with_stats(query.stats, [&](auto stats) {
        if (mover.ball) {
            stats.primitives(1);
            if (!find_first_hit(*mover.ball, ray, hit)) return;
            stats.primitive_hits(1);
            hit.primitive = PrimitiveId{0};
        } else {
            Ray shrinking = ray;
            mover.lone->closest(PrimitiveId{0}, shrinking, kUnusedShear, hit, stats, query.mask);
        }
    });
    return hit.found();
}

bool MotionAggregate::occluded_in(std::size_t instance, const Ray& ray, RayQuery query) const {
    const Mover& mover = movers_[instance];
    if (mover.lone == nullptr) return table_.instances[instance].aggregate->occluded(ray, query);
    return with_stats(query.stats, [&](auto stats) {
        if (!mover.ball) {
            return mover.lone->occluded(PrimitiveId{0}, ray, kUnusedShear, stats, query.mask);
        }
        ShapeHit hit;
        stats.primitives(1);
        if (!find_first_hit(*mover.ball, ray, hit)) return false;
        stats.primitive_hits(1);
        return true;
    });
}

void MotionAggregate::closest_moving(const Ray& ray, Hit& best, RayQuery query) const {
    double t_max = best.found() ? best.t : ray.t_max;
    visit<MotionBvh::Order::NearFirst>(
        ray, query, [&] { return t_max; },
        [&](PrimitiveId id, const ShapeHit& hit) {
            if (!wins(hit.t, id, best)) return false;
            static_cast<ShapeHit&>(best) = hit;
            best.primitive = id;
            best.path.clear();
            t_max = hit.t;
            return false;
        },
        [&](PrimitiveId id, std::size_t instance, const Ray& inner_ray) {
            Hit inner;
            if (!closest_in(instance, inner_ray, inner, query) || !wins(inner.t, id, best)) {
                return false;
            }
            best = inner;
            best.path.push_back(id);
            t_max = inner.t;
            return false;
        });
}

bool MotionAggregate::closest(const Ray& ray, Hit& hit, RayQuery query) const {
    hit = Hit{};
    if (!is_valid(ray)) return false;
    if (resting_ && table_.is_seen(*resting_, query.mask) &&
        closest_in(table_.index(*resting_), ray, hit, query)) {
        hit.path.push_back(*resting_);
    }
    closest_moving(ray, hit, query);
    return hit.found();
}

bool MotionAggregate::occluded_by_moving(const Ray& ray, RayQuery query) const {
    bool met = false;
    visit<MotionBvh::Order::Any>(
        ray, query, [&] { return ray.t_max; },
        [&](PrimitiveId, const ShapeHit&) { return met = true; },
        [&](PrimitiveId, std::size_t instance, const Ray& inner_ray) {
            return met = occluded_in(instance, inner_ray, query);
        });
    return met;
}

bool MotionAggregate::occluded(const Ray& ray, RayQuery query) const {
    if (!is_valid(ray)) return false;
    if (resting_ && occluded_in(table_.index(*resting_), ray, query)) return true;
    return occluded_by_moving(ray, query);
}

void MotionAggregate::all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const {
    if (!is_valid(ray)) return;
    const std::size_t before = hits.size();
    const auto append = [&](PrimitiveId id, std::size_t instance, const Ray& inner_ray) {
        const std::size_t known = hits.size();
        table_.instances[instance].aggregate->all_hits(inner_ray, hits, query);
        for (std::size_t i = known; i < hits.size(); ++i) hits[i].path.push_back(id);
        return false;
    };
    if (resting_) append(*resting_, table_.index(*resting_), ray);
    visit<MotionBvh::Order::Any>(
        ray, query, [&] { return ray.t_max; },
        [&](PrimitiveId id, const ShapeHit& hit) {
            Hit& found = hits.emplace_back();
            static_cast<ShapeHit&>(found) = hit;
            found.primitive = id;
            return false;
        },
        append);
    sort_appended(hits, before);
}

bool MotionAggregate::shadowed(const Ray& ray, std::vector<Hit>& crossings, RayQuery query) const {
    if (!is_valid(ray)) return false;
    const std::size_t before = crossings.size();
    bool blocked = false;
    const auto append = [&](PrimitiveId id, std::size_t instance, const Ray& inner_ray) {
        const std::size_t known = crossings.size();
        blocked = table_.instances[instance].aggregate->shadowed(inner_ray, crossings, query);
        if (blocked) return true;
        for (std::size_t i = known; i < crossings.size(); ++i) crossings[i].path.push_back(id);
        return false;
    };
    if (resting_ && append(*resting_, table_.index(*resting_), ray)) return true;
    visit<MotionBvh::Order::Any>(
        ray, query, [&] { return ray.t_max; },
        [&](PrimitiveId id, const ShapeHit& hit) {
            using enum PrimitiveTable::ShadowEffect;
            const PrimitiveTable::ShadowEffect effect = effect_of(id, ray, query.time);
            if (effect == None) return false;
            if (effect == Blocks) return blocked = true;
            Hit& found = crossings.emplace_back();
            static_cast<ShapeHit&>(found) = hit;
            found.primitive = id;
            return false;
        },
        append);
    if (!blocked) sort_appended(crossings, before);
    return blocked;
}

void MotionAggregate::closest_batch_at(std::span<const Ray> rays, std::span<const float> times,
                                       std::span<Hit> hits, RayQuery query,
                                       Coherence coherence) const {
    if (resting_ && !rests_alone_) {
        resting_instance().aggregate->closest_batch(rays, hits, query, coherence);
    } else {
        for (Hit& hit : hits) hit = Hit{};
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!is_valid(rays[i])) continue;
        if (rests_alone_) closest_in(table_.index(*resting_), rays[i], hits[i], query);
        if (hits[i].found()) hits[i].path.push_back(*resting_);
        closest_moving(rays[i], hits[i], {query.stats, query.mask, times[i]});
    }
}

void MotionAggregate::occluded_batch_at(std::span<const Ray> rays, std::span<const float> times,
                                        std::span<bool> met, RayQuery query,
                                        Coherence coherence) const {
    for (bool& m : met) m = false;
    if (resting_ && !rests_alone_) {
        resting_instance().aggregate->occluded_batch(rays, met, query, coherence);
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (met[i] || !is_valid(rays[i])) continue;
        met[i] = (rests_alone_ && occluded_in(table_.index(*resting_), rays[i], query)) ||
                 occluded_by_moving(rays[i], {query.stats, query.mask, times[i]});
    }
}

void MotionAggregate::closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                                    Coherence coherence) const {
    const std::vector<float> times(rays.size(), query.time);
    closest_batch_at(rays, times, hits, query, coherence);
}

void MotionAggregate::occluded_batch(std::span<const Ray> rays, std::span<bool> met, RayQuery query,
                                     Coherence coherence) const {
    const std::vector<float> times(rays.size(), query.time);
    occluded_batch_at(rays, times, met, query, coherence);
}

}  // namespace alhazen
