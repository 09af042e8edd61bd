#pragma once
/// Writes SVG: nested elements with attributes, escaped text, paths and points.
///
/// Source: W3C, "Scalable Vector Graphics (SVG) 1.1", 2nd ed., 2011.
/// Conventions: y points down in the output; callers flip it. Text is ASCII: other characters
/// become '?', so that names from any file give well-formed XML. Coordinates are written with a
/// fixed number of decimals (`decimals`) or with ten significant digits (`digits`).

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// The text with the characters of markup escaped.
[[nodiscard]] std::string xml_escaped(std::string_view text);
/// "#rrggbb" for a linear colour, sRGB encoded.
[[nodiscard]] std::string css_color(const Rgb& linear);

namespace svg {

[[nodiscard]] std::string decimals(double x, int count);
[[nodiscard]] std::string digits(double x);
/// "x,y x,y ..." with two decimals: the `points` attribute of a polygon or polyline.
[[nodiscard]] std::string points(std::span<const Vec2> corners);

/// The `d` attribute of a path.
class Path {
  public:
    void move_to(const Vec2& p) { add('M', p); }
    void line_to(const Vec2& p) { add('L', p); }
    void close() { data_ += 'Z'; }
    [[nodiscard]] const std::string& data() const { return data_; }

  private:
    void add(char command, const Vec2& p);
    std::string data_;
};

struct Attribute {
    std::string_view name;
    std::string value;  ///< escaped when written
};
using Attributes = std::initializer_list<Attribute>;

class Writer {
  public:
    /// Begins an element; output until `close` is its content.
    void open(std::string_view element, Attributes attributes = {});
    void close();
    /// Writes an element without content.
    void leaf(std::string_view element, Attributes attributes);
    /// Writes an element that holds text.
    void text(std::string_view element, Attributes attributes, std::string_view text);
    /// Writes markup unchanged, such as a style sheet or definitions.
    void raw(std::string_view markup) { out_ += markup; }
    /// Closes all open elements and returns the text.
    [[nodiscard]] std::string finish();

  private:
    void begin(std::string_view element, Attributes attributes);

    std::string out_;
    std::vector<std::string> open_;
};

}  // namespace svg

}  // namespace alhazen
