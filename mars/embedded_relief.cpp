#include "mars/embedded_relief.h"

#include "mars/embedded_bumps.h"
#include "mars/embedded_relief_table.h"

namespace mars::embedded {

void relief(const Block& block, Lane<double>& out) {
  static const Bumps<std::int16_t> bumps{bump_centres(static_cast<int>(kReliefTable.size())), kReliefTable,
                                         kReliefReach, kReliefStep_m};
  sum_bumps(block, bumps, out);
}

}  // namespace mars::embedded
