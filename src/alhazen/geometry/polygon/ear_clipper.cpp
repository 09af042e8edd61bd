#include "alhazen/geometry/polygon/ear_clipper.h"

#include <algorithm>

#include "alhazen/math/orientation.h"

namespace alhazen {

EarClipper::EarClipper(const std::vector<Vec2>& flat)
    : flat_(flat),
      corners_(flat.size()),
      ears_(flat.size()),
      straight_(flat.size()),
      convex_(flat.size()),
      left_(flat.size()) {
    const std::size_t n = flat.size();
    for (std::size_t i = 0; i < n; ++i) {
        corners_[i].previous = std::uint32_t(i == 0 ? n - 1 : i - 1);
        corners_[i].next = std::uint32_t(i + 1 == n ? 0 : i + 1);
    }
    triangles_.reserve(n - 2);
    renew_at_ = n;
}

std::vector<std::array<std::uint32_t, 3>> EarClipper::clip() {
    merge_repeated();
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
        if (!corners_[i].gone) cut_spikes(i);
    }
    rebuild();
    renew_ears();
    std::uint32_t at = 0;
    while (corners_[at].gone) ++at;
    while (left_ > 2) {
        at = next_corner(at);
        cut(at);
        at = corners_[at].next;  // continues around the polygon, so that triangles do not share one
                                 // vertex
        while (corners_[at].gone) at = corners_[at].next;
        if (left_ <= rebuild_at_) rebuild();
    }
    return std::move(triangles_);
}

/// Cuts off vertices that coincide with the next one, which have no angle.
void EarClipper::merge_repeated() {
    for (std::uint32_t i = 0; i < corners_.size() && left_ > 2; ++i) {
        if (flat_[i] == flat_[corners_[i].next]) emit(i);
    }
}

/// True if the outline turns back at the corner, or does not move to or from it: its triangle has
/// no area, so that without the corner the loop surrounds the same points.
bool EarClipper::is_spike(std::uint32_t i) const {
    const Vec2 a = flat_[corners_[i].previous], b = flat_[i], c = flat_[corners_[i].next];
    const Vec2 to = b - a, from = c - b;
    return to.x * from.x + to.y * from.y <= 0.0 && orientation(a, b, c) == 0;
}

/// Cuts off spikes at a corner and the next one, and those that this makes. Returns the last corner
/// left at or before it.
std::uint32_t EarClipper::cut_spikes(std::uint32_t at) {
    while (left_ > 2) {
        const std::uint32_t next = corners_[at].next;
        if (is_spike(at)) {
            emit(at);
            at = corners_[at].previous;
        } else if (is_spike(next)) {
            emit(next);
        } else {
            break;
        }
    }
    return at;
}

/// Rebuilds the tree over the remaining vertices, at most half as many as at the last build.
void EarClipper::rebuild() {
    std::vector<std::uint32_t> ids;
    ids.reserve(left_);
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
        if (!corners_[i].gone) ids.push_back(i);
    }
    if (reflex_) spent_ += reflex_->tests();
    reflex_.emplace(flat_, ids);
    for (const std::uint32_t i : ids) classify(i);
    rebuild_at_ = left_ / 2;
}

void EarClipper::renew_ears() {
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
        if (!corners_[i].gone) update_ear(i);
    }
    renew_at_ = left_ - left_ / 8;
}

void EarClipper::classify(std::uint32_t i) {
    const Corner& corner = corners_[i];
    const int turn = orientation(flat_[corner.previous], flat_[i], flat_[corner.next]);
    straight_.assign(i, turn == 0);
    convex_.assign(i, turn >= 0);
    reflex_->activate(i, turn < 0);
}

/// A corner that does not turn right is an ear if no reflex vertex lies in its triangle.
void EarClipper::update_ear(std::uint32_t i) {
    const Corner& corner = corners_[i];
    bool ear = convex_.contains(i);
    const std::uint64_t most = std::max(kMostTests, kTestsPerVertex * flat_.size());
    if (ear && spent_ + reflex_->tests() < most) {
        ear = !reflex_->any_in(flat_[corner.previous], flat_[i], flat_[corner.next]);
    }
    ears_.assign(i, ear);
}

/// The first ear around the polygon, starting at `from`.
std::uint32_t EarClipper::next_corner(std::uint32_t from) {
    std::optional<std::uint32_t> found = ears_.next_around(from);
    if (!found && left_ <= renew_at_) {
        // If the polygon touches itself, a cut may create ears at corners other than the two
        // neighbours. Updated after an eighth of the corners is gone: O(n) tests in total.
        renew_ears();
        found = ears_.next_around(from);
    }
    if (!found) found = straight_.next_around(from);
    if (!found) found = convex_.next_around(from);
    return found.value_or(from);
}

/// Emits the triangle of a corner and removes the corner from the loop.
void EarClipper::emit(std::uint32_t at) {
    Corner& corner = corners_[at];
    triangles_.push_back({corner.previous, at, corner.next});
    corner.gone = true;
    corners_[corner.previous].next = corner.next;
    corners_[corner.next].previous = corner.previous;
    --left_;
    for (OrderedBits* bits : {&ears_, &straight_, &convex_}) bits->assign(at, false);
    if (reflex_) reflex_->activate(at, false);
}

void EarClipper::cut(std::uint32_t at) {
    emit(at);
    std::uint32_t previous = corners_[at].previous;
    while (left_ > 2 && flat_[previous] == flat_[corners_[at].next]) {
        emit(previous);
        previous = corners_[previous].previous;
    }
    previous = cut_spikes(previous);
    if (left_ <= 2) return;
    const std::uint32_t next = corners_[previous].next;
    classify(previous);
    classify(next);
    update_ear(previous);
    update_ear(next);
}

}  // namespace alhazen
