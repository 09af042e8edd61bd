#pragma once
/// Splits the primitives of a table into bounded ones, which an accelerator can be built over, and
/// unbounded ones (planes and other shapes without a finite box), which are few and tested for
/// every ray. Every query is an interruption point of the builder that calls it.

#include <cstdint>
#include <vector>

#include "alhazen/base/interruption.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

class BoundedPrimitives final : public BoundsSource {
  public:
    /// Boxes with a coordinate beyond this count as unbounded: sums of squares must not overflow.
    static constexpr double kReach = 1e150;

    /// Keeps a reference to `table`.
    explicit BoundedPrimitives(const PrimitiveTable& table);

    [[nodiscard]] std::size_t size() const override {
        return identity_ ? table_.size() : bounded_.size();
    }
    [[nodiscard]] Box3 box(std::size_t i) const override {
        interruption_point();
        return table_.box(id(i));
    }
    [[nodiscard]] Interval extent(std::size_t i, const Vec3& axis) const override {
        interruption_point();
        return table_.extent(id(i), axis);
    }
    [[nodiscard]] BoundingSphere sphere(std::size_t i) const override {
        interruption_point();
        return table_.sphere(id(i));
    }
    [[nodiscard]] bool overlaps(std::size_t i, const Box3& cell) const override {
        interruption_point();
        return table_.overlaps(id(i), cell);
    }
    [[nodiscard]] Box3 clipped_box(std::size_t i, const Box3& cell) const override {
        interruption_point();
        return table_.clipped_box(id(i), cell);
    }
    [[nodiscard]] std::optional<std::array<Vec3, 3>> triangle(std::size_t i) const override {
        interruption_point();
        return table_.triangle(id(i));
    }
    [[nodiscard]] bool blocks_light(std::size_t i) const override {
        return table_.blocks_light(id(i));
    }
    [[nodiscard]] std::span<const RayEnd> ray_ends() const override { return table_.ray_ends(); }

    /// The table id of the i-th bounded primitive; ascending.
    [[nodiscard]] std::uint32_t id(std::size_t i) const {
        return identity_ ? static_cast<std::uint32_t>(i) : bounded_[i];
    }
    /// Moves the ids of the bounded primitives out; empty when primitive i is the i-th bounded one.
    [[nodiscard]] std::vector<std::uint32_t> take_bounded() {
        return identity_ ? std::vector<std::uint32_t>{} : std::move(bounded_);
    }
    [[nodiscard]] const std::vector<PrimitiveId>& unbounded() const { return unbounded_; }
    /// The box of all primitives; infinite if any of them is.
    [[nodiscard]] const Box3& all() const { return all_; }

  private:
    const PrimitiveTable& table_;
    std::vector<std::uint32_t> bounded_;
    std::vector<PrimitiveId> unbounded_;
    Box3 all_;
    bool identity_ = false;
};

}  // namespace alhazen
