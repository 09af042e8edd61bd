#pragma once
/// Checked reading of the JSON part of a glTF file. Members are read by type and range; errors are
/// reported with their JSON pointer.
///
/// Source: IETF RFC 8259 (JSON), RFC 6901 (JSON pointer); "glTF 2.0 Specification", 2021, sections
/// 2.7 and 3.1.
/// Differs: pointers are written in URI form ("#/meshes/0"). Integers may be written as 3.0.
/// Conventions: a reading function returns none (or the default) after it has reported an error.
/// Unknown members are ignored: extensions and newer versions may add them.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "alhazen/base/diagnostics.h"
#include "alhazen/formats/gltf/document/gltf_document.h"

namespace alhazen::gltf {

/// True if the extension is supported.
[[nodiscard]] bool is_supported(std::string_view extension);

/// True if a file without the extension shows the same shapes, with another appearance only.
[[nodiscard]] bool is_only_look(std::string_view extension);

/// The shortest decimal text that identifies the number, for messages.
[[nodiscard]] std::string written(double x);

/// A position in the JSON tree: a link to the parent and its own key or index. Lives on the stack
/// of the reader; builds the pointer text only on demand.
class Place {
  public:
    Place() = default;
    Place(const Place& parent, std::string_view key) : parent_(&parent), key_(key) {}
    Place(const Place& parent, std::size_t position)
        : parent_(&parent), position_(position), is_position_(true) {}

    [[nodiscard]] std::string pointer() const;

  private:
    const Place* parent_ = nullptr;
    std::string_view key_;
    std::size_t position_ = 0;
    bool is_position_ = false;
};

/// Top-level arrays with references by index.
enum class Collection {
    Accessors,
    Buffers,
    BufferViews,
    Cameras,
    Images,
    Lights,
    Materials,
    Meshes,
    Nodes,
    Samplers,
    Scenes,
    Skins,
    Textures,
    Variants,  ///< of KHR_materials_variants
};
inline constexpr std::size_t kCollectionCount = 14;

/// Shared state of the readers of one document.
struct JsonContext {
    Diagnostics& diagnostics;
    std::string file;
    std::array<std::size_t, kCollectionCount> sizes{};  ///< of the top-level arrays
    std::set<std::string, std::less<>> extensions_used;

    void error(const Place& place, const std::string& message) const;
    void warning(const Place& place, const std::string& message) const;
    /// For checks after the JSON is freed. `pointer`: as in "#/meshes/0".
    void error(const std::string& pointer, const std::string& message) const;
    void warning(const std::string& pointer, const std::string& message) const;
    [[nodiscard]] std::size_t size_of(Collection collection) const {
        return sizes[static_cast<std::size_t>(collection)];
    }
};

struct Range {
    double lo = -std::numeric_limits<double>::infinity();
    double hi = std::numeric_limits<double>::infinity();
    bool above_lo = false;  ///< true: lo itself is not allowed
};
inline constexpr Range kUnitRange{0, 1};
inline constexpr Range kNotNegative{0};
inline constexpr Range kPositive{.lo = 0, .above_lo = true};

/// A JSON object being read.
class JsonObject {
  public:
    /// Reports undeclared extensions of the object, and known ones that do not extend it.
    JsonObject(nlohmann::json& value, const Place& place, const JsonContext& context);

    [[nodiscard]] const Place& place() const { return place_; }
    [[nodiscard]] const JsonContext& context() const { return context_; }
    [[nodiscard]] bool has(std::string_view key) const;
    /// The member, without a type check; null if absent.
    [[nodiscard]] nlohmann::json* find(std::string_view key) const;
    [[nodiscard]] std::vector<std::string> keys() const;

    std::optional<std::uint64_t> integer(std::string_view key, std::uint64_t lo = 0,
                                         std::uint64_t hi = kMaxInteger) const;
    std::optional<double> number(std::string_view key, Range range = {}) const;
    [[nodiscard]] bool flag(std::string_view key, bool otherwise = false) const;
    std::optional<std::string> text(std::string_view key) const;
    /// Like `text`, but moves the string out of the tree, since it may be large.
    std::optional<std::string> take_text(std::string_view key) const;
    /// A non-empty list of `size` numbers, or of any number of them if `size` is 0.
    std::optional<std::vector<double>> numbers(std::string_view key, std::size_t size,
                                               Range range = {}) const;
    template <std::size_t n>
    void numbers_into(std::string_view key, std::array<double, n>& out, Range range = {}) const {
        if (const auto list = numbers(key, n, range)) std::copy_n(list->begin(), n, out.begin());
    }
    void number_into(std::string_view key, double& out, Range range = {}) const {
        out = number(key, range).value_or(out);
    }
    /// A valid index into a top-level array.
    std::optional<Index> index(std::string_view key, Collection collection) const;
    /// A non-empty list of distinct indices.
    [[nodiscard]] std::vector<Index> indices(std::string_view key, Collection collection) const;
    /// Reports a missing member.
    void require(std::string_view key) const;

    /// Calls f(JsonObject&) if the member exists and is an object.
    template <class F>
    void with_object(std::string_view key, F&& f) const {
        nlohmann::json* value = find(key);
        if (value == nullptr) return;
        const Place place(place_, key);
        if (!is_object(*value, place)) return;
        JsonObject object(*value, place, context_);
        f(object);
    }
    /// Calls f(JsonObject&) for an extension of this object.
    template <class F>
    void with_extension(std::string_view name, F&& f) const {
        if (find("extensions") == nullptr) return;
        with_object("extensions", [&](JsonObject& extensions) { extensions.with_object(name, f); });
    }
    /// Calls f(JsonObject&, position) for each object of a non-empty list.
    template <class F>
    void each_object(std::string_view key, F&& f) const {
        nlohmann::json* value = find(key);
        if (value == nullptr) return;
        const Place list(place_, key);
        if (!is_list(*value, list)) return;
        std::size_t position = 0;
        for (nlohmann::json& element : *value) {
            const Place place(list, position);
            if (is_object(element, place)) {
                JsonObject object(element, place, context_);
                f(object, position);
            }
            ++position;
        }
    }
    /// Reports at the member `key`, or at the object if `key` is empty.
    void error(std::string_view key, const std::string& message) const;
    void warning(std::string_view key, const std::string& message) const;

    /// Largest integer that a double holds exactly, 2^53 - 1.
    static constexpr std::uint64_t kMaxInteger = (std::uint64_t{1} << 53) - 1;

  private:
    bool is_object(const nlohmann::json& value, const Place& place) const;
    bool is_list(const nlohmann::json& value, const Place& place) const;
    std::optional<std::uint64_t> integer_at(const nlohmann::json& value, const Place& place,
                                            std::uint64_t lo, std::uint64_t hi) const;
    std::optional<Index> index_at(const nlohmann::json& value, const Place& place,
                                  Collection collection) const;

    nlohmann::json& value_;
    const Place& place_;
    const JsonContext& context_;
};

/// Parses a JSON text. Reports a syntax error with line and column, a duplicate key in an object,
/// and nesting beyond 64; then returns none. Throws Error (Resource) above `most` values; strings
/// and keys count as 4, objects and arrays as 8, in proportion to their memory (about 20 bytes per
/// count).
[[nodiscard]] std::optional<nlohmann::json> parse_json(std::string_view text,
                                                       const std::string& file, std::uint64_t most,
                                                       Diagnostics& diagnostics);

}  // namespace alhazen::gltf
