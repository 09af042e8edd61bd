#pragma once
/// Typed access to the parse tree: converts and checks values, reports unrecognised keys.
///
/// Conventions: every function reports a bad value with its location, returns false and leaves its
/// output unchanged. For values left incomplete by a syntax error, which has been reported, it only
/// returns false.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "alhazen/formats/text/text_tree.h"
#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// Reads values; `what` names the value in messages ("radius").
struct ValueReader {
    Diagnostics& diagnostics;

    bool read(TextNode value, std::string_view what, double& out) const;
    bool read(TextNode value, std::string_view what, int& out) const;
    bool read(TextNode value, std::string_view what, bool& out) const;
    bool read(TextNode value, std::string_view what, Vec2& out) const;
    bool read(TextNode value, std::string_view what, Vec3& out) const;
    bool read(TextNode value, std::string_view what, Rgb& out) const;
    /// Reads a word or a string.
    bool read(TextNode value, std::string_view what, std::string& out) const;
    /// Reads exactly `count` numbers.
    bool read_numbers(TextNode value, std::string_view what, int count, double* out) const;
    /// True for a list of any length.
    bool is_list(TextNode value, std::string_view what) const;

    /// Reports "WHAT: expected EXPECTED, found ..." unless the value is broken. Always false.
    bool fail(TextNode value, std::string_view what, std::string_view expected) const;
};

/// Names separated by commas: "a, b, c".
[[nodiscard]] std::string joined(const std::vector<std::string_view>& names);

/// A keyword and its value.
template <class T>
using Vocabulary = std::vector<std::pair<std::string_view, T>>;

/// Records the queries of a reader (BlockReader::observe).
class BlockObserver {
  public:
    virtual ~BlockObserver() = default;
    /// `words`: the possible values of a keyword; empty for other values.
    virtual void key(std::string_view block, std::string_view key,
                     const std::vector<std::string_view>& words) = 0;
    virtual void required(std::string_view block, std::string_view key) = 0;
};

/// The pairs of one block. Query every known key, then call `finish`.
class BlockReader {
  public:
    enum class Strictness {
        Strict,    ///< unknown and repeated keys are errors
        Tolerant,  ///< unknown and repeated keys are warnings; the last repetition is used
    };

    /// `what` names the block in messages: "sphere".
    BlockReader(TextNode block, std::string what, Strictness strictness, Diagnostics& diagnostics)
        : block_(block), what_(std::move(what)), strictness_(strictness), values_{diagnostics} {}

    /// Reports all further queries to `observer`; null: none.
    void observe(BlockObserver* observer) { observer_ = observer; }

    /// The value of `key`, unless absent or broken.
    [[nodiscard]] std::optional<TextNode> find(std::string_view key) { return find(key, key); }
    /// The value of a key that has another `spelling`.
    [[nodiscard]] std::optional<TextNode> find(std::string_view key, std::string_view spelling);
    /// True if the key is present, whether its value is valid or not.
    [[nodiscard]] bool has(std::string_view key) const;

    /// Reads a value; true if the key is present and its value valid.
    template <class T>
    bool read(std::string_view key, T& out) {
        const std::optional<TextNode> value = find(key);
        return value && values_.read(*value, key, out);
    }
    template <class T>
    bool read_word(std::string_view key, const Vocabulary<T>& words, T& out);

    /// Reports an error if the key is absent.
    void require(std::string_view key);
    /// Reports an error if `key` is present without `other`; marks it as known.
    void needs(std::string_view key, std::string_view other);
    /// Marks a key as known without reading it.
    void ignore(std::string_view key) { (void)find(key); }

    /// Reports pairs that were never queried, and items that are not pairs unless `allow_items`.
    void finish(bool allow_items = false);

    [[nodiscard]] TextNode block() const { return block_; }
    [[nodiscard]] const ValueReader& values() const { return values_; }
    [[nodiscard]] const std::string& what() const { return what_; }
    void error(TextNode where, std::string message) const;

  private:
    void complain(TextNode where, std::string message) const;

    TextNode block_;
    std::string what_;
    Strictness strictness_;
    ValueReader values_;
    std::vector<std::string_view> known_;
    BlockObserver* observer_ = nullptr;
};

template <class T>
bool BlockReader::read_word(std::string_view key, const Vocabulary<T>& words, T& out) {
    const std::optional<TextNode> value = find(key);
    if (!value && observer_ == nullptr) return false;
    std::vector<std::string_view> names;
    for (const auto& [word, meaning] : words) {
        if (value && value->is(NodeKind::Word) && value->text() == word) {
            out = meaning;
            return true;
        }
        names.push_back(word);
    }
    if (observer_ != nullptr) observer_->key(what_, key, names);
    if (!value) return false;
    return values_.fail(*value, key, "one of " + joined(names));
}

}  // namespace alhazen
