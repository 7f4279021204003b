#include "scripts/flight.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scripts/path.h"
#include "tests/support/support.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/overlays.h"
#include "vpe/core/appearance/settings.h"

namespace scripts {
namespace {

using test_support::Random;

constexpr const char* kExample =
    "flight 1                                  # format version\n"
    "view fov=60 size=1280x720 fps=30\n"
    "at 0    pose lon=-74 lat=-13.5 alt=12000 yaw=90 pitch=-15 roll=0\n"
    "at 8    pose lon=-68 lat=-13.2 height=3000 yaw=100 pitch=-10 roll=-20\n"
    "at 8    set mode=textured exaggeration=2\n"
    "at 10   look yaw=40 pitch=5               # head offset relative to the platform\n"
    "at 12   interest lon=-67 lat=-13 radius=40000 levels=+1\n"
    "at 20   end\n";

Flight example() {
  Flight flight;
  flight.view = {60, 1280, 720, {30, 1}};
  flight.waypoints = {{0, -74, -13.5, 12000, false, 90, -15, 0}, {8, -68, -13.2, 3000, true, 100, -10, -20}};
  flight.sets = {{8, "mode", "textured"}, {8, "exaggeration", "2"}};
  flight.heads = {{10, 40, 5, 0}};
  flight.interests = {{12, {-67, -13, 40000, 1}}};
  flight.end_s = 20;
  return flight;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// Expects one error on `line`, and its message.
std::string error_of(const std::string& text, int line) {
  const ParsedFlight parsed = parse_flight(text, "F.flight");
  EXPECT_FALSE(parsed.flight.has_value()) << text;
  EXPECT_EQ(parsed.errors.size(), 1u) << text;
  if (parsed.errors.empty()) return "";
  EXPECT_EQ(parsed.errors[0].line, line) << to_string(parsed.errors[0]);
  EXPECT_EQ(parsed.errors[0].file, "F.flight");
  return parsed.errors[0].expected;
}

// Returns a flight with one pose on line 2, then these lines.
std::string with_lines(const std::string& lines) {
  return std::string("flight 1\nat 0 pose lon=0 lat=0 alt=1\n").append(lines);
}

void expect_error(const std::string& text, int line, const std::string& part) {
  const std::string problem = error_of(text, line);
  EXPECT_NE(problem.find(part), std::string::npos) << problem << "\nwanted: " << part;
}

TEST(Flight, ReadsTheDocumentedExample) {
  const ParsedFlight parsed = parse_flight(kExample, "F.flight");
  ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
  EXPECT_TRUE(parsed.errors.empty());
  EXPECT_EQ(*parsed.flight, example());
  EXPECT_EQ(duration_s(*parsed.flight), 20);
}

TEST(Flight, ToleratesLineEndsBlanksCommentsAndByteOrderMark) {
  std::string text = std::string("\xef\xbb\xbf") + "# Flug über das Tal\n\n \t \n" + kExample;
  const Flight wanted = example();
  EXPECT_EQ(parse_flight(text, "").flight, wanted);
  std::string dos;
  for (const char c : text) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(parse_flight(dos, "").flight, wanted);
  text.pop_back();
  EXPECT_EQ(parse_flight(text, "").flight, wanted);
}

TEST(Flight, LeftOutPartsHaveDefaults) {
  const ParsedFlight parsed = parse_flight("flight 1\nat 1.5 pose lat=1 lon=2 alt=-3\n", "");
  ASSERT_TRUE(parsed.flight.has_value());
  EXPECT_EQ(parsed.flight->view, FlightView());
  EXPECT_EQ(parsed.flight->waypoints.at(0), (Waypoint{1.5, 2, 1, -3, false, 0, 0, 0}));
  EXPECT_FALSE(parsed.flight->end_s.has_value());
  EXPECT_EQ(duration_s(*parsed.flight), 1.5);
  EXPECT_EQ(parse_flight("flight 1\nview\nat 0 pose lat=1 lon=2 alt=3\n", "").flight->view, FlightView());
}

TEST(Flight, EndsWithTheLastTimeGiven) {
  EXPECT_EQ(duration_s(*parse_flight(with_lines("at 7 look yaw=1\n"), "").flight), 7);
  EXPECT_EQ(duration_s(*parse_flight(with_lines("at 8 set mode=lit\n"), "").flight), 8);
  EXPECT_EQ(duration_s(*parse_flight(with_lines("at 9 interest lon=0 lat=0 radius=1 levels=-1\n"), "").flight),
            9);
}

TEST(Flight, FirstLineIsTheVersion) {
  expect_error("", 1, "\"flight 1.2\" or \"flight 1.3\", found an empty file");
  expect_error("\n# nothing\n", 2, "found an empty file");
  expect_error("at 0 end\n", 1, "\"flight 1\"");
  expect_error("\nflight 2\n", 2, "reads versions 1 to 1.3), found version 2");
  expect_error("flight 1.4\n", 1, "found version 1.4");
  expect_error("flight 1.10\n", 1, "found version 1.10");
  expect_error("flight 1 2\n", 1, "\"flight 1\"");
  expect_error("flight one\n", 1, "\"flight 1\"");
  expect_error(std::string("\x7f"
                           "ELF\0\0\xff\xfe",
                           8),
               1, "\"flight 1\"");
}

TEST(Flight, BadLinesNameLineAndWhatWasExpected) {
  expect_error("flight 1\n", 1, "at least one pose");
  expect_error(with_lines("go home\n"), 3, "a command: view or at, found \"go\"");
  expect_error(with_lines("at\n"), 3, "at TIME");
  expect_error(with_lines("at 1\n"), 3, "at TIME");
  expect_error(with_lines("at now end\n"), 3, "a time in seconds");
  expect_error(with_lines("at -1 end\n"), 3, "a time in seconds from 0");
  expect_error(with_lines("at nan end\n"), 3, "a time in seconds");
  expect_error(with_lines("at 1e9 end\n"), 3, "a time in seconds");
  expect_error(with_lines("at 1 jump\n"), 3, "pose, look, set, interest or end after the time");
  expect_error(with_lines("\nat 5 look yaw=1\nat 4.999 look yaw=2\n"), 5,
               "5 s or later (times may not run backwards)");
  expect_error(with_lines("at 0 pose lon=1 lat=0 alt=1\n"), 3, "one pose at 0 s");
  expect_error(with_lines("at 1 look yaw=1\nat 1 look yaw=1\n"), 4, "one look at 1 s");
  expect_error(with_lines("at 1 end\nat 2 look yaw=1\n"), 4, "nothing after \"end\"");
  expect_error(with_lines("at 1 end now\n"), 3, "nothing after \"end\"");
  expect_error(with_lines("flight 1\n"), 3, "a command");
}

TEST(Flight, BadPosesAreRefused) {
  const std::string good = "flight 1\nat 0 pose lon=0 lat=0 alt=1 yaw=0 pitch=0 roll=0\n";
  ASSERT_TRUE(parse_flight(good, "").flight.has_value());
  expect_error(replaced(good, "lat=0", "lat=91"), 2, "lat=NUMBER from -90 to 90, found \"91\"");
  expect_error(replaced(good, "lat=0", "lat=nan"), 2, "lat=NUMBER");
  expect_error(replaced(good, "lon=0", "lon=1e3"), 2, "lon=NUMBER from -360 to 360");
  expect_error(replaced(good, "lon=0", "lon="), 2, "lon=NUMBER");
  expect_error(replaced(good, "lon=0", "lon=0,5"), 2, "lon=NUMBER");
  expect_error(replaced(good, "alt=1", "alt=inf"), 2, "alt=NUMBER");
  expect_error(replaced(good, "alt=1", "alt=1 height=1"), 2, "found both");
  expect_error(replaced(good, "alt=1", ""), 2, "found neither");
  expect_error(replaced(good, "alt=1", "height=-1"), 2, "height=NUMBER from 0");
  expect_error(replaced(good, "pitch=0", "pitch=90.001"), 2, "pitch=NUMBER from -90 to 90");
  expect_error(replaced(good, "lon=0", ""), 2, "lon=.. and lat=..");
  expect_error(replaced(good, "lon=0", "lon=0 lon=0"), 2, "lon once");
  expect_error(replaced(good, "yaw", "heading"), 2,
               "keys lon, lat, alt, height, yaw, pitch, roll, found \"heading=0\"");
  EXPECT_FALSE(parse_flight(replaced(good, "yaw=0", "yaw 0"), "").flight.has_value());
}

std::string expected_by(const std::string& text) {
  const ParsedFlight parsed = parse_flight(text, "F");
  return parsed.errors.empty() ? "" : parsed.errors[0].expected;
}

TEST(Flight, BadViewsAreRefused) {
  const auto with_view = [](const std::string& view) {
    return std::string("flight 1\nview ").append(view).append("\nat 0 pose lon=0 lat=0 alt=1\n");
  };
  EXPECT_EQ(expected_by(with_view("fov=179 size=32768x1 fps=1000")), "");
  for (const char* view : {"fov=0",
                           "fov=180",
                           "fov=nan",
                           "fov=-60",
                           "size=0x720",
                           "size=1280x0",
                           "size=100000x100000",
                           "size=1280",
                           "size=1280x720x3",
                           "size=x",
                           "size=-1x-1",
                           "size=1e3x720",
                           "fps=0",
                           "fps=-30",
                           "fps=1001",
                           "fps=0.0001",
                           "fps=30/0",
                           "fps=30/-1",
                           "fps=x",
                           "fps=",
                           "fps=30/1/1",
                           "fps=1.2.3",
                           "fps=nan",
                           "fov=60 fov=60",
                           "size=1x1 size=1x1",
                           "fps=1 fps=1",
                           "zoom=1"}) {
    expect_error(with_view(view), 2, "");
  }
  expect_error("flight 1\nview fov=60\nview fov=60\nat 0 pose lon=0 lat=0 alt=1\n", 3, "one view line");
  expect_error(with_lines("view fov=60\n"), 3, "before the first \"at\"");
}

TEST(Flight, BadSettingsHeadsAndInterestsAreRefused) {
  expect_error(with_lines("at 1 set\n"), 3, "KEY=VALUE");
  expect_error(with_lines("at 1 set mode\n"), 3, "KEY=VALUE");
  expect_error(with_lines("at 1 set mode=shiny\n"), 3, "one of wireframe");
  expect_error(with_lines("at 1 set mod=lit\n"), 3, "did you mean mode, rays.mode?");
  expect_error(with_lines("at 1 set exaggeration=1000\n"), 3, "from 0.1 to 100");
  expect_error(with_lines("at 1 look\n"), 3, "at least one of yaw, pitch, roll");
  expect_error(with_lines("at 1 look pitch=91\n"), 3, "pitch=NUMBER");
  expect_error(with_lines("at 1 look lon=1\n"), 3, "keys yaw, pitch, roll");
  expect_error(with_lines("at 1 interest lon=1 lat=1 radius=1\n"), 3, "lon, lat, radius and levels");
  expect_error(with_lines("at 1 interest lon=1 lat=1 radius=1 levels=0.5\n"), 3, "levels=WHOLE NUMBER");
  expect_error(with_lines("at 1 interest lon=1 lat=1 radius=-1 levels=1\n"), 3, "radius=NUMBER");
}

// Returns a flight of version 1.1 with one pose on line 2, then these lines.
std::string in_1_1(const std::string& lines) {
  return std::string("flight 1.1\nat 0 pose lon=0 lat=0 alt=1\n").append(lines);
}

TEST(Flight, ReadsViewsWithATime) {
  const ParsedFlight parsed =
      parse_flight(in_1_1("at 1 view fov=30 backend=ray eyes=sbs base=2.5 convergence=80 size=640x360\n"
                          "at 1 set mode=lit\n"
                          "at 2 view eyes=off\n"
                          "at 3 view backend=auto base=0\n"
                          "at 4 view backend=voxel\n"),
                   "F");
  ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
  using vpe::core::DrawnBy;
  const std::vector<ViewCommand> wanted{
      {1, {30, ImageSize{640, 360}, DrawnBy::kRay, Eyes{vpe::core::StereoLayout::kSideBySide}, 2.5, 80}},
      {2, {{}, {}, {}, Eyes{}, {}, {}}},
      {3, {{}, {}, DrawnBy::kAuto, {}, 0, {}}},
      {4, {{}, {}, DrawnBy::kRay, {}, {}, {}}}};
  EXPECT_EQ(parsed.flight->views, wanted);
  EXPECT_EQ(duration_s(*parsed.flight), 4);
  EXPECT_EQ(version_of(*parsed.flight), FlightVersion::k1_1);
  EXPECT_EQ(to_text(*parsed.flight).substr(0, 11), "flight 1.1\n");
  EXPECT_EQ(to_line(wanted[0]), "at 1 view fov=30 size=640x360 backend=ray eyes=sbs base=2.5 convergence=80\n");
}

// What does not use a newer version is written as it was before there was one.
TEST(Flight, IsWrittenInTheOldestVersionThatHoldsIt) {
  const std::string old =
      "flight 1\nview fov=60 size=1280x720 fps=30\nat 0 pose lon=0 lat=0 alt=1 yaw=0 pitch=0 roll=0\n";
  for (const char* version : {"flight 1\n", "flight 1.1\n", "flight 1.2\n", "flight 1.3\n"}) {
    const ParsedFlight parsed = parse_flight(version + old.substr(9), "F");
    ASSERT_TRUE(parsed.flight.has_value());
    EXPECT_EQ(to_text(*parsed.flight), old);
  }
}

TEST(Flight, BadViewsWithATimeAreRefused) {
  expect_error(with_lines("at 1 view fov=30\n"), 3, "\"flight 1.1\" as the first command");
  expect_error(in_1_1("at 1 jump\n"), 3, "pose, look, set, interest, view or end after the time");
  expect_error(in_1_1("at 1 view\n"), 3, "at least one of fov, base, convergence, size, backend, eyes");
  expect_error(in_1_1("at 1 view fov=0\n"), 3, "fov=NUMBER from 0.001 to 179, found \"0\"");
  expect_error(in_1_1("at 1 view fov=180\n"), 3, "fov=NUMBER");
  expect_error(in_1_1("at 1 view base=-1\n"), 3, "base=NUMBER from 0 to 1000000000");
  expect_error(in_1_1("at 1 view base=nan\n"), 3, "base=NUMBER");
  expect_error(in_1_1("at 1 view size=0x1\n"), 3, "size=WIDTHxHEIGHT");
  expect_error(in_1_1("at 1 view backend=opengl\n"), 3, "backend=polygon, backend=ray or backend=auto");
  expect_error(in_1_1("at 1 view eyes=2\n"), 3, "eyes=off, eyes=sbs, eyes=ou or eyes=anaglyph, found \"2\"");
  expect_error(in_1_1("at 1 view eyes=\n"), 3, "eyes=off");
  expect_error(in_1_1("at 1 view eyes=off eyes=off\n"), 3, "eyes once");
  expect_error(in_1_1("at 1 view fov=1 fov=1\n"), 3, "fov once");
  expect_error(in_1_1("at 1 view zoom=1\n"), 3,
               "keys fov, base, convergence, size, backend, eyes, found \"zoom=1\"");
  expect_error(in_1_1("at 1 view fps=30\n"), 3, "keys fov, base");
  expect_error(in_1_1("at 1 view fov=30\nat 1 view eyes=off\n"), 4, "one view at 1 s");
  expect_error(in_1_1("at 1 end\nat 2 view fov=30\n"), 4, "nothing after \"end\"");
  expect_error(in_1_1("view fov=30\n"), 3, "before the first \"at\"");
}

// Returns a flight of version 1.2 with one pose on line 2, then these lines.
std::string in_1_2(const std::string& lines) {
  return std::string("flight 1.2\nat 0 pose lon=0 lat=0 alt=1\n").append(lines);
}

TEST(Flight, ReadsObjects) {
  const ParsedFlight parsed =
      parse_flight(in_1_2("at 1 object Curiosity lon=137.4 lat=-4.6 heading=90\n"
                          "at 1 object \"a \\\"b\\\" #\" show=off\n"
                          "at 2 view fov=30\n"
                          "at 3 object Curiosity show=on height=2.5 lat=-4.5 lon=137.5\n"),
                   "F");
  ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
  const std::vector<ObjectCommand> wanted{{1, "Curiosity", vpe::core::ObjectPlace{137.4, -4.6, 0, 90}, {}},
                                          {1, "a \"b\" #", {}, false},
                                          {3, "Curiosity", vpe::core::ObjectPlace{137.5, -4.5, 2.5, {}}, true}};
  EXPECT_EQ(parsed.flight->objects, wanted);
  EXPECT_EQ(duration_s(*parsed.flight), 3);
  EXPECT_EQ(version_of(*parsed.flight), FlightVersion::k1_2);
  EXPECT_EQ(to_text(*parsed.flight).substr(0, 11), "flight 1.2\n");
  EXPECT_EQ(to_line(wanted[0]), "at 1 object Curiosity lon=137.4 lat=-4.6 height=0 heading=90\n");
  EXPECT_EQ(to_line(wanted[1]), "at 1 object \"a \\\"b\\\" #\" show=off\n");
  EXPECT_EQ(to_line(wanted[2]), "at 3 object Curiosity lon=137.5 lat=-4.5 height=2.5 show=on\n");
}

TEST(Flight, BadObjectsAreRefused) {
  expect_error(in_1_1("at 1 object a show=off\n"), 3, "\"flight 1.2\" as the first command");
  expect_error(in_1_2("at 1 jump\n"), 3, "pose, look, set, interest, view, object or end after the time");
  expect_error(in_1_2("at 1 object\n"), 3, "the name of an object, 1 to 200 bytes");
  expect_error(in_1_2("at 1 object \"\" show=on\n"), 3, "the name of an object");
  expect_error(in_1_2("at 1 object " + std::string(201, 'a') + " show=on\n"), 3, "the name of an object");
  expect_error(in_1_2("at 1 object a\n"), 3, "lon=.. and lat=.., or show=on or show=off");
  expect_error(in_1_2("at 1 object a lon=1\n"), 3, "lon=.. and lat=.. of an object");
  expect_error(in_1_2("at 1 object a heading=1 show=on\n"), 3, "lon=.. and lat=.. of an object");
  expect_error(in_1_2("at 1 object a lon=1 lat=91\n"), 3, "lat=NUMBER from -90 to 90");
  expect_error(in_1_2("at 1 object a lon=1 lat=1 height=1e9\n"), 3, "height=NUMBER");
  expect_error(in_1_2("at 1 object a lon=1 lat=1 yaw=1\n"), 3, "keys lon, lat, height, heading, show");
  expect_error(in_1_2("at 1 object a show=yes\n"), 3, "show=on or show=off, found \"yes\"");
  expect_error(in_1_2("at 1 object a show=on show=off\n"), 3, "show once");
  expect_error(in_1_2("at 1 object a show=on\nat 1 object b show=on\nat 1 object a lon=1 lat=1\n"), 5,
               "one line of \"a\" at 1 s");
}

TEST(Flight, QuotesHoldValuesWithBlanks) {
  if (!vpe::core::overlays_refused().empty()) GTEST_SKIP() << vpe::core::overlays_refused();
  const auto text_of = [](const std::string& line) {
    const ParsedFlight parsed = parse_flight(with_lines("at 1 set " + line + "\n"), "F");
    EXPECT_TRUE(parsed.flight.has_value())
        << line << " " << (parsed.errors.empty() ? "" : parsed.errors[0].expected);
    return parsed.flight ? parsed.flight->sets.at(0).text : "";
  };
  EXPECT_EQ(text_of("overlay.title=\"West of it\""), "West of it");
  EXPECT_EQ(text_of("overlay.title=\"  # 1  \"   # a comment"), "  # 1  ");
  EXPECT_EQ(text_of("overlay.title=\"\"#"), "");
  EXPECT_EQ(text_of("overlay.title="), "");
  EXPECT_EQ(text_of("overlay.title=\"a \\\"b\\\" \\\\ \\c=\""), "a \"b\" \\ c=");
  // Only a quote right after the first equals sign begins a quoted value.
  EXPECT_EQ(text_of("overlay.title=5\"x"), "5\"x");
  EXPECT_EQ(text_of("overlay.title=a=\"b\""), "a=\"b\"");
  expect_error(with_lines("at 1 set overlay.title=\"no end\n"), 3, "a closing quote");
  expect_error(with_lines("at 1 set overlay.title=\"end\\\"\n"), 3, "a closing quote");
  expect_error(with_lines("at 1 set overlay.title=\"a\"b\n"), 3, "a blank after a closing quote, found \"b\"");
}

TEST(Flight, AnyTextOfASettingReadsBack) {
  if (!vpe::core::overlays_refused().empty()) GTEST_SKIP() << vpe::core::overlays_refused();
  Random random(8);
  constexpr std::string_view kCharacters = " \"\\#=ab";
  for (int i = 0; i < 2000; ++i) {
    SetCommand set{1, "overlay.title", ""};
    for (int n = random.integer(0, 6); n > 0; --n) {
      set.text +=
          kCharacters[static_cast<std::size_t>(random.integer(0, static_cast<int>(kCharacters.size()) - 1))];
    }
    const ParsedFlight parsed = parse_flight(with_lines(to_line(set)), "F");
    ASSERT_TRUE(parsed.flight.has_value()) << to_line(set);
    ASSERT_EQ(parsed.flight->sets.at(0), set) << to_line(set);
  }
}

TEST(Flight, ReportsEveryBadLineUpToALimit) {
  const ParsedFlight parsed = parse_flight(with_lines("at 1 jump\nat 2 look yaw=1\nat 3 hop\n"), "F");
  ASSERT_EQ(parsed.errors.size(), 2u);
  EXPECT_EQ(parsed.errors[0].line, 3);
  EXPECT_EQ(parsed.errors[1].line, 5);
  EXPECT_EQ(to_string(parsed.errors[1]).rfind("F:5: expected ", 0), 0u);
  std::string many = with_lines("");
  for (int i = 0; i < 1000; ++i) many += "nonsense\n";
  EXPECT_EQ(parse_flight(many, "F").errors.size(), std::size_t{ParsedFlight::kMaxErrors});
}

TEST(Flight, MessagesShowOnlyPrintableText) {
  const ParsedFlight parsed =
      parse_flight(with_lines("\x1b[2J\xff\x01 1\nat 1 set \xc3\x1b=\x02\nat 1 look yaw=\x1b\n"), "F");
  ASSERT_EQ(parsed.errors.size(), 3u);
  for (const FlightError& error : parsed.errors) {
    for (const char c : error.expected) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << error.expected;
  }
}

// Returns a valid setting.
SetCommand random_set(Random& random, double time_s) {
  const auto& list = vpe::core::Settings::list();
  const vpe::core::SettingInfo& info =
      list[static_cast<std::size_t>(random.integer(0, static_cast<int>(list.size()) - 1))];
  if (info.type == vpe::core::SettingType::kChoice) {
    return {time_s, std::string(info.key),
            std::string(info.choices[static_cast<std::size_t>(
                random.integer(0, static_cast<int>(info.choices.size()) - 1))])};
  }
  if (info.key == "palette") return {time_s, "palette", "viridis"};
  if (info.key == "sun")
    return {time_s, "sun", random.integer(0, 1) == 0 ? "2026-11-20T14:00:30.5+02:00" : "Ls90,15:00"};
  return {time_s, std::string(info.key), info.default_text};
}

// Returns a view with at least one member.
ViewState random_view(Random& random) {
  ViewState view;
  const int members = random.integer(1, 63);
  const auto has = [members](int n) { return (members >> n & 1) == 1; };
  if (has(0)) view.fov_deg = random.log_uniform(0.001, 179);
  if (has(1)) {
    const int width = random.integer(1, 32768);
    view.size = ImageSize{width, random.integer(1, 32768)};
  }
  if (has(2)) view.backend = static_cast<vpe::core::DrawnBy>(random.integer(0, 2));
  if (has(3)) {
    const int eyes = random.integer(0, 3);
    view.eyes = Eyes{};
    if (eyes < 3) view.eyes->layout = static_cast<vpe::core::StereoLayout>(eyes);
  }
  if (has(4)) view.eye_base_m = random.integer(0, 3) == 0 ? 0 : random.log_uniform(1e-9, 1e9);
  if (has(5)) view.convergence_m = random.integer(0, 3) == 0 ? 0 : random.log_uniform(1e-9, 1e12);
  return view;
}

ObjectCommand random_object(Random& random, double time_s) {
  const char* names[] = {"rover", "a b", "#1", "say \"x\"", "back\\slash", "tab\there", "lon=1"};
  ObjectCommand command{time_s, names[random.integer(0, 6)], {}, {}};
  if (random.integer(0, 2) > 0) {
    command.place = vpe::core::ObjectPlace{
        random.uniform(-360, 360), random.uniform(-90, 90), random.uniform(-10, 1e4), {}};
    if (random.integer(0, 1) == 0) command.place->heading_deg = random.uniform(-360, 360);
  }
  if (!command.place || random.integer(0, 2) == 0) command.is_shown = random.integer(0, 1) == 1;
  return command;
}

// Adds a line of a relief that may be there already.
void add_relief(Random& random, double time_s, std::vector<ReliefCommand>& to) {
  const char* names[] = {"pit", "a b", "#1", "say \"x\"", "back\\slash", "kind=pad"};
  ReliefCommand line{time_s, names[random.integer(0, 5)], "", {}};
  const bool is_known = std::ranges::any_of(to, [&](const auto& one) { return one.name == line.name; });
  if (!is_known || random.integer(0, 3) == 0) {
    line.keys = "kind=crater lon=" + vpe::base::format_number(random.uniform(-360, 360)) + " lat=-4 radius=20";
  } else if (random.integer(0, 2) > 0) {
    line.keys = "radius=" + vpe::base::format_number(random.log_uniform(0.01, 1e6)) + " mode=min";
  }
  if (line.keys.empty() || random.integer(0, 2) == 0) line.is_shown = random.integer(0, 1) == 1;
  to.push_back(line);
}

Flight random_flight(Random& random) {
  Flight flight;
  flight.view.fov_deg = random.uniform(1, 170);
  flight.view.width = random.integer(1, 32768);
  flight.view.height = random.integer(1, 32768);
  flight.view.fps = *parse_frame_rate(std::to_string(random.integer(1, 60000)) + "/" +
                                      std::to_string(random.integer(60, 1001)));
  double t = random.integer(0, 1) == 0 ? 0 : random.uniform(0, 5);
  const int commands = random.integer(1, 30);
  for (int i = 0; i < commands; ++i) {
    if (i == 0 || random.integer(0, 1) == 0) {
      flight.waypoints.push_back({t, random.uniform(-360, 360), random.uniform(-90, 90),
                                  random.log_uniform(1e-3, 1e9), random.integer(0, 1) == 1,
                                  random.uniform(-360, 360), random.uniform(-90, 90),
                                  random.uniform(-360, 360)});
    }
    if (random.integer(0, 2) == 0) {
      flight.heads.push_back(
          {t, random.uniform(-360, 360), random.uniform(-90, 90), random.uniform(-360, 360)});
    }
    while (random.integer(0, 2) == 0) flight.sets.push_back(random_set(random, t));
    if (random.integer(0, 3) == 0) {
      flight.interests.push_back({t,
                                  {random.uniform(-360, 360), random.uniform(-90, 90), random.uniform(0, 1e6),
                                   random.integer(-30, 30)}});
    }
    if (random.integer(0, 3) == 0) flight.views.push_back({t, random_view(random)});
    if (random.integer(0, 3) == 0) flight.objects.push_back(random_object(random, t));
    if (random.integer(0, 3) == 0) add_relief(random, t, flight.reliefs);
    if (random.integer(0, 3) == 0)
      flight.patches.push_back({t, random.integer(0, 1) == 0 ? "a b.vpe" : "#.tif", random.uniform(0, 1)});
    t += random.log_uniform(1e-9, 100);
  }
  if (random.integer(0, 1) == 0) flight.end_s = t;
  return flight;
}

TEST(FlightProperty, TextReadsBackTheSameFlight) {
  Random random(6);
  for (int i = 0; i < 2000; ++i) {
    const Flight flight = random_flight(random);
    const ParsedFlight parsed = parse_flight(to_text(flight), "F");
    ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
    ASSERT_EQ(*parsed.flight, flight);
    ASSERT_EQ(to_text(*parsed.flight), to_text(flight));
  }
}

TEST(FlightProperty, AnyTextGivesAFlightOrErrors) {
  Random random(7);
  int flights = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string text = to_text(random_flight(random));
    for (int edits = random.integer(0, 3); edits > 0; --edits) {
      const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1));
      switch (random.integer(0, 3)) {
        case 0: text[at] = static_cast<char>(random.integer(0, 255)); break;
        case 1: text.erase(at, static_cast<std::size_t>(random.integer(1, 20))); break;
        case 2:
          text.insert(at, text.substr(static_cast<std::size_t>(random.integer(0, static_cast<int>(at))), 30));
          break;
        default: text.insert(at, "=# \n\t-9e"); break;
      }
      text.push_back(' ');
    }
    const ParsedFlight parsed = parse_flight(text, "F");
    ASSERT_NE(parsed.flight.has_value(), !parsed.errors.empty());
    if (parsed.flight) {
      ++flights;
      ASSERT_EQ(parse_flight(to_text(*parsed.flight), "F").flight, parsed.flight) << text;
    }
  }
  EXPECT_GT(flights, 400);
  EXPECT_LT(flights, 3600);
}

TEST(FrameRate, ReadsWholeRationalAndDecimalRates) {
  EXPECT_EQ(parse_frame_rate("30"), (FrameRate{30, 1}));
  EXPECT_EQ(parse_frame_rate("30000/1001"), (FrameRate{30000, 1001}));
  EXPECT_EQ(parse_frame_rate("60/2"), (FrameRate{30, 1}));
  EXPECT_EQ(parse_frame_rate("29.97"), (FrameRate{2997, 100}));
  EXPECT_EQ(parse_frame_rate("0.5"), (FrameRate{1, 2}));
  EXPECT_EQ(to_text(FrameRate{30000, 1001}), "30000/1001");
  EXPECT_EQ(to_text(FrameRate{25, 1}), "25");
  for (const char* text :
       {"", "0", "30 ", "+30", "30/", "/30", "30.", ".", "1e2", "29.9700001", "99999999999"}) {
    EXPECT_FALSE(parse_frame_rate(text).has_value()) << text;
  }
}

TEST(FrameRate, FramesAreAtExactlyKOverRate) {
  const FrameRate whole{30, 1};
  for (std::int64_t k = 0; k < 100000; ++k) ASSERT_EQ(frame_time(whole, k), static_cast<double>(k) / 30.0);
  // 80-bit arithmetic is the oracle: the nearest double of the exact quotient.
  const FrameRate ntsc{30000, 1001};
  for (std::int64_t k = 0; k < 100000; ++k) {
    const auto exact = static_cast<long double>(k * 1001) / 30000.0L;
    ASSERT_EQ(frame_time(ntsc, k), static_cast<double>(exact));
  }
}

TEST(FrameRate, CountIsRoundedAndInverseToTheTimeOfTheEnd) {
  EXPECT_EQ(frame_count({30, 1}, 20), 600);
  EXPECT_EQ(frame_count({30, 1}, 60), 1800);
  EXPECT_EQ(frame_count({30, 1}, 0), 0);
  EXPECT_EQ(frame_count({30, 1}, 0.016), 0);
  EXPECT_EQ(frame_count({30, 1}, 0.017), 1);
  EXPECT_EQ(frame_count({30000, 1001}, 10), 300);
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    const FrameRate rate = *parse_frame_rate(std::to_string(random.integer(1001, 120000)) + "/1001");
    const std::int64_t frames = random.integer(0, 1000000);
    ASSERT_EQ(frame_count(rate, frame_time(rate, frames)), frames);
  }
}

TEST(Flight, ExamplesCanBeFlown) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(VPE_SOURCE_DIR "/scripts/flights")) {
    std::ifstream stream(entry.path(), std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    const ParsedFlight parsed = parse_flight(text.str(), entry.path().string());
    for (const FlightError& error : parsed.errors) ADD_FAILURE() << to_string(error);
    ++files;
    if (!parsed.flight) continue;
    for (const double terrain_m : {-5000.0, 0.0}) {
      const auto terrain = [&](mars::LonLat, double x) { return x * terrain_m; };
      const Path path(*parsed.flight, mars::kMarsRadius_m, terrain);
      EXPECT_GE(path.duration_s(), 3.0) << entry.path();
      // One flies past objects, just above the ground.
      const double least_m = entry.path().stem() == "gale-objects" ? 2.0 : 2500.0;
      EXPECT_GE(lowest_clearance(path, parsed.flight->view.fps, terrain)->height_m, least_m) << entry.path();
    }
  }
  EXPECT_GE(files, 3);
}

}  // namespace
}  // namespace scripts
