#pragma once
/// Memory for arrays that are needed one after another: pages in use are not cleared again.

#include <cstddef>
#include <type_traits>
#include <vector>

#include "alhazen/base/huge_array.h"

namespace alhazen {

class HugeRoom {
  public:
    /// Throws std::bad_alloc, like `take`.
    explicit HugeRoom(std::size_t bytes)
        : memory_(make_huge_array<Line>(lines_of(bytes))), size_(bytes) {}

    /// Memory for an array of values that are written before they are read; beside the room if this
    /// is used up.
    template <class T>
    [[nodiscard]] T* take(std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kAlignment);
        const std::size_t bytes = bytes_for<T>(count);
        if (bytes > size_ - used_) {
            others_.push_back(make_huge_array<Line>(lines_of(bytes)));
            return reinterpret_cast<T*>(others_.back().get());
        }
        auto* const first =
            reinterpret_cast<T*>(reinterpret_cast<std::byte*>(memory_.get()) + used_);
        used_ += bytes;
        return first;
    }
    /// The bytes that `take` takes.
    template <class T>
    [[nodiscard]] static constexpr std::size_t bytes_for(std::size_t count) {
        return (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
    }
    [[nodiscard]] std::size_t used() const { return used_; }
    /// Takes back the memory taken since `used` bytes were in use.
    void rewind(std::size_t used) { used_ = used; }

  private:
    static constexpr std::size_t kAlignment = 64;
    struct alignas(kAlignment) Line {
        std::byte bytes[kAlignment];
    };
    [[nodiscard]] static std::size_t lines_of(std::size_t bytes) { return bytes / kAlignment + 1; }

    HugeArray<Line> memory_;
    std::size_t size_, used_ = 0;
    std::vector<HugeArray<Line>> others_;
};

}  // namespace alhazen
