// The former names of docs/glossary.md, which no source, script or page may use again.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct FormerNames {
  int row;  // of the table of former names in docs/glossary.md
  const char* pattern;
  bool is_kept_in_files = false;  // keys of JSON, CSV and SQL: allowed in pages and in string literals
};

constexpr FormerNames kFormer[] = {
    {2, R"(\berror_px\b|projected error)", true},
    {3, R"(\b(error_m|tile_error_m|tile_error_px)\b)", true},
    {4, R"(\b(EyePose|ColumnEye|SkylineEye|eye_m|to_eye|make_eye)\b)"},
    {5, R"(\b(Picture\w+|picture_\w+|\w+_picture)\b)", true},
    {6, R"(\b(CullerWorth|WorthLimits|not_used)\b)"},
    {7, R"(\b(Shell|shell_of|make_volume|TileVolume)\b)"},
    {8, R"(\b(TileWalls|WallLine|make_walls)\b)"},
    {9, R"(\bstretch\()"},
    {10, R"(\blook_from\b)"},
    {11, R"(\b(LookAndWait\w*|LookState|LookInput|LookOutput|look_and_wait)\b)"},
    {12, R"(\b(substitute\(|Readiness|Substitution)\b)"},
    {13, R"(\b(relief_m|sag_m)\b)", true},
    {14, R"(\btally\b)"},
    {15, R"(\b(LodRule|kHitchner|lod_rule|lod\.rule)\b)"},
    {16, R"(\b(shown_level|lod_number)\b)"},
    {17, R"(\b(FanPlan|FanCaster|FanLine|Fan)\b)"},
    {18, R"(\b(cast_sheets|Sheet)\b)"},
    {19, R"(\b(Desks?|LatticeShelf)\b)"},
    {20, R"(\b(Lattice|TileLattices|LatticeStore|LatticeLines|LatticeFrame)\b)"},
    {21, R"(\b(PictureAhead|picture_ahead)\b)"},
    {22, R"(\b(plain_caster|cast_plain)\b|rays\.mode=plain)"},
    {23, R"(\bthin_view\b)"},
    {24, R"(\b(GroundPainter|ground_look|ShadeParams)\b)"},
    {25, R"(\b(Surfacing|PaintBy|gl::Painting|struct Painting)\b)"},
    {26, R"(\b(Lens|make_lens)\b)"},
    {27, R"(\b(TileNumber|draw_numbers|tile_number)\b)"},
    {28, R"(\b(core::Part|Part part|AboveNote|ShareFile|ShareMeta)\b)"},
    {29, R"(\b(recipe_|PanoramaRecipe|put_note|kAboveNote)\b)"},
    {30, R"(\b(has_missing|shows_gaps|with_gaps|pds_missing|is_hole)\b|[^-\w]without data\b)"},
    {31, R"(\b(fit_level|fit_bend|levelling|RimAware|RimPost|kLevelOutlier)\b)"},
    {32, R"(\b(PictureOrder|MeasureOrder|ProbeOrder|PanoramaOrder|ReportOrder)\b)"},
    {33, R"(\b(Contestant|rivals|WayOptions|time_in_turns)\b)"},
    {34, R"(\b(WideScene|WideName|Decals?|lay_out_wide)\b)"},
    {35, R"(\b(Standpoint|Station|panorama::look)\b)"},
    {36, R"(\b(Companions|PlaceReader|PlaceRead)\b)"},
    {37, R"(\b(Halver|LevelChain)\b)"},
    {38, R"(\b(SpotGuide|SpotTracker|NearSpot|step_in)\b)"},
    {39, R"(\b(FlightDesk|MapWish|MeasureWish|parting_words)\b|->said\(\)|\.said\(\))"},
    {40, R"(--(convert|mask-blunders|again|planes)\b|--level (fit|bend)|--backend voxel)"},
};

// What may name them: the table of accepted former names and its test, the comparison with the former version, the
// glossary, the changelog, and this file.
bool is_exempt(const std::string& path) {
  static const std::vector<std::string> kExempt{"vpe/core/registry/former_names", "tests/compatibility/",
                                                "docs/glossary.md", "CHANGELOG.md",
                                                "tests/architecture/names_test.cpp"};
  return path.find("former_name") != std::string::npos ||
         std::any_of(kExempt.begin(), kExempt.end(), [&](const std::string& e) { return path.starts_with(e); });
}

bool is_text(const fs::path& path) {
  static const std::vector<std::string> kExtensions{".h",     ".cpp", ".glsl", ".txt",
                                                    ".cmake", ".sh",  ".md",   ".flight"};
  return std::find(kExtensions.begin(), kExtensions.end(), path.extension().string()) != kExtensions.end();
}

// The text with its string literals emptied, line by line as before.
std::string without_literals(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const bool is_raw = text.compare(at, 2, "R\"") == 0;
    const bool is_plain = !is_raw && text[at] == '"' && (at == 0 || text[at - 1] != '\'');
    if (!is_raw && !is_plain) {
      out += text[at++];
      continue;
    }
    std::size_t end = at + 1;
    if (is_raw) {  // R"delimiter( ... )delimiter"
      const std::size_t open = std::min(text.find('(', at), text.size());
      const std::string close = ")" + text.substr(at + 2, open - at - 2) + "\"";
      end = std::min(text.find(close, open), text.size() - close.size()) + close.size() - 1;
    }
    while (is_plain && end < text.size() && text[end] != '"' && text[end] != '\n')
      end += text[end] == '\\' ? 2 : 1;
    end = std::min(end, text.size() - 1);
    out.append(static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                                                   text.begin() + static_cast<std::ptrdiff_t>(end), '\n')),
               '\n');
    if (text[end] == '\n') out += '\n';
    at = end + 1;
  }
  return out;
}

struct Pattern {
  int row;
  std::regex regex;
  bool is_kept_in_files;
  std::vector<std::string> stems;  // words of the pattern, one of which every match contains
};

std::vector<std::string> stems_of(const std::string& pattern) {
  static const std::regex kEscape(R"(\\.)");
  static const std::regex kWord("[A-Za-z_]{3,}");
  const std::string words = std::regex_replace(pattern, kEscape, " ");
  return {std::sregex_token_iterator(words.begin(), words.end(), kWord), std::sregex_token_iterator()};
}

const std::vector<Pattern>& patterns() {
  static const std::vector<Pattern> kPatterns = [] {
    std::vector<Pattern> all;
    for (const FormerNames& f : kFormer)
      all.push_back(
          {f.row, std::regex(f.pattern, std::regex::optimize), f.is_kept_in_files, stems_of(f.pattern)});
    return all;
  }();
  return kPatterns;
}

// A line that calls a name a former one may name it.
std::vector<std::string> former_names_in(const std::string& path, const std::string& body) {
  std::vector<std::string> found;
  std::istringstream text(body);
  std::istringstream code(path.ends_with(".md") ? std::string() : without_literals(body));
  std::string line;
  std::string code_line;
  for (int number = 1; std::getline(text, line); ++number) {
    if (!std::getline(code, code_line)) code_line.clear();
    if (line.find("ormer") != std::string::npos) continue;
    for (const Pattern& p : patterns()) {
      const std::string& looked_at = p.is_kept_in_files ? code_line : line;
      // Regular expressions are slow.
      if (std::none_of(p.stems.begin(), p.stems.end(),
                       [&](const std::string& stem) { return looked_at.find(stem) != std::string::npos; }))
        continue;
      std::smatch match;
      if (!std::regex_search(looked_at, match, p.regex)) continue;
      found.push_back(path + ":" + std::to_string(number) + ": '" + match.str() + "' is a former name (row " +
                      std::to_string(p.row) + " of docs/glossary.md)");
    }
  }
  return found;
}

TEST(Names, NoFormerNameIsUsed) {
  const fs::path root = VPE_SOURCE_DIR;
  std::size_t files = 0;
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::end(entry); ++entry) {
    const std::string name = entry->path().filename().string();
    if (entry->is_directory() && entry.depth() == 0 &&
        (name.starts_with(".") || name.starts_with("build") || name == "out")) {
      entry.disable_recursion_pending();
      continue;
    }
    const std::string path = fs::relative(entry->path(), root).generic_string();
    if (!entry->is_regular_file() || !is_text(entry->path()) || is_exempt(path)) continue;
    std::ifstream file(entry->path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (const std::string& problem : former_names_in(path, text)) ADD_FAILURE() << problem;
    ++files;
  }
  EXPECT_GT(files, 500U);
}

TEST(NamesSelfTest, FormerNamesAreFound) {
  const auto count = [](const std::string& body) { return former_names_in("lod/a.cpp", body).size(); };
  EXPECT_EQ(count("double screen_space_error_px = 0;\nstruct LabelLayout {};\n"), 0U);
  EXPECT_EQ(count("{\"tile_error_m\", a.geometric_error_m},\n"), 0U);
  EXPECT_EQ(count("double error_px = 0;\nTileWalls walls;\n"), 2U);
  EXPECT_EQ(count("core::Part part;\nmars::EyePose eye;\n"), 2U);
  EXPECT_EQ(count("R\"(\nSELECT relief_m,\n sag_m)\" relief_m\n"), 1U);
  EXPECT_EQ(count("vpe build --mask-blunders\n"), 1U);
  EXPECT_EQ(count("// Former name of --reject-outliers: --mask-blunders\n"), 0U);
}

}  // namespace
