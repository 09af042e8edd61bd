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
    ReentrantStack() : base_(storage().size()) {}
    ReentrantStack(const ReentrantStack&) = delete;
    ReentrantStack& operator=(const ReentrantStack&) = delete;
    ~ReentrantStack() { storage().resize(base_); }

    [[nodiscard]] bool empty() const { return storage().size() == base_; }
    [[nodiscard]] std::size_t size() const { return storage().size() - base_; }
    void push(const T& value) { storage().push_back(value); }
    T pop() {
        const T value = storage().back();
        storage().pop_back();
        return value;
    }
    [[nodiscard]] const T& top() const { return storage().back(); }
    /// Valid until the next push, here or in a nested traversal.
    [[nodiscard]] T* begin() { return storage().data() + base_; }
    [[nodiscard]] T* end() { return storage().data() + storage().size(); }

  private:
    static std::vector<T>& storage() {
        static thread_local std::vector<T> storage;
        return storage;
    }
    std::size_t base_;
};

}  // namespace alhazen
