#include "alhazen/simd/targets.h"

#include <hwy/highway.h>

#include "alhazen/base/error.h"

namespace alhazen {
namespace {

/// Bits of the available targets; a lower bit is a better target.
std::int64_t compiled_and_supported() {
    return hwy::SupportedTargets() & HWY_TARGETS;
}

void choose(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

std::vector<std::string> simd_targets() {
    std::vector<std::string> names;
    for (std::int64_t rest = compiled_and_supported(); rest != 0; rest &= rest - 1) {
        names.emplace_back(hwy::TargetName(rest & -rest));
    }
    return names;
}

std::string simd_target() {
    const std::int64_t targets = compiled_and_supported();
    return hwy::TargetName(targets & -targets);
}

SimdTargetOverride::SimdTargetOverride(const std::string& name)
    : before_(compiled_and_supported()) {
    hwy::SetSupportedTargetsForTest(0);
    std::string names;
    for (std::int64_t rest = compiled_and_supported(); rest != 0; rest &= rest - 1) {
        const std::int64_t target = rest & -rest;
        if (name == hwy::TargetName(target)) {
            choose(target);
            return;
        }
        names += names.empty() ? "" : ", ";
        names += hwy::TargetName(target);
    }
    choose(before_);
    throw Error(ErrorKind::Usage,
                "no instruction set '" + name + "' on this machine; the valid names are: " + names);
}

SimdTargetOverride::~SimdTargetOverride() {
    choose(before_);
}

}  // namespace alhazen
