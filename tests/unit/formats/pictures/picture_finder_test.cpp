/// Files by names with other capitals, of the file and of its folders.

#include "alhazen/formats/pictures/picture_finder.h"

#include <gtest/gtest.h>

#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::TemporaryFolder;

/// The courses' layout: scenes/ and pictures side by side, in a root of mixed capitals.
struct Course {
    TemporaryFolder folder;
    PictureFinder finder;
    Course() : finder({folder.path() / "Root"}, folder.path() / "Root/Scenes") {
        for (const char* file :
             {"Root/Scenes/a.png", "Root/Scenes/tex/Q.png", "Root/Pictures/Deep/b.PNG",
              "Root/pictures/deep/c.png", "Outside/d.png"}) {
            folder.write(file, "");
        }
    }
};

TEST(PictureFinder, CapitalsOfFoldersDoNotMatter) {
    Course course;
    EXPECT_EQ(course.finder.find("a.png"), "a.png");
    EXPECT_EQ(course.finder.find("A.PNG"), "a.png");
    EXPECT_EQ(course.finder.find("TEX\\q.png"), "tex/Q.png");
    EXPECT_EQ(course.finder.find("Tex/Q.png"), "tex/Q.png");
    EXPECT_EQ(course.finder.find("../PICTURES/DEEP/b.png"), "../Pictures/Deep/b.PNG");
    EXPECT_EQ(course.finder.find("../SCENES/a.png"), "a.png");
    EXPECT_EQ(course.finder.find((course.folder.path() / "Root/scenes/A.png").string()), "a.png");
    EXPECT_EQ(course.finder.find("tex/r.png"), std::nullopt);
    EXPECT_EQ(course.finder.find("TEX"), std::nullopt);
}

TEST(PictureFinder, FoldersOfOneNameWithOtherCapitalsAreAllSearched) {
    Course course;
    EXPECT_EQ(course.finder.find("../Pictures/Deep/C.png"), "../pictures/deep/c.png");
    EXPECT_EQ(course.finder.find("../Pictures/DEEP/B.png"), "../Pictures/Deep/b.PNG");
}

TEST(PictureFinder, NothingOutsideTheRootsIsFound) {
    Course course;
    EXPECT_EQ(course.finder.find("../../Outside/d.png"), std::nullopt);
    EXPECT_EQ(course.finder.find("../../outside/D.png"), std::nullopt);
    std::filesystem::create_directory_symlink(course.folder.path() / "Outside",
                                              course.folder.path() / "Root/Scenes/link");
    EXPECT_EQ(course.finder.find("LINK/d.png"), std::nullopt);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
