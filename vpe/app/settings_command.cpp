#include <CLI/CLI.hpp>
#include <cstdio>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/commands.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/settings.h"

namespace vpe::app {

namespace {

std::string range_text(const core::SettingInfo& info) {
  if (info.type == core::SettingType::kTable || info.type == core::SettingType::kText) return info.grammar;
  if (info.type != core::SettingType::kChoice) {
    return base::format_number(info.min) + " .. " + base::format_number(info.max) +
           (info.word.empty() ? "" : ", or " + std::string(info.word));
  }
  std::string choices;
  for (const std::string_view word : info.choices) choices += (choices.empty() ? "" : ", ") + std::string(word);
  return choices;
}

void settings(const Common& common) {
  if (common.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const core::SettingInfo& info : core::Settings::list()) {
      list.push_back({{"key", info.key},
                      {"default", info.default_text},
                      {"range", range_text(info)},
                      {"unit", info.unit},
                      {"meaning", info.meaning}});
    }
    print_json(list);
    return;
  }
  for (const core::SettingInfo& info : core::Settings::list()) {
    std::printf("%-24s %s\n%-24s   default %s; %s%s%s\n", std::string(info.key).c_str(),
                std::string(info.meaning).c_str(), "",
                info.default_text.empty() ? "nothing" : info.default_text.c_str(), range_text(info).c_str(),
                info.unit.empty() ? "" : " ", std::string(info.unit).c_str());
  }
}

}  // namespace

void add_settings(CLI::App& program, Common& common) {
  CLI::App* command = add_command(
      program, "settings", "List the settings that --set, and 'set' in flights, can change", common, true);
  add_examples(*command, {{"the table", "vpe settings"},
                          {"with types, ranges and defaults for a program", "vpe settings --json"}});
  command->callback([&common] { settings(common); });
}

}  // namespace vpe::app
