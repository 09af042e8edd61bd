#pragma once
/// A shape of any type, for tests that are compiled once, not once per type.

#include <memory>
#include <utility>

#include "alhazen/base/diagnostics.h"
#include "alhazen/geometry/box.h"
#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/core/shape_hits.h"

namespace alhazen::testing {

class TestedShape {
  public:
    template <class S>
    explicit TestedShape(S shape) : shape_(std::make_shared<Model<S>>(std::move(shape))) {}

    [[nodiscard]] bool closed() const { return shape_->closed(); }
    [[nodiscard]] Box3 box() const { return shape_->box(); }
    [[nodiscard]] Interval extent(const Vec3& axis) const { return shape_->extent(axis); }
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const {
        return shape_->surface(ray, hit);
    }
    void validate(Diagnostics& diagnostics) const { shape_->validate(diagnostics); }
    /// Appends the crossings.
    void intersect(const Ray& ray, ShapeHits& hits) const { shape_->intersect(ray, hits); }
    [[nodiscard]] bool begins_inside(const Ray& line) const { return shape_->begins_inside(line); }

  private:
    struct Concept {
        virtual ~Concept() = default;
        virtual bool closed() const = 0;
        virtual Box3 box() const = 0;
        virtual Interval extent(const Vec3& axis) const = 0;
        virtual ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const = 0;
        virtual void validate(Diagnostics& diagnostics) const = 0;
        virtual void intersect(const Ray& ray, ShapeHits& hits) const = 0;
        virtual bool begins_inside(const Ray& line) const = 0;
    };
    template <class S>
    struct Model final : Concept {
        explicit Model(S s) : shape(std::move(s)) {}
        bool closed() const override { return shape.closed(); }
        Box3 box() const override { return shape.box(); }
        Interval extent(const Vec3& axis) const override { return shape.extent(axis); }
        ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const override {
            return shape.surface(ray, hit);
        }
        void validate(Diagnostics& diagnostics) const override { shape.validate({}, diagnostics); }
        void intersect(const Ray& ray, ShapeHits& hits) const override {
            append_hits(shape, ray, hits);
        }
        bool begins_inside(const Ray& line) const override {
            return inside_at_minus_infinity(shape, line);
        }
        S shape;
    };

    std::shared_ptr<const Concept> shape_;
};

}  // namespace alhazen::testing
