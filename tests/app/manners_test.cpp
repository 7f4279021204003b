// Start-up without unneeded libraries and tiles, the manual, the completion, and `vpe doctor`.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>

#include "paging/planet/planet_file.h"
#include "paging/planet/sqlite.h"
#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

class StartUp : public AppTest {
 protected:
  // Returns the names of shared libraries that a run opened, as the dynamic linker reports them.
  std::string libraries_of(const Words& arguments) const {
    Command command = command_for(arguments);
    command.environment["LD_DEBUG"] = "files";
    command.environment["LD_DEBUG_OUTPUT"] = path("ld");
    const Result result = run(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::string all;
    for (const auto& entry : std::filesystem::directory_iterator(dir_.path())) {
      if (entry.path().filename().string().starts_with("ld.")) {
        all += read_text(entry.path());
        std::filesystem::remove(entry.path());
      }
    }
    return all;
  }
  static bool has_opengl(const std::string& libraries) {
    static const std::regex kOpenGl(
        "lib(EGL|GL|OpenGL|GLX|GLdispatch|OSMesa|gallium|LLVM)[-_.a-zA-Z0-9]*\\.so|_dri\\.so");
    return std::regex_search(libraries, kOpenGl);
  }
};

TEST_F(StartUp, OnlyWhatDrawsOpensOpenGl) {
  const std::string p = planet().string();
  const std::string version = libraries_of({"--version"});
  if (version.find("libc.so") == std::string::npos) GTEST_SKIP() << "skipped: no LD_DEBUG with this C library";
  EXPECT_FALSE(has_opengl(version));
  EXPECT_FALSE(has_opengl(libraries_of({"info", p})));
  EXPECT_FALSE(has_opengl(libraries_of({"query", p, "10,20"})));
  EXPECT_FALSE(has_opengl(libraries_of({"verify", p})));
  EXPECT_FALSE(has_opengl(libraries_of({"settings"})));
  // The trace shows OpenGL where it is opened.
  EXPECT_TRUE(has_opengl(libraries_of({"doctor"})));
}

// All payloads but one are unreadable: a command that reads any of them fails.
TEST_F(StartUp, InfoReadsNoTileAndQueryOnlyItsOwn) {
  std::filesystem::copy_file(planet(), dir_ / "x.vpe");
  const Result info = vpe({"info", "x.vpe", "--json"});
  const Result query = vpe({"query", "x.vpe", "10,20"});
  ASSERT_EQ(query.exit_code, 0) << query.err;
  {
    const auto kept = paging::PlanetFile::open(path("x.vpe"))
                          ->tree()
                          .deepest(lod::tile_at(mars::chart_point(mars::direction({10, 20})), 20))
                          .key;
    paging::Database db(path("x.vpe"), paging::Database::Mode::kCreate);
    db.execute("UPDATE heights SET data = x'00' WHERE key != " + std::to_string(lod::pack(kept)));
    db.execute("UPDATE mesh SET data = x'00'");
    db.execute("UPDATE image SET data = x'00'");
  }
  EXPECT_EQ(vpe({"info", "x.vpe", "--json"}).out, info.out);
  EXPECT_EQ(vpe({"query", "x.vpe", "10,20"}).out, query.out);
  EXPECT_EQ(vpe({"query", "x.vpe", "-170,-20"}).exit_code, 1);
}

class Manual : public AppTest {};

TEST_F(Manual, TheManPageNamesEveryCommandOptionAndSetting) {
  const Result page = vpe({"man"});
  ASSERT_EQ(page.exit_code, 0) << page.err;
  std::string plain = page.out;
  plain = std::regex_replace(plain, std::regex(R"(\\-)"), "-");
  const std::string help = vpe({"--help"}).out;
  static const std::regex kOption("--[a-z-]+");
  int commands = 0;
  // Commands are the indented lines after "Subcommands:".
  std::istringstream lines(help.substr(help.find("Subcommands:")));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with("  ")) {
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    ++commands;
    EXPECT_NE(plain.find(".SS vpe " + name), std::string::npos) << name;
    const std::string own = vpe({name, "--help"}).out;
    for (auto at = std::sregex_iterator(own.begin(), own.end(), kOption); at != std::sregex_iterator(); ++at) {
      EXPECT_NE(plain.find(at->str()), std::string::npos) << name << " " << at->str();
    }
  }
  EXPECT_GE(commands, 10);
  EXPECT_NE(plain.find(".SS vpe report error-time [PLANET]"), std::string::npos);
  for (const auto& setting : parse_json(vpe({"settings", "--json"}).out)) {
    EXPECT_NE(plain.find(".B " + setting.at("key").get<std::string>()), std::string::npos);
  }
  if (const auto man = find_program("man"); !man.empty()) {
    write_text(dir_ / "vpe.1", page.out);
    Command command;
    command.program = man;
    command.arguments = {"--warnings", "-E", "UTF-8", "-l", "-Tutf8", "vpe.1"};
    command.folder = dir_.path();
    command.environment["MANWIDTH"] = "80";
    const Result shown = run(command);
    EXPECT_EQ(shown.exit_code, 0);
    EXPECT_EQ(shown.err, "");
  }
}

// Runs the completion in bash.
TEST_F(Manual, BashCompletesCommandsOptionsKeysAndChoices) {
  const auto bash = find_program("bash");
  if (bash.empty()) GTEST_SKIP() << "skipped: no bash";
  write_text(dir_ / "vpe.bash", vpe({"completion"}).out);
  const auto offers = [&](const std::string& words, int at) {
    write_text(dir_ / "ask.sh", "compopt() { :; }\n. ./vpe.bash\nCOMP_WORDS=(" + words + ")\nCOMP_CWORD=" +
                                    std::to_string(at) + "\n_vpe\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
    Command command;
    command.program = bash;
    command.arguments = {"ask.sh"};
    command.folder = dir_.path();
    const Result result = run(command);
    EXPECT_EQ(result.err, "");
    return result.out;
  };
  EXPECT_EQ(offers("vpe ren", 1), "render\n");
  EXPECT_NE(offers("vpe ''", 1).find("verify\n"), std::string::npos);
  EXPECT_EQ(offers("vpe render --cert", 2), "--certificate\n");
  EXPECT_EQ(offers("vpe report err", 2), "error-time\n");
  EXPECT_EQ(offers("vpe report error-time --base", 3), "--baseline\n");
  EXPECT_EQ(offers("vpe render --set exagg", 3), "exaggeration=\n");
  EXPECT_EQ(offers("vpe render --set mode = wire", 5), "wireframe\n");
  EXPECT_NE(offers("vpe render --set edges =", 4).find("smooth\n"), std::string::npos);
  write_text(dir_ / "a b.vpe", "");
  EXPECT_NE(offers("vpe info a", 2).find("a b.vpe\n"), std::string::npos);
}

class Doctor : public AppTest {};

TEST_F(Doctor, ReportsWhatWillBeUsedAndWhatIsMissing) {
  const nlohmann::json json = parse_json(vpe({"doctor", "--json", "--threads", "1"}).out);
  for (const char* what :
       {"vpe", "GDAL", "display", "OpenGL", "threads", "memory", "cache", "ffmpeg", "models"}) {
    EXPECT_NE(json.at(what).at("state").get<std::string>(), "bad") << json.at(what);
  }
  EXPECT_EQ(json.at("threads").at("text").get<std::string>().front(), '1');
  // No OpenGL, no ffmpeg, a cache that cannot be made: each is reported, and the exit status is 1.
  write_text(dir_ / "file", "");
  Command command = command_for({"doctor"});
  command.environment["VPE_EGL"] = "device-that-nobody-has";
  command.environment["XDG_CACHE_HOME"] = path("file");
  command.environment["PATH"] = path("empty");
  const Result bad = run(command);
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_TRUE(
      says(bad.out, {"OpenGL   bad", "cache    bad", "cannot make the cache folder", "apt install ffmpeg"}));
  EXPECT_TRUE(says(bad.err, {"requirements of drawing are not met: OpenGL, cache"}));
}

TEST_F(StartUp, ThereIsNoColourOffATerminal) {
  for (const Words& words : {Words{"--help"}, Words{"doctor"}, Words{"info", planet().string()}}) {
    const Result result = vpe(words);
    EXPECT_EQ((result.out + result.err).find('\x1b'), std::string::npos);
  }
}

}  // namespace
}  // namespace app_test
