#include "alhazen/aggregates/accelerator_bytes.h"

#include <unordered_set>
#include <vector>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

std::uint64_t accelerator_bytes(const Aggregate& aggregate) {
    std::uint64_t bytes = 0;
    std::unordered_set<const Aggregate*> known{&aggregate};
    std::vector<const Aggregate*> open{&aggregate};
    while (!open.empty()) {
        const Aggregate& next = *open.back();
        open.pop_back();
        bytes += next.memory_bytes();
        for (const Instance& instance : next.primitives().instances) {
            if (known.insert(instance.aggregate.get()).second) {
                open.push_back(instance.aggregate.get());
            }
        }
    }
    return bytes;
}

}  // namespace alhazen
