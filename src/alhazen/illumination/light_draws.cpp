#include "alhazen/illumination/light_draws.h"

#include "alhazen/illumination/illumination_data.h"

namespace alhazen {

namespace {

/// Prefetches an emitter: of many lights most are not in the cache.
void fetch(const Emitter& emitter) {
    constexpr std::size_t kLine = 64;
    const auto* const bytes = reinterpret_cast<const char*>(&emitter);
    for (std::size_t at = 0; at < sizeof(Emitter); at += kLine) __builtin_prefetch(bytes + at);
}

}  // namespace

void LightDraws::add(const LitPoint& at, double choice, const Vec2& u, const Wavelengths& waves) {
    const Illumination::Data& d = *lights_.data_;
    const std::size_t i = size_++;
    if (choice >= d.near_share) {
        const ChosenLight chosen = d.choose_far(choice);
        if (chosen.probability > 0.0 && d.is_environment(chosen.light) &&
            d.environment->searches(u)) {
            sky_draws_[sky_++] = {i, chosen, at, &waves, d.environment->begin(u)};
        } else {
            results_.set(i, d.draw_far(chosen, at, u, waves));
        }
        return;
    }
    near_points_.set(near_, at);
    near_choices_.of[near_] = choice / d.near_share;
    near_draws_[near_++] = {i, u, &waves};
}

void LightDraws::draw_near() {
    const Illumination::Data& d = *lights_.data_;
    std::array<ChosenLight, kMost> chosen;
    d.choose_near(near_points_, near_choices_, near_, chosen.data());
    for (const ChosenLight& one : std::span(chosen).first(near_)) {
        if (one.probability > 0.0 && d.is_emitter(one.light)) fetch(d.emitter(one.light));
    }
    for (std::size_t k = 0; k < near_; ++k) {
        const auto& [draw, u, waves] = near_draws_[k];
        const std::size_t light = chosen[k].light;
        const double probability = d.near_share * chosen[k].probability;
        if (!(probability > 0.0)) {
            results_.set(draw, {});
        } else if (!d.is_emitter(light) || !RectangleLanes::takes(d.emitter(light)) ||
                   is_far(d.emitter(light), near_points_.point_of(k))) {
            results_.set(draw, d.draw_near(light, probability, near_points_[k], u, *waves));
        } else {
            rectangles_.set(in_lanes_, d.emitter(light), near_points_.point_of(k), u);
            waiting_[in_lanes_++] = {draw, light, probability, waves};
        }
    }
}

void LightDraws::draw_sky() {
    const Illumination::Data& d = *lights_.data_;
    const std::span<SkyDraw> draws = std::span(sky_draws_).first(sky_);
    for (const SkyDraw& draw : draws) d.environment->approach(draw.search);
    for (SkyDraw& draw : draws) d.environment->find(draw.search);
    for (const SkyDraw& draw : draws) {
        const LitPoint& at = draw.at;
        const Vec3 direction = d.environment->direction(draw.search);
        const bool counts = at.both_sides || at.in_volume || dot(direction, at.normal) > 0.0;
        results_.set(draw.draw,
                     counts ? d.draw_sky(draw.chosen, at, direction, *draw.waves) : LightDraw{});
    }
}

void LightDraws::draw_rectangles() {
    const Illumination::Data& d = *lights_.data_;
    rectangles_.draw();
    const RectangleLanes::Numbers& n = rectangles_.numbers();
    for (std::size_t lane = 0; lane < in_lanes_; ++lane) {
        const Waiting& w = waiting_[lane];
        const bool in_lane = ((n.drawn & n.shining) >> lane & 1u) != 0 && !w.waves->is_spectral();
        const Rgb* const radiance = in_lane ? d.constant_radiance(w.light) : nullptr;
        if (radiance == nullptr) {
            const EmitterSample sample = rectangles_.sampled(lane);
            results_.set(w.draw, d.draw_of_emitter(w.light, w.probability, rectangles_.from(lane),
                                                   sample, *w.waves));
            continue;
        }
        // As `draw_of_emitter`.
        for (int k = 0; k < 3; ++k) results_.to_light[k][w.draw] = n.to_light[k][lane];
        results_.distance[w.draw] = n.distance[lane];
        results_.density[w.draw] = w.probability * n.density[lane];
        results_.set(w.draw, w.waves->emission(*radiance), false, {w.light, {}});
    }
}

void LightDraws::draw() {
    draw_sky();
    draw_near();
    if (in_lanes_ > 0) draw_rectangles();
}

void LightDraws::Results::set(std::size_t lane, const LightDraw& draw) {
    for (int k = 0; k < 3; ++k) to_light[k][lane] = draw.to_light[k];
    distance[lane] = draw.distance;
    density[lane] = draw.density;
    set(lane, draw.radiance, draw.singular, draw.place);
}

void LightDraws::Results::set(std::size_t lane, const Spectrum& light, bool is_singular,
                              const PlaceInLight& place) {
    for (int k = 0; k < Spectrum::kCount; ++k) radiance[k][lane] = light[k];
    const std::uint32_t bit = 1u << lane;
    singular = is_singular ? singular | bit : singular & ~bit;
    places[lane] = place;
}

LightDraw LightDraws::operator[](std::size_t i) const {
    const Results& r = results_;
    return {.to_light = {r.to_light[0][i], r.to_light[1][i], r.to_light[2][i]},
            .distance = r.distance[i],
            .radiance = {r.radiance[0][i], r.radiance[1][i], r.radiance[2][i], r.radiance[3][i]},
            .density = r.density[i],
            .singular = (r.singular >> i & 1u) != 0,
            .place = r.places[i]};
}

}  // namespace alhazen
