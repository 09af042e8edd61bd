#pragma once
/// Per-thread memory of a traversal's stack or heap, reused from ray to ray.
///
/// A traversal may start inside another one on the same thread (an instance in a leaf): each uses
/// the part of the memory above those of the enclosing traversals.

#include <cstddef>
#include <vector>

namespace alhazen {

template <class T>
class ReentrantStack {
  public:
    ReentrantStack() : base_(room().size()) {}
    ReentrantStack(const ReentrantStack&) = delete;
    ReentrantStack& operator=(const ReentrantStack&) = delete;
    ~ReentrantStack() { room().resize(base_); }

    [[nodiscard]] bool empty() const { return room().size() == base_; }
    [[nodiscard]] std::size_t size() const { return room().size() - base_; }
    void push(const T& value) { room().push_back(value); }
    T pop() {
        const T value = room().back();
        room().pop_back();
        return value;
    }
    [[nodiscard]] const T& top() const { return room().back(); }
    /// Valid until the next push, here or in a nested traversal.
    [[nodiscard]] T* begin() { return room().data() + base_; }
    [[nodiscard]] T* end() { return room().data() + room().size(); }

  private:
    static std::vector<T>& room() {
        static thread_local std::vector<T> room;
        return room;
    }
    std::size_t base_;
};

}  // namespace alhazen
