#pragma once
/// Results of queries about solids as JSON, one line per ray or point.
///
/// Conventions: numbers round-trip exactly; null is infinite. `solid` is the number of the solid,
/// `name` its name (SolidScene).

#include <istream>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "alhazen/solids/solid_scene.h"

namespace alhazen {

[[nodiscard]] nlohmann::ordered_json spans_json(const SolidScene& scene, const Ray& ray,
                                                std::span<const SolidSpan> spans);
[[nodiscard]] nlohmann::ordered_json thickness_json(const SolidScene& scene, const Ray& ray,
                                                    const Thickness& thickness);
[[nodiscard]] nlohmann::ordered_json inside_json(const SolidScene& scene, const Vec3& point,
                                                 std::span<const Containment> solids);

/// Parses numbers separated by commas or white space; "inf" is a number. Throws Error (Usage) that
/// names `what` if their count is not in `counts` or a word is not a number.
[[nodiscard]] std::vector<double> parse_numbers(const std::string& text,
                                                std::initializer_list<std::size_t> counts,
                                                const std::string& what,
                                                const FileLocation& where = {});
/// Parses "ox,oy,oz,dx,dy,dz[,t_min,t_max]". Throws Error (Usage), also for an invalid ray.
[[nodiscard]] Ray parse_ray(const std::string& text, const FileLocation& where = {});
/// Parses "x,y,z". Throws Error (Usage).
[[nodiscard]] Vec3 parse_point(const std::string& text, const FileLocation& where = {});

/// Reads the lines of a text file in batches, without empty lines and comments after '#'. A byte
/// order mark of UTF-8 is skipped; other encodings of Unicode are an Error (Scene).
class LineReader {
  public:
    struct Line {
        std::string text;
        FileLocation where;
    };
    LineReader(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}
    /// Up to `count` further lines; none at the end. Throws Error (File) when reading fails.
    [[nodiscard]] std::vector<Line> next(std::size_t count);

  private:
    std::istream& in_;
    std::string name_;
    int line_ = 0;
};

}  // namespace alhazen
