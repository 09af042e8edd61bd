#pragma once
/// Writes an NFF file statement by statement, for the generators of the Standard Procedural
/// Databases.
///
/// Source: Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987.
/// Conventions: numbers have at most `digits` significant digits, as by "%g" of C; the published
/// files have six. Angles are in degrees, as in the file.

#include <cstdint>
#include <span>
#include <string>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// Viewpoint statement `v`.
struct NffTextView {
    Vec3 from, at, up;
    double angle_deg = 45;
    double hither = 1;
    int resolution = 512;  ///< pixels per side
};

/// Material statement `f`.
struct NffTextFill {
    Rgb color;
    double diffuse = 0, specular = 0, shininess = 0, transmission = 0, index = 0;
};

class NffText {
  public:
    /// Significant digits of the published files.
    static constexpr int kPublishedDigits = 6;

    explicit NffText(int digits = kPublishedDigits) : digits_(digits) {}

    void background(const Rgb& color);
    void view(const NffTextView& view);
    void light(const Vec3& position);
    void fill(const NffTextFill& fill);
    void sphere(const Vec3& center, double radius);
    /// Cone or cylinder without caps.
    void cone(const Vec3& base, double base_radius, const Vec3& apex, double apex_radius);
    void polygon(std::span<const Vec3> vertices);
    /// Polygon with one normal per vertex.
    void patch(std::span<const Vec3> vertices, std::span<const Vec3> normals);

    [[nodiscard]] std::string take() { return std::move(text_); }

  private:
    void numbers(std::initializer_list<double> values);
    void vector_line(const char* word, const Vec3& v);

    int digits_;
    std::string text_;
};

}  // namespace alhazen
