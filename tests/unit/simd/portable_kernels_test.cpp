#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "alhazen/simd/targets.h"

namespace alhazen {
namespace {

// Else the program has the kernels of the rooms, and its other tests say nothing of plain C++.
TEST(PortableKernels, AreInPlainCxxAlone) {
    EXPECT_EQ(simd_targets(), std::vector<std::string>{"SCALAR"});
}

}  // namespace
}  // namespace alhazen
