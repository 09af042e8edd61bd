#pragma once
/// The crossings of one ray with one shape: a small vector with a capacity of `kMaxShapeHits`
/// without allocation.
///
/// Conventions: ascending in t. Shapes with a small fixed bound of crossings write into `room` and
/// state their number with `grow`; shapes with any number (`kManyHits`) append. The constructor
/// leaves the storage uninitialised. A caller that reads only the first crossings states how many;
/// a shape may stop once there are `enough`. Threads: used by one thread.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>

#include "alhazen/geometry/hit.h"

namespace alhazen {

/// Largest number of crossings with a line for shapes with a fixed bound.
inline constexpr int kMaxShapeHits = 16;

/// Value of `kMaxHits` for shapes with any number of crossings; their `intersect` appends to
/// ShapeHits.
inline constexpr int kManyHits = std::numeric_limits<int>::max();

class ShapeHits {
  public:
    static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

    /// For a caller that reads only the first `wanted` crossings.
    explicit ShapeHits(std::size_t wanted = kAll) : wanted_(wanted) {}
    ShapeHits(const ShapeHits&) = delete;
    ShapeHits& operator=(const ShapeHits&) = delete;

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    /// Largest number of crossings that the caller reads.
    [[nodiscard]] std::size_t wanted() const { return wanted_; }
    /// True if a shape may omit further crossings behind those appended.
    [[nodiscard]] bool enough() const { return size_ >= wanted_; }

    /// Storage of the next `n` crossings. Valid until the next call of a non-const function.
    ShapeHit* room(int n) {
        if (size_ + static_cast<std::size_t>(n) > capacity_) enlarge(static_cast<std::size_t>(n));
        return data() + size_;
    }
    /// Appends the first `n` crossings written to `room`.
    void grow(int n) { size_ += static_cast<std::size_t>(n); }
    void push_back(const ShapeHit& hit) {
        const ShapeHit kept = hit;  // `hit` may lie in the storage that is reallocated
        *room(1) = kept;
        ++size_;
    }
    /// Keeps the first `n`. Precondition: n <= size().
    void shrink(std::size_t n) { size_ = n; }
    void clear() { size_ = 0; }

    ShapeHit* data() { return heap_ ? heap_.get() : reinterpret_cast<ShapeHit*>(inside_); }
    [[nodiscard]] const ShapeHit* data() const {
        return heap_ ? heap_.get() : reinterpret_cast<const ShapeHit*>(inside_);
    }
    ShapeHit& operator[](std::size_t i) { return data()[i]; }
    const ShapeHit& operator[](std::size_t i) const { return data()[i]; }
    ShapeHit* begin() { return data(); }
    ShapeHit* end() { return data() + size_; }
    [[nodiscard]] const ShapeHit* begin() const { return data(); }
    [[nodiscard]] const ShapeHit* end() const { return data() + size_; }
    const ShapeHit& front() const { return data()[0]; }
    const ShapeHit& back() const { return data()[size_ - 1]; }

  private:
    void enlarge(std::size_t n) {
        const std::size_t capacity = std::max(2 * capacity_, size_ + n);
        auto larger = std::make_unique<ShapeHit[]>(capacity);
        std::copy(begin(), end(), larger.get());
        heap_ = std::move(larger);
        capacity_ = capacity;
    }

    std::size_t size_ = 0, capacity_ = kMaxShapeHits, wanted_;
    std::unique_ptr<ShapeHit[]> heap_;
    // Bytes, because an array of values would be zeroed for every ray.
    alignas(ShapeHit) std::byte inside_[kMaxShapeHits * sizeof(ShapeHit)];
};

}  // namespace alhazen
