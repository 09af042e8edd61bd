// Checks that views lie in their buffers, accessors in their views, and sparse indices ascend.
#include <algorithm>

#include "alhazen/formats/gltf/document/gltf_accessors.h"
#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

namespace {

/// True if `count` elements of `size` bytes with this `stride`, from `offset` on, fit in `length`
/// bytes. No overflow for any arguments.
bool fits(std::uint64_t offset, std::uint64_t count, std::uint64_t stride, std::uint64_t size,
          std::uint64_t length) {
    if (count == 0) return offset <= length;
    if (offset > length || size > length - offset) return false;
    return (count - 1) <= (length - offset - size) / stride;
}

class LayoutChecker {
  public:
    explicit LayoutChecker(const Loading& loading)
        : loading_(loading), document_(loading.document) {}

    void views() const {
        for (std::size_t i = 0; i < document_.views.size(); ++i) {
            const BufferView& view = document_.views[i];
            const Buffer& buffer = document_.buffers[view.buffer];
            if (fits(view.offset, 1, 1, view.length, size_of(buffer))) continue;
            loading_.error(pointer_to("bufferViews", i),
                           std::to_string(view.length) + " bytes from " +
                               std::to_string(view.offset) + " do not fit into the " +
                               std::to_string(size_of(buffer)) + " of buffer " +
                               std::to_string(view.buffer));
        }
    }

    void accessor(std::size_t position) {
        const Accessor& accessor = document_.accessors[position];
        const std::string place = pointer_to("accessors", position);
        const ElementLayout layout = layout_of(accessor.component, accessor.type);
        if (!accessor.view) {
            limit_zeros(accessor, place);
        } else if (range(accessor, layout, place)) {
            const bool zeros = lacks_data(document_.views[*accessor.view]);
            zeros ? limit_zeros(accessor, place) : limit_numbers(accessor, place);
        }
        if (accessor.sparse) sparse(accessor, layout, place + "/sparse");
    }

  private:
    [[nodiscard]] bool lacks_data(const BufferView& view) const {
        return document_.buffers[view.buffer].lacks_data;
    }
    static std::uint64_t size_of(const Buffer& buffer) {
        return buffer.lacks_data ? buffer.length : buffer.bytes.size();
    }

    /// True if the elements lie in the view.
    bool range(const Accessor& accessor, const ElementLayout& layout,
               const std::string& place) const {
        const BufferView& view = document_.views[*accessor.view];
        const std::uint64_t stride = view.stride != 0 ? view.stride : layout.packed;
        if (stride < layout.size) {
            loading_.error(place, "the stride of the buffer view, " + std::to_string(stride) +
                                      ", is less than an element");
        }
        if (!fits(accessor.offset, accessor.count, stride, layout.size, view.length)) {
            loading_.error(place, std::to_string(accessor.count) + " elements from byte " +
                                      std::to_string(accessor.offset) +
                                      " do not fit into the buffer view of " +
                                      std::to_string(view.length) + " bytes");
            return false;
        }
        const std::size_t unit = layout.columns > 1 ? 4 : layout.component;
        if ((view.offset + accessor.offset) % layout.component != 0 ||
            accessor.offset % unit != 0 || stride % layout.component != 0) {
            loading_.error(place, "byteOffset must be a multiple of " + std::to_string(unit));
        }
        return true;
    }

    /// Limits the numbers of all accessors. Accessors may overlap, so the file size is no bound.
    void limit_numbers(const Accessor& accessor, const std::string& place) {
        const std::uint64_t most =
            kNumbersPerElement * std::min(loading_.source.options.max_elements, kMostElements);
        const std::uint64_t n = component_count(accessor.type);
        if (accessor.count <= most / n && numbers_ + accessor.count * n <= most) {
            numbers_ += accessor.count * n;
            return;
        }
        throw Error(ErrorKind::Resource,
                    place + ": more than " + std::to_string(most) +
                        " numbers in all accessors together (a multiple of the limit of elements)",
                    {loading_.file, 0, 0});
    }

    /// Limits the numbers of accessors without data, which take no space in the file.
    void limit_zeros(const Accessor& accessor, const std::string& place) {
        const std::uint64_t most = loading_.source.options.max_elements / kElementsPerZero;
        const std::uint64_t n = component_count(accessor.type);
        if (accessor.count <= most / n && zeros_ + accessor.count * n <= most) {
            zeros_ += accessor.count * n;
            return;
        }
        throw Error(ErrorKind::Resource,
                    place + ": more than " + std::to_string(most) +
                        " numbers in accessors without a buffer view (a part of the limit of "
                        "elements)",
                    {loading_.file, 0, 0});
    }

    void sparse(const Accessor& accessor, const ElementLayout& layout,
                const std::string& place) const {
        const SparseAccessor& s = *accessor.sparse;
        const std::size_t size = component_size(s.indices_type);
        const BufferView& indices = document_.views[s.indices_view];
        const BufferView& values = document_.views[s.values_view];
        bool good = true;
        const auto refuse = [&](const char* part, const std::string& message) {
            loading_.error(place + part, message);
            good = false;
        };
        if (indices.stride != 0) refuse("/indices", "the buffer view must not have a stride");
        if (values.stride != 0) refuse("/values", "the buffer view must not have a stride");
        if (!fits(s.indices_offset, s.count, size, size, indices.length)) {
            refuse("/indices",
                   std::to_string(s.count) + " indices do not fit into the buffer view");
        }
        if (!fits(s.values_offset, s.count, layout.packed, layout.size, values.length)) {
            refuse("/values", std::to_string(s.count) + " values do not fit into the buffer view");
        }
        if ((indices.offset + s.indices_offset) % size != 0) {
            refuse("/indices", "byteOffset must be a multiple of " + std::to_string(size));
        }
        if ((values.offset + s.values_offset) % layout.component != 0) {
            refuse("/values",
                   "byteOffset must be a multiple of " + std::to_string(layout.component));
        }
        if (good && !lacks_data(indices) && lies_in_buffer(indices)) order(accessor, place);
    }

    [[nodiscard]] bool lies_in_buffer(const BufferView& view) const {
        return fits(view.offset, 1, 1, view.length, document_.buffers[view.buffer].bytes.size());
    }

    void order(const Accessor& accessor, const std::string& place) const {
        std::uint64_t least = 0;
        for (std::uint64_t i = 0; i < accessor.sparse->count; ++i) {
            const std::uint64_t index = sparse_index(document_, accessor, i);
            if (index < least || index >= accessor.count) {
                loading_.error(place + "/indices",
                               "index " + std::to_string(i) + ", " + std::to_string(index) +
                                   ", is not ascending or not below the count of " +
                                   std::to_string(accessor.count));
                return;
            }
            least = index + 1;
        }
    }

    // Multiples of the limit of elements: by default 1.6 * 10^9 numbers, of which 25 million may be
    // zeros.
    static constexpr std::uint64_t kNumbersPerElement = 4, kElementsPerZero = 16;

    // 4 * kMostElements does not overflow.
    static constexpr std::uint64_t kMostElements = std::uint64_t{1} << 60;

    const Loading& loading_;
    const Document& document_;
    std::uint64_t numbers_ = 0, zeros_ = 0;
};

}  // namespace

void check_layout(const Loading& loading) {
    LayoutChecker checker(loading);
    checker.views();
    for (std::size_t i = 0; i < loading.document.accessors.size(); ++i) checker.accessor(i);
}

}  // namespace alhazen::gltf
