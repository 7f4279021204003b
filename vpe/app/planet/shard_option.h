// `--part`: the share of divided work that this run does.
#pragma once

#include <string>

#include "vpe/base/shard.h"
#include "vpe/base/user_folders.h"

namespace vpe::app {

using base::Environment;
using base::Shard;

// Parses "k/n", or "auto", which reads the first of these environments that is set: a SLURM array
// (SLURM_ARRAY_TASK_ID, SLURM_ARRAY_TASK_COUNT; SLURM_ARRAY_TASK_MIN, 0 when not set; SLURM_ARRAY_TASK_STEP, 1
// when not set), Open MPI (OMPI_COMM_WORLD_RANK, OMPI_COMM_WORLD_SIZE), PMI (PMI_RANK, PMI_SIZE), srun
// (SLURM_PROCID, SLURM_NTASKS). Empty text is all of the work. Throws UsageError.
Shard parse_shard(const std::string& text, const Environment& environment);

// The same with the environment of this process.
Shard parse_shard(const std::string& text);

}  // namespace vpe::app
