#include "vpe/app/commands.h"

#include <sys/statvfs.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "mars/sources/source.h"
#include "objects/files/level_program.h"
#include "objects/files/model_file.h"
#include "vpe/app/cli/config_file.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/cli/subprocess.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/cpu_limits.h"
#include "vpe/base/number.h"
#include "vpe/base/parallel.h"
#include "vpe/gl/context.h"

namespace vpe::app {

namespace {

namespace fs = std::filesystem;

// One line of the report: what was examined, what will be used, and why.
struct Finding {
  enum class State { kGood, kNote, kBad };
  std::string what;
  State state = State::kGood;
  std::string text;
};
using State = Finding::State;

std::string gigabytes(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GB", bytes * 1e-9);
  return text;
}

Finding find_display() {
  for (const char* name : {"WAYLAND_DISPLAY", "DISPLAY"}) {
    if (const char* value = std::getenv(name); value != nullptr && *value != '\0') {
      return {"display", State::kGood,
              std::string(name) + "=" + value + "; not used: images and films need none"};
    }
  }
  return {"display", State::kGood, "none; images and films need none"};
}

Finding find_opengl() {
  try {
    const gl::ContextInfo info = gl::Context::create()->info();
    const std::string text = info.platform + ": OpenGL " + info.version + " on " + info.renderer;
    if (!info.software) return {"OpenGL", State::kGood, text};
    return {
        "OpenGL", State::kNote,
        text + "; in software: no GPU with a driver for OpenGL 4.5 was found; images are the same, but slow"};
  } catch (const std::runtime_error& e) {
    return {"OpenGL", State::kBad, std::string(e.what()) + "; images are drawn by rays where none is named"};
  }
}

Finding find_configuration() {
  std::string text;
  for (const fs::path& file : config_files()) text += (text.empty() ? "" : ", ") + file.string();
  return {"config", State::kGood, text.empty() ? "no file of the user or the system" : text};
}

// Says what limits the default number of threads on this machine.
std::string limits_text(const base::CpuLimits& limits) {
  std::string text = std::to_string(limits.threads()) + " of " + std::to_string(limits.machine);
  if (limits.threads() >= limits.machine) return std::to_string(limits.machine) + ", all of this machine";
  if (limits.affinity <= limits.threads()) return text + " of this machine, by CPU affinity";
  return text + " of this machine, by the control group's quota of " + base::format_general(*limits.quota, 3) +
         " processors";
}

Finding find_threads(const Common& common) {
  const base::CpuLimits limits = base::cpu_limits();
  const int threads = common.threads > 0 ? common.threads : base::default_threads();
  Finding finding{"threads", State::kGood, limits_text(limits)};
  if (common.threads > 0) {
    finding.text = std::to_string(common.threads) + " by --threads; without it " + finding.text;
    if (common.threads > limits.threads()) finding.state = State::kNote;
  }
  const char* slurm = std::getenv("SLURM_CPUS_PER_TASK");
  const auto task = base::parse_integer(slurm == nullptr ? "" : slurm);
  if (task && *task > 0 && *task < threads) {
    finding.state = State::kNote;
    finding.text += "; SLURM_CPUS_PER_TASK is " + std::to_string(*task) +
                    ", and the job is not confined to them; give --threads $SLURM_CPUS_PER_TASK";
  }
  return finding;
}

Finding find_memory(const Common& common) {
  const double pages = static_cast<double>(::sysconf(_SC_PHYS_PAGES));
  const double free_pages = static_cast<double>(::sysconf(_SC_AVPHYS_PAGES));
  const double page = static_cast<double>(::sysconf(_SC_PAGESIZE));
  const std::string text = std::to_string(common.memory_mb) + " MB for data (--memory); this machine has " +
                           gigabytes(pages * page) + ", " + gigabytes(free_pages * page) + " unused";
  const bool little = common.memory_mb * 1e6 > 0.8 * pages * page;
  return {"memory", little ? State::kBad : State::kGood, little ? text + "; lower --memory" : text};
}

Finding find_cache() {
  fs::path folder;
  try {
    folder = cache_folder();
  } catch (const std::runtime_error& e) {
    return {"cache", State::kBad, e.what()};
  }
  if (::access(folder.c_str(), W_OK) != 0) {
    return {"cache", State::kBad,
            folder.string() + " cannot be written; set XDG_CACHE_HOME to a folder that can"};
  }
  std::error_code none;
  double bytes = 0;
  int planets = 0;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() != ".vpe") continue;
    ++planets;
    bytes += static_cast<double>(entry.file_size(none));
  }
  struct statvfs disk {};
  double left = 0;
  if (::statvfs(folder.c_str(), &disk) == 0) {
    left = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
  }
  std::string text = folder.string() + ": " + std::to_string(planets) + " planets, " + gigabytes(bytes) + "; " +
                     gigabytes(left) + " free";
  if (!fs::exists(embedded_planet_path(), none))
    text += "; the embedded Mars is built at its first use, which takes a minute or two";
  return {"cache", left < 2e9 ? State::kNote : State::kGood, text};
}

Finding find_ffmpeg() {
  try {
    Subprocess child({"ffmpeg", "-version"});
    if (child.finish()) return {"ffmpeg", State::kGood, child.output().substr(0, child.output().find('\n'))};
    return {"ffmpeg", State::kNote, "does not run: " + child.stderr_text() + "; films as .mp4 need it"};
  } catch (const std::runtime_error& e) {
    return {
        "ffmpeg", State::kNote,
        std::string(e.what()) + "; films as .mp4 need it (apt install ffmpeg), folders of PNG frames do not"};
  }
}

Finding find_models() {
  const std::string program = objects::model_reader_program();
  if (program.empty())
    return {
        "models", State::kNote,
        "vpe-model-reader is not there; objects of scenes need it (build it where libassimp-dev is installed)"};
  if (objects::model_levels_program().empty())
    return {"models", State::kNote,
            "vpe-model-levels is not there; objects have one level of detail without it"};
  return {"models", State::kGood, program};
}

const char* word(State state) {
  switch (state) {
    case State::kGood: return "good";
    case State::kNote: return "note";
    case State::kBad: return "bad";
  }
  return "";
}

void doctor(const Common& common) {
  const std::vector<Finding> findings{{"vpe", State::kGood, version()},
                                      {"GDAL", State::kGood, mars::raster_library()},
                                      find_display(),
                                      find_opengl(),
                                      find_configuration(),
                                      find_threads(common),
                                      find_memory(common),
                                      find_cache(),
                                      find_ffmpeg(),
                                      find_models()};
  if (common.json) {
    nlohmann::json json = nlohmann::json::object();
    for (const Finding& f : findings) json[f.what] = {{"state", word(f.state)}, {"text", f.text}};
    print_json(json);
  } else {
    for (const Finding& f : findings)
      std::printf("%-8s %-4s  %s\n", f.what.c_str(), word(f.state), f.text.c_str());
  }
  std::string bad;
  for (const Finding& f : findings) {
    if (f.state == State::kBad) bad += (bad.empty() ? "" : ", ") + f.what;
  }
  if (!bad.empty())
    throw std::runtime_error("some requirements of drawing are not met: " + bad + " (see above)");
}

}  // namespace

void add_doctor(CLI::App& program, Common& common) {
  CLI::App* command = add_command(program, "doctor",
                                  "Check this machine: OpenGL, threads, memory, cache, ffmpeg", common, true);
  add_examples(*command, {{"what drawing will use, and what is missing", "vpe doctor"},
                          {"the state under other limits", "vpe doctor --threads 4 --memory 512 --json"}});
  command->callback([&common] { doctor(common); });
}

}  // namespace vpe::app
