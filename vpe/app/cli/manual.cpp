#include "vpe/app/cli/manual.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "vpe/app/cli/command_list.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/program.h"
#include "vpe/core/appearance/settings.h"

namespace vpe::app {

namespace {

// Returns text as roff needs it: no line begins with a control character, hyphens stay hyphens.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) {
      out += std::string("\\&") + c;
    } else {
      out += c;
    }
  }
  return out;
}

// Describes an option's value. CLI11 appends limits to the type: "INT:INT in [1 - 8]", "FLOAT:0.1 .. 9".
struct ValueText {
  std::string name;
  std::string limits;
};
ValueText value_text(const CLI::Option& option) {
  if (option.get_expected_max() == 0) return {};
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  ValueText text{type.substr(0, colon), colon == std::string::npos ? "" : type.substr(colon + 1)};
  if (const std::size_t in = text.limits.find(" in "); in != std::string::npos) text.limits.erase(0, in + 4);
  return text;
}

std::string comma_apart(std::string names) {
  for (std::size_t at = names.find(','); at != std::string::npos; at = names.find(',', at + 2)) {
    names.insert(at + 1, " ");
  }
  return names;
}

void describe(const CLI::Option& option, std::string& page) {
  const ValueText value = value_text(option);
  page += ".TP\n\\fB" + roff(comma_apart(option.get_name(false, true))) + "\\fR";
  if (option.nonpositional() && !value.name.empty()) page += " \\fI" + roff(value.name) + "\\fR";
  page += "\n" + roff(option.get_description());
  std::string more = value.limits;
  if (const std::string text = option.get_default_str(); !text.empty()) {
    more += (more.empty() ? "" : "; ") + ("default " + text);
  }
  if (!more.empty()) page += " (" + roff(more) + ")";
  page += "\n";
}

std::string synopsis(const CLI::App& command) {
  std::string line;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const bool many = option->get_expected_max() > 1;
    const std::string name = option->get_name(true) + (many ? "..." : "");
    line += " " + (option->get_required() ? name : "[" + name + "]");
  }
  return line;
}

std::string join(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
  return line;
}

std::vector<std::string> long_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // hidden from users
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

std::string man_page(const CLI::App& program) {
  std::string page =
      std::string(".TH VPE 1 \"\" \"vpe ") + version() + "\" \"User commands\"\n.SH NAME\nvpe \\- " +
      roff("explores planets: builds planet files, answers queries, draws images and panoramas, and flies") +
      "\n.SH SYNOPSIS\n.B vpe\n\\fICOMMAND\\fR [options]\n.SH DESCRIPTION\n" + roff(program.get_description()) +
      "\n" + roff(program.get_footer()) + "\n.SH COMMANDS\n";
  for (const CLI::App* command : all_commands(program)) {
    page += ".SS vpe " + roff(command_words(*command) + synopsis(*command)) + "\n" +
            roff(command->get_description()) + ".\n";
    for (const CLI::Option* option : command->get_options()) describe(*option, page);
  }
  page += ".SH SETTINGS\n" + roff("Keys of --set, and of the command 'set' in flights.") + "\n";
  for (const core::SettingInfo& info : core::Settings::list()) {
    page += ".TP\n.B " + roff(std::string(info.key)) + "\n" + roff(std::string(info.meaning)) + " (default " +
            roff(info.default_text.empty() ? "nothing" : info.default_text) + ")\n";
  }
  page += ".SH EXAMPLES\n" + roff("'vpe COMMAND --help' shows those of a command.") + "\n";
  for (const CLI::App* command : all_commands(program)) {
    const std::string examples = command->get_footer();
    page += ".SS vpe " + roff(command_words(*command)) + "\n.nf\n" +
            roff(examples.substr(std::min(examples.find('\n') + 1, examples.size()))) + "\n.fi\n";
  }
  page +=
      ".SH EXIT STATUS\n" +
      roff(
          "0: success. 1: failure, explained on standard error. 2: wrong usage. 130 or 143: ended by SIGINT or "
          "SIGTERM; finished work is kept where the same command can continue it.") +
      "\n.SH FILES\n.TP\n.I $XDG_CACHE_HOME/vpe\n" +
      roff(
          "Planet files built from DEMs and from the embedded Mars (~/.cache/vpe when the variable is not "
          "set). They may be removed at any time.") +
      "\n.TP\n.I $XDG_CONFIG_HOME/vpe/config.toml\n" +
      roff(
          "The user's options, in the format of --config (~/.config when the variable is not set); then "
          "vpe/config.toml in each of $XDG_CONFIG_DIRS (/etc/xdg). The command line takes precedence over the "
          "environment, the environment over --config, and --config over these files.") +
      "\n.SH ENVIRONMENT\n.TP\n.B VPE_MEMORY\n" + roff("Value of --memory where the option is not given.") +
      "\n.TP\n.B VPE_THREADS\n" + roff("Value of --threads where the option is not given.") +
      "\n.TP\n.B VPE_EGL\n" +
      roff("device or surfaceless: the EGL platform to take OpenGL from; both are tried when not set.") + "\n";
  return page;
}

std::string bash_completion(const CLI::App& program) {
  std::vector<std::string> names;  // first words
  std::string cases;
  std::string second_words;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
    std::vector<std::string> seconds;
    for (const CLI::App* inner : command->get_subcommands([](const CLI::App*) { return true; })) {
      seconds.push_back(inner->get_name());
    }
    if (!seconds.empty())
      second_words += "      " + command->get_name() + ") words=\"" + join(seconds) + "\" ;;\n";
  }
  for (const CLI::App* command : all_commands(program)) {
    cases += "    '" + command_words(*command) + " '*) words=\"" + join(long_options(*command)) + "\" ;;\n";
  }
  std::vector<std::string> keys;
  std::string choices;
  for (const core::SettingInfo& info : core::Settings::list()) {
    keys.push_back(std::string(info.key) + "=");
    if (info.type != core::SettingType::kChoice) continue;
    std::vector<std::string> words;
    for (const std::string_view word : info.choices) words.emplace_back(word);
    choices += "        " + std::string(info.key) + ") words=\"" + join(words) + "\" ;;\n";
  }
  std::vector<std::string> first = names;
  first.insert(first.end(), {"--help", "--version"});
  return std::string("# bash completion of vpe ") + version() +
         ", made by 'vpe completion'\n"
         "_vpe() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W \"" +
         join(first) +
         "\" -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  if [ \"$COMP_CWORD\" -eq 2 ]; then\n"
         "    case ${COMP_WORDS[1]} in\n" +
         second_words +
         "    esac\n"
         "    if [ -n \"$words\" ]; then\n"
         "      COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "      return\n"
         "    fi\n"
         "  fi\n"
         "  # bash makes '=' a word of its own: --set KEY=VALUE arrives as up to three words.\n"
         "  if [ \"$before\" = --set ]; then\n"
         "    compopt -o nospace\n"
         "    COMPREPLY=($(compgen -W \"" +
         join(keys) +
         "\" -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  local key=\n"
         "  if [ \"$current\" = '=' ] && [ \"${COMP_WORDS[COMP_CWORD-2]}\" = --set ]; then\n"
         "    key=$before current=\n"
         "  elif [ \"$before\" = '=' ] && [ \"$COMP_CWORD\" -ge 4 ] && [ \"${COMP_WORDS[COMP_CWORD-3]}\" = "
         "--set ]; then\n"
         "    key=${COMP_WORDS[COMP_CWORD-2]}\n"
         "  fi\n"
         "  if [ -n \"$key\" ]; then\n"
         "    case $key in\n" +
         choices +
         "    esac\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  if [[ $current == -* ]]; then\n"
         "    case \"${COMP_WORDS[1]} ${COMP_WORDS[2]} \" in\n" +
         cases +
         "    esac\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  compopt -o filenames\n"
         "  mapfile -t COMPREPLY < <(compgen -f -- \"$current\")\n"
         "}\n"
         "complete -F _vpe vpe\n";
}

void add_manual(CLI::App& program, Common& common) {
  CLI::App* completion =
      add_command(program, "completion", "Print the completion script for bash", common, false);
  add_examples(*completion, {{"in this shell", "vpe completion > vpe.bash && . ./vpe.bash"},
                             {"in every shell of a user",
                              "vpe completion > ~/.local/share/bash-completion/completions/vpe"}});
  completion->callback([&program] { std::fputs(bash_completion(program).c_str(), stdout); });
  CLI::App* page = add_command(program, "man", "Print the manual page (vpe man | man -l -)", common, false);
  add_examples(*page, {{"read it", "vpe man | man -l -"}, {"install it", "vpe man > vpe.1"}});
  page->callback([&program] { std::fputs(man_page(program).c_str(), stdout); });
}

}  // namespace vpe::app
