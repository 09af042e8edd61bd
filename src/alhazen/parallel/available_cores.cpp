#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <thread>

#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

/// Cores in the affinity mask of the process, or of the machine if the mask cannot be read.
int cores_by_affinity() {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    if (sched_getaffinity(0, sizeof(cores), &cores) == 0) return CPU_COUNT(&cores);
    return static_cast<int>(std::thread::hardware_concurrency());
}

/// The CPU quota of the control group (version 2), rounded up; `otherwise` if there is none or it
/// is larger.
int cores_by_quota(int otherwise) {
    std::ifstream file("/sys/fs/cgroup/cpu.max");
    std::string quota;
    double period = 0;
    if (!(file >> quota >> period) || quota == "max" || !(period > 0)) return otherwise;
    // atof returns 0 for a malformed file, which the test below rejects.
    const double cores = std::ceil(std::atof(quota.c_str()) / period);
    return cores >= 1 && cores < otherwise ? static_cast<int>(cores) : otherwise;
}

}  // namespace

int available_cores() {
    static const int cores = [] {
        const int allowed = std::max(1, cores_by_affinity());
        return cores_by_quota(allowed);
    }();
    return cores;
}

}  // namespace alhazen
