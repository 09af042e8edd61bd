#pragma once
/// A vector that owns its values, in large pages, or refers to memory of another owner, such as a
/// mapped file. Reading costs the same in both cases.
///
/// Conventions: every operation that may change the values first copies them to owned memory, and
/// so does forming a non-const reference: read through const references.

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "alhazen/base/huge_pages.h"

namespace alhazen {

/// Leaves new values uninitialised if they need not be: they are written once, not twice.
template <class T>
struct UnwrittenPageAllocator : HugePageAllocator<T> {
    UnwrittenPageAllocator() = default;
    template <class U>
    explicit UnwrittenPageAllocator(const UnwrittenPageAllocator<U>&) {}

    template <class U, class... Arguments>
    void construct(U* place, Arguments&&... arguments) {
        if constexpr (sizeof...(Arguments) == 0 && std::is_trivially_default_constructible_v<U>) {
            ::new (static_cast<void*>(place)) U;
        } else {
            ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
        }
    }
};

template <class T>
class MappableVector {
  public:
    using value_type = T;

    MappableVector() = default;
    /// Refers to values that `owner` keeps alive.
    MappableVector(std::span<const T> values, std::shared_ptr<const void> owner)
        : values_(values), owner_(std::move(owner)) {}
    MappableVector(const MappableVector& other) : own_(other.own_), owner_(other.owner_) {
        values_ = other.is_mapped() ? other.values_ : std::span<const T>(own_);
    }
    MappableVector(MappableVector&& other) noexcept
        : own_(std::move(other.own_)),
          values_(std::exchange(other.values_, {})),
          owner_(std::move(other.owner_)) {}
    MappableVector& operator=(MappableVector other) noexcept {
        std::swap(own_, other.own_);
        std::swap(values_, other.values_);
        std::swap(owner_, other.owner_);
        return *this;
    }
    ~MappableVector() = default;

    [[nodiscard]] bool is_mapped() const { return owner_ != nullptr; }

    // ---- reading
    [[nodiscard]] std::size_t size() const { return values_.size(); }
    [[nodiscard]] bool empty() const { return values_.empty(); }
    [[nodiscard]] const T* data() const { return values_.data(); }
    [[nodiscard]] const T& operator[](std::size_t i) const { return values_.data()[i]; }
    [[nodiscard]] const T* begin() const { return values_.data(); }
    [[nodiscard]] const T* end() const { return values_.data() + values_.size(); }
    /// Capacity of owned memory; the size where the values are mapped.
    [[nodiscard]] std::size_t capacity() const { return is_mapped() ? size() : own_.capacity(); }

    // ---- changing
    [[nodiscard]] T* data() { return own().data(); }
    [[nodiscard]] T& operator[](std::size_t i) { return own()[i]; }
    [[nodiscard]] T* begin() { return own().data(); }
    [[nodiscard]] T* end() { return own().data() + own_.size(); }
    template <class... Arguments>
    T& emplace_back(Arguments&&... arguments) {
        T& value = own().emplace_back(std::forward<Arguments>(arguments)...);
        values_ = own_;
        return value;
    }
    void push_back(const T& value) { emplace_back(value); }
    void append(std::span<const T> values) {
        change([&](auto& own) { own.insert(own.end(), values.begin(), values.end()); });
    }
    void reserve(std::size_t n) {
        change([&](auto& own) { own.reserve(n); });
    }
    /// New values of a type without a constructor are uninitialised, as are those of
    /// `emplace_back` without arguments.
    void resize(std::size_t n) {
        change([&](auto& own) { own.resize(n); });
    }
    void shrink_to_fit() {
        change([](auto& own) { own.shrink_to_fit(); });
    }

  private:
    using Own = std::vector<T, UnwrittenPageAllocator<T>>;

    Own& own() {
        if (is_mapped()) {
            own_.assign(values_.begin(), values_.end());
            values_ = own_;
            owner_.reset();
        }
        return own_;
    }
    template <class Change>
    void change(Change&& apply) {
        apply(own());
        values_ = own_;
    }

    Own own_;
    std::span<const T> values_;  ///< the values of `own_` or of the other owner
    std::shared_ptr<const void> owner_;
};

}  // namespace alhazen
