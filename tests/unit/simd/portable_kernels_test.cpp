#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "alhazen/simd/targets.h"

namespace alhazen {
namespace {

// Otherwise the program has the kernels of the modules, and its other tests do not test plain C++.
TEST(PortableKernels, AreInPlainCxxAlone) {
    EXPECT_EQ(simd_targets(), std::vector<std::string>{"SCALAR"});
}

}  // namespace
}  // namespace alhazen
