#include "alhazen/renderers/light_transport/splat_film.h"

#include <algorithm>
#include <cmath>

#include "alhazen/imaging/film/filter_kernel.h"

namespace alhazen {

SplatFilm::SplatFilm(const Film& film, const SamplingPlan& plan)
    : filter_(*plan.filter),
      radius_(plan.radius),
      width_(film.frame_width()),
      height_(film.frame_height()),
      crop_(film.crop()),
      sums_(film.crop().area()) {
    double integral = 0.0;
    const double step = 2.0 * radius_ / FilterKernel::kCells;
    for (int i = 0; i < FilterKernel::kCells; ++i) {
        integral += step * filter_.value(-radius_ + (i + 0.5) * step, radius_);
    }
    scale_ = 1.0 / integral;
}

double SplatFilm::kernel(double offset) const {
    return std::abs(offset) <= radius_ ? scale_ * filter_.value(offset, radius_) : 0.0;
}

bool SplatFilm::add(const Vec2& place, const Rgb& light) {
    const double x = place.x * width_, y = (1.0 - place.y) * height_;
    const auto first = [&](double at) { return static_cast<int>(std::ceil(at - radius_ - 0.5)); };
    const auto last = [&](double at) { return static_cast<int>(std::floor(at + radius_ - 0.5)); };
    bool finite = true;
    for (int j = std::max(first(y), crop_.y0); j <= std::min(last(y), crop_.y1 - 1); ++j) {
        for (int i = std::max(first(x), crop_.x0); i <= std::min(last(x), crop_.x1 - 1); ++i) {
            const double share = kernel(x - i - 0.5) * kernel(y - j - 0.5);
            Sum& sum = sums_[std::size_t(j - crop_.y0) * std::size_t(crop_.width()) +
                             std::size_t(i - crop_.x0)];
            const bool added = sum.add({share * light.r, share * light.g, share * light.b});
            finite = finite && added;
        }
    }
    return finite;
}

void SplatFilm::add_to(Film& film, double paths) const {
    const double scale = static_cast<double>(width_) * height_ / paths;
    std::size_t k = 0;
    for (int j = crop_.y0; j < crop_.y1; ++j) {
        for (int i = crop_.x0; i < crop_.x1; ++i) {
            const auto [r, g, b] = sums_[k++].value();
            film.set(i, j, film.at(i, j) + scale * Rgb{r, g, b});
        }
    }
}

}  // namespace alhazen
