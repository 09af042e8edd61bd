#include "alhazen/base/mapped_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "support/scratch_folder.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ScratchFolder;

std::string text_of(const MappedFile& file) {
    const auto bytes = file.bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(MappedFile, HasTheBytesOfTheFile) {
    const ScratchFolder folder;
    const std::string text(10000, 'x');
    EXPECT_EQ(text_of(*MappedFile::open(folder.write("a", "some bytes"))), "some bytes");
    EXPECT_EQ(text_of(*MappedFile::open(folder.write("b", text))), text);
    EXPECT_TRUE(MappedFile::open(folder.write("empty", ""))->bytes().empty());
}

TEST(MappedFile, StaysAsItWasWhenTheFileIsReplaced) {
    const ScratchFolder folder;
    const auto path = folder.write("a", "the old one");
    const auto file = MappedFile::open(path);
    write_file_atomically(path, std::string("new"));
    EXPECT_EQ(text_of(*file), "the old one");
    std::filesystem::remove(path);
    EXPECT_EQ(text_of(*file), "the old one");
}

TEST(MappedFile, RefusesWhatIsNoRegularFile) {
    const ScratchFolder folder;
    EXPECT_THROW((void)MappedFile::open(folder.path()), Error);
    EXPECT_THROW((void)MappedFile::open(folder.path() / "none"), Error);
    EXPECT_THROW((void)MappedFile::open(""), Error);
    const auto fifo = folder.path() / "fifo";
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    EXPECT_THROW((void)MappedFile::open(fifo), Error) << "and does not wait for a writer";
}

TEST(FileWriting, PiecesAreWrittenOneAfterAnother) {
    const ScratchFolder folder;
    const std::string a = "one, ", b, c = "two";
    const std::span<const std::byte> pieces[] = {
        std::as_bytes(std::span(a)), std::as_bytes(std::span(b)), std::as_bytes(std::span(c))};
    write_file_atomically(folder.path() / "file", pieces);
    EXPECT_EQ(read_file(folder.path() / "file"), "one, two");
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
