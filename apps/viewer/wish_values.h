#pragma once
/// Typed values of a request in JSON.
///
/// Conventions: throws Error (Usage) that names the key of a value that is missing or of the wrong
/// type. Values with a fallback may be missing.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen::viewer {

/// Parses JSON nested at most 64 deep.
[[nodiscard]] nlohmann::ordered_json wish_json(std::string_view text);

/// A required value of any type.
[[nodiscard]] const nlohmann::ordered_json& value_in(const nlohmann::ordered_json& wish,
                                                     const char* key);
/// A value, or null if it is missing. Throws if `wish` is no object.
[[nodiscard]] const nlohmann::ordered_json* find_in(const nlohmann::ordered_json& wish,
                                                    const char* key);
[[nodiscard]] std::string text_in(const nlohmann::ordered_json& wish, const char* key,
                                  std::optional<std::string> fallback = std::nullopt);
[[nodiscard]] bool flag_in(const nlohmann::ordered_json& wish, const char* key);  ///< or false
[[nodiscard]] double number_in(const nlohmann::ordered_json& wish, const char* key,
                               double fallback);
/// An integer. 3.0 counts as one.
[[nodiscard]] int whole_in(const nlohmann::ordered_json& wish, const char* key,
                           std::optional<int> fallback, int least, int most);
/// Three numbers, required.
[[nodiscard]] Vec3 vector_in(const nlohmann::ordered_json& wish, const char* key);
/// Lists, empty if missing.
[[nodiscard]] std::vector<double> numbers_in(const nlohmann::ordered_json& wish, const char* key);
[[nodiscard]] std::vector<std::string> texts_in(const nlohmann::ordered_json& wish,
                                                const char* key);

}  // namespace alhazen::viewer
