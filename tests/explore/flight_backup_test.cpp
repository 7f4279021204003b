// Tests of the copies of flights with unsaved changes.
#include "vpe/explore/flight_backup.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "mars/geodesy/bodies.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"
#include "vpe/base/temporary.h"

namespace vpe::explore {
namespace {

namespace fs = std::filesystem;

constexpr double kRadius_m = 3396190;

scripts::Flight one_pose() {
  scripts::Flight flight;
  scripts::Waypoint waypoint;
  waypoint.lon_deg = 10;
  waypoint.up_m = 5000;
  flight.waypoints = {waypoint};
  return flight;
}

scripts::Waypoint at(double lon_deg) {
  scripts::Waypoint waypoint;
  waypoint.lon_deg = lon_deg;
  waypoint.up_m = 5000;
  return waypoint;
}

std::string content(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = base::read_file(file, 1 << 20);
  return {bytes.begin(), bytes.end()};
}

TEST(FlightBackup, IsThereWhileChangesAreUnsaved) {
  const test_support::TempDir folder;
  FlightBackup backup(folder / "state");
  FlightEditor editor(one_pose(), kRadius_m);
  EXPECT_EQ(backup.update(nullptr), "");
  EXPECT_EQ(backup.update(&editor), "");
  EXPECT_FALSE(fs::exists(backup.file()));
  ASSERT_EQ(editor.append(at(11), 1000), "");
  EXPECT_EQ(backup.update(&editor), "");
  EXPECT_EQ(content(backup.file()), editor.to_text());
  ASSERT_EQ(editor.append(at(12), 1000), "");
  EXPECT_EQ(backup.update(&editor), "");
  EXPECT_EQ(content(backup.file()), editor.to_text());
  editor.mark_saved();
  EXPECT_EQ(backup.update(&editor), "");
  EXPECT_FALSE(fs::exists(backup.file()));
  editor.undo();
  EXPECT_EQ(backup.update(&editor), "");
  EXPECT_TRUE(fs::exists(backup.file()));
  editor.redo();
  EXPECT_EQ(backup.update(&editor), "");
  EXPECT_FALSE(fs::exists(backup.file()));
  ASSERT_EQ(editor.append(at(13), 1000), "");
  EXPECT_EQ(backup.update(&editor), "");
  EXPECT_EQ(backup.update(nullptr), "");  // the flight was removed
  EXPECT_FALSE(fs::exists(backup.file()));
}

TEST(FlightBackup, KeepsNothingWithoutAFolderAndReportsOnceWhereItCannot) {
  const test_support::TempDir folder;
  FlightEditor editor(one_pose(), kRadius_m);
  editor.mark_unsaved();
  FlightBackup none{fs::path()};
  EXPECT_EQ(none.update(&editor), "");
  EXPECT_TRUE(none.abandoned().empty());
  std::ofstream(folder / "file") << "no folder";
  FlightBackup backup(folder / "file");
  EXPECT_NE(backup.update(&editor).find("unsaved flight"), std::string::npos);
  EXPECT_EQ(backup.update(&editor), "");
}

// The copy of a process that was killed is found by the next one, and is then that one's own.
TEST(FlightBackup, OutlivesItsProgram) {
  const test_support::TempDir folder;
  const pid_t child = fork();
  if (child == 0) {
    FlightBackup backup(folder.path());
    FlightEditor editor(one_pose(), kRadius_m);
    editor.mark_unsaved();
    const bool done = backup.update(&editor).empty();
    if (!done) _exit(1);
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  std::ofstream(folder / "unsaved.flight") << "of no program";
  std::ofstream(folder / "unsaved-notes.flight") << "of somebody else";
  FlightBackup backup(folder.path());
  std::ofstream(folder / ("unsaved" + base::process_mark() + ".flight")) << "of a living program";
  std::ofstream(folder / "unsaved.another-machine-12.flight") << "of a living program there";
  const std::vector<fs::path> found = backup.abandoned();
  ASSERT_EQ(found.size(), 1U);
  const std::string text = content(found.front());
  EXPECT_EQ(text, FlightEditor(one_pose(), kRadius_m).to_text());
  backup.adopt(found.front());
  EXPECT_TRUE(backup.abandoned().empty());
  EXPECT_EQ(content(backup.file()), text);
  FlightEditor editor(one_pose(), kRadius_m);
  EXPECT_EQ(backup.update(&editor), "");  // it is saved elsewhere
  EXPECT_FALSE(fs::exists(backup.file()));
}

}  // namespace
}  // namespace vpe::explore
