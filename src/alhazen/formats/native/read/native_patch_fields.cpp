// Lists and counts of patches.

#include "alhazen/formats/native/read/native_shape_fields.h"

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

void read_native_list(BlockReader& reader, std::string_view key, std::vector<TrimLoop>&) {
    (void)reader.find(key);
}

std::string native_field_text(std::uint32_t count) {
    return native_value(static_cast<double>(count));
}

std::string native_field_text(const std::vector<Vec3>& list) {
    return native_list_of(list, [](const Vec3& p) { return native_value(p); });
}

std::string native_field_text(const std::vector<double>& list) {
    return native_list_of(list, [](double x) { return native_value(x); });
}

std::string native_field_text(const std::vector<std::uint32_t>& list) {
    return native_list_of(list, [](std::uint32_t x) { return native_field_text(x); });
}

std::string native_field_text(const std::vector<TrimLoop>&) {
    return "[]";
}

}  // namespace alhazen
