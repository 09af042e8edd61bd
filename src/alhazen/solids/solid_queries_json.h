#pragma once
/// Answers about the solids of a scene as JSON, one line for each ray or point.
///
/// Conventions: numbers have as many digits as repeat them exactly; null is infinite. `solid` is
/// the number of the solid, `name` its name (SolidScene).

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

/// The numbers of a text, apart by commas or white space. Throws Error (Usage) that names `what`
/// when there are not as many as one of `counts` or one of them is none; "inf" is a number.
[[nodiscard]] std::vector<double> parse_numbers(const std::string& text,
                                                std::initializer_list<std::size_t> counts,
                                                const std::string& what,
                                                const FileLocation& where = {});
/// "ox,oy,oz,dx,dy,dz[,t_min,t_max]". Throws Error (Usage), also for a ray that cannot be traced.
[[nodiscard]] Ray parse_ray(const std::string& text, const FileLocation& where = {});
/// "x,y,z". Throws Error (Usage).
[[nodiscard]] Vec3 parse_point(const std::string& text, const FileLocation& where = {});

/// Lines of a text file, without empty ones and what follows '#'; as many at a time as are asked
/// for.
class LineReader {
  public:
    struct Line {
        std::string text;
        FileLocation where;
    };
    LineReader(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}
    /// Up to `count` more lines; none at the end. Throws Error (File) when reading fails.
    [[nodiscard]] std::vector<Line> next(std::size_t count);

  private:
    std::istream& in_;
    std::string name_;
    int line_ = 0;
};

}  // namespace alhazen
