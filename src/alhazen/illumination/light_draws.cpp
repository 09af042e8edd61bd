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
            drawn_[i] = d.draw_far(chosen, at, u, waves);
        }
        return;
    }
    near_points_[near_] = at;
    near_choices_[near_] = choice / d.near_share;
    near_draws_[near_++] = {i, u, &waves};
}

void LightDraws::draw_near() {
    const Illumination::Data& d = *lights_.data_;
    std::array<ChosenLight, kMost> chosen;
    d.choose_near(std::span(near_points_).first(near_), std::span(near_choices_).first(near_),
                  chosen.data());
    for (const ChosenLight& one : std::span(chosen).first(near_)) {
        if (one.probability > 0.0 && d.is_emitter(one.light)) fetch(d.emitter(one.light));
    }
    for (std::size_t k = 0; k < near_; ++k) {
        const auto& [draw, u, waves] = near_draws_[k];
        const LitPoint& at = near_points_[k];
        const std::size_t light = chosen[k].light;
        const double probability = d.near_share * chosen[k].probability;
        if (!(probability > 0.0)) {
            drawn_[draw] = {};
        } else if (!d.is_emitter(light) || !RectangleLanes::takes(d.emitter(light))) {
            drawn_[draw] = d.draw_near(light, probability, at, u, *waves);
        } else {
            rectangles_.set(in_lanes_, d.emitter(light), at.point, u);
            waiting_[in_lanes_++] = {draw, light, probability, at.point, waves};
        }
    }
}

void LightDraws::draw_sky() {
    const Illumination::Data& d = *lights_.data_;
    const std::span<SkyDraw> draws = std::span(sky_draws_).first(sky_);
    for (const SkyDraw& draw : draws) d.environment->approach(draw.search);
    for (SkyDraw& draw : draws) d.environment->find(draw.search);
    for (const SkyDraw& draw : draws) {
        drawn_[draw.draw] =
            d.draw_sky(draw.chosen, draw.at, d.environment->direction(draw.search), *draw.waves);
    }
}

void LightDraws::draw() {
    draw_sky();
    draw_near();
    if (in_lanes_ == 0) return;
    rectangles_.draw();
    for (std::size_t lane = 0; lane < in_lanes_; ++lane) {
        const Waiting& w = waiting_[lane];
        drawn_[w.draw] = lights_.data_->draw_of_emitter(w.light, w.probability, w.at,
                                                        rectangles_.sampled(lane), *w.waves);
    }
}

}  // namespace alhazen
