#include "alhazen/renderers/bidirectional/path_weight.h"

namespace alhazen {

namespace {

double known(double density) {
    return density > 0.0 ? density : 1.0;
}

bool is_possible(const WholePath& path, int s) {
    const int m = static_cast<int>(path.vertices.size()) - 1;
    const auto singular = [&](int i) {
        return path.vertices[static_cast<std::size_t>(i)].singular;
    };
    if (s == 0) return path.hit;
    if (s == 1) return path.joined > 0.0 && !(m >= 1 && singular(1));
    if (!path.emitted || singular(s - 1)) return false;
    return s == m + 1 || !singular(s);
}

/// Ratio of the densities of strategies s + 1 and s.
double step(const WholePath& path, int s) {
    const auto at = [&](int i) -> const WholePath::Vertex& {
        return path.vertices[static_cast<std::size_t>(i)];
    };
    const double joined = known(path.joined);
    if (s == 0) return joined / known(at(0).from_eye);
    double ratio = known(at(s).from_light) / known(at(s).from_eye);
    if (s == 1) ratio *= known(at(0).from_light) / joined;
    return ratio;
}

bool is_merged(const WholePath& path, int k) {
    const WholePath::Vertex& v = path.vertices[static_cast<std::size_t>(k)];
    return path.merging > 0.0 && path.emitted && k >= 2 && !v.singular && !v.in_volume;
}

/// `own` plus the squared densities of all other strategies relative to that of strategy s.
double sum_of_squares(const WholePath& path, int s, double own) {
    const int m = static_cast<int>(path.vertices.size()) - 1;
    const auto at = [&](int i) -> const WholePath::Vertex& {
        return path.vertices[static_cast<std::size_t>(i)];
    };
    double sum = own;
    double ratio = 1.0;
    for (int i = s; i <= m; ++i) {
        ratio *= step(path, i);
        if (is_possible(path, i + 1)) sum += ratio * ratio;
        if (is_merged(path, i)) {
            const double merged = ratio * known(at(i).from_eye) * path.merging;
            sum += merged * merged;
        }
    }
    ratio = 1.0;
    for (int i = s; i-- > 0;) {
        ratio /= step(path, i);
        if (is_possible(path, i)) sum += ratio * ratio;
        if (is_merged(path, i)) {
            const double merged = ratio * known(at(i).from_light) * path.merging;
            sum += merged * merged;
        }
    }
    return sum;
}

}  // namespace

double path_weight(const WholePath& path, int s) {
    return path.vertices.size() == 1 ? 1.0 : 1.0 / sum_of_squares(path, s, 1.0);
}

double merged_path_weight(const WholePath& path, int k) {
    const double merged =
        known(path.vertices[static_cast<std::size_t>(k)].from_light) * path.merging;
    const double squared = merged * merged;
    return squared / sum_of_squares(path, k, is_possible(path, k) ? 1.0 : 0.0);
}

}  // namespace alhazen
