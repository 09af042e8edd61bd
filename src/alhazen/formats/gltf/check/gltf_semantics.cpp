#include "alhazen/formats/gltf/check/gltf_semantics.h"

#include <algorithm>
#include <charconv>

namespace alhazen::gltf {

namespace {

/// Set of component types, one bit each.
using Formats = unsigned;
constexpr Formats kFloat = 1, kByte = 2, kByteN = 4, kUByte = 8, kUByteN = 16, kShort = 32,
                  kShortN = 64, kUShort = 128, kUShortN = 256, kUInt = 512;
constexpr Formats kSignedN = kByteN | kShortN;
constexpr Formats kUnsignedN = kUByteN | kUShortN;
constexpr Formats kAnySmall = kByte | kUByte | kShort | kUShort | kSignedN | kUnsignedN;

Formats format_of(const Accessor& accessor) {
    const bool n = accessor.normalized;
    switch (accessor.component) {
        case ComponentType::Byte:
            return n ? kByteN : kByte;
        case ComponentType::UnsignedByte:
            return n ? kUByteN : kUByte;
        case ComponentType::Short:
            return n ? kShortN : kShort;
        case ComponentType::UnsignedShort:
            return n ? kUShortN : kUShort;
        case ComponentType::UnsignedInt:
            return kUInt;
        case ComponentType::Float:
            return kFloat;
    }
    return 0;
}

struct Rule {
    const char* name;
    bool numbered;
    ElementType least, most;  ///< VEC3 or VEC4 for colours
    Formats plain;            ///< allowed in every file
    Formats quantized;        ///< additionally with KHR_mesh_quantization
    ElementType target_least, target_most;
    Formats target;            ///< 0: not allowed for morph targets
    Formats target_quantized;  ///< additionally with KHR_mesh_quantization
};

constexpr ElementType kVec2 = ElementType::Vec2, kVec3 = ElementType::Vec3,
                      kVec4 = ElementType::Vec4;
constexpr Rule kRules[] = {
    {"POSITION", false, kVec3, kVec3, kFloat, kAnySmall, kVec3, kVec3, kFloat,
     kByte | kShort | kSignedN},
    {"NORMAL", false, kVec3, kVec3, kFloat, kSignedN, kVec3, kVec3, kFloat, kSignedN},
    {"TANGENT", false, kVec4, kVec4, kFloat, kSignedN, kVec3, kVec3, kFloat, kSignedN},
    {"TEXCOORD", true, kVec2, kVec2, kFloat | kUnsignedN, kAnySmall, kVec2, kVec2,
     kFloat | kSignedN | kUnsignedN, kByte | kShort},
    {"COLOR", true, kVec3, kVec4, kFloat | kUnsignedN, 0, kVec3, kVec4,
     kFloat | kSignedN | kUnsignedN, 0},
    {"JOINTS", true, kVec4, kVec4, kUByte | kUShort, 0, kVec4, kVec4, 0, 0},
    {"WEIGHTS", true, kVec4, kVec4, kFloat | kUnsignedN, 0, kVec4, kVec4, 0, 0},
};

const Rule* rule_of(std::string_view name) {
    const auto* found = std::find_if(std::begin(kRules), std::end(kRules),
                                     [&](const Rule& rule) { return name == rule.name; });
    return found == std::end(kRules) ? nullptr : found;
}

}  // namespace

std::optional<Semantic> parse_semantic(std::string_view attribute) {
    if (!attribute.empty() && attribute[0] == '_') return Semantic{attribute, {}, true};
    const std::size_t bar = attribute.find('_');
    const Rule* rule = rule_of(attribute.substr(0, bar));
    if (rule == nullptr || rule->numbered != (bar != std::string_view::npos)) return std::nullopt;
    if (!rule->numbered) return Semantic{attribute, {}, false};
    const std::string_view digits = attribute.substr(bar + 1);
    std::uint32_t set = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), set);
    const bool whole = error == std::errc() && end == digits.data() + digits.size();
    // Rejects signs and leading zeros.
    if (!whole || digits != std::to_string(set)) return std::nullopt;
    return Semantic{attribute.substr(0, bar), set, false};
}

bool suits(const Semantic& semantic, const Accessor& accessor, bool is_target, bool quantized) {
    const Formats format = format_of(accessor);
    if (semantic.is_custom) return format != kUInt;
    const Rule& rule = *rule_of(semantic.name);
    if (is_target) {
        return accessor.type >= rule.target_least && accessor.type <= rule.target_most &&
               (format & (rule.target | (quantized ? rule.target_quantized : 0))) != 0;
    }
    return accessor.type >= rule.least && accessor.type <= rule.most &&
           (format & (rule.plain | (quantized ? rule.quantized : 0))) != 0;
}

}  // namespace alhazen::gltf
