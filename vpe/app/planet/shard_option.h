// `--part`: which share of divided work this run does.
#pragma once

#include <string>

#include "vpe/base/shard.h"
#include "vpe/base/user_folders.h"

namespace vpe::app {

using base::Environment;
using base::Shard;

// "k/n", or "auto": from the variables of a SLURM array (SLURM_ARRAY_TASK_ID, _COUNT; _MIN, 0 when not set;
// _STEP, 1 when not set), else of Open MPI (OMPI_COMM_WORLD_RANK, _SIZE), of PMI (PMI_RANK, PMI_SIZE), of srun
// (SLURM_PROCID, SLURM_NTASKS), the first that is set. Throws UsageError.
Shard parse_shard(const std::string& text, const Environment& environment);

// parse_shard over the environment of this process.
Shard parse_shard(const std::string& text);

}  // namespace vpe::app
