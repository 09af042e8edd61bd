// Lists and counts of patches, and the loops that trim them.

#include "alhazen/formats/native/fields/native_shape_fields.h"

namespace alhazen {

namespace {

template <class T, class Add>
void read_items(BlockReader& reader, std::string_view key, const Add& add) {
    const auto list = reader.find(key);
    if (!list || !reader.values().is_list(*list, key)) return;
    for (const TextNode item : *list) {
        T value{};
        if (reader.values().read(item, key, value)) add(item, value);
    }
}

}  // namespace

void read_native_count(BlockReader& reader, std::string_view key, std::uint32_t& count) {
    int read = 0;
    if (!reader.read(key, read)) return;
    if (read < 0) {
        reader.error(*reader.find(key), std::string(key) + ": expected a number from 0");
        return;
    }
    count = static_cast<std::uint32_t>(read);
}

void read_native_list(BlockReader& reader, std::string_view key, std::vector<Vec3>& list) {
    read_items<Vec3>(reader, key, [&](TextNode, const Vec3& value) { list.push_back(value); });
}

void read_native_list(BlockReader& reader, std::string_view key, std::vector<double>& list) {
    read_items<double>(reader, key, [&](TextNode, double value) { list.push_back(value); });
}

void read_native_list(BlockReader& reader, std::string_view key, std::vector<std::uint32_t>& list) {
    read_items<int>(reader, key, [&](TextNode item, int value) {
        if (value < 0) {
            reader.values().fail(item, key, "numbers from 0");
        } else {
            list.push_back(static_cast<std::uint32_t>(value));
        }
    });
}

namespace {

constexpr const char* kTrimExpected =
    "polyline((u, v), (u, v), ...) or curve { degree = ...; knots = [...]; points = [...] }";

/// Reads `polyline((u, v), ...)` or `curve { degree, knots, points, weights }`.
bool read_trim_curve(TextNode entry, std::string_view key, const ValueReader& values,
                     TrimCurve& curve) {
    if (entry.is(NodeKind::Entry, "polyline") && !entry.empty() &&
        entry.first().is(NodeKind::List)) {
        for (const TextNode item : entry.first()) {
            Vec2 point;
            if (!values.read(item, key, point)) return false;
            curve.points.push_back(point);
        }
        return true;
    }
    if (!entry.is(NodeKind::Entry, "curve") || entry.empty() ||
        !entry.first().is(NodeKind::Block)) {
        return values.fail(entry, key, kTrimExpected);
    }
    BlockReader block(entry.first(), "curve", BlockReader::Strictness::Strict, values.diagnostics);
    const std::size_t before = values.diagnostics.error_count();
    read_native_count(block, "degree", curve.degree);
    read_native_list(block, "knots", curve.knots);
    block.require("points");
    read_items<Vec2>(block, "points",
                     [&](TextNode, const Vec2& value) { curve.points.push_back(value); });
    read_native_list(block, "weights", curve.weights);
    block.finish();
    return values.diagnostics.error_count() == before;
}

}  // namespace

void read_native_list(BlockReader& reader, std::string_view key, std::vector<TrimLoop>& loops) {
    const auto list = reader.find(key);
    if (!list || !reader.values().is_list(*list, key)) return;
    for (const TextNode item : *list) {
        if (!reader.values().is_list(item, key)) continue;
        TrimLoop loop;
        for (const TextNode entry : item) {
            TrimCurve curve;
            if (read_trim_curve(entry, key, reader.values(), curve)) {
                loop.push_back(std::move(curve));
            }
        }
        loops.push_back(std::move(loop));
    }
}

namespace {

/// Writes `[a, b, ...]`, in lines of about 100 characters.
template <class T, class TextOf>
std::string wrapped_list(const std::vector<T>& list, const TextOf& text_of) {
    constexpr std::size_t kWidth = 100;
    std::string text = "[";
    std::size_t line = 0;
    for (const T& value : list) {
        const std::string item = text_of(value);
        if (text.size() > 1) text += ",";
        if (text.size() - line + item.size() > kWidth) {
            text += "\n        ";
            line = text.size();
        } else if (text.size() > 1) {
            text += " ";
        }
        text += item;
    }
    return text + "]";
}

std::string trim_text(const TrimCurve& curve) {
    const auto point = [](const Vec2& p) { return native_value(p); };
    if (curve.degree == 1 && curve.knots.empty() && curve.weights.empty()) {
        std::string points = wrapped_list(curve.points, point);
        points.front() = '(';
        points.back() = ')';
        return "polyline" + points;
    }
    std::string text = "curve { degree = " + native_field_text(curve.degree);
    if (!curve.knots.empty()) text += "; knots = " + native_field_text(curve.knots);
    text += "; points = " + wrapped_list(curve.points, point);
    if (!curve.weights.empty()) text += "; weights = " + native_field_text(curve.weights);
    return text + " }";
}

}  // namespace

std::string native_field_text(std::uint32_t count) {
    return std::to_string(count);
}

std::string native_field_text(const std::vector<Vec3>& list) {
    return wrapped_list(list, [](const Vec3& p) { return native_value(p); });
}

std::string native_field_text(const std::vector<double>& list) {
    return wrapped_list(list, [](double x) { return native_value(x); });
}

std::string native_field_text(const std::vector<std::uint32_t>& list) {
    return wrapped_list(list, [](std::uint32_t x) { return std::to_string(x); });
}

std::string native_field_text(const std::vector<TrimLoop>& loops) {
    return wrapped_list(loops, [](const TrimLoop& loop) {
        std::vector<std::string> curves;
        for (const TrimCurve& curve : loop) curves.push_back(trim_text(curve));
        return native_list(curves);
    });
}

}  // namespace alhazen
