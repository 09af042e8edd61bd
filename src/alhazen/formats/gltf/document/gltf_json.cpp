#include "alhazen/formats/gltf/document/gltf_json.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/base/interruption.h"
#include "alhazen/base/unicode_marks.h"

namespace alhazen::gltf {

namespace {

using nlohmann::json;

constexpr const char* kCollectionNames[kCollectionCount] = {
    "accessor", "buffer", "bufferView", "camera", "image", "light",   "material",
    "mesh",     "node",   "sampler",    "scene",  "skin",  "texture", "variant"};

constexpr std::string_view kSupported[] = {
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_materials_volume_scatter",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
};

/// Places of the objects that an extension extends; "N" stands for a position.
struct Extended {
    std::string_view extension;
    std::array<std::string_view, 2> places;
};
constexpr Extended kExtended[] = {
    {"EXT_mesh_gpu_instancing", {"#/nodes/N"}},
    {"EXT_texture_webp", {"#/textures/N"}},
    {"KHR_animation_pointer", {"#/animations/N/channels/N/target"}},
    {"KHR_lights_punctual", {"#", "#/nodes/N"}},
    {"KHR_materials_anisotropy", {"#/materials/N"}},
    {"KHR_materials_clearcoat", {"#/materials/N"}},
    {"KHR_materials_diffuse_transmission", {"#/materials/N"}},
    {"KHR_materials_dispersion", {"#/materials/N"}},
    {"KHR_materials_emissive_strength", {"#/materials/N"}},
    {"KHR_materials_ior", {"#/materials/N"}},
    {"KHR_materials_iridescence", {"#/materials/N"}},
    {"KHR_materials_pbrSpecularGlossiness", {"#/materials/N"}},
    {"KHR_materials_sheen", {"#/materials/N"}},
    {"KHR_materials_specular", {"#/materials/N"}},
    {"KHR_materials_transmission", {"#/materials/N"}},
    {"KHR_materials_unlit", {"#/materials/N"}},
    {"KHR_materials_variants", {"#", "#/meshes/N/primitives/N"}},
    {"KHR_materials_volume", {"#/materials/N"}},
    {"KHR_materials_volume_scatter", {"#/materials/N"}},
    {"KHR_mesh_quantization", {}},
    {"KHR_node_visibility", {"#/nodes/N"}},
};

/// Place of KHR_texture_transform: any reference of a material to a texture.
constexpr std::string_view kTextureTransform = "KHR_texture_transform", kTextureInfo = "Texture";

/// A pointer with "N" for each position: "#/nodes/3" -> "#/nodes/N".
std::string without_positions(std::string_view pointer) {
    std::string text;
    for (std::size_t at = 0; at < pointer.size();) {
        const std::size_t end = std::min(pointer.find('/', at + 1), pointer.size());
        const std::string_view part = pointer.substr(at, end - at);
        const bool is_position =
            part.size() > 1 && part.find_first_not_of("0123456789", 1) == std::string_view::npos;
        text += is_position ? "/N" : part;
        at = end;
    }
    return text;
}

/// True if the extension is unknown, or extends the objects at this place.
bool is_expected(std::string_view extension, std::string_view place) {
    if (extension == kTextureTransform) return place.ends_with(kTextureInfo);
    for (const Extended& known : kExtended) {
        if (known.extension != extension) continue;
        return std::find(known.places.begin(), known.places.end(), place) != known.places.end();
    }
    return true;
}

std::string in_quotes(std::string_view text) {
    return '"' + std::string(text.substr(0, 80)) + (text.size() > 80 ? "...\"" : "\"");
}

std::string type_of(const json& value) {
    return value.is_array() ? "an array" : value.is_object() ? "an object" : value.type_name();
}

}  // namespace

std::string written(double x) {
    const std::string text = json(x).dump();
    return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

bool is_supported(std::string_view extension) {
    return std::find(std::begin(kSupported), std::end(kSupported), extension) !=
           std::end(kSupported);
}

bool is_only_look(std::string_view extension) {
    return extension.find("_materials_") != std::string_view::npos ||
           extension.find("_texture_") != std::string_view::npos;
}

std::string Place::pointer() const {
    std::vector<const Place*> path;
    for (const Place* p = this; p->parent_ != nullptr; p = p->parent_) path.push_back(p);
    std::string text = "#";
    std::for_each(path.rbegin(), path.rend(), [&](const Place* p) {
        text += '/';
        if (p->is_position_) {
            text += std::to_string(p->position_);
            return;
        }
        // RFC 6901: ~ and / are escaped as ~0 and ~1. Names can have any length and are cut.
        for (const char c : p->key_.substr(0, 80)) {
            text += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
        }
    });
    return text;
}

void JsonContext::error(const Place& place, const std::string& message) const {
    error(place.pointer(), message);
}
void JsonContext::warning(const Place& place, const std::string& message) const {
    warning(place.pointer(), message);
}
void JsonContext::error(const std::string& pointer, const std::string& message) const {
    diagnostics.error({file, 0, 0}, pointer + ": " + message);
}
void JsonContext::warning(const std::string& pointer, const std::string& message) const {
    diagnostics.warning({file, 0, 0}, pointer + ": " + message);
}

JsonObject::JsonObject(json& value, const Place& place, const JsonContext& context)
    : value_(value), place_(place), context_(context) {
    const json* extensions = find("extensions");
    if (extensions == nullptr) return;
    const Place where(place_, "extensions");
    if (!is_object(*extensions, where)) return;
    if (extensions->empty()) return;
    const std::string kind = without_positions(place_.pointer());
    for (const auto& [name, unused] : extensions->items()) {
        if (context_.extensions_used.count(name) != 0) {
            if (is_expected(name, kind)) continue;
            context_.error(Place(where, name), "the extension does not belong to this object");
            continue;
        }
        context_.error(Place(where, name), "the extension is not listed in extensionsUsed");
    }
}

bool JsonObject::has(std::string_view key) const {
    return find(key) != nullptr;
}

json* JsonObject::find(std::string_view key) const {
    const auto found = value_.find(key);
    return found == value_.end() ? nullptr : &*found;
}

std::vector<std::string> JsonObject::keys() const {
    std::vector<std::string> names;
    for (const auto& [name, unused] : value_.items()) names.push_back(name);
    return names;
}

void JsonObject::error(std::string_view key, const std::string& message) const {
    if (key.empty()) return context_.error(place_, message);
    context_.error(Place(place_, key), message);
}

void JsonObject::warning(std::string_view key, const std::string& message) const {
    if (key.empty()) return context_.warning(place_, message);
    context_.warning(Place(place_, key), message);
}

void JsonObject::require(std::string_view key) const {
    if (!has(key)) error({}, in_quotes(key) + " is missing");
}

bool JsonObject::is_object(const json& value, const Place& place) const {
    if (value.is_object()) return true;
    context_.error(place, "expected an object, found " + type_of(value));
    return false;
}

bool JsonObject::is_list(const json& value, const Place& place) const {
    if (!value.is_array()) {
        context_.error(place, "expected an array, found " + type_of(value));
        return false;
    }
    if (!value.empty()) return true;
    context_.error(place, "the array must not be empty");
    return false;
}

std::optional<std::uint64_t> JsonObject::integer_at(const json& value, const Place& place,
                                                    std::uint64_t lo, std::uint64_t hi) const {
    std::optional<std::uint64_t> n;
    if (value.is_number_unsigned()) {
        n = value.get<std::uint64_t>();
    } else if (value.is_number_float()) {
        const double x = value.get<double>();
        if (x >= 0 && x <= static_cast<double>(kMaxInteger) && x == std::floor(x)) {
            n = static_cast<std::uint64_t>(x);
        }
    }
    if (n && *n >= lo && *n <= hi) return n;
    std::string message = "expected an integer from " + std::to_string(lo);
    const bool beyond = value.is_number() && value.get<double>() > static_cast<double>(kMaxInteger);
    if (hi != kMaxInteger || beyond) message += " to " + std::to_string(hi);
    context_.error(place,
                   message + ", found " + (value.is_number() ? value.dump() : type_of(value)));
    return std::nullopt;
}

std::optional<std::uint64_t> JsonObject::integer(std::string_view key, std::uint64_t lo,
                                                 std::uint64_t hi) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    return integer_at(*value, Place(place_, key), lo, hi);
}

namespace {

std::optional<double> number_at(const json& value, const Place& place, Range range,
                                const JsonContext& context) {
    if (!value.is_number()) {
        context.error(place, "expected a number, found " + type_of(value));
        return std::nullopt;
    }
    const double x = value.get<double>();
    if (std::isfinite(x) && x <= range.hi && (range.above_lo ? x > range.lo : x >= range.lo)) {
        return x;
    }
    std::string message = "expected a number";
    if (std::isfinite(range.lo)) {
        message += (range.above_lo ? " above " : " from ") + written(range.lo);
    }
    if (std::isfinite(range.hi)) message += " to " + written(range.hi);
    context.error(place, message + ", found " + value.dump());
    return std::nullopt;
}

}  // namespace

std::optional<double> JsonObject::number(std::string_view key, Range range) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    return number_at(*value, Place(place_, key), range, context_);
}

bool JsonObject::flag(std::string_view key, bool otherwise) const {
    const json* value = find(key);
    if (value == nullptr) return otherwise;
    if (value->is_boolean()) return value->get<bool>();
    error(key, "expected true or false, found " + type_of(*value));
    return otherwise;
}

std::optional<std::string> JsonObject::text(std::string_view key) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    if (value->is_string()) return value->get<std::string>();
    error(key, "expected a string, found " + type_of(*value));
    return std::nullopt;
}

std::optional<std::string> JsonObject::take_text(std::string_view key) const {
    json* value = find(key);
    if (value == nullptr || !value->is_string()) return text(key);
    return std::exchange(value->get_ref<std::string&>(), {});
}

std::optional<std::vector<double>> JsonObject::numbers(std::string_view key, std::size_t size,
                                                       Range range) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    const Place list(place_, key);
    if (!is_list(*value, list)) return std::nullopt;
    if (size != 0 && value->size() != size) {
        context_.error(list, "expected " + std::to_string(size) + " numbers, found " +
                                 std::to_string(value->size()));
        return std::nullopt;
    }
    std::vector<double> result;
    result.reserve(value->size());
    for (const json& element : *value) {
        const auto x = number_at(element, Place(list, result.size()), range, context_);
        if (!x) return std::nullopt;
        result.push_back(*x);
    }
    return result;
}

std::optional<Index> JsonObject::index_at(const json& value, const Place& place,
                                          Collection collection) const {
    const auto n = integer_at(value, place, 0, kMaxInteger);
    if (!n) return std::nullopt;
    const std::size_t size = context_.size_of(collection);
    if (*n < size) return static_cast<Index>(*n);
    const char* name = kCollectionNames[static_cast<std::size_t>(collection)];
    context_.error(place, std::string("there is no ") + name + " " + std::to_string(*n) +
                              " (the file has " + std::to_string(size) + ")");
    return std::nullopt;
}

std::optional<Index> JsonObject::index(std::string_view key, Collection collection) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    return index_at(*value, Place(place_, key), collection);
}

std::vector<Index> JsonObject::indices(std::string_view key, Collection collection) const {
    const json* value = find(key);
    if (value == nullptr) return {};
    const Place list(place_, key);
    if (!is_list(*value, list)) return {};
    std::vector<Index> result;
    std::size_t position = 0;
    for (const json& element : *value) {
        const auto n = index_at(element, Place(list, position), collection);
        if (n) result.push_back(*n);
        ++position;
    }
    std::vector<Index> sorted = result;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) {
        context_.error(list, std::to_string(*twice) + " occurs more than once");
    }
    return result;
}

namespace {

constexpr int kMaxDepth = 64;
// Costs in plain values, proportional to the memory of the tree, so that the limit bounds memory
// for any mix of values.
constexpr std::uint64_t kStringCost = 4, kContainerCost = 8;

/// Thrown to abort the parser.
struct Refused {
    std::string message;
};

/// Counts the values of a text before it is parsed. A separate pass: the parser's own callback
/// takes quadratic time for long arrays of objects.
class Watch final : public nlohmann::json_sax<json> {
  public:
    explicit Watch(std::uint64_t most) : most_(most) {}

    bool null() override { return count(); }
    bool boolean(bool) override { return count(); }
    bool number_integer(number_integer_t) override { return count(); }
    bool number_unsigned(number_unsigned_t) override { return count(); }
    bool number_float(number_float_t, const string_t&) override { return count(); }
    bool string(string_t&) override { return count(kStringCost); }
    bool binary(binary_t&) override { return count(); }
    bool start_object(std::size_t) override {
        keys_.emplace_back();
        return open();
    }
    bool key(string_t& name) override {
        interruption_point();
        if (keys_.back().insert(name).second) return count(kStringCost);
        throw Refused{"the key " + in_quotes(name) + " occurs twice in one object"};
    }
    bool end_object() override {
        keys_.pop_back();
        return close();
    }
    bool start_array(std::size_t) override { return open(); }
    bool end_array() override { return close(); }
    /// Ignored here: the parser reports the same error.
    bool parse_error(std::size_t, const std::string&, const json::exception&) override {
        return false;
    }

  private:
    bool open() {
        interruption_point();
        if (depth_++ < kMaxDepth) return count(kContainerCost);
        throw Refused{"the JSON text is nested deeper than " + std::to_string(kMaxDepth)};
    }
    bool close() {
        --depth_;
        return true;
    }
    bool count(std::uint64_t cost = 1) {
        values_ += cost;
        if (values_ <= most_) return true;
        throw Error(ErrorKind::Resource,
                    "the JSON text has more than " + std::to_string(most_) +
                        " values, strings counted as 4, objects and arrays as 8 (a twentieth of "
                        "max_elements of the import options)");
    }

    std::vector<std::set<std::string>> keys_;  ///< of the open objects
    int depth_ = 0;
    std::uint64_t most_, values_ = 0;
};

/// The parser's message without its prefix "[json.exception...] "; long strings in it are cut.
std::string plain(const std::string& what) {
    const std::size_t end = what.find("] ");
    return what.substr(end == std::string::npos ? 0 : end + 2, 300);
}

FileLocation location_at(std::string_view text, std::size_t offset, const std::string& file) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    const auto lines = std::count(before.begin(), before.end(), '\n');
    const std::size_t start = before.rfind('\n');
    const std::size_t column = before.size() - (start == std::string_view::npos ? 0 : start + 1);
    return {file, static_cast<int>(lines) + 1, static_cast<int>(std::max<std::size_t>(column, 1))};
}

}  // namespace

std::optional<json> parse_json(std::string_view text, const std::string& file, std::uint64_t most,
                               Diagnostics& diagnostics) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) {
        diagnostics.error({file, 1, 1}, "JSON: the text begins with a byte order mark");
        return std::nullopt;
    }
    if (report_wide_text(text, file, diagnostics)) return std::nullopt;
    try {
        Watch watch(most);
        static_cast<void>(json::sax_parse(text.begin(), text.end(), &watch));
        json root = json::parse(text.begin(), text.end());
        if (root.is_object()) return root;
        diagnostics.error({file, 0, 0}, "#: expected an object, found " + type_of(root));
    } catch (const Refused& refused) {
        diagnostics.error({file, 0, 0}, "#: " + refused.message);
    } catch (const json::parse_error& error) {
        diagnostics.error(location_at(text, error.byte, file), "JSON: " + plain(error.what()));
    } catch (const json::exception& error) {
        diagnostics.error({file, 0, 0}, "JSON: " + plain(error.what()));
    }
    return std::nullopt;
}

}  // namespace alhazen::gltf
