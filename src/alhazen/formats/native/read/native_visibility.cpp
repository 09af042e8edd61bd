#include "alhazen/formats/native/read/native_visibility.h"

#include <optional>
#include <vector>

#include "alhazen/formats/native/fields/native_text.h"

namespace alhazen {

namespace {

constexpr std::string_view kKey = "visible_to";

std::optional<RayMask> kind_named(TextNode word) {
    if (!word.is(NodeKind::Word)) return std::nullopt;
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (word.text() == kRayKindNames[k]) return mask_of(static_cast<RayKind>(k));
    }
    return std::nullopt;
}

bool is_word(TextNode value, std::string_view word) {
    return value.is(NodeKind::Word) && value.text() == word;
}

}  // namespace

RayMask read_native_visibility(BlockReader& reader) {
    const std::optional<TextNode> value = reader.find(kKey);
    if (!value || is_word(*value, "all")) return kAllRays;
    if (is_word(*value, "none")) return 0;
    if (const auto kind = kind_named(*value)) return *kind;
    const std::string kinds =
        joined(std::vector<std::string_view>(kRayKindNames.begin(), kRayKindNames.end()));
    if (!value->is(NodeKind::List)) {
        reader.values().fail(*value, kKey, "all, none or a list of " + kinds);
        return kAllRays;
    }
    RayMask mask = 0;
    for (const TextNode item : *value) {
        const auto kind = kind_named(item);
        if (kind) {
            mask |= *kind;
        } else {
            reader.values().fail(item, kKey, "one of " + kinds);
        }
    }
    return mask;
}

std::string native_visibility(RayMask mask) {
    if (mask == kAllRays) return "all";
    if (mask == 0) return "none";
    std::vector<std::string> kinds;
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if ((mask & mask_of(static_cast<RayKind>(k))) != 0) kinds.emplace_back(kRayKindNames[k]);
    }
    return native_list(kinds);
}

}  // namespace alhazen
