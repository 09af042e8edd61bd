#include "alhazen/accel/accelerator_names.h"

#include <tuple>

#include "alhazen/accel/accel_list.h"
#include "alhazen/base/error.h"

namespace alhazen {
namespace {

template <class A>
AcceleratorInfo info_of() {
    return {A::kName, A::kDescription,
            [] {
                const AcceleratorSettings none;
                SettingsReader reader(A::kName, none);
                (void)A::configure(reader);
                return reader.described();
            },
            [](const AcceleratorSettings& settings) {
                SettingsReader reader(A::kName, settings);
                (void)A::configure(reader);
                reader.finish();
            }};
}

template <class... A>
void append_infos(std::tuple<A...>*, std::vector<AcceleratorInfo>& infos) {
    (infos.push_back(info_of<A>()), ...);
}

/// The wide BVH has build options (wide_bvh/build/build_options.h) instead of settings.
AcceleratorInfo wide_bvh_info() {
    return {kDefaultAccelerator, "wide bounding volume hierarchy, SIMD: the fastest",
            [] { return std::vector<SettingDescription>{}; },
            [](const AcceleratorSettings& settings) {
                SettingsReader(kDefaultAccelerator, settings).finish();
            }};
}

std::vector<AcceleratorInfo> all_infos() {
    std::vector<AcceleratorInfo> infos{wide_bvh_info()};
    append_infos(static_cast<BoundAccelerators*>(nullptr), infos);
    append_infos(static_cast<CellAccelerators*>(nullptr), infos);
    append_infos(static_cast<DirectionAccelerators*>(nullptr), infos);
    return infos;
}

}  // namespace

std::span<const AcceleratorInfo> accelerator_names() {
    static const std::vector<AcceleratorInfo> infos = all_infos();
    return infos;
}

std::size_t accelerator_index(const std::string& name) {
    const std::span<const AcceleratorInfo> all = accelerator_names();
    std::string names;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (name == all[i].name) return i;
        names += names.empty() ? "" : ", ";
        names += all[i].name;
    }
    throw Error(ErrorKind::Usage, "no accelerator '" + name + "'; the valid names are: " + names);
}

void check_accelerator(const std::string& accelerator) {
    const AcceleratorChoice choice = parse_accelerator(accelerator);
    accelerator_names()[accelerator_index(choice.name)].check(choice.settings);
}

}  // namespace alhazen
