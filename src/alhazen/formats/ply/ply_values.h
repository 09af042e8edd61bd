#pragma once
/// Sequential reader of the numbers in a PLY body, ascii or binary.
///
/// Conventions: `read` is false at the end of the bytes and for text that is not a number; every
/// value of every type is exactly representable as a double.

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "alhazen/formats/ply/ply_header.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

/// Values of an ascii body.
class AsciiValues {
  public:
    static constexpr std::size_t kListItemBytes = 2;
    static constexpr bool kHasLines = true;

    AsciiValues(std::string_view bytes, const PlyHeader& header)
        : cursor_(bytes.substr(header.body_offset), header.body_line) {}

    bool read(PlyType, double& value) { return cursor_.skip_to_word() && cursor_.number(value); }
    bool skip(const PlyElement&) { return false; }
    /// Moves to the next value; true if that is the first of its line.
    bool begins_line() {
        cursor_.skip_to_word();
        return cursor_.begins_line();
    }
    [[nodiscard]] bool ends_line() const {
        TextCursor next = cursor_;
        return !next.skip_blanks();
    }
    [[nodiscard]] std::int64_t line() const { return cursor_.line(); }
    /// Recovers after an error: continues with the next line.
    bool recover() {
        cursor_.skip_line();
        return cursor_.skip_to_word();
    }
    [[nodiscard]] std::size_t bytes_left() const { return cursor_.bytes_left() + 1; }
    /// Bytes from the next word on.
    [[nodiscard]] std::size_t surplus_bytes() const {
        TextCursor next = cursor_;
        return next.skip_to_word() ? next.bytes_left() : 0;
    }
    /// Location of the next value.
    [[nodiscard]] FileLocation location(const std::string& file) const {
        TextCursor next = cursor_;
        next.skip_to_word();
        return next.location(file);
    }
    [[nodiscard]] std::string found() const {
        return cursor_.at_end() ? "the end of the file" : cursor_.shown_word();
    }

  private:
    TextCursor cursor_;
};

template <class T>
T load_number(const char* bytes, bool swap) {
    char copy[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i) copy[i] = bytes[swap ? sizeof(T) - 1 - i : i];
    T value;
    std::memcpy(&value, copy, sizeof(T));
    return value;
}

/// Values of a binary body.
class BinaryValues {
  public:
    static constexpr std::size_t kListItemBytes = 1;
    static constexpr bool kHasLines = false;

    BinaryValues(std::string_view bytes, const PlyHeader& header)
        : rest_(bytes.substr(header.body_offset)),
          swap_((header.format == PlyFormat::BigEndian) ==
                (std::endian::native == std::endian::little)) {}

    bool read(PlyType type, double& value) {
        const std::size_t size = size_of(type);
        if (rest_.size() < size) return false;
        value = decode(type, rest_.data());
        rest_.remove_prefix(size);
        return true;
    }
    /// Skips all items of an element without lists. Precondition: enough bytes are left.
    bool skip(const PlyElement& element) {
        for (const PlyProperty& property : element.properties) {
            if (property.count_type) return false;
        }
        rest_.remove_prefix(element.count * element.min_bytes(PlyFormat::LittleEndian));
        return true;
    }
    /// Cannot recover: the start of the next item is unknown.
    static bool recover() { return false; }
    [[nodiscard]] std::size_t bytes_left() const { return rest_.size(); }
    [[nodiscard]] std::size_t surplus_bytes() const { return rest_.size(); }
    [[nodiscard]] FileLocation location(const std::string& file) const { return {file, 0, 0}; }
    [[nodiscard]] std::string found() const { return "the end of the file"; }

  private:
    double decode(PlyType type, const char* p) const {
        switch (type) {
            case PlyType::Int8:
                return load_number<std::int8_t>(p, swap_);
            case PlyType::Uint8:
                return load_number<std::uint8_t>(p, swap_);
            case PlyType::Int16:
                return load_number<std::int16_t>(p, swap_);
            case PlyType::Uint16:
                return load_number<std::uint16_t>(p, swap_);
            case PlyType::Int32:
                return load_number<std::int32_t>(p, swap_);
            case PlyType::Uint32:
                return load_number<std::uint32_t>(p, swap_);
            case PlyType::Float32:
                return double(load_number<float>(p, swap_));
            case PlyType::Float64:
                return load_number<double>(p, swap_);
        }
        return 0.0;
    }

    std::string_view rest_;
    bool swap_;
};

}  // namespace alhazen
