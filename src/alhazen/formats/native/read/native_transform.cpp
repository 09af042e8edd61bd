#include "alhazen/formats/native/read/native_transform.h"

#include <numbers>

namespace alhazen {

namespace {

constexpr const char* kExpected =
    "translate(x, y, z), rotate((x, y, z), degrees), scale(s), scale(x, y, z), "
    "matrix(row, row, row) or a list of them";

std::optional<Affine> read_rotation(TextNode arguments, const ValueReader& values) {
    Vec3 axis;
    double degrees = 0;
    if (arguments.size() != 2) {
        values.fail(arguments, "rotate", "((x, y, z), degrees)");
        return std::nullopt;
    }
    auto argument = arguments.begin();
    if (!values.read(*argument, "rotate", axis)) return std::nullopt;
    if (axis == Vec3{}) {
        values.fail(*argument, "rotate", "an axis that is not zero");
        return std::nullopt;
    }
    ++argument;
    if (!values.read(*argument, "rotate", degrees)) return std::nullopt;
    return Affine::rotate(axis, degrees * std::numbers::pi / 180.0);
}

std::optional<Affine> read_matrix(TextNode arguments, const ValueReader& values) {
    double m[3][4];
    int row = 0;
    if (arguments.size() != 3) {
        values.fail(arguments, "matrix", "three rows of 4 numbers");
        return std::nullopt;
    }
    for (const TextNode values_of_row : arguments) {
        if (!values.read_numbers(values_of_row, "matrix", 4, m[row++])) return std::nullopt;
    }
    const auto column = [&](int j) { return Vec3{m[0][j], m[1][j], m[2][j]}; };
    return Affine{{column(0), column(1), column(2)}, column(3)};
}

std::optional<Affine> read_one(TextNode value, const ValueReader& values) {
    if (value.broken()) return std::nullopt;
    const bool call =
        value.is(NodeKind::Entry) && !value.empty() && value.first().is(NodeKind::List);
    if (call && value.text() == "rotate") return read_rotation(value.first(), values);
    if (call && value.text() == "matrix") return read_matrix(value.first(), values);
    if (call && value.text() == "translate") {
        Vec3 offset;
        if (values.read(value.first(), "translate", offset)) return Affine::translate(offset);
        return std::nullopt;
    }
    if (call && value.text() == "scale") {
        Vec3 factors;
        double factor = 1;
        if (value.first().size() == 1) {
            if (!values.read(value.first().first(), "scale", factor)) return std::nullopt;
            return Affine::scale({factor, factor, factor});
        }
        if (values.read(value.first(), "scale", factors)) return Affine::scale(factors);
        return std::nullopt;
    }
    values.fail(value, "transform", kExpected);
    return std::nullopt;
}

/// Reads one transform, or a list of them.
Affine read_any(TextNode value, const ValueReader& values) {
    if (value.broken()) return {};
    if (!value.is(NodeKind::List)) return read_one(value, values).value_or(Affine{});
    Affine all;
    for (const TextNode step : value) all = read_one(step, values).value_or(Affine{}) * all;
    return all;
}

}  // namespace

Affine read_native_transform(BlockReader& reader) {
    const std::optional<TextNode> value = reader.find("transform");
    return value ? read_any(*value, reader.values()) : Affine{};
}

std::vector<TransformKey> read_native_motion(BlockReader& reader) {
    const std::optional<TextNode> list = reader.find("motion");
    if (!list || list->broken() || !reader.values().is_list(*list, "motion")) return {};
    std::vector<TransformKey> keys;
    for (const TextNode entry : *list) {
        TransformKey key;
        if (!entry.is(NodeKind::List) || entry.size() != 2) {
            reader.values().fail(entry, "motion", "(time, transform), ...");
            return {};
        }
        auto part = entry.begin();
        if (!reader.values().read(*part, "motion", key.time)) return {};
        key.outer_from_inner = read_any(*++part, reader.values());
        keys.push_back(key);
    }
    if (const char* fault = fault_of(keys); fault != nullptr) {
        reader.error(*list, fault);
        return {};
    }
    return keys;
}

void read_native_placement(BlockReader& reader, const NativeScope& scope, Part& part) {
    const Affine inner = read_native_transform(reader);
    part.object_from_part = scope.placed(inner);
    std::vector<TransformKey> keys = read_native_motion(reader);
    if (keys.empty()) return;
    part.motion = std::make_shared<const PartMotion>(
        PartMotion{scope.object_from_here, std::move(keys), inner});
}

}  // namespace alhazen
