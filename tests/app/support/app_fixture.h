// Fixture that runs vpe in a temporary folder, with a cache of its own and a small planet.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/app/support/process.h"
#include "tests/support/support.h"

namespace app_test {

using Words = std::vector<std::string>;

struct Dem {
  int width = 180;
  int height = 90;
  bool georeference = true;
  double west_deg = -180;
  double north_deg = 90;
  double cell_deg = 2;
  std::optional<double> no_data;
  double radius_m = 3396190;
  std::function<double(int column, int row)> height_m;  // empty: hills of some kilometres
};

// Writes a GeoTIFF on the sphere of Mars: Float32 where height_m is given, else Int16.
void write_dem(const std::filesystem::path& path, const Dem& dem = {});

void write_text(const std::filesystem::path& path, const std::string& text);
std::string read_text(const std::filesystem::path& path);

// Changes bytes in the middle of every payload of a planet file's table ("heights", "mesh"). Checksums stay.
void damage_payloads(const std::filesystem::path& planet, const std::string& table);

// Checks that a message contains every part: what failed, which file, why, what to do.
::testing::AssertionResult says(const std::string& message, const Words& parts);

class AppTest : public ::testing::Test {
 protected:
  // Runs vpe in dir_, without the user's files and variables.
  Result vpe(const Words& arguments, const std::string& input = "") const;
  Command command_for(const Words& arguments) const;

  // Expects this exit code, a message of these parts on stderr, and nothing on stdout.
  void expect_failure(const Words& arguments, int exit_code, const Words& parts) const;

  // Returns a planet of 6 tiles of hills with posts about 42 km apart, made once per process.
  static const std::filesystem::path& planet();

  // Returns the files in dir_ that only unfinished work leaves.
  std::vector<std::string> leftovers() const;
  bool exists(const std::string& name) const { return std::filesystem::exists(dir_ / name); }
  std::string path(const std::string& name) const { return (dir_ / name).string(); }

  test_support::TempDir dir_;
};

// Parses the whole text as JSON. Fails the test when it is not.
nlohmann::json parse_json(const std::string& text);

// Returns a flight of two seconds at 10 frames/s over the planet.
std::string small_flight(const std::string& view = "fov=50 size=96x54 fps=10");

}  // namespace app_test
