#pragma once
/// Brute force: every ray is tested against every primitive, in the order of their ids. The oracle.
///
/// Source: Appel, "Some Techniques for Shading Machine Renderings of Solids", AFIPS 1968. Differs:
/// nothing. Complexity: O(n) per ray; no memory.

#include "alhazen/accel/accelerator.h"

namespace alhazen {

class List {
  public:
    static constexpr const char* kName = "list";
    static constexpr const char* kDescription = "brute force: every ray against every primitive";
    struct Config {};
    [[nodiscard]] static Config configure(SettingsReader&) { return {}; }

    [[nodiscard]] static List build(const BoundsSource& source, const Config&) {
        List list;
        list.count_ = static_cast<std::uint32_t>(source.size());
        return list;
    }

    template <class Visitor, class Stats>
    void traverse(const Ray&, Visitor& visitor, Stats) const {
        for (std::uint32_t i = 0; i < count_; ++i) {
            if (visitor.visit(i)) return;
        }
    }

    [[nodiscard]] std::size_t memory_bytes() const { return sizeof(*this); }

  private:
    std::uint32_t count_ = 0;
};
static_assert(Accelerator<List>);

}  // namespace alhazen
