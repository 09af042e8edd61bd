#include "support/test_data.h"

#include <cstdlib>
#include <string_view>

namespace alhazen::testing {

std::filesystem::path test_data() {
    const char* folder = std::getenv("ALHAZEN_TEST_DATA");
    return folder != nullptr ? folder : ALHAZEN_TEST_DATA_DEFAULT;
}

std::filesystem::path source_folder() {
    return ALHAZEN_SOURCE_DIR;
}

bool data_is_required() {
    const char* ci = std::getenv("CI");
    return ci != nullptr && std::string_view(ci) == "true";
}

}  // namespace alhazen::testing
