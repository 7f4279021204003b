#include "vpe/app/planet/shard_option.h"

#include <array>
#include <cstdlib>
#include <filesystem>
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

// Returns part k of `of`, with k from the environment.
Shard shard_of_count(std::int64_t of, const Environment& environment) {
  const std::string option = "--part auto/" + std::to_string(of);
  for (const RankSource& source : kSources) {
    const auto rank = number_in(environment, source.rank);
    if (!rank) continue;
    const std::string said = option + ": " + source.rank + "=" + std::to_string(*rank);
    if (source.least != nullptr) {
      // Without regard to the array's own first number: an array of the tasks that are sent again has another.
      if (*rank >= 1 && *rank <= of) return {*rank, of};
      throw UsageError(said + " is not a number from 1 to " + std::to_string(of) +
                       "; number the array --array=1-" + std::to_string(of) + ", or give --part k/n");
    }
    const Shard shard = shard_from(source, *rank, environment);
    if (shard.of == of) return shard;
    throw UsageError(said + " is one of " + std::to_string(shard.of) + " processes; start " +
                     std::to_string(of) + ", or give --part k/n");
  }
  return shard_from(environment);  // throws
}

void require_whole_array(const Shard& shard, const Environment& environment) {
  if (!shard.is_all() || !number_in(environment, kSources.front().rank)) return;
  throw UsageError(
      "--part auto: the array has one task (SLURM_ARRAY_TASK_COUNT=1), which would do all of the work; if it is one "
      "of n that is sent again, give --part auto/n or --part $SLURM_ARRAY_TASK_ID/n, else leave --part out");
}

// Returns n of the file NAME.k-of-n.EXTENSION of a part, also of an unfinished one.
std::optional<std::int64_t> count_in_name(const std::string& file, const std::filesystem::path& output) {
  const std::string begin = output.stem().string() + ".";
  const std::string extension = output.extension().string();
  std::string_view rest = file;
  if (!rest.starts_with(begin)) return std::nullopt;
  rest.remove_prefix(begin.size());
  if (rest.ends_with(".part")) rest.remove_suffix(5);
  if (!rest.ends_with(extension)) return std::nullopt;
  rest.remove_suffix(extension.size());
  const std::size_t of = rest.find("-of-");
  if (of == std::string_view::npos || !base::parse_integer(rest.substr(0, of))) return std::nullopt;
  return base::parse_integer(rest.substr(of + 4));
}

}  // namespace

Shard parse_shard(const std::string& text, const Environment& environment) {
  if (text.empty()) return {};
  if (text == "auto") {
    const Shard shard = shard_from(environment);
    require_whole_array(shard, environment);
    return shard;
  }
  const std::size_t slash = text.find('/');
  std::optional<std::int64_t> number;
  std::optional<std::int64_t> of;
  if (text.starts_with("auto/")) {
    of = base::parse_integer(std::string_view(text).substr(slash + 1));
    if (of && *of >= 1 && *of <= kMostParts) return shard_of_count(*of, environment);
  }
  if (slash != std::string::npos) {
    number = base::parse_integer(std::string_view(text).substr(0, slash));
    of = base::parse_integer(std::string_view(text).substr(slash + 1));
  }
  if (!number || !of || *number < 1 || *of > kMostParts || *number > *of) {
    throw UsageError("--part '" + text + "': expected k/n with k from 1 to n, auto/n or auto");
  }
  return {*number, *of};
}

Shard parse_shard(const std::string& text) { return parse_shard(text, base::process_environment()); }

void require_count_of_parts(const std::string& text, const std::string& output, const Shard& shard) {
  if (text != "auto") return;
  namespace fs = std::filesystem;
  const fs::path path(output);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const auto of = count_in_name(name, path);
    if (!of || *of == shard.of) continue;
    const std::string count = std::to_string(*of);
    throw UsageError("--part auto: this is task " + std::to_string(shard.number) + " of " +
                     std::to_string(shard.of) + ", but " + (folder / name).string() + " is one of " + count +
                     " parts; if tasks of that array are sent again, give --part auto/" + count +
                     ", else remove the file");
  }
}

}  // namespace vpe::app
