#pragma once
/// Reads numbers and runs of bytes from memory with bounds checks: throws Error (Scene) if the data
/// end too early.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "alhazen/imaging/codecs/image_size.h"

namespace alhazen {

class ByteReader {
  public:
    /// `name`: the file, for messages. Both arguments must outlive the reader.
    ByteReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    [[nodiscard]] std::size_t position() const { return position_; }
    [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }
    [[nodiscard]] const std::string& name() const { return name_; }

    /// Moves to an offset from the start.
    void seek(std::uint64_t position) {
        if (position > bytes_.size()) ends_early();
        position_ = std::size_t(position);
    }
    [[nodiscard]] std::string_view take(std::uint64_t count) {
        if (count > left()) ends_early();
        const std::string_view taken = bytes_.substr(position_, std::size_t(count));
        position_ += std::size_t(count);
        return taken;
    }
    std::uint8_t u8() { return std::uint8_t(take(1)[0]); }
    std::uint16_t u16_little() { return std::uint16_t(little(2)); }
    std::uint32_t u32_little() { return little(4); }
    std::int32_t i32_little() { return std::int32_t(little(4)); }

    /// The text up to `end`, at most `max_length` characters; moves behind `end`.
    [[nodiscard]] std::string_view until(char end, std::size_t max_length) {
        const std::size_t found = bytes_.substr(position_, max_length + 1).find(end);
        if (found == std::string_view::npos) {
            if (left() <= max_length) ends_early();
            bad_image(name_, "damaged picture: a line of the header is too long");
        }
        const std::string_view text = take(found);
        ++position_;
        return text;
    }

    [[noreturn]] void ends_early() const {
        bad_image(name_, "damaged picture: the data end too early");
    }

  private:
    std::uint32_t little(std::size_t count) {
        const std::string_view taken = take(count);
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < count; ++i) {
            value |= std::uint32_t{std::uint8_t(taken[i])} << (8 * i);
        }
        return value;
    }

    std::string_view bytes_;
    const std::string& name_;
    std::size_t position_ = 0;
};

}  // namespace alhazen
