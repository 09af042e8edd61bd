#pragma once
/// YAML text made safe to read: limits first, then nodes whose values are read as the course's
/// program wrote them.
///
/// Source: YAML 1.2, through yaml-cpp.
/// Differs: numbers are read from their text, not by YAML's rules of types (`5e-05` is a number
/// here); every finding names the line and column. Conventions: a missing value is the given
/// default, a wrong one is reported and becomes the default.

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <string_view>

#include "alhazen/base/diagnostics.h"
#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// The largest text that is parsed: nodes take a few hundred bytes each.
inline constexpr std::size_t kMaxYamlBytes = std::size_t{1} << 20;

/// The document of `bytes`; nothing after an error. Throws Error: Resource for text that is too
/// large, Scene for text nested deeper than `max_nesting`.
[[nodiscard]] std::optional<YAML::Node> parse_yaml(std::string_view bytes, const std::string& file,
                                                   int max_nesting, Diagnostics& diagnostics);

/// Reads values of nodes and reports at their place.
class YamlValues {
  public:
    YamlValues(std::string file, Diagnostics& diagnostics)
        : file_(std::move(file)), diagnostics_(diagnostics) {}

    [[nodiscard]] FileLocation location(const YAML::Node& node) const;
    void error(const YAML::Node& node, const std::string& message);
    void warning(const YAML::Node& node, const std::string& message);

    /// The value of `key`, or an undefined node when `map` is no map or has no such key.
    [[nodiscard]] static YAML::Node find(const YAML::Node& map, const char* key);

    [[nodiscard]] double number(const YAML::Node& map, const char* key, double missing);
    [[nodiscard]] bool flag(const YAML::Node& map, const char* key, bool missing);
    [[nodiscard]] std::string text(const YAML::Node& map, const char* key);
    /// {X, Y, Z}; `missing` also stands for each component.
    [[nodiscard]] Vec3 vector(const YAML::Node& map, const char* key, double missing);
    /// {R, G, B, A}, without A; missing channels are 0.
    [[nodiscard]] Rgb color(const YAML::Node& map, const char* key);

  private:
    std::string file_;
    Diagnostics& diagnostics_;
};

}  // namespace alhazen
