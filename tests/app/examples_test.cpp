// The examples in `vpe COMMAND --help` and in the manual page are command lines that the program accepts.
#include <map>
#include <regex>
#include <sstream>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

class Examples : public AppTest {
 protected:
  // Returns the names after "Subcommands:" in a help text.
  static Words subcommands(const std::string& help) {
    Words names;
    const std::size_t at = help.find("Subcommands:");
    if (at == std::string::npos) return names;
    std::istringstream lines(help.substr(at));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line) && line.starts_with("  "))
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    return names;
  }

  // Returns the words of every command, such as {"report", "all"}.
  std::vector<Words> commands() const {
    std::vector<Words> all;
    for (const std::string& name : subcommands(help_of({}))) {
      all.push_back({name});
      for (const std::string& inner : subcommands(help_of({name}))) all.push_back({name, inner});
    }
    return all;
  }

  // Both tests read the same texts.
  const std::string& help_of(Words words) const {
    static std::map<Words, std::string> texts;
    std::string& text = texts[words];
    words.emplace_back("--help");
    if (text.empty()) text = vpe(words).out;
    return text;
  }

  // Returns the command lines at the end of a help text.
  static Words lines_of(const std::string& help) {
    Words lines;
    const std::size_t at = help.find("\nExamples:\n");
    if (at == std::string::npos) return lines;
    std::istringstream text(help.substr(at));
    for (std::string line; std::getline(text, line);) {
      if (line.starts_with("    vpe ")) lines.push_back(line.substr(4));
    }
    return lines;
  }

  // Returns the arguments of a line, up to what the shell takes.
  static Words arguments_of(const std::string& line) {
    Words arguments;
    std::istringstream words(line.substr(line.find(' ')));
    for (std::string word; words >> word;) {
      if (word == "<" || word == ">" || word == "|" || word == "&&") break;
      arguments.push_back(word);
    }
    return arguments;
  }
};

std::string join(const Words& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : " ") + word;
  return all;
}

TEST_F(Examples, EveryHelpHasSomeAndTheManualPageHasAll) {
  const std::string page = std::regex_replace(vpe({"man"}).out, std::regex(R"(\\-)"), "-");
  const std::size_t section = page.find("\n.SH EXAMPLES\n");
  ASSERT_NE(section, std::string::npos);
  const std::vector<Words> all = commands();
  EXPECT_GE(all.size(), 20U);
  for (const Words& words : all) {
    const Words lines = lines_of(help_of(words));
    EXPECT_GE(lines.size(), 2U) << join(words);
    for (const std::string& line : lines) {
      EXPECT_TRUE(line.starts_with("vpe " + join(words) + " ") || line == "vpe " + join(words) ||
                  words == Words{"report"})
          << line;
      EXPECT_NE(page.find("\n    " + line + "\n", section), std::string::npos) << line;
    }
  }
}

// The example runs where its inputs are absent, or its output cannot be made: whatever the parsers find comes
// before. Commands that only read get a planet.
TEST_F(Examples, TheProgramAcceptsEachOfThem) {
  const Words reading{"info", "verify", "query", "profile"};
  write_text(dir_ / "names.csv", "name,lon,lat\nA,10,20\n");
  write_text(dir_ / "scaling", "in the way of a folder");
  write_text(dir_ / "papers", "in the way of a folder");
  write_text(dir_ / "mars-data", "in the way of a folder");  // else 'vpe get' would fetch
  for (const Words& words : commands()) {
    const bool reads = std::find(reading.begin(), reading.end(), words[0]) != reading.end();
    if (reads) std::filesystem::copy_file(planet(), dir_ / "mars.vpe");
    for (const std::string& line : lines_of(help_of(words))) {
      const Result result = vpe(arguments_of(line), "lon,lat\n1,2\n");
      EXPECT_NE(result.exit_code, 2) << line << "\n" << result.err;
      EXPECT_TRUE(!reads || result.exit_code == 0) << line << "\n" << result.err;
    }
    if (reads) std::filesystem::remove(dir_ / "mars.vpe");
  }
}

}  // namespace
}  // namespace app_test
