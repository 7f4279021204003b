#include "vpe/app/cli/former_options.h"

#include "vpe/core/registry/former_names.h"

namespace vpe::app {

using core::NameKind;

std::string_view current_option(std::string_view option) {
  return core::current_name(NameKind::kOption, option);
}

std::string current_value(std::string_view option, std::string_view value) {
  const std::string pair = std::string(option) + "=" + std::string(value);
  return std::string(core::current_name(NameKind::kOptionValue, pair).substr(option.size() + 1));
}

void use_current_names(std::vector<std::string>& words) {
  std::string before;  // the option whose value the word may be
  for (std::string& word : words) {
    if (word == "--") return;
    if (!word.starts_with("--")) {
      if (!before.empty()) word = current_value(before, word);
      before.clear();
      continue;
    }
    const std::size_t equals = word.find('=');
    const std::string option(current_option(std::string_view(word).substr(0, equals)));
    if (equals == std::string::npos) {
      word = option;
      before = option;
    } else {
      word = option + "=" + current_value(option, word.substr(equals + 1));
      before.clear();
    }
  }
}

}  // namespace vpe::app
