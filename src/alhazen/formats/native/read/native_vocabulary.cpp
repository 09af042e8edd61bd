#include "alhazen/formats/native/read/native_vocabulary.h"

#include <algorithm>
#include <type_traits>

#include "alhazen/formats/native/fields/native_shape_fields.h"
#include "alhazen/formats/native/read/native_parts.h"
#include "alhazen/formats/native/read/native_shapes.h"

namespace alhazen {

namespace {

/// Records the keys of one type of block.
class KeyNotes final : public BlockObserver {
  public:
    explicit KeyNotes(NativeBlockType& type) : type_(type) {}

    void key(std::string_view block, std::string_view key,
             const std::vector<std::string_view>& words) override {
        if (block != type_.name) return;
        NativeKey& known = entry(key);
        if (known.words.empty()) known.words.assign(words.begin(), words.end());
    }
    /// Only a key that an empty block requires is required: others depend on the kind of block.
    void required(std::string_view block, std::string_view key) override {
        if (block == type_.name) entry(key).required |= empty_;
    }
    /// Announces the next block, with no keys (`empty`) or some.
    void begin(bool empty) { empty_ = empty; }

  private:
    NativeKey& entry(std::string_view key) {
        const auto found = std::find_if(type_.keys.begin(), type_.keys.end(),
                                        [&](const NativeKey& k) { return k.name == key; });
        if (found != type_.keys.end()) return *found;
        return type_.keys.emplace_back(NativeKey{.name = std::string(key)});
    }

    NativeBlockType& type_;
    bool empty_ = true;
};

/// Reads a text and records the reader's queries; ignores findings. `with_object`: an object "x"
/// exists.
void read_noted(const std::string& text, bool with_object, KeyNotes& notes) {
    SceneDescription scene;
    scene.path = "scene.alhazen";
    scene.objects.push_back({"scene", {}, {}});
    Diagnostics ignored;
    const ImportOptions options;
    const SourceText source(text, "");
    const TextTree tree(source, {}, ignored);
    NativeContext context(scene, ignored, options);
    if (with_object) context.object_names.emplace("x", ObjectIndex{0});
    context.observer = &notes;
    std::vector<Part> parts;
    NativeScope scope{parts, {}, std::nullopt, {}};
    read_native_items(tree.root(), context, scope);
}

const char* word_of(Unit unit) {
    switch (unit) {
        case Unit::Point:
            return "point";
        case Unit::Vector:
            return "vector";
        case Unit::Direction:
            return "direction";
        case Unit::Length:
            return "length";
        case Unit::Number:
            return "number";
        case Unit::Count:
            return "count";
        case Unit::Flag:
            return "bool";
        case Unit::Text:
            return "text";
        case Unit::Compound:
            return "list";
    }
    return "";
}

template <class S, class T>
void describe_field(const Field<S, T>& field, NativeBlockType& type) {
    for (NativeKey& key : type.keys) {
        if (key.name != field.name) continue;
        key.unit = word_of(field.unit);
        if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, Vec3> ||
                      std::is_same_v<T, Vec2>) {
            key.usual = native_field_text(S{}.*field.member);
        }
    }
}

template <class... S>
void describe_fields(ShapeTypes<S...>, NativeBlockType& type) {
    const auto describe = [&]<class Shape>(const Shape*) {
        if (type.name != Shape::kName) return;
        for_each_field<Shape>([&](const auto& field) { describe_field(field, type); });
    };
    (describe(static_cast<const S*>(nullptr)), ...);
}

NativeBlockType block_type(std::string_view name) {
    NativeBlockType type{std::string(name), is_native_shape(name), {}};
    KeyNotes notes(type);
    const std::string head = type.name + " \"x\" ";
    const bool of_object = type.name == "instance";
    read_noted(head + "{ }", of_object, notes);
    notes.begin(false);
    const std::vector<NativeKey> found = type.keys;
    for (const NativeKey& key : found) {
        for (const std::string& word : key.words) {
            read_noted(head + "{ " + key.name + " = " + word + " }", of_object, notes);
        }
    }
    if (type.is_shape) describe_fields(AnalyticShapes{}, type);
    return type;
}

}  // namespace

std::vector<NativeBlockType> native_vocabulary() {
    std::vector<NativeBlockType> types;
    for (const std::string_view name : native_block_names()) {
        if (name != "include") types.push_back(block_type(name));
    }
    return types;
}

}  // namespace alhazen
