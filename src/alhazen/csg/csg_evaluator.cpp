#include "alhazen/csg/csg_evaluator.h"

#include <array>

#include "alhazen/base/error.h"
#include "alhazen/csg/csg_event_heap.h"
#include "alhazen/csg/csg_roth.h"
#include "alhazen/csg/csg_truth_table.h"

namespace alhazen {

namespace {

template <class E>
std::unique_ptr<const CsgEvaluator> make(const CsgSolid& solid) {
    return std::make_unique<const E>(solid);
}

std::unique_ptr<const CsgEvaluator> make_fastest(const CsgSolid& solid) {
    return CsgTruthTable::fits(solid) ? make<CsgTruthTable>(solid) : make<CsgEventHeap>(solid);
}

constexpr std::array kEntries{
    CsgEvaluatorEntry{CsgEventHeap::kName, CsgEventHeap::kDescription, &make_fastest},
    CsgEvaluatorEntry{CsgRoth::kName, CsgRoth::kDescription, &make<CsgRoth>}};

}  // namespace

std::span<const CsgEvaluatorEntry> csg_evaluator_table() {
    return kEntries;
}

const CsgEvaluatorEntry& find_csg_evaluator(const std::string& name) {
    std::string names;
    for (const CsgEvaluatorEntry& entry : csg_evaluator_table()) {
        if (name == entry.name) return entry;
        names += names.empty() ? "" : ", ";
        names += entry.name;
    }
    throw Error(ErrorKind::Usage, "no CSG evaluator '" + name + "'; the valid names are: " + names);
}

}  // namespace alhazen
