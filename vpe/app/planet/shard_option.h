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
// (SLURM_PROCID, SLURM_NTASKS). Empty text is all of the work. "auto/n" takes k alone from there: the number of
// an array's task, which then must be from 1 to n, or the rank of one of n processes; tasks of an array that are
// sent again keep their parts. "auto" is refused in an array of one task, which may be one of them. Throws
// UsageError.
Shard parse_shard(const std::string& text, const Environment& environment);

// The same with the environment of this process.
Shard parse_shard(const std::string& text);

// Throws UsageError if `text` is "auto" and files of parts of `output` (see shard_file_name()), finished or not,
// have another number of parts than `shard`: those are tasks of an array that were sent again.
void require_count_of_parts(const std::string& text, const std::string& output, const Shard& shard);

}  // namespace vpe::app
