#pragma once
/// Scratch memory of queries, kept per thread, so that queries do not allocate in a steady state.
/// Nested solids use one each.
///
/// Conventions: a query finds the data of the previous one and clears what must be empty.

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
        std::deque<Scratch> all;  ///< a deque keeps addresses valid while it grows
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
