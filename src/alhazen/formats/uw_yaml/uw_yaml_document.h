#pragma once
/// Safe reading of YAML text: limits, parsing, and values in the notation of the course program.
///
/// Source: YAML 1.2, through yaml-cpp.
/// Differs: numbers are parsed from their text, not by the YAML type rules (`5e-05` is a number
/// here); every finding has line and column.
/// Conventions: an absent value gives the default; an invalid one is reported and gives the
/// default.

#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "alhazen/base/diagnostics.h"
#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// Maximum size of the text in bytes: a node takes a few hundred bytes of memory.
inline constexpr std::size_t kMaxYamlBytes = std::size_t{1} << 20;

/// Parses `bytes`; none after an error. Throws Error: Resource for text that is too large, Scene
/// for text nested deeper than `max_nesting`.
[[nodiscard]] std::optional<YAML::Node> parse_yaml(std::string_view bytes, const std::string& file,
                                                   int max_nesting, Diagnostics& diagnostics);

/// Reads values of nodes; reports errors at their location.
class YamlValues {
  public:
    YamlValues(std::string file, Diagnostics& diagnostics)
        : file_(std::move(file)), diagnostics_(diagnostics) {}

    [[nodiscard]] FileLocation location(const YAML::Node& node) const;
    void error(const YAML::Node& node, const std::string& message);
    void warning(const YAML::Node& node, const std::string& message);

    /// The value of `key`; an undefined node if `map` is not a map or lacks the key.
    [[nodiscard]] static YAML::Node find(const YAML::Node& map, const char* key);

    /// The finite number that a node holds; none if it holds something else.
    [[nodiscard]] static std::optional<double> number_of(const YAML::Node& node);
    /// The truth value that a node holds, in the words of YAML 1.1 and any capitals that it has.
    [[nodiscard]] static std::optional<bool> flag_of(const YAML::Node& node);

    [[nodiscard]] double number(const YAML::Node& map, const char* key, double missing);
    [[nodiscard]] bool flag(const YAML::Node& map, const char* key, bool missing);
    [[nodiscard]] std::string text(const YAML::Node& map, const char* key);
    /// {X, Y, Z}; `missing` is the default of each component.
    [[nodiscard]] Vec3 vector(const YAML::Node& map, const char* key, double missing);
    /// {R, G, B, A}, of which A is ignored; the default of each channel is 0.
    [[nodiscard]] Rgb color(const YAML::Node& map, const char* key);

    /// Reports what is wrong with the keys of a map: a warning for those that are not among `known`
    /// (none: any key is) and for those given twice, an error for merge keys and for a node that is
    /// no map. `what` names the map; each key of it is reported once in a file.
    void check_keys(const YAML::Node& map, const std::string& what,
                    std::span<const std::string_view> known = {},
                    const char* of_two = "the first counts");
    void check_keys(const YAML::Node& map, const std::string& what,
                    std::initializer_list<std::string_view> known) {
        check_keys(map, what, std::span(known.begin(), known.size()));
    }

  private:
    void warn_once(const YAML::Node& key, const std::string& message);

    std::string file_;
    Diagnostics& diagnostics_;
    std::set<std::string> warned_;
    std::set<std::pair<int, std::string>> checked_;  ///< by position: aliases repeat a map
};

}  // namespace alhazen
