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

/// Density of strategy s + 1 over that of s.
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

}  // namespace

double path_weight(const WholePath& path, int s) {
    const int m = static_cast<int>(path.vertices.size()) - 1;
    if (m == 0) return 1.0;
    double sum = 1.0;
    double ratio = 1.0;
    for (int i = s; i <= m; ++i) {
        ratio *= step(path, i);
        if (is_possible(path, i + 1)) sum += ratio * ratio;
    }
    ratio = 1.0;
    for (int i = s; i-- > 0;) {
        ratio /= step(path, i);
        if (is_possible(path, i)) sum += ratio * ratio;
    }
    return 1.0 / sum;
}

}  // namespace alhazen
