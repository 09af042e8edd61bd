#include "alhazen/session/photon_file.h"

#include <gtest/gtest.h>

#include <cstring>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(PhotonFile, HasAVertexOfTenPropertiesForEachPhoton) {
    PhotonCloud cloud;
    cloud.photons.push_back({{5000000.25, 2, 3}, {0, 0, -1}, {0.5f, 0.25f, 0.125f}, 1});
    cloud.photons.push_back({{4, 5, 6}, {0, 1, 0}, {7, 8, 9}, 0});
    const std::string file = photon_ply(cloud);
    const std::string end = "property uchar caustic\nend_header\n";
    EXPECT_EQ(file.substr(0, 4), "ply\n");
    EXPECT_NE(file.find("format binary_little_endian 1.0\n"), std::string::npos);
    EXPECT_NE(file.find("element vertex 2\n"), std::string::npos);
    const std::size_t body = file.find(end) + end.size();
    ASSERT_EQ(file.size() - body, 2u * 49u);
    // 5000000.25 as an IEEE double and 0.125 as a float, lowest byte first.
    EXPECT_NE(file.find("property double x\n"), std::string::npos);
    EXPECT_EQ(file.substr(body, 8), std::string("\0\0\0\x10\xd0\x12\x53\x41", 8));
    EXPECT_EQ(file.substr(body + 44, 5), std::string("\0\0\0\x3e\1", 5));
    EXPECT_EQ(file.back(), '\0');
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
