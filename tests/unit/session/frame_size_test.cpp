// The size of a picture of which one side follows from the other.

#include <gtest/gtest.h>

#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/session/render.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(FrameSizes, TheOtherSideFollowsFromTheAspect) {
    RenderOptions options;
    options.height = 480;
    FrameSize size = frame_size({}, options, 4.0 / 3.0);
    EXPECT_EQ(size.width, 640);
    EXPECT_EQ(size.height, 480);
    size = frame_size({}, options, 1e-30);
    EXPECT_EQ(size.width, 1);
    options.height.reset();
    options.width = 641;
    size = frame_size({}, options, 2.0);
    EXPECT_EQ(size.height, 321);
}

TEST(FrameSizes, ASideThatIsTooLongForAnyNumberIsRefused) {
    // 2^23 times 512 rows are 2^32 columns.
    for (const double aspect : {0x1p23, 1e12, 1e30, 1e300, std::numeric_limits<double>::max()}) {
        RenderOptions options;
        EXPECT_THROW((void)frame_size({}, options, aspect), Error) << aspect;
        options.width = 512;
        EXPECT_THROW((void)frame_size({}, options, 1.0 / aspect), Error) << aspect;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
