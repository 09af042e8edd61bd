#include "alhazen/formats/text/block_reader.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

bool ValueReader::fail(TextNode value, std::string_view what, std::string_view expected) const {
    if (!value.broken()) {
        diagnostics.error(value.location(), std::string(what) + ": expected " +
                                                std::string(expected) + ", found " +
                                                value.describe());
    }
    return false;
}

bool ValueReader::read(TextNode value, std::string_view what, double& out) const {
    if (!value.is(NodeKind::Number) || value.broken()) return fail(value, what, "a number");
    out = value.number();
    return true;
}

bool ValueReader::read(TextNode value, std::string_view what, int& out) const {
    constexpr double kLargest = 1e9;
    const double number = value.number();
    if (!value.is(NodeKind::Number) || value.broken() || number != std::floor(number) ||
        std::abs(number) > kLargest) {
        return fail(value, what, "a whole number");
    }
    out = static_cast<int>(number);
    return true;
}

bool ValueReader::read(TextNode value, std::string_view what, bool& out) const {
    const bool yes = value.is(NodeKind::Word, "true");
    if (!yes && !value.is(NodeKind::Word, "false")) return fail(value, what, "true or false");
    out = yes;
    return true;
}

bool ValueReader::read_numbers(TextNode value, std::string_view what, int count,
                               double* out) const {
    const std::string expected = "a list of " + std::to_string(count) + " numbers";
    if (!value.is(NodeKind::List) || value.broken()) return fail(value, what, expected);
    int read = 0;
    for (const TextNode number : value) {
        if (read == count) return fail(value, what, expected);
        if (!number.is(NodeKind::Number)) return fail(number, what, "a number");
        out[read++] = number.number();
    }
    return read == count || fail(value, what, expected);
}

bool ValueReader::read(TextNode value, std::string_view what, Vec2& out) const {
    double v[2];
    if (!read_numbers(value, what, 2, v)) return false;
    out = {v[0], v[1]};
    return true;
}

bool ValueReader::read(TextNode value, std::string_view what, Vec3& out) const {
    double v[3];
    if (!read_numbers(value, what, 3, v)) return false;
    out = {v[0], v[1], v[2]};
    return true;
}

bool ValueReader::read(TextNode value, std::string_view what, Rgb& out) const {
    double v[3];
    if (!read_numbers(value, what, 3, v)) return false;
    out = {v[0], v[1], v[2]};
    return true;
}

bool ValueReader::read(TextNode value, std::string_view what, std::string& out) const {
    const bool text = value.is(NodeKind::Word) || value.is(NodeKind::String);
    if (!text || value.broken()) return fail(value, what, "a name");
    out = value.text();
    return true;
}

bool ValueReader::is_list(TextNode value, std::string_view what) const {
    if (value.is(NodeKind::List) && !value.broken()) return true;
    return fail(value, what, "a list");
}

std::string joined(const std::vector<std::string_view>& names) {
    std::string text;
    for (const std::string_view name : names) {
        if (!text.empty()) text += ", ";
        text += name;
    }
    return text;
}

std::optional<TextNode> BlockReader::find(std::string_view key, std::string_view spelling) {
    for (const std::string_view name : {key, spelling}) {
        if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.push_back(name);
        if (name == spelling) break;
    }
    if (observer_ != nullptr) observer_->key(what_, key, {});
    std::optional<TextNode> found;
    std::string_view seen;
    for (const TextNode item : block_) {
        if (!item.is(NodeKind::Pair, key) && !item.is(NodeKind::Pair, spelling)) continue;
        if (!seen.empty()) {
            const bool same = seen == item.text();
            complain(item, what_ + ": '" + std::string(item.text()) + "' is given twice" +
                               (same ? "" : ", first as '" + std::string(seen) + "'"));
        }
        seen = item.text();
        if (item.broken() || item.empty()) continue;
        if (!found || strictness_ == Strictness::Tolerant) found = item.first();
    }
    return found;
}

bool BlockReader::has(std::string_view key) const {
    return std::any_of(block_.begin(), block_.end(),
                       [&](TextNode item) { return item.is(NodeKind::Pair, key); });
}

void BlockReader::require(std::string_view key) {
    if (observer_ != nullptr) observer_->required(what_, key);
    if (has(key)) return;
    values_.diagnostics.error(block_.location(),
                              what_ + ": '" + std::string(key) + " = ...' is missing");
}

void BlockReader::needs(std::string_view key, std::string_view other) {
    const std::optional<TextNode> value = find(key);
    if (value && !has(other)) {
        error(*value, "'" + std::string(key) + "' needs '" + std::string(other) + "'");
    }
}

void BlockReader::finish(bool allow_items) {
    for (const TextNode item : block_) {
        if (item.broken()) continue;
        const bool known = std::find(known_.begin(), known_.end(), item.text()) != known_.end();
        if (!item.is(NodeKind::Pair)) {
            if (allow_items) continue;
            const bool lacks_equals =
                known && (item.is(NodeKind::Entry) || item.is(NodeKind::Word));
            complain(item, what_ + (lacks_equals
                                        ? ": expected '=' after '" + std::string(item.text()) + "'"
                                        : ": unexpected " + item.describe()));
            continue;
        }
        if (known) continue;
        complain(item, what_ + ": unknown key '" + printable(item.text()) + "'; known are " +
                           joined(known_));
    }
}

void BlockReader::error(TextNode where, std::string message) const {
    values_.diagnostics.error(where.location(), what_ + ": " + std::move(message));
}

void BlockReader::complain(TextNode where, std::string message) const {
    if (strictness_ == Strictness::Strict) {
        values_.diagnostics.error(where.location(), std::move(message));
    } else {
        values_.diagnostics.warning(where.location(), std::move(message));
    }
}

}  // namespace alhazen
