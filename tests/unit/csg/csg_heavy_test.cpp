#include "csg_random_trees.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(CsgHeavy, TenThousandRandomTreesAreAsPointsTell) {
    testing::check_random_trees(100000, 10000, 20);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
