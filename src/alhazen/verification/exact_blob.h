#pragma once
/// All crossings of a line with a blob, for any number type.
///
/// Source: the definition in shapes/blobs/blob.h.
/// Differs: between the boundaries of components the density is summed in powers of t about the
/// middle, and its roots are isolated by those of its derivatives (exact_polynomials.h). Uses no
/// tree, no Bernstein forms and no error bounds.

#include "alhazen/verification/exact_polynomials.h"

namespace alhazen {

/// The support of a component along a line: strength q^2, q = q[0] + q[1] t + q[2] t^2.
template <class R>
struct BlobPiece {
    R in, out;
    R strength;
    PowersOf<R> q;
};

/// Adds 1 - |f + t d|^2 / scale, between lo and hi, if it is positive somewhere.
template <class R>
void add_blob_piece(const Vec3Of<R>& f, const Vec3Of<R>& d, const R& scale, const R& strength,
                    const R& lo, const R& hi, std::vector<BlobPiece<R>>& pieces) {
    const R a = dot(d, d), b = dot(f, d), c = dot(f, f) - scale;
    R in = lo, out = hi;
    if (a > 0) {
        const std::vector<R> ends = quadratic_roots<R>(a, b, c);
        if (ends.empty()) return;
        if (ends[0] > in) in = ends[0];
        if (ends[1] < out) out = ends[1];
    } else if (!(c < 0)) {
        return;
    }
    if (!(in < out)) return;
    pieces.push_back({in, out, strength, {-c / scale, -2 * b / scale, -a / scale}});
}

template <class R>
std::vector<BlobPiece<R>> blob_pieces(const Blob& blob, const LineOf<R>& line) {
    const R far = kInfinitelyFar<R>;
    const Vec3Of<R>& d = line.direction;
    std::vector<BlobPiece<R>> pieces;
    for (const BlobComponent& c : blob.components) {
        const R squared = R(c.radius) * R(c.radius), strength = c.strength;
        const Vec3Of<R> from_base = line.origin - Vec3Of<R>(c.base);
        const Vec3Of<R> axis = Vec3Of<R>(c.top) - Vec3Of<R>(c.base);
        const R length = dot(axis, axis);
        if (!c.rod || length == 0) {
            add_blob_piece<R>(from_base, d, squared, strength, -far, far, pieces);
            continue;
        }
        const Vec3Of<R> from_top = line.origin - Vec3Of<R>(c.top);
        // A rod: a cylinder between the planes through its ends, spheres beyond.
        const R speed = dot(d, axis), start = dot(from_base, axis);
        const Vec3Of<R> aside = from_base - (start / length) * axis;
        const Vec3Of<R> sideways = d - (speed / length) * axis;
        if (speed == 0) {
            const Vec3Of<R>& f = start < 0 ? from_base : start > length ? from_top : aside;
            add_blob_piece<R>(f, d, squared, strength, -far, far, pieces);
            continue;
        }
        const R at_base = -start / speed, at_top = (length - start) / speed;
        const bool up = speed > 0;
        const R& first = up ? at_base : at_top;
        const R& last = up ? at_top : at_base;
        add_blob_piece<R>(up ? from_base : from_top, d, squared, strength, -far, first, pieces);
        add_blob_piece<R>(aside, sideways, squared, strength, first, last, pieces);
        add_blob_piece<R>(up ? from_top : from_base, d, squared, strength, last, far, pieces);
    }
    return pieces;
}

template <class R>
CrossingsOf<R> exact_crossings(const Blob& blob, const LineOf<R>& line) {
    const std::vector<BlobPiece<R>> pieces = blob_pieces(blob, line);
    std::vector<R> ends;
    for (const BlobPiece<R>& piece : pieces) {
        ends.push_back(piece.in);
        ends.push_back(piece.out);
    }
    std::sort(ends.begin(), ends.end());
    CrossingsOf<R> found;
    bool inside = false;
    const auto cross = [&](const R& t) {
        found.t.push_back(t);
        inside = !inside;
    };
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const R &from = ends[i], &to = ends[i + 1];
        if (!(from < to)) continue;
        const R middle = (from + to) / 2, half = to - middle;
        PowersOf<R> sum_of{R(blob.threshold)};
        for (const BlobPiece<R>& piece : pieces) {
            if (piece.in > from || piece.out < to) continue;
            const PowersOf<R>& q = piece.q;
            const PowersOf<R> moved{q[0] + middle * (q[1] + middle * q[2]),
                                    q[1] + 2 * middle * q[2], q[2]};
            sum_of = sum(sum_of, product(moved, moved), R(-piece.strength));
        }
        // Inside where negative. At a common end of two spans rounding may give different signs.
        if ((value_at(sum_of, R(-half)) < 0) != inside) cross(from);
        for (const R& t : sign_changes(sum_of, R(-half), half)) cross(middle + t);
    }
    if (inside) cross(ends.back());
    return found;
}

}  // namespace alhazen
