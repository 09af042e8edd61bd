#pragma once
/// Memory that a query works in, kept by its thread: no query allocates once the first few have
/// made room. Solids within solids take one each.
///
/// Conventions: what a query leaves in it the next one finds; each clears what it needs clear.

#include <cstddef>
#include <deque>

namespace alhazen {

template <class Scratch>
class CsgScratchLease {
  public:
    CsgScratchLease() : pool_(pool()) {
        if (pool_.used == pool_.all.size()) pool_.all.emplace_back();
        scratch_ = &pool_.all[pool_.used++];
    }
    ~CsgScratchLease() { --pool_.used; }
    CsgScratchLease(const CsgScratchLease&) = delete;
    CsgScratchLease& operator=(const CsgScratchLease&) = delete;

    Scratch& operator*() const { return *scratch_; }

  private:
    struct Pool {
        std::deque<Scratch> all;  ///< addresses stay valid while it grows
        std::size_t used = 0;
    };
    static Pool& pool() {
        thread_local Pool pool;
        return pool;
    }
    Pool& pool_;
    Scratch* scratch_;
};

}  // namespace alhazen
