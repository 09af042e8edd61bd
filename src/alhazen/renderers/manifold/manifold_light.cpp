#include "alhazen/renderers/manifold/manifold_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/math/constants.h"
#include "alhazen/renderers/core/tinted_media.h"
#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

namespace {

/// Largest number of parts with known chains that are searched at every point; such a search is
/// cheap.
constexpr std::size_t kMostAlways = 4;
/// Largest number of parts chosen by weight; of more one is chosen uniformly.
constexpr std::size_t kMostWeighed = 64;
/// For refractions: share of random seeds that lie around the straight direction, and 1 minus the
/// cosine of their largest angle to it.
constexpr double kNearStraight = 0.75, kStraightVersine = 0.06;
/// Number of steps from index 1 to that of a part, if the straight direction is totally reflected.
constexpr int kIndexSteps = 4;
/// Chains whose first directions differ by less are equal.
constexpr double kSameDirection = 1e-5;

/// Share of all directions covered by the part's bounding sphere, at most 1/2.
double share_of_directions(const SpecularPart& part, const Vec3& from) {
    if (!part.bounded) return 0.5;
    const double squared = length_squared(part.around.center - from);
    const double sine2 = part.around.radius * part.around.radius / squared;
    if (!(sine2 < 1.0)) return 0.5;
    return 0.5 * sine2 / (1.0 + std::sqrt(1.0 - sine2));
}

}  // namespace

void ChainTrail::begin(double density) {
    length = density <= kMostDensity ? 0 : kNone;
}

void ChainTrail::go_on(const Surface& surface, bool transmitted) {
    if (length == kNone) return;
    const std::uint64_t key = part_key(surface);
    const bool is_next = length == 0 || (length == 1 && refracted && transmitted && key == part);
    part = key;
    refracted = transmitted;
    length = is_next ? static_cast<std::uint8_t>(length + 1) : kNone;
}

bool ManifoldScene::finds(const ChainTrail& trail, const Hit& hit, const Surface& surface,
                          const Vec3& direction) const {
    if (trail.length == 0 || trail.length == ChainTrail::kNone) return false;
    const SpecularPart* const part = parts.find(trail.part);
    if (part == nullptr || !(trail.refracted ? part->refracts : part->reflects)) return false;
    return lights.may_pick(hit, surface, direction);
}

ManifoldScene::ManifoldScene(const Scene& scene, const Illumination& of)
    : parts(scene), lights(of) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const bool known = parts[i].sphere || parts[i].flat;
        (known && always.size() < kMostAlways ? always : by_chance).push_back(i);
    }
}

bool ManifoldLight::begin(const Receiver& at) {
    at_ = &at;
    number_ = 0;
    const double light = next_number();
    const Vec2 u{next_number(), next_number()};
    pick_ = manifold_.lights.pick(light, u);
    end_ = {pick_.at, pick_.infinite};
    return pick_.density > 0.0;
}

ManifoldLight::Choice ManifoldLight::choose_part(double choice) const {
    const std::vector<std::size_t>& some = manifold_.by_chance;
    const std::size_t n = some.size();
    if (n > kMostWeighed) {
        const auto i = std::min(static_cast<std::size_t>(choice * double(n)), n - 1);
        return {&manifold_.parts[some[i]], 1.0 / double(n)};
    }
    double weights[kMostWeighed] = {}, sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        // Above 0, because a part of small solid angle may contribute much light.
        weights[i] = share_of_directions(manifold_.parts[some[i]], at_->surface.point) + 1e-3;
        sum += weights[i];
    }
    double left = choice * sum;
    std::size_t i = 0;
    while (i + 1 < n && left >= weights[i]) left -= weights[i++];
    return {&manifold_.parts[some[i]], weights[i] / sum};
}

void ManifoldLight::find_by(const Choice& part) {
    part_ = part;
    for (const ChainKind kind :
         {ChainKind::Reflection, ChainKind::Refraction, ChainKind::TwoRefractions}) {
        if (may_be(kind)) find_kind(kind);
    }
}

bool ManifoldLight::may_be(ChainKind kind) const {
    const SpecularPart& part = *part_.part;
    if (length_of(kind) > at_->most_bends) return false;
    if (!(refracts(kind) ? part.refracts : part.reflects)) return false;
    if (kind != ChainKind::Refraction || !part.closed) return true;
    // Between two outside points the part is crossed twice.
    return part.box.contains(at_->surface.point) || (!end_.infinite && part.box.contains(end_.at));
}

MediumStack ManifoldLight::media_along(const Vec3& direction) const {
    MediumStack media = at_->media;
    if (dot(direction, at_->scatter.geometric()) < 0.0) at_->scatter.cross(media);
    return media;
}

bool ManifoldLight::set_out(ChainKind kind, const Vec3& direction) {
    chain_.kind = kind;
    chain_.direction = direction;
    known_indices_ = 0;
    MediumStack media = media_along(direction);
    Ray ray = leaving_ray(at_->surface, direction);
    RayKind ray_kind = RayKind::Reflection;
    for (int i = 0; i < length_of(kind); ++i) {
        const auto k = static_cast<std::size_t>(i);
        ChainVertex& v = chain_.at[k];
        if (!tracer_.find(ray, part_.part->key, ray_kind, at_->time, v)) return false;
        if (refracts(kind)) {
            set_shading_point(scene_, v.ray, v.hit, {!media.empty(), 0.0, at_->time, true}, {},
                              point_);
            vertex_.set(scene_, point_, media, at_->waves);
            v.eta = vertex_.singular(Transport::Radiance).eta;
            // Shadow rays find what passes a null boundary.
            if (!(v.eta > 0.0) || vertex_.is_null_boundary()) return false;
            vertex_.cross(media);
        }
        indices_.eta[k] = v.eta;
        indices_.entering[k] = v.entering;
        known_indices_ = i + 1;
        if (!ChainTracer::bend(refracts(kind), v)) return false;
        ray = leaving_ray(v.surface, v.leaving);
        ray_kind = RayKind::Refraction;
    }
    return true;
}

bool ManifoldLight::reach(ChainKind kind, const Vec3& seed) {
    return set_out(kind, seed) &&
           walk_to(tracer_, at_->surface, part_.part->key, indices_, end_, at_->time, chain_);
}

bool ManifoldLight::reach_by_indices(ChainKind kind, const Vec3& seed) {
    if (known_indices_ < length_of(kind)) return false;
    Vec3 direction = seed;
    for (int step = 0; step <= kIndexSteps; ++step) {
        ChainIndices indices = indices_;
        const double share = static_cast<double>(step) / kIndexSteps;
        for (double& eta : indices.eta) eta = step < kIndexSteps ? 1.0 + share * (eta - 1.0) : eta;
        if (!tracer_.follow(at_->surface, direction, kind, part_.part->key, indices, at_->time,
                            chain_) ||
            !walk_to(tracer_, at_->surface, part_.part->key, indices, end_, at_->time, chain_)) {
            return false;
        }
        direction = chain_.direction;
    }
    return true;
}

std::optional<ChainSeeds> ManifoldLight::all_seeds(ChainKind kind) {
    const SpecularPart& part = *part_.part;
    const Vec3& from = at_->surface.point;
    if (part.flat && kind != ChainKind::TwoRefractions) {
        const FlatPlace& flat = *part.flat;
        if (kind == ChainKind::Reflection) {
            return reflections_by_plane(flat.point, flat.normal, from, end_);
        }
        const double side = dot(from - flat.point, flat.normal);
        if (!set_out(kind, side > 0.0 ? -flat.normal : flat.normal)) return std::nullopt;
        return refractions_by_plane(flat.point, flat.normal, indices_.eta[0], from, end_);
    }
    if (!part.sphere) return std::nullopt;
    if (kind == ChainKind::Reflection) return reflections_by_sphere(*part.sphere, from, end_);
    if (kind != ChainKind::TwoRefractions) return std::nullopt;
    const Vec3 to_center = part.sphere->center - from;
    const auto outside = [&](const Vec3& p) {
        return length(p - part.sphere->center) > part.sphere->radius;
    };
    if (!outside(from) || !(end_.infinite || outside(end_.at))) return ChainSeeds();
    if (!set_out(kind, normalize(to_center)) || !(indices_.eta[0] <= 1.0)) return std::nullopt;
    return refractions_by_ball(*part.sphere, 1.0 / indices_.eta[0], from, end_);
}

std::optional<Vec3> ManifoldLight::likely_seed(ChainKind kind) const {
    const SpecularPart& part = *part_.part;
    const Vec3& from = at_->surface.point;
    // Weak refraction changes the direction little.
    if (refracts(kind)) return straight();
    if (!part.bounded) return std::nullopt;
    const ChainSeeds seeds = reflections_by_sphere(part.around, from, end_);
    if (seeds.empty()) return std::nullopt;
    return seeds[0];
}

Vec3 ManifoldLight::random_seed(ChainKind kind) {
    const SpecularPart& part = *part_.part;
    const Vec3& from = at_->surface.point;
    const double which = next_number();
    const Vec2 u{next_number(), next_number()};
    if (refracts(kind) && which < kNearStraight)
        return direction_in_cone(straight(), kStraightVersine, u);
    const double share = share_of_directions(part, from);
    if (share >= 0.5) return direction_in_cone({0, 0, 1}, 2.0, u);
    return direction_in_cone(normalize(part.around.center - from), 2.0 * share, u);
}

void ManifoldLight::find_kind(ChainKind kind) {
    const std::optional<ChainSeeds> seeds = all_seeds(kind);
    if (!seeds) return find_by_trials(kind);
    for (const Vec3& seed : *seeds) {
        if (reach(kind, seed)) note(light_along(), 1.0);
    }
}

void ManifoldLight::find_by_trials(ChainKind kind) {
    const std::optional<Vec3> likely = likely_seed(kind);
    const bool known =
        likely && (reach(kind, *likely) || (refracts(kind) && reach_by_indices(kind, *likely)));
    const Vec3 first = chain_.direction;
    if (known) note(light_along(), 1.0);

    if (!reach(kind, random_seed(kind))) return;
    const Vec3 direction = chain_.direction;
    if (known && length(direction - first) < kSameDirection) return;
    const Spectrum light = light_along();
    if (light.is_black()) return;
    std::uint32_t trials = 1;
    while (!(reach(kind, random_seed(kind)) &&
             length(chain_.direction - direction) < kSameDirection)) {
        if (++trials < kMostTrials) continue;
        ++manifold_.cut;
        break;
    }
    chain_.direction = direction;
    note(light, trials);
}

void ManifoldLight::note(const Spectrum& light, double times) {
    if (light.is_black() || !light.is_finite()) return;
    found_.push_back({chain_.direction, chain_.length(), (times / part_.probability) * light});
}

Spectrum ManifoldLight::light_along() {
    const ScatterPoint& scatter = at_->scatter;
    const Vec3& direction = chain_.direction;
    if (pick_.is_hit && !(scatter.density(direction) <= kMostDensity)) return {};
    const Spectrum value = scatter.value(direction, Transport::Radiance);
    if (value.is_black()) return {};
    const Spectrum sent = manifold_.lights.sent(pick_, chain_.last().surface.point, at_->waves);
    if (sent.is_black()) return {};
    const MediumStack first = media_along(direction);
    MediumStack media = first;
    const Spectrum through = through_vertices(media);
    if (through.is_black()) return {};
    const double spread = spread_ratio(tracer_, chain_, end_, at_->time);
    const Spectrum light = (spread / pick_.density) * (value * (through * sent));
    if (light.is_black()) return {};
    return light * unhindered(first, media);
}

Spectrum ManifoldLight::through_vertices(MediumStack& media) {
    Spectrum through = Spectrum::all(1.0);
    for (int i = 0; i < chain_.length(); ++i) {
        const ChainVertex& v = chain_.at[static_cast<std::size_t>(i)];
        set_shading_point(scene_, v.ray, v.hit, {!media.empty(), 0.0, at_->time, true}, {}, point_);
        vertex_.set(scene_, point_, media, at_->waves);
        const SingularLight light = vertex_.singular(Transport::Radiance);
        if (!refracts(chain_.kind)) {
            through = through * light.reflected;
            continue;
        }
        constexpr double kSameIndex = 1e-9;
        if (!(std::abs(light.eta - v.eta) <= kSameIndex * v.eta)) return {};
        through = through * light.transmitted;
        vertex_.cross(media);
    }
    return through;
}

Spectrum ManifoldLight::unhindered(const MediumStack& first, const MediumStack& last) {
    // A refracted chain has a medium of its own between the vertices; a reflected one has one
    // vertex.
    MediumStack media = first;
    Spectrum share = Spectrum::all(1.0);
    const ShapeSurface* from = &at_->surface;
    Vec3 direction = chain_.direction;
    RayKind ray_kind =
        dot(direction, at_->scatter.geometric()) < 0.0 ? RayKind::Refraction : RayKind::Reflection;
    const auto pass = [&](const MediumStack& in, const Ray& ray) {
        share = share * shadows_.between(ray, at_->time, ray_kind, in, at_->waves, nullptr);
        return !share.is_black();
    };
    for (int i = 0; i < chain_.length(); ++i) {
        const ChainVertex& v = chain_.at[static_cast<std::size_t>(i)];
        const Ray ray = ray_between(from->point, leaving_ray(*from, direction), v.surface.point,
                                    leaving_ray(v.surface, -direction), v.travelled,
                                    std::abs(dot(v.surface.normal, direction)));
        if (!pass(media, ray)) return {};
        from = &v.surface;
        direction = v.leaving;
        ray_kind = refracts(chain_.kind) ? RayKind::Refraction : RayKind::Reflection;
        if (i + 1 == chain_.length()) break;
        set_shading_point(scene_, v.ray, v.hit, {!media.empty(), 0.0, at_->time, true}, {}, point_);
        vertex_.set(scene_, point_, media, at_->waves);
        vertex_.cross(media);
    }
    const double rest =
        end_.infinite ? std::numeric_limits<double>::infinity() : length(end_.at - from->point);
    // Rays along the chain find the light if they can hit it.
    if (!pick_.is_hit) ray_kind = RayKind::Shadow;
    const double facing = pick_.is_hit ? std::abs(dot(pick_.normal, direction)) : 0.0;
    const Ray ray = ray_to_light(manifold_.lights, from->point, leaving_ray(*from, direction), rest,
                                 pick_.place, facing);
    if (!pass(last, ray)) return {};
    return share;
}

}  // namespace alhazen
