#include "alhazen/imaging/film/shared_film.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

/// Number of linear pieces of a kernel's table; beyond the radius the kernel is 0.
constexpr int kPieces = 2048;

}  // namespace

SharedFilm::SharedFilm(const FilterEntry& filter, double radius, const PixelBox& crop)
    : radius_(radius),
      // The reach of a sample at the border of its pixel; one pixel more would have only distance
      // 0.
      reach_(std::max(0, static_cast<int>(std::ceil(radius - 0.5)))),
      crop_(crop),
      pixels_(crop.area()) {
    table_.reserve(kPieces + 2);
    for (int i = 0; i <= kPieces; ++i) {
        table_.push_back(filter.value(radius * i / kPieces, radius));
    }
    table_.push_back(0.0);
}

double SharedFilm::kernel(double distance) const {
    const double place = std::abs(distance) * (kPieces / radius_);
    if (!(place <= kPieces)) return 0.0;
    const auto piece = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(piece);
    return (1.0 - share) * table_[piece] + share * table_[piece + 1];
}

SharedFilm::Spread::Spread(const SharedFilm& film)
    : film_(film),
      sums_(std::size_t(2 * film.reach_ + 1) * std::size_t(2 * film.reach_ + 1)),
      column_(std::size_t(2 * film.reach_ + 1)),
      row_(column_.size()) {}

void SharedFilm::Spread::add(const Vec2& offset, const Rgb& sample) {
    const int reach = film_.reach_;
    for (int k = -reach; k <= reach; ++k) {
        column_[std::size_t(k + reach)] = film_.kernel(offset.x - k);
        // Rows are numbered downwards.
        row_[std::size_t(k + reach)] = film_.kernel(offset.y + k);
    }
    Sum* sum = sums_.data();
    for (const double r : row_) {
        for (const double c : column_) {
            const double weight = r * c;
            sum->color += weight * sample;
            sum->weight += weight;
            ++sum;
        }
    }
}

bool SharedFilm::add(int x, int y, Spread& spread) {
    bool all = true;
    std::size_t k = 0;
    for (int j = y - reach_; j <= y + reach_; ++j) {
        for (int i = x - reach_; i <= x + reach_; ++i) {
            Spread::Sum& sum = spread.sums_[k++];
            const bool inside = i >= crop_.x0 && i < crop_.x1 && j >= crop_.y0 && j < crop_.y1;
            if (inside && sum.weight != 0.0) {
                Pixel& pixel = pixels_[std::size_t(j - crop_.y0) * std::size_t(crop_.width()) +
                                       std::size_t(i - crop_.x0)];
                const bool added = pixel.add({sum.color.r, sum.color.g, sum.color.b, sum.weight});
                all = all && added;
            }
            sum = {};
        }
    }
    return all;
}

void SharedFilm::write(Film& film) const {
    std::size_t k = 0;
    for (int j = crop_.y0; j < crop_.y1; ++j) {
        for (int i = crop_.x0; i < crop_.x1; ++i) {
            const auto [r, g, b, weight] = pixels_[k++].value();
            if (!(weight > 0.0)) continue;
            film.set(i, j, (1.0 / weight) * Rgb{r, g, b});
        }
    }
}

}  // namespace alhazen
