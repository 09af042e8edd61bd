#include "wish_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/base/error.h"

namespace alhazen::viewer {

namespace {

using json = nlohmann::ordered_json;

/// The largest number of nested brackets.
int depth_of(std::string_view text) {
    int depth = 0, most = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string && c == '\\') {
            ++i;
        } else if (c == '"') {
            in_string = !in_string;
        } else if (!in_string && (c == '[' || c == '{')) {
            most = std::max(most, ++depth);
        } else if (!in_string && (c == ']' || c == '}')) {
            --depth;
        }
    }
    return most;
}

std::string shortened(const json& value) {
    constexpr std::size_t kMost = 60;
    std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    if (text.size() > kMost) text.replace(kMost, std::string::npos, "...");
    return text;
}
[[noreturn]] void fail(const char* key, const std::string& expected, const json& found) {
    throw Error(ErrorKind::Usage,
                fmt::format("{} must be {}, found {}", key, expected, shortened(found)));
}

/// A list whose items all have a type; null if it is missing.
const json* list_in(const json& wish, const char* key, bool (json::*is_one)() const noexcept,
                    const char* expected) {
    const json* const found = find_in(wish, key);
    if (found == nullptr) return nullptr;
    const bool good =
        found->is_array() && std::all_of(found->begin(), found->end(),
                                         [&](const json& item) { return (item.*is_one)(); });
    if (!good) fail(key, expected, *found);
    return found;
}

}  // namespace

json wish_json(std::string_view text) {
    constexpr int kDeepest = 64;
    if (depth_of(text) > kDeepest) throw Error(ErrorKind::Usage, "nested deeper than 64 levels");
    try {
        return json::parse(text);
    } catch (const json::out_of_range&) {
        throw Error(ErrorKind::Usage, "the request has a number that is too large");
    } catch (const json::parse_error& error) {
        throw Error(ErrorKind::Usage,
                    fmt::format("the request is no JSON, from its byte {} on", error.byte));
    }
}

const json* find_in(const json& wish, const char* key) {
    if (!wish.is_object()) {
        throw Error(ErrorKind::Usage, "expected an object, found " + shortened(wish));
    }
    const auto found = wish.find(key);
    return found == wish.end() ? nullptr : &*found;
}

const json& value_in(const json& wish, const char* key) {
    const json* const found = find_in(wish, key);
    if (found == nullptr) throw Error(ErrorKind::Usage, fmt::format("{} is missing", key));
    return *found;
}

std::string text_in(const json& wish, const char* key, std::optional<std::string> fallback) {
    if (fallback && find_in(wish, key) == nullptr) return *fallback;
    const json& found = value_in(wish, key);
    if (!found.is_string()) fail(key, "a text", found);
    return found.get<std::string>();
}

bool flag_in(const json& wish, const char* key) {
    const json* const found = find_in(wish, key);
    if (found != nullptr && !found->is_boolean()) fail(key, "true or false", *found);
    return found != nullptr && found->get<bool>();
}

double number_in(const json& wish, const char* key, double fallback) {
    const json* const found = find_in(wish, key);
    if (found != nullptr && !found->is_number()) fail(key, "a number", *found);
    return found == nullptr ? fallback : found->get<double>();
}

int whole_in(const json& wish, const char* key, std::optional<int> fallback, int least, int most) {
    if (fallback && find_in(wish, key) == nullptr) return *fallback;
    const json& found = value_in(wish, key);
    // Compared before the conversion to int: 2^32 + 1 must not become 1.
    const double value =
        found.is_number() ? found.get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (!(value >= least && value <= most) || std::trunc(value) != value) {
        fail(key, fmt::format("a whole number from {} to {}", least, most), found);
    }
    return static_cast<int>(value);
}

std::vector<double> numbers_in(const json& wish, const char* key) {
    const json* const found = list_in(wish, key, &json::is_number, "a list of numbers");
    return found == nullptr ? std::vector<double>() : found->get<std::vector<double>>();
}

std::vector<std::string> texts_in(const json& wish, const char* key) {
    const json* const found = list_in(wish, key, &json::is_string, "a list of texts");
    return found == nullptr ? std::vector<std::string>() : found->get<std::vector<std::string>>();
}

Vec3 vector_in(const json& wish, const char* key) {
    const json& given = value_in(wish, key);
    const std::vector<double> v = numbers_in(wish, key);
    if (v.size() != 3) fail(key, "three numbers", given);
    return {v[0], v[1], v[2]};
}

}  // namespace alhazen::viewer
