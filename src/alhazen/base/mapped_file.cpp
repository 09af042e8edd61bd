#include "alhazen/base/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "alhazen/base/error.h"

namespace alhazen {

std::shared_ptr<const MappedFile> MappedFile::open(const std::filesystem::path& path) {
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::File, what, {path.string(), 0, 0});
    };
    if (path.empty() || path.native().find('\0') != std::string::npos) {
        fail("the file name is empty or contains a NUL");
    }
    // O_NONBLOCK: opening a FIFO without a writer would block.
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd < 0) fail(std::string("cannot open the file: ") + std::strerror(errno));
    struct stat status {};
    const bool regular = ::fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
    const auto size = static_cast<std::size_t>(status.st_size);
    void* memory = nullptr;
    if (regular && size > 0) memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
    const int error_number = errno;
    ::close(fd);
    if (!regular) fail("is not a regular file");
    if (memory == MAP_FAILED) {
        fail(std::string("cannot map the file: ") + std::strerror(error_number));
    }
    const std::span bytes(static_cast<const std::byte*>(memory), size);
    return std::shared_ptr<const MappedFile>(new MappedFile(bytes));
}

MappedFile::~MappedFile() {
    if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace alhazen
