#include "alhazen/formats/gltf/document/gltf_accessors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "alhazen/base/interruption.h"
#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read in native byte order");

struct ComponentName {
    ComponentType type;
    const char* name;
    std::size_t size;
};
constexpr ComponentName kComponents[] = {
    {ComponentType::Byte, "BYTE", 1},
    {ComponentType::UnsignedByte, "UNSIGNED_BYTE", 1},
    {ComponentType::Short, "SHORT", 2},
    {ComponentType::UnsignedShort, "UNSIGNED_SHORT", 2},
    {ComponentType::UnsignedInt, "UNSIGNED_INT", 4},
    {ComponentType::Float, "FLOAT", 4},
};

struct ElementName {
    const char* name;
    std::size_t rows, columns;
};
/// Indexed by ElementType.
constexpr ElementName kElements[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1},
                                     {"VEC4", 4, 1},   {"MAT2", 2, 2}, {"MAT3", 3, 3},
                                     {"MAT4", 4, 4}};

const ComponentName& entry_of(ComponentType type) {
    for (const ComponentName& entry : kComponents) {
        if (entry.type == type) return entry;
    }
    return kComponents[5];
}

/// Writes the components of all elements to `out`, converted by `convert`.
template <class T, class Out, class Convert>
void copy_as(const Document& document, const Accessor& accessor, std::vector<Out>& out,
             Convert convert) {
    const ElementLayout layout = layout_of(accessor.component, accessor.type);
    const std::size_t n = layout.rows * layout.columns;
    each_run(document, accessor, [&](const ElementRun& run) {
        if (run.data == nullptr) return;
        Out* to = out.data() + run.first * n;
        for (std::uint64_t i = 0; i < run.count; ++i) {
            interruption_point();
            const char* element = run.data + i * run.stride;
            for (std::size_t column = 0; column < layout.columns; ++column) {
                const char* from = element + column * layout.column_stride;
                for (std::size_t row = 0; row < layout.rows; ++row, from += sizeof(T)) {
                    T value;
                    std::memcpy(&value, from, sizeof(T));
                    *to++ = convert(value);
                }
            }
        }
    });
}

template <class T>
void copy_numbers(const Document& document, const Accessor& accessor, std::vector<double>& out) {
    if (!accessor.normalized || std::is_same_v<T, float>) {
        copy_as<T>(document, accessor, out, [](T x) { return static_cast<double>(x); });
        return;
    }
    // Division keeps the largest value exactly 1; multiplication by the inverse would not.
    const double most = static_cast<double>(std::numeric_limits<T>::max());
    copy_as<T>(document, accessor, out,
               [most](T x) { return std::max(static_cast<double>(x) / most, -1.0); });
}

/// All numbers of an accessor, which may be a copy outside the document.
std::vector<double> numbers_of(const Document& document, const Accessor& accessor) {
    std::vector<double> out(accessor.count * component_count(accessor.type), 0.0);
    switch (accessor.component) {
        case ComponentType::Byte:
            copy_numbers<std::int8_t>(document, accessor, out);
            break;
        case ComponentType::UnsignedByte:
            copy_numbers<std::uint8_t>(document, accessor, out);
            break;
        case ComponentType::Short:
            copy_numbers<std::int16_t>(document, accessor, out);
            break;
        case ComponentType::UnsignedShort:
            copy_numbers<std::uint16_t>(document, accessor, out);
            break;
        case ComponentType::UnsignedInt:
            copy_numbers<std::uint32_t>(document, accessor, out);
            break;
        case ComponentType::Float:
            copy_numbers<float>(document, accessor, out);
            break;
    }
    return out;
}

void read_sparse(const JsonObject& object, Accessor& accessor) {
    object.with_object("sparse", [&](const JsonObject& sparse) {
        SparseAccessor result;
        bool is_known = true;
        sparse.require("count");
        sparse.require("indices");
        sparse.require("values");
        result.count = sparse.integer("count", 1).value_or(0);
        if (result.count > accessor.count) {
            sparse.error("count", "more sparse elements (" + std::to_string(result.count) +
                                      ") than elements (" + std::to_string(accessor.count) + ")");
        }
        sparse.with_object("indices", [&](const JsonObject& indices) {
            indices.require("bufferView");
            indices.require("componentType");
            result.indices_view = indices.index("bufferView", Collection::BufferViews).value_or(0);
            result.indices_offset = indices.integer("byteOffset").value_or(0);
            const auto type = indices.integer("componentType");
            if (type && *type != 5121 && *type != 5123 && *type != 5125) {
                indices.warning("componentType",
                                "expected 5121, 5123 or 5125; the sparse values are ignored");
                is_known = false;
            } else if (type) {
                result.indices_type = static_cast<ComponentType>(*type);
            }
        });
        sparse.with_object("values", [&](const JsonObject& values) {
            values.require("bufferView");
            result.values_view = values.index("bufferView", Collection::BufferViews).value_or(0);
            result.values_offset = values.integer("byteOffset").value_or(0);
        });
        if (is_known) accessor.sparse = result;
    });
}

/// Reads the types; false, with a warning, for an unknown type.
bool read_types(const JsonObject& object, Accessor& accessor) {
    bool is_known = true;
    object.require("componentType");
    object.require("type");
    if (const auto code = object.integer("componentType")) {
        const auto* found = std::find_if(
            std::begin(kComponents), std::end(kComponents),
            [&](const ComponentName& c) { return static_cast<std::uint64_t>(c.type) == *code; });
        if (found == std::end(kComponents)) {
            object.warning("componentType",
                           "expected 5120, 5121, 5122, 5123, 5125 or 5126, found " +
                               std::to_string(*code) + "; the accessor is ignored");
            is_known = false;
        } else {
            accessor.component = found->type;
        }
    }
    if (const auto name = object.text("type")) {
        const auto* found = std::find_if(std::begin(kElements), std::end(kElements),
                                         [&](const ElementName& e) { return *name == e.name; });
        if (found == std::end(kElements)) {
            object.warning("type",
                           "expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4; the accessor "
                           "is ignored");
            is_known = false;
        } else {
            accessor.type = static_cast<ElementType>(found - std::begin(kElements));
        }
    }
    return is_known;
}

/// Reads the member "min" or "max": numbers that the type can hold.
std::vector<double> read_bound(const JsonObject& object, const char* key,
                               const Accessor& accessor) {
    constexpr double kLargestFloat = std::numeric_limits<float>::max();
    const bool is_float = accessor.component == ComponentType::Float;
    const bool is_signed =
        accessor.component == ComponentType::Byte || accessor.component == ComponentType::Short;
    const auto bits = static_cast<int>(8 * component_size(accessor.component));
    const double least = is_float ? -kLargestFloat : is_signed ? -std::ldexp(1.0, bits - 1) : 0.0;
    const double most =
        is_float ? kLargestFloat : std::ldexp(1.0, is_signed ? bits - 1 : bits) - 1.0;
    auto bound =
        object.numbers(key, component_count(accessor.type)).value_or(std::vector<double>());
    for (const double x : bound) {
        if (x >= least && x <= most && (is_float || x == std::floor(x))) continue;
        object.error(key, written(x) + " is not a number of " + name_of(accessor.component));
    }
    return bound;
}

Accessor read_accessor(const JsonObject& object) {
    Accessor accessor;
    accessor.name = object.text("name").value_or("");
    const bool is_known = read_types(object, accessor);
    accessor.view = object.index("bufferView", Collection::BufferViews);
    accessor.offset = object.integer("byteOffset").value_or(0);
    if (object.has("byteOffset") && !object.has("bufferView")) {
        object.error("byteOffset", "not allowed without a bufferView");
    }
    object.require("count");
    accessor.count = object.integer("count", 1).value_or(0);
    accessor.normalized = object.flag("normalized");
    if (accessor.normalized && component_size(accessor.component) == 4) {
        object.error("normalized", std::string("only bytes and shorts can be normalised, not ") +
                                       name_of(accessor.component));
    }
    if (!is_known) {
        // No use allows this type without data, so each use reports it.
        Accessor unusable;
        unusable.component = ComponentType::Byte;
        unusable.count = 1;
        return unusable;
    }
    accessor.min = read_bound(object, "min", accessor);
    accessor.max = read_bound(object, "max", accessor);
    read_sparse(object, accessor);
    return accessor;
}

}  // namespace

std::size_t component_size(ComponentType type) {
    return entry_of(type).size;
}
const char* name_of(ComponentType type) {
    return entry_of(type).name;
}
const char* name_of(ElementType type) {
    return kElements[static_cast<std::size_t>(type)].name;
}
std::size_t component_count(ElementType type) {
    const ElementName& entry = kElements[static_cast<std::size_t>(type)];
    return entry.rows * entry.columns;
}

ElementLayout layout_of(ComponentType component, ElementType type) {
    const ElementName& entry = kElements[static_cast<std::size_t>(type)];
    ElementLayout layout{.rows = entry.rows, .columns = entry.columns};
    layout.component = component_size(component);
    const std::size_t column = layout.rows * layout.component;
    layout.column_stride = layout.columns == 1 ? column : (column + 3) / 4 * 4;
    layout.size = (layout.columns - 1) * layout.column_stride + column;
    layout.packed = layout.columns * layout.column_stride;
    return layout;
}

ElementRun base_run(const Document& document, const Accessor& accessor) {
    ElementRun run{.count = accessor.count};
    if (!accessor.view) return run;
    const BufferView& view = document.views[*accessor.view];
    run.data = bytes_of(document, view).data() + accessor.offset;
    run.stride =
        view.stride != 0 ? view.stride : layout_of(accessor.component, accessor.type).packed;
    return run;
}

ElementRun sparse_run(const Document& document, const Accessor& accessor) {
    const SparseAccessor& sparse = *accessor.sparse;
    return {.data = bytes_of(document, document.views[sparse.values_view]).data() +
                    sparse.values_offset,
            .stride = layout_of(accessor.component, accessor.type).packed,
            .count = sparse.count};
}

std::uint64_t sparse_index(const Document& document, const Accessor& accessor, std::uint64_t i) {
    const SparseAccessor& sparse = *accessor.sparse;
    const std::size_t size = component_size(sparse.indices_type);
    std::uint32_t index = 0;
    const char* from = bytes_of(document, document.views[sparse.indices_view]).data();
    std::memcpy(&index, from + sparse.indices_offset + i * size, size);
    return index;
}

void read_accessors(const JsonObject& root, Loading& loading) {
    root.each_object("accessors", [&](const JsonObject& object, std::size_t) {
        loading.document.accessors.push_back(read_accessor(object));
    });
}

std::vector<double> read_numbers(const Document& document, Index index) {
    return numbers_of(document, document.accessors[index]);
}

std::vector<double> read_numbers(const Document& document, Index index, std::uint64_t most) {
    Accessor first = document.accessors[index];
    first.count = std::min(first.count, most);
    return numbers_of(document, first);
}

std::vector<std::uint32_t> read_integers(const Document& document, Index index) {
    const Accessor& accessor = document.accessors[index];
    std::vector<std::uint32_t> out(accessor.count * component_count(accessor.type), 0);
    const auto copy = [](auto x) { return static_cast<std::uint32_t>(x); };
    switch (accessor.component) {
        case ComponentType::UnsignedByte:
            copy_as<std::uint8_t>(document, accessor, out, copy);
            break;
        case ComponentType::UnsignedShort:
            copy_as<std::uint16_t>(document, accessor, out, copy);
            break;
        case ComponentType::UnsignedInt:
            copy_as<std::uint32_t>(document, accessor, out, copy);
            break;
        default:
            break;  // the checks reject these types for integers
    }
    return out;
}

}  // namespace alhazen::gltf
