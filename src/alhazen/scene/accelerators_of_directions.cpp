#include "alhazen/accel/accel_list.h"
#include "alhazen/scene/accelerator_entries.h"

namespace alhazen {

std::vector<AcceleratorEntry> direction_accelerators() {
    return entries_of(static_cast<DirectionAccelerators*>(nullptr));
}

}  // namespace alhazen
