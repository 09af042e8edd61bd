#pragma once
/// Values and blocks as text of the native format.
///
/// Conventions: numbers are the shortest decimals that read back to the same double, including -0;
/// strings are escaped so that all bytes are preserved. Non-finite numbers cannot be written.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "alhazen/geometry/motion/transform_motion.h"
#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// Throws Error (Scene) if the number is not finite.
[[nodiscard]] std::string native_value(double number);
[[nodiscard]] std::string native_value(int number);
[[nodiscard]] std::string native_value(bool truth);
std::string native_value(const char*) = delete;  // prevents a conversion to bool
[[nodiscard]] std::string native_value(const Vec2& v);
[[nodiscard]] std::string native_value(const Vec3& v);
[[nodiscard]] std::string native_value(const Rgb& color);
/// `matrix(row, row, row)`.
[[nodiscard]] std::string native_value(const Affine& transform);
/// `[(time, matrix), ...]`.
[[nodiscard]] std::string native_value(const std::vector<TransformKey>& keys);
/// The text in quotes, escaped.
[[nodiscard]] std::string native_string(std::string_view text);
/// `[a, b, c]`.
[[nodiscard]] std::string native_list(const std::vector<std::string>& values);
/// The list of the texts of all values, by `text_of`.
template <class Values, class TextOf>
[[nodiscard]] std::string native_list_of(const Values& values, TextOf text_of) {
    std::vector<std::string> texts;
    texts.reserve(values.size());
    for (const auto& value : values) texts.push_back(text_of(value));
    return native_list(texts);
}

/// The text of a block: `head { key = value; ... }`.
class NativeBlockText {
  public:
    /// The head is `type "label"`, or `type` alone if the label is empty; a block used as a value
    /// has no head.
    explicit NativeBlockText(std::string_view type = {}, std::string_view label = {});

    void add(std::string_view key, std::string value) {
        pairs_.emplace_back(key, std::move(value));
    }
    /// Adds a pair unless the value is the reader's default.
    template <class T>
    void add_unless(std::string_view key, const T& value, const T& usual) {
        std::string text = native_value(value);
        if (text != native_value(usual)) add(key, std::move(text));
    }

    [[nodiscard]] bool empty() const { return pairs_.empty(); }
    /// The block, on one line if it is short, without a final line end.
    [[nodiscard]] std::string text(int indent = 0) const;
    /// The block for use after the beginning of a line, without the first indent.
    [[nodiscard]] std::string value(int indent) const {
        return text(indent).substr(static_cast<std::size_t>(indent));
    }

  private:
    std::string head_;
    std::vector<std::pair<std::string, std::string>> pairs_;
};

}  // namespace alhazen
