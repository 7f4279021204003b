#include "vpe/app/planet/shard_option.h"

#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr std::int64_t kMostParts = 1'000'000'000;

std::optional<std::int64_t> number_in(const Environment& environment, const char* name) {
  const char* text = environment(name);
  if (text == nullptr || *text == '\0') return std::nullopt;
  const auto number = base::parse_integer(text);
  if (!number || *number < 0 || *number > kMostParts) {
    throw UsageError(std::string("--part auto: ") + name + "='" + text + "' is not a count; give --part k/n");
  }
  return number;
}

// Names of the variables that hold rank and number of parts; ranks start at `least` and advance by `step`.
struct RankSource {
  const char* rank;
  const char* size;
  const char* least = nullptr;
  const char* step = nullptr;
};
constexpr std::array kSources{RankSource{"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT",
                                         "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_STEP"},
                              RankSource{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                              RankSource{"PMI_RANK", "PMI_SIZE"}, RankSource{"SLURM_PROCID", "SLURM_NTASKS"}};

Shard shard_from(const RankSource& source, std::int64_t rank, const Environment& environment) {
  const auto size = number_in(environment, source.size);
  if (!size) {
    throw UsageError(std::string("--part auto: ") + source.rank + " is set, but " + source.size +
                     " is not; set it too, or give --part k/n");
  }
  const auto optional_number = [&](const char* name, std::int64_t otherwise) {
    return name == nullptr ? otherwise : number_in(environment, name).value_or(otherwise);
  };
  const std::int64_t least = optional_number(source.least, 0);
  const std::int64_t step = optional_number(source.step, 1);
  const std::int64_t offset = rank - least;
  if (step < 1 || offset < 0 || offset % step != 0 || offset / step >= *size) {
    throw UsageError(std::string("--part auto: ") + source.rank + "=" + std::to_string(rank) +
                     " does not fit " + std::to_string(*size) + " parts from " + std::to_string(least) + " on" +
                     (step == 1 ? "" : " in steps of " + std::to_string(step)) +
                     (source.least == nullptr ? "; give --part k/n"
                                              : std::string("; number the array evenly and set ") +
                                                    source.least + " to its first number, or give --part k/n"));
  }
  return {offset / step + 1, *size};
}

Shard shard_from(const Environment& environment) {
  std::string names;
  for (const RankSource& source : kSources) {
    if (const auto rank = number_in(environment, source.rank)) return shard_from(source, *rank, environment);
    names += std::string(names.empty() ? "" : ", ") + source.rank;
  }
  throw UsageError("--part auto: none of " + names +
                   " is set; run it in a SLURM array or under mpirun or srun, or give --part k/n");
}

}  // namespace

Shard parse_shard(const std::string& text, const Environment& environment) {
  if (text.empty()) return {};
  if (text == "auto") return shard_from(environment);
  const std::size_t slash = text.find('/');
  std::optional<std::int64_t> number;
  std::optional<std::int64_t> of;
  if (slash != std::string::npos) {
    number = base::parse_integer(std::string_view(text).substr(0, slash));
    of = base::parse_integer(std::string_view(text).substr(slash + 1));
  }
  if (!number || !of || *number < 1 || *of > kMostParts || *number > *of) {
    throw UsageError("--part '" + text + "': expected k/n with k from 1 to n, or auto");
  }
  return {*number, *of};
}

Shard parse_shard(const std::string& text) { return parse_shard(text, base::process_environment()); }

}  // namespace vpe::app
