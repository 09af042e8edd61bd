#pragma once
/// A vector of at most N trivially copyable values, stored inside its owner: no allocation, and a
/// copy costs only the values in use.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace alhazen {

template <class T, std::size_t N>
requires std::is_trivially_copyable_v<T>
class InlineVector {
  public:
    InlineVector() = default;
    InlineVector(const InlineVector& other) : size_(other.size_) {
        std::copy_n(other.values_, size_, values_);
    }
    InlineVector& operator=(const InlineVector& other) {
        size_ = other.size_;
        if (this != &other) std::copy_n(other.values_, size_, values_);
        return *this;
    }

    static constexpr std::size_t capacity() { return N; }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] bool full() const { return size_ == N; }

    /// Precondition: not full.
    void push_back(const T& value) { values_[size_++] = value; }
    /// Precondition: not empty.
    void pop_back() { --size_; }
    void clear() { size_ = 0; }

    T& operator[](std::size_t i) { return values_[i]; }
    const T& operator[](std::size_t i) const { return values_[i]; }
    T& back() { return values_[size_ - 1]; }
    const T& back() const { return values_[size_ - 1]; }
    T* begin() { return values_; }
    T* end() { return values_ + size_; }
    const T* begin() const { return values_; }
    const T* end() const { return values_ + size_; }

    friend bool operator==(const InlineVector& a, const InlineVector& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end());
    }

  private:
    std::uint32_t size_ = 0;
    T values_[N];
};

}  // namespace alhazen
