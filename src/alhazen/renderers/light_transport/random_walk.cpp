#include "alhazen/renderers/light_transport/random_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/renderers/light_transport/emission_of.h"

namespace alhazen {

bool RandomWalk::find(Ray& ray, const WalkLuck& luck, float time, bool inside) {
    segment_ = 0.0;
    for (int passed = 0; passed <= kMaxPassedSurfaces; ++passed) {
        ++counters_[kind_].cast;
        hit_ = Hit();
        if (!scene_.aggregate->closest(ray, hit_, {stats_, mask_of(kind_), time})) return false;
        ++counters_[kind_].hit;
        set_shading_point(scene_, ray, hit_, {inside, 0.0, time, kind_ != RayKind::Eye},
                          {.constant = &constant_}, point_);
        travelled_ += hit_.t;
        segment_ += hit_.t;
        if (luck.chance.stops(luck.id, luck.first_pair << 16 | met_++, point_.material->coverage)) {
            return true;
        }
        ray = leaving_ray(point_.surface, ray.direction);
    }
    return false;
}

void RandomWalk::walk(Transport transport, const WalkStart& start, const WalkLuck& luck,
                      std::vector<PathVertex>& vertices) {
    vertices.clear();
    escape_ = {};
    met_ = 0;
    travelled_ = 0.0;
    const bool from_eye = transport == Transport::Radiance;
    kind_ = from_eye ? RayKind::Eye : RayKind::Reflection;
    Ray ray = start.ray;
    Wavelengths waves = *start.waves;
    Spectrum throughput = start.throughput;
    double density = start.density;
    bool parallel = start.parallel;
    double eta_scale = 1.0;
    MediumStack media = start.media;
    for (std::uint32_t pair = luck.first_pair; static_cast<int>(vertices.size()) < luck.most;
         pair += kWalkPairs) {
        if (!find(ray, luck, start.time, !media.empty())) {
            const Medium* const medium = media.here();
            escape_.is = true;
            if (medium != nullptr) {
                throughput = throughput * transmittance(waves.absorption(medium->absorption),
                                                        std::numeric_limits<double>::infinity());
            }
            escape_.direction = ray.direction;
            escape_.throughput = throughput;
            escape_.density = density;
            return;
        }
        if (const Medium* const medium = media.here(); medium != nullptr) {
            throughput = throughput * transmittance(waves.absorption(medium->absorption), segment_);
        }
        const double cosine = std::abs(dot(ray.direction, point_.geometric));
        PathVertex& v = vertices.emplace_back();
        v.surface = point_.surface;
        v.throughput = throughput;
        v.media = media;
        v.distance = travelled_;
        v.coverage = point_.material->coverage;
        v.density = parallel ? density * cosine : density * cosine / (travelled_ * travelled_);
        parallel = false;
        if (from_eye) {
            const bool lights_others =
                vertices.size() >= 2 && !vertices[vertices.size() - 2].singular;
            if (!point_.material->unlit || !lights_others) {
                v.emission = emission_of(scene_, point_, waves);
            }
            if (!v.emission.is_black()) {
                v.emit = lights_.emit_density(hit_, point_.surface, -ray.direction);
                if (vertices.size() >= 2) {
                    const PathVertex& before = vertices[vertices.size() - 2];
                    const LitPoint at{before.surface.point, before.scatter.normal(),
                                      before.scatter.transmits()};
                    v.joined = cosine / (travelled_ * travelled_) *
                               lights_.density(at, ray, hit_, point_.surface, travelled_);
                }
            }
        }
        v.scatter.set(scene_, point_, media, waves, true, &bsdfs_);
        if (v.scatter.needs_hero()) {
            waves.keep_hero(throughput);
            v.throughput = throughput;
        }
        v.hero_only = waves.hero_only();
        if (point_.material->unlit || static_cast<int>(vertices.size()) == luck.most) return;

        const Vec2 u = luck.chance.draw(luck.id, pair);
        const Vec2 choices = luck.chance.draw(luck.id, pair + 1);
        const std::optional<Scattered> drawn = v.scatter.sample(choices.x, u, transport);
        // A thin sheet is passed straight by chance, and then is no vertex.
        const double straight = v.scatter.straight_probability();
        if (straight > 0.0 && straight < 1.0 && !(drawn && drawn->straight)) {
            v.throughput = (1.0 / (1.0 - straight)) * v.throughput;
        }
        if (!drawn || drawn->weight.is_black()) return;
        throughput = throughput * drawn->weight;
        if (drawn->dispersed) waves.keep_hero(throughput);
        if (!from_eye) throughput = v.scatter.importance_correction(drawn->direction) * throughput;
        if (drawn->transmitted) v.scatter.cross(media);
        kind_ = drawn->transmitted ? RayKind::Refraction : RayKind::Reflection;
        if (drawn->straight) {
            const double left = travelled_;
            vertices.pop_back();
            ray = leaving_ray(point_.surface, drawn->direction);
            travelled_ = left;
            if (++met_ > kMaxPassedSurfaces) return;
            continue;
        }
        eta_scale *= drawn->transmitted && from_eye ? drawn->eta * drawn->eta : 1.0;
        v.singular = drawn->singular;
        density = drawn->singular ? 1.0 : drawn->density;
        v.back = drawn->singular ? 1.0 : v.scatter.reverse_density(drawn->direction);
        if (vertices.size() >= 2) {
            PathVertex& before = vertices[vertices.size() - 2];
            const double facing = std::abs(dot(v.scatter.view(), before.scatter.geometric()));
            before.reverse = v.back * facing / (v.distance * v.distance);
        }
        if (!throughput.is_finite()) return;
        if (static_cast<int>(vertices.size()) >= luck.roulette) {
            constexpr double kMost = 0.95;
            // Of light its power counts, which has any scale: its share of what it began with.
            const double begun = from_eye ? 1.0 : start.throughput.max();
            const double share = std::min(kMost, eta_scale * throughput.max() / begun);
            if (!(luck.chance.draw(luck.id, pair + 2).x < share)) return;
            throughput = (1.0 / share) * throughput;
        }
        ray = leaving_ray(point_.surface, drawn->direction);
        travelled_ = 0.0;
    }
}

}  // namespace alhazen
