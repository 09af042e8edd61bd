#pragma once
/// Version of the linked Embree.

#include <string>

#ifdef ALHAZEN_HAVE_EMBREE
#include <embree3/rtcore.h>
#endif

namespace alhazen::bench {

[[nodiscard]] inline std::string peer_version() {
#ifdef ALHAZEN_HAVE_EMBREE
    return "Embree " RTC_VERSION_STRING;
#else
    return "no Embree";
#endif
}

}  // namespace alhazen::bench
