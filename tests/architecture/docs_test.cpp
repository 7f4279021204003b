// What the pages name: their links, and the files, folders and tests in their code spans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = VPE_SOURCE_DIR;

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> pages() {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(kRoot))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  for (const char* folder : {"docs", "tests"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / folder))
      if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

// Returns the anchor that a heading gets: lower case, blanks as hyphens, without punctuation.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    if (c == ' ') anchor += '-';
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' ||
        static_cast<unsigned char>(c) > 127)
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return anchor;
}

std::set<std::string> anchors(const std::string& text) {
  std::set<std::string> found;
  std::istringstream lines(text);
  bool is_code = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) is_code = !is_code;
    const std::size_t begin = line.find_first_not_of('#');
    if (!is_code && begin != 0 && begin != std::string::npos && line[begin] == ' ')
      found.insert(anchor_of(line.substr(begin + 1)));
  }
  return found;
}

// Returns what is wrong with a link as it stands on a page; "": nothing.
std::string problem_of_link(const fs::path& page, const std::string& link) {
  if (link.find("://") != std::string::npos || link.starts_with("mailto:")) return "";
  const std::size_t hash = link.find('#');
  const fs::path target = hash == 0 ? page : page.parent_path() / link.substr(0, hash);
  if (!fs::exists(target)) return "links to " + link + ", which does not exist";
  if (hash == std::string::npos || target.extension() != ".md") return "";
  if (!anchors(text_of(target)).contains(link.substr(hash + 1))) return "links to the missing heading " + link;
  return "";
}

// Returns whether a file or folder exists. Pages may leave out tests/, vpe/ or vpe/voxel/, and the extension.
bool is_path(const std::string& span) {
  for (const char* folder : {"", "tests/", "vpe/", "vpe/voxel/"})
    for (const char* extension : {"", ".h", ".cpp"})
      if (fs::exists(kRoot / (folder + span + extension))) return true;
  return false;
}

// The text of all test sources, to look test names up in.
const std::string& test_sources() {
  static const std::string kText = [] {
    std::string all;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / "tests"))
      if (entry.path().extension() == ".cpp") all += text_of(entry.path());
    return all;
  }();
  return kText;
}

bool is_test(const std::string& suite, const std::string& name) {
  return test_sources().find("(" + suite + ", " + name + ")") != std::string::npos;
}

// Returns what is wrong with a code span: a path below a folder of the repository, or `Suite.Test`.
std::string problem_of_span(const std::string& span) {
  static const std::regex kPath(
      R"((base|mars|vpe|lod|cull|paging|panorama|scripts|tests|tools|cmake|core|gl|voxel|explore|stability|architecture)(/[\w.-]+)+/?)");
  static const std::regex kPlaceholder(R"((^|.*[/_])[A-Z]+([/_.].*|$))");
  static const std::regex kTest(
      R"(([A-Z][A-Za-z0-9]*[a-z][A-Za-z0-9]*)\.([A-Z][A-Za-z0-9]*[a-z][A-Za-z0-9]*))");
  std::smatch match;
  // Extensions that the program writes are a user's files, as panorama/view.png.
  static const std::regex kSource(R"(.*(\.(h|cpp|sh|cmake|glsl|txt|md|flight|py|in)|/[\w-]+/?))");
  if (std::regex_match(span, kPath) && std::regex_match(span, kSource) &&
      !std::regex_match(span, kPlaceholder) && !is_path(span))
    return "names " + span + ", which does not exist";
  if (std::regex_match(span, match, kTest) && !is_test(match[1], match[2]))
    return "names the test " + span + ", which does not exist";
  return "";
}

std::vector<std::string> problems(const fs::path& page, const std::string& text) {
  static const std::regex kLink(R"(\]\(([^)\s]+)\))");
  static const std::regex kSpan("`([^`\n]+)`");
  // The glossary's and the changelog's former names name what was.
  const bool has_former_names = page.filename() == "glossary.md" || page.filename() == "CHANGELOG.md";
  std::vector<std::string> found;
  std::istringstream lines(text);
  bool is_code = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("```")) is_code = !is_code;
    if (is_code) continue;
    const auto add = [&](const std::string& problem) {
      if (!problem.empty())
        found.push_back(fs::relative(page, kRoot).generic_string() + ":" + std::to_string(number) + " " +
                        problem);
    };
    for (std::sregex_iterator it(line.begin(), line.end(), kLink), end; it != end; ++it)
      add(problem_of_link(page, (*it)[1]));
    if (has_former_names) continue;
    for (std::sregex_iterator it(line.begin(), line.end(), kSpan), end; it != end; ++it)
      for (std::istringstream words((*it)[1]); words;) {
        std::string word;
        if (words >> word) add(problem_of_span(word));
      }
  }
  return found;
}

TEST(Docs, NameOnlyWhatExists) {
  const std::vector<fs::path> all = pages();
  EXPECT_GT(all.size(), 40U);
  for (const fs::path& page : all)
    for (const std::string& problem : problems(page, text_of(page))) ADD_FAILURE() << problem;
}

TEST(DocsSelfTest, WrongNamesAreFound) {
  const auto count = [](const std::string& body) { return problems(kRoot / "docs" / "page.md", body).size(); };
  EXPECT_EQ(count("[a](design/rays.md) `lod/tree` `mars/cube_test` `Docs.NameOnlyWhatExists`\n"), 0U);
  EXPECT_EQ(count("[a](design/rays.md#the-method) [b](https://example.org/x) `NAME.LBL` `panorama/view.png`\n"),
            0U);
  EXPECT_EQ(count("```\n[a](design/no.md) `lod/no_such_file.h`\n```\n"), 0U);
  EXPECT_EQ(count("[a](design/no.md)\n[b](design/rays.md#no-such-heading)\n"), 2U);
  EXPECT_EQ(count("`lod/no_such_file.h` `vpe/no/such/folder/` `Docs.NoSuchTest`\n"), 3U);
}

}  // namespace
