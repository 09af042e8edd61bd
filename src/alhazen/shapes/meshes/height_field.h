#pragma once
/// A terrain over a rectangle, solid down to a base level: two triangles per cell.
///
/// Source: Tevs, Ihrke and Seidel, "Maximum mipmaps for fast, accurate, and scalable dynamic height
/// field rendering", I3D 2008 (a pyramid of the highest and lowest values as a tree over the
/// cells).
/// Differs: exact. The geometry is triangles, intersected by the watertight test
/// (geometry/watertight_triangle.h); the top, the four sides and the bottom are a closed mesh of
/// implicit vertices, so that a line crosses it an even number of times. The tree only culls cells.
/// Conventions: samples (column, row) are evenly spaced at x from `lo.x` to `hi.x` and y from
/// `lo.y` to `hi.y`; heights are stored as float, and these floats are the geometry. Each cell is
/// cut along the diagonal from its low to its high corner. On the top and the bottom uv run with x
/// and y from 0 to 1, on the sides u along them, v upward. Flat shading.
/// Complexity: O(sqrt(samples)) cells for a grazing ray, O(log samples) for most; 2.7 bytes per
/// sample in addition to the 4 of the heights.

#include <memory>

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

/// Lowest and highest values of squares of 2^level cells, from level 1 on.
struct HeightPyramid {
    struct Level {
        std::uint32_t columns = 0, rows = 0;
        std::vector<float> lowest, highest;  ///< [row][column]
    };
    std::vector<Level> levels;
};

struct HeightField {
    static constexpr const char* kName = "height_field";
    static constexpr int kMaxHits = kManyHits;
    static constexpr bool kClosed = true;

    std::uint32_t columns = 0, rows = 0;                  ///< samples along x and along y
    std::shared_ptr<const std::vector<float>> heights{};  ///< [row][column]
    Vec2 lo{0, 0}, hi{1, 1};
    double base = -1;  ///< below all heights

    std::shared_ptr<const HeightPyramid> pyramid{};  ///< derived
    Box3 bounds{};                                   ///< derived

    static constexpr auto kFields =
        std::make_tuple(field("columns", &HeightField::columns, Unit::Count, Check::Shape),
                        field("rows", &HeightField::rows, Unit::Count, Check::Shape),
                        field("heights", &HeightField::heights, Unit::Compound, Check::Shape),
                        field("lo", &HeightField::lo, Unit::Point, Check::Shape),
                        field("hi", &HeightField::hi, Unit::Point, Check::Shape),
                        field("base", &HeightField::base, Unit::Length, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const { return bounds; }
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    void intersect(const Ray& ray, ShapeHits& hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;

    /// Corners of a triangle by its part, counter-clockwise from outside.
    [[nodiscard]] std::array<Vec3, 3> triangle(std::uint32_t part) const;
    /// The parts of a cell's top are 2 cell and 2 cell + 1; the parts of the bottom and of the
    /// sides follow.
    [[nodiscard]] std::uint32_t cells() const { return (columns - 1) * (rows - 1); }

    /// Position of a sample, or with `at_base` its projection to the base level.
    [[nodiscard]] Vec3 vertex(std::uint32_t column, std::uint32_t row, bool at_base = false) const;
    [[nodiscard]] float height(std::uint32_t column, std::uint32_t row) const {
        return (*heights)[std::size_t{row} * columns + column];
    }
};

}  // namespace alhazen
