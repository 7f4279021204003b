#include "mars/embedded/relief.h"

#include "mars/embedded/bumps.h"
#include "mars/embedded/relief_table.h"

namespace mars::embedded {

void relief(const Block& block, Lane<double>& out) {
  static const Bumps<std::int16_t> bumps{bump_centres(static_cast<int>(kReliefTable.size())), kReliefTable,
                                         kReliefReach, kReliefStep_m};
  sum_bumps(block, bumps, out);
}

}  // namespace mars::embedded
