#include "alhazen/renderers/vcm/light_paths.h"

#include <cmath>

#include "alhazen/renderers/core/sampling_plan.h"

namespace alhazen {

namespace {

/// Pairs of dimensions of the start of a light path: place, direction; time and choice.
enum StartPair : std::uint32_t { kPlace = 0, kAlong = 1, kChoice = PathRandomness::kTime };

/// Factor from a density by solid angle at `v` to one by area at the vertex before.
double facing_from(const PathVertex& v, const PathVertex& before) {
    return before.facing(v.view()) / (v.distance * v.distance) * v.backward;
}

}  // namespace

LightPathNumbers::LightPathNumbers(const RenderJob& job, std::uint64_t seed)
    : sampler_(find_sampler("sobol")->make(seed, kMaxSamples)),
      filter_(*job.sampling->filter, job.sampling->radius),
      job_(job) {
    round_ = std::make_unique<SampleRound>(SampleRound{*sampler_, filter_, 0, 1, {}, {}, seed});
    job_.round = round_.get();
}

SampleId LightPathNumbers::id(std::uint64_t number) {
    const std::uint64_t set = number / kMaxSamples;
    constexpr auto kSide = static_cast<std::uint64_t>(SamplePixel::kMaxSide);
    return {{static_cast<int>(set % kSide), static_cast<int>(set / kSide)},
            static_cast<std::uint32_t>(number % kMaxSamples)};
}

LightPathWalk::LightPathWalk(const LightPathNumbers& numbers, const Illumination& lights,
                             const LightPathShot& shot, RayCounters& counters,
                             TraversalStats* stats)
    : job_(numbers.job()),
      lights_(lights),
      weights_(job_.scene),
      shot_(shot),
      random_(job_),
      starts_(job_.scene),
      walk_(job_.scene, lights, counters, stats) {}

SideSums LightPathWalk::begin(const LightRay& light, double& facing) const {
    const PathVertex& first = path_[0];
    const Vec3 to_light = first.view();
    const Illumination::LightPoint place = lights_.point_of_light(light.place, light.ray.origin);
    facing = place.normal != Vec3{}
                 ? std::abs(dot(to_light, place.normal)) / (first.distance * first.distance)
                 : 1.0;
    const double joined = facing * lights_.density(first.lit(), place, to_light, first.distance);
    facing *= first.backward;
    const bool only_joined = weights_.shadow_rays_alone() && joined > 0.0 && !first.singular;
    return SideSums::at_light(place.infinite ? light.direction_density : light.place_density,
                              joined, place.is_hit && !only_joined, first.density);
}

void LightPathWalk::keep(const PathVertex& v, const SideSums& sums, double facing,
                         std::size_t number, std::vector<LightVertex>& kept) const {
    if (v.in_volume || !v.connects() || v.throughput.is_black() || !v.throughput.is_finite())
        return;
    const Vec3& p = v.point();
    Wavelengths waves = *shot_.waves;
    Spectrum ignored;
    if (v.hero_only) waves.keep_hero(ignored);
    const Spectrum power = (1.0 / (v.coverage * static_cast<double>(shot_.count))) * v.throughput;
    kept.push_back({{{p.x, p.y, p.z},
                     stored_light(power, waves),
                     OctahedralVector(v.scatter.view()),
                     OctahedralVector(v.scatter.geometric())},
                    sums,
                    facing,
                    static_cast<std::uint32_t>(number)});
}

bool LightPathWalk::shoot(std::uint64_t number, std::vector<LightVertex>& kept) {
    const SampleId id = LightPathNumbers::id(shot_.first + number);
    const LightRay light = lights_.emit(random_.draw(id, kChoice).y, random_.draw(id, kPlace),
                                        random_.draw(id, kAlong), *shot_.waves);
    const float time =
        job_.scene.has_motion ? shot_.shutter.at(random_.draw(id, PathRandomness::kTime).x) : 0.0f;
    const WalkStart start = starts_.of(light, time, *shot_.waves);
    if (start.throughput.is_black() || !start.throughput.is_finite()) return false;
    walk_.walk(
        Transport::Importance, start,
        {random_, id, PathRandomness::kFirstBounce, shot_.settings.depth, shot_.settings.roulette},
        path_);
    set_falloff(lights_, light, *shot_.waves, path_);
    if (path_.size() < 2) return true;
    double facing = 1.0;
    SideSums sums = begin(light, facing);
    double before = facing * path_[0].back;
    for (std::size_t a = 2; a <= path_.size(); ++a) {
        const PathVertex &last = path_[a - 2], &v = path_[a - 1];
        sums =
            sums.after(before, last.singular, a > 2 && !last.in_volume, shot_.merging, v.density);
        facing = facing_from(v, last);
        keep(v, sums, facing, a, kept);
        before = facing * v.back;
    }
    return true;
}

}  // namespace alhazen
