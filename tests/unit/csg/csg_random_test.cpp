#include "csg_random_trees.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(CsgRandom, BothEvaluatorsFindTheTransitionsThatPointsTell) {
    testing::check_random_trees(1000, 300, 20);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
