#include "alhazen/geometry/motion/transform_motion.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

using Quaternion = std::array<double, 4>;

Mat3 transpose(const Mat3& m) {
    return {{m.x_axis.x, m.y_axis.x, m.z_axis.x},
            {m.x_axis.y, m.y_axis.y, m.z_axis.y},
            {m.x_axis.z, m.y_axis.z, m.z_axis.z}};
}
Mat3 mixed(double a, const Mat3& m, double b, const Mat3& n) {
    return {a * m.x_axis + b * n.x_axis, a * m.y_axis + b * n.y_axis, a * m.z_axis + b * n.z_axis};
}
double largest_entry(const Mat3& m) {
    return std::max(
        {max_component(abs(m.x_axis)), max_component(abs(m.y_axis)), max_component(abs(m.z_axis))});
}
/// A bound on the length of m v for unit v (Frobenius norm).
double norm_of(const Mat3& m) {
    return std::sqrt(length_squared(m.x_axis) + length_squared(m.y_axis) +
                     length_squared(m.z_axis));
}

/// The orthogonal factor of the polar decomposition, by Higham's iteration (Newton's method for Q^T
/// Q = 1).
Mat3 orthogonal_factor(const Mat3& m) {
    const double size = std::cbrt(std::abs(determinant(m)));
    Mat3 q = mixed(1.0 / size, m, 0.0, m);
    for (int i = 0; i < 64; ++i) {
        const Mat3 next = mixed(0.5, q, 0.5, transpose(inverse(q)));
        const double change = largest_entry(mixed(1.0, next, -1.0, q));
        q = next;
        if (change < 1e-15) break;
    }
    return q;
}

/// The quaternion of a rotation matrix, computed from its largest component.
Quaternion quaternion_of(const Mat3& m) {
    const double xx = m.x_axis.x, yy = m.y_axis.y, zz = m.z_axis.z;
    const double squares[4] = {1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz,
                               1 + xx + yy + zz};
    const auto k = static_cast<std::size_t>(std::max_element(squares, squares + 4) - squares);
    const double s = 2.0 * std::sqrt(squares[k]);
    const double yz = m.y_axis.z - m.z_axis.y, zx = m.z_axis.x - m.x_axis.z,
                 xy = m.x_axis.y - m.y_axis.x;
    const double xy2 = m.y_axis.x + m.x_axis.y, zx2 = m.x_axis.z + m.z_axis.x,
                 yz2 = m.z_axis.y + m.y_axis.z;
    switch (k) {
        case 0:
            return {s / 4, xy2 / s, zx2 / s, yz / s};
        case 1:
            return {xy2 / s, s / 4, yz2 / s, zx / s};
        case 2:
            return {zx2 / s, yz2 / s, s / 4, xy / s};
        default:
            return {yz / s, zx / s, xy / s, s / 4};
    }
}

Mat3 matrix_of(const Quaternion& q) {
    const auto [x, y, z, w] = q;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

double dot(const Quaternion& a, const Quaternion& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/// `half`: half the angle of the rotation from a to b, 0 if they are equal.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double half, double share) {
    double from = 1.0 - share, to = share;
    if (half > 1e-6) {
        const double sine = std::sin(half);
        from = std::sin((1.0 - share) * half) / sine;
        to = std::sin(share * half) / sine;
    }
    Quaternion q;
    for (std::size_t k = 0; k < 4; ++k) q[k] = from * a[k] + to * b[k];
    const double size = std::sqrt(dot(q, q));
    for (double& c : q) c /= size;
    return q;
}

}  // namespace

const char* fault_of(std::span<const TransformKey> keys) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!std::isfinite(keys[i].time) || (i > 0 && !(keys[i - 1].time < keys[i].time))) {
            return "the times of a motion's keys must ascend";
        }
        if (!is_invertible(keys[i].outer_from_inner)) {
            return "a motion's transforms must be finite and have an inverse";
        }
        const auto mirrors = [&](std::size_t k) {
            return determinant(keys[k].outer_from_inner.linear) < 0.0;
        };
        if (mirrors(i) != mirrors(0)) {
            return "a motion cannot turn from its object to the mirror image: it would be flat in "
                   "between";
        }
    }
    return nullptr;
}

TransformMotion::TransformMotion(std::span<const TransformKey> keys) {
    for (const TransformKey& key : keys) {
        const Mat3& m = key.outer_from_inner.linear;
        Mat3 q = orthogonal_factor(m);
        if (determinant(m) < 0.0) q = mixed(-1.0, q, 0.0, q);
        const Mat3 raw = transpose(q) * m;
        keys_.push_back({key.time, key.outer_from_inner, quaternion_of(q),
                         mixed(0.5, raw, 0.5, transpose(raw))});
    }
    for (std::size_t i = 0; i + 1 < keys_.size(); ++i) {
        Key &a = keys_[i], &b = keys_[i + 1];
        if (dot(a.rotation, b.rotation) < 0.0) {
            for (double& c : b.rotation) c = -c;
        }
        const Mat3 &m = a.own.linear, &n = b.own.linear;
        // Computes the angle by its sine, which is accurate for small angles.
        Quaternion apart;
        for (std::size_t k = 0; k < 4; ++k) apart[k] = b.rotation[k] - a.rotation[k];
        const double half = 2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(dot(apart, apart))));
        steps_.push_back({2.0 * half, m == n, {}, {}});
    }
    find_linear_parts();
}

TransformMotion::Moment TransformMotion::moment(double time) const {
    if (time <= keys_.front().time) return {0, 0.0};
    if (time >= keys_.back().time) return {keys_.size() - 1, 0.0};
    std::size_t i = 0;
    while (time >= keys_[i + 1].time) ++i;
    return {i, (time - keys_[i].time) / (keys_[i + 1].time - keys_[i].time)};
}

Affine TransformMotion::own_at(const Moment& m) const {
    const Key& a = keys_[m.i];
    if (m.share == 0.0) return a.own;
    const Key& b = keys_[m.i + 1];
    const Vec3 translation = (1.0 - m.share) * a.own.translation + m.share * b.own.translation;
    const Step& step = steps_[m.i];
    if (step.translates) return {a.own.linear, translation};
    const Quaternion q = slerp(a.rotation, b.rotation, 0.5 * step.angle, m.share);
    return {matrix_of(q) * mixed(1.0 - m.share, a.stretch, m.share, b.stretch), translation};
}

void TransformMotion::find_linear_parts() {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        if (!steps_[i].translates) continue;
        steps_[i].linear = has_outer_ ? outer_.linear * keys_[i].own.linear : keys_[i].own.linear;
        steps_[i].inverse = alhazen::inverse(steps_[i].linear);
    }
}

Placement TransformMotion::at(double time) const {
    const Moment m = moment(time);
    if (m.i < steps_.size() && steps_[m.i].translates) {
        const Step& step = steps_[m.i];
        const Vec3 &a = keys_[m.i].own.translation, &b = keys_[m.i + 1].own.translation;
        const Vec3 own = m.share == 0.0 ? a : (1.0 - m.share) * a + m.share * b;
        const Vec3 translation = has_outer_ ? outer_.point(own) : own;
        return {{step.linear, translation}, {step.inverse, -(step.inverse * translation)}};
    }
    const Affine own = own_at(m);
    const Affine outer_from_inner = has_outer_ ? outer_ * own : own;
    return {outer_from_inner, inverse(outer_from_inner)};
}

TransformMotion TransformMotion::inside(const Affine& outer_from_here) const {
    if (outer_from_here == Affine{}) return *this;
    TransformMotion motion = *this;
    motion.outer_ = outer_from_here * outer_;
    motion.has_outer_ = true;
    motion.find_linear_parts();
    return motion;
}

double TransformMotion::sag(std::size_t step, double reach, int n) const {
    // With rotation R, stretch S and the parameter u of the step, p = T + R S x, so |p''| <= |R''|
    // |S x| + 2 |R'| |S'| |x|, and a chord of length h misses by h^2 |p''| / 8.
    const double angle = steps_[step].angle;
    const Mat3 &a = keys_[step].stretch, &b = keys_[step + 1].stretch;
    const double size = std::max(norm_of(a), norm_of(b)) * reach;
    const double change = norm_of(mixed(1.0, b, -1.0, a)) * reach;
    return (angle * angle * size + 2.0 * angle * change) / (8.0 * n * n);
}

MovingBox TransformMotion::bounds(const Box3& inner) const {
    if (inner.empty()) return {};
    if (!inner.bounded()) return {kAllSpace, kAllSpace};
    const auto box_at = [&](double time) {
        return padded(transformed(at(time).outer_from_inner, inner), 1e-13);
    };
    MovingBox box{box_at(0.0), box_at(1.0)};
    double reach = 0;
    for (int i = 0; i < 8; ++i) reach = std::max(reach, length(inner.corner(i)));
    const double outer = has_outer_ ? norm_of(outer_.linear) : 1.0;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const double begin = keys_[i].time, length = keys_[i + 1].time - begin;
        // Steps of an eighth of a radian; padding bounds the rest.
        const int n = std::clamp(int(std::ceil(8.0 * steps_[i].angle)), 1, 64);
        const double pad = outer * sag(i, reach, n);
        for (int k = 0; k <= n; ++k) {
            // A time outside the shutter interval is clamped: chords become shorter.
            const double time = std::clamp(begin + length * k / n, 0.0, 1.0);
            Box3 here = box_at(time);
            here.lo -= Vec3{pad, pad, pad};
            here.hi += Vec3{pad, pad, pad};
            box.widen_to(time, here);
        }
    }
    return box;
}

}  // namespace alhazen
