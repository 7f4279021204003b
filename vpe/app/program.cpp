#include "vpe/app/program.h"

#include <clocale>
#include <csignal>
#include <cstdio>
#include <exception>

#include "vpe/app/interrupt.h"

#ifndef VPE_VERSION
#define VPE_VERSION "0"
#endif

namespace vpe::app {

CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& about, Common& common,
                      bool with_json) {
  CLI::App* command = program.add_subcommand(name, about);
  command->add_option("--memory", common.memory_mb, "Memory for data, MB")->check(CLI::Range(64, 1 << 20))->capture_default_str();
  command->add_option("--threads", common.threads, "Worker threads, 0 = all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  command->add_flag("--quiet,-q", common.quiet, "No progress, only errors");
  command->set_config("--config", "", "Read options from a TOML file");
  if (with_json) command->add_flag("--json", common.json, "Print figures as JSON on stdout");
  return command;
}

int run(int argc, char** argv) {
  // The C locale throughout: a number means the same on every machine.
  std::setlocale(LC_ALL, "C");
  std::signal(SIGPIPE, SIG_IGN);
  CLI::App program("vpe explores planets: build planet files, ask them, draw them, fly over them.", "vpe");
  program.set_version_flag("--version", std::string("vpe ") + VPE_VERSION);
  program.require_subcommand(1);
  program.footer("'vpe COMMAND --help' explains a command. Without a PLANET the embedded Mars (an illustration) is used.");
  Common common;
  add_build(program, common);
  add_info(program, common);
  add_query(program, common);
  add_render(program, common);
  add_fly(program, common);
  add_settings(program, common);
  try {
    program.parse(argc, argv);
    return kSuccess;
  } catch (const CLI::ParseError& e) {
    const int code = program.exit(e);
    return code == 0 ? kSuccess : kUsage;
  } catch (const UsageError& e) {
    std::fprintf(stderr, "vpe: %s\n", e.what());
    return kUsage;
  } catch (const Interrupted& e) {
    std::fprintf(stderr, "vpe: stopped\n");
    return kSignalBase + e.signal();
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "vpe: out of memory; lower --memory, --size or --threads\n");
    return kFailure;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "vpe: %s\n", e.what());
    return kFailure;
  }
}

}  // namespace vpe::app
