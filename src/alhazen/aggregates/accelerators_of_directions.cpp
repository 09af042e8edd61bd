#include "alhazen/accel/accel_list.h"
#include "alhazen/aggregates/accelerator_entries.h"

namespace alhazen {

std::vector<MakeAggregate> direction_accelerators() {
    return makers_of(static_cast<DirectionAccelerators*>(nullptr));
}

}  // namespace alhazen
