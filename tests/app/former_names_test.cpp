// Former names of options, values and settings are accepted everywhere, and shown nowhere.
#include "vpe/core/registry/former_names.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "tests/app/support/app_fixture.h"
#include "vpe/app/cli/former_options.h"

namespace app_test {
namespace {

using vpe::core::FormerName;
using vpe::core::NameKind;

// A command line that fails because a file does not exist, and its option under test with the values to try; an
// empty value stands for a flag.
struct Example {
  Words command;
  Words values;
};

Example example_of(const std::string& option) {
  const Words build{"build", "missing.tif", "-o", "x.vpe"};
  const Words render{"render", "missing.vpe", "--pose", "0,0,300000", "-o", "x.png"};
  if (option == "--to-datum") return {build, {"", "=areoid"}};
  if (option == "--align") return {build, {"none", "plane", "edges"}};
  if (option == "--reject-outliers") return {build, {""}};
  if (option == "--from-sidecar") return {{"panorama"}, {"missing.json"}};
  if (option == "--aux-layers") {
    return {{"panorama", "missing.vpe", "--at", "1,2", "--height", "2", "-o", "x.tif"}, {"range"}};
  }
  if (option == "--hotspots") return {{"explore", "missing.vpe"}, {"missing.txt"}};
  if (option == "--backend") return {render, {"polygon", "ray"}};
  return {};
}

std::string option_of(const std::string& pair) { return pair.substr(0, pair.find('=')); }
std::string value_of(const std::string& pair) { return pair.substr(pair.find('=') + 1); }

class FormerNames : public AppTest {
 protected:
  Result run_with(Words command, const Words& more) const {
    command.insert(command.end(), more.begin(), more.end());
    return vpe(command);
  }
  // Both fail because of the missing file, in the same way.
  void expect_same(const Words& command, const Words& former, const Words& current) const {
    const Result now = run_with(command, current);
    const Result before = run_with(command, former);
    EXPECT_EQ(now.exit_code, 1) << now.err;
    EXPECT_TRUE(says(now.err, {"missing"}));
    EXPECT_EQ(before.exit_code, now.exit_code) << before.err;
    EXPECT_EQ(before.err, now.err);
  }
  // Both forms, `--option value` and `--option=value`.
  void expect_same_option(const Words& command, const std::string& former, const std::string& former_value,
                          const std::string& current, const std::string& current_value) const {
    if (former_value.empty() || former_value.front() == '=') {
      expect_same(command, {former + former_value}, {current + current_value});
      return;
    }
    expect_same(command, {former, former_value}, {current, current_value});
    expect_same(command, {former + "=" + former_value}, {current + "=" + current_value});
  }
};

// Keys of the preferences file have a test of their own in tests/explore.
TEST_F(FormerNames, TheCommandLineTakesEveryOneOfThem) {
  for (const FormerName& name : vpe::core::former_names()) {
    const std::string former(name.former);
    const std::string current(name.current);
    SCOPED_TRACE(former);
    if (name.kind == NameKind::kOption) {
      const Example example = example_of(current);
      ASSERT_FALSE(example.command.empty()) << "no example of " << current;
      for (const std::string& value : example.values)
        expect_same_option(example.command, former, value, current, value);
    } else if (name.kind == NameKind::kOptionValue) {
      const Example example = example_of(option_of(current));
      ASSERT_FALSE(example.command.empty()) << "no example of " << current;
      expect_same_option(example.command, option_of(former), value_of(former), option_of(current),
                         value_of(current));
    } else if (name.kind == NameKind::kBackend) {
      expect_same_option(example_of("--backend").command, "--backend", former, "--backend", current);
    } else if (name.kind == NameKind::kSettingValue) {
      expect_same(example_of("--backend").command, {"--set", former}, {"--set", current});
    } else if (name.kind == NameKind::kSetting) {
      const auto all = parse_json(vpe({"settings", "--json"}).out);
      const auto info =
          std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.at("key") == current; });
      ASSERT_NE(info, all.end());
      const std::string value = "=" + info->at("default").get<std::string>();
      expect_same(example_of("--backend").command, {"--set", former + value}, {"--set", current + value});
    }
  }
}

TEST_F(FormerNames, ConfigurationFilesTakeEveryOption) {
  const auto result_of = [&](const Words& command, const std::string& toml) {
    write_text(dir_ / "c.toml", toml);
    return run_with(command, {"--config", "c.toml"});
  };
  for (const FormerName& name : vpe::core::former_names()) {
    if (name.kind != NameKind::kOption && name.kind != NameKind::kOptionValue) continue;
    const std::string former(name.former);
    const std::string current(name.current);
    SCOPED_TRACE(former);
    const Example example = example_of(option_of(current));
    ASSERT_FALSE(example.command.empty()) << "no example of " << current;
    const bool is_value = name.kind == NameKind::kOptionValue;
    const std::string& first = example.values.front();
    const std::string quoted = "'" + first + "'";
    const std::string other = first.empty() ? "true" : quoted;
    const auto line = [&](const std::string& text) {
      return option_of(text).substr(2) + " = " + (is_value ? "'" + value_of(text) + "'" : other) + "\n";
    };
    const std::string table = "[" + example.command.front() + "]\n";
    for (const std::string& head : {std::string(), table}) {
      const Result now = result_of(example.command, head + line(current));
      const Result before = result_of(example.command, head + line(former));
      EXPECT_EQ(now.exit_code, 1) << now.err;
      EXPECT_TRUE(says(now.err, {"missing"}));
      EXPECT_EQ(before.exit_code, 1) << before.err;
      EXPECT_EQ(before.err, now.err);
    }
  }
}

// Neither values of other options nor words after "--" are names.
TEST_F(FormerNames, OnlyNamesChange) {
  using vpe::app::use_current_names;
  const auto current = [](Words words) {
    use_current_names(words);
    return words;
  };
  EXPECT_EQ(current({"build", "--level", "fit", "fit"}), (Words{"build", "--align", "plane", "fit"}));
  EXPECT_EQ(current({"build", "--level=bend"}), (Words{"build", "--align=edges"}));
  EXPECT_EQ(current({"build", "--level=fit=bend"}), (Words{"build", "--align=fit=bend"}));
  EXPECT_EQ(current({"build", "--convert", "fit"}), (Words{"build", "--to-datum", "fit"}));
  EXPECT_EQ(current({"build", "--", "--level", "fit"}), (Words{"build", "--", "--level", "fit"}));
  EXPECT_EQ(current({"--levels", "level", "-level", ""}), (Words{"--levels", "level", "-level", ""}));
}

TEST_F(FormerNames, HelpManualAndCompletionShowNone) {
  const std::string help = vpe({"--help"}).out;
  std::vector<Words> commands;
  std::istringstream lines(help.substr(help.find("Subcommands:")));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with("  ")) {
    commands.push_back({line.substr(2, line.find(' ', 2) - 2), "--help"});
  }
  ASSERT_GE(commands.size(), 10U);
  commands.push_back({"man"});
  commands.push_back({"completion"});
  for (const Words& command : commands) {
    std::string text = vpe(command).out;
    ASSERT_FALSE(text.empty()) << command.front();
    text.erase(std::remove(text.begin(), text.end(), '\\'), text.end());  // of roff
    std::replace_if(
        text.begin(), text.end(),
        [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '.' && c != '_'; }, ' ');
    std::istringstream words(text);
    for (std::string word; words >> word;) {
      for (const FormerName& name : vpe::core::former_names()) {
        if (name.kind != NameKind::kOption && name.kind != NameKind::kSetting) continue;
        EXPECT_NE(word, name.former) << command.front();
      }
    }
  }
}

}  // namespace
}  // namespace app_test
