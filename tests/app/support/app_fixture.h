// vpe in a folder of its own, with a cache of its own, and a small planet.
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
  std::function<double(int column, int row)> height_m;  // left out: hills of some kilometres
};

// An Int16 or, where height_m is given, Float32 GeoTIFF on the sphere of Mars.
void write_dem(const std::filesystem::path& path, const Dem& dem = {});

void write_text(const std::filesystem::path& path, const std::string& text);
std::string read_text(const std::filesystem::path& path);

// Other bytes in the middle of every payload of a planet file's table ("heights", "mesh"), its checksums as before.
void damage_payloads(const std::filesystem::path& planet, const std::string& table);

// Every part of a message that must be there: what, which file, why, what to do.
::testing::AssertionResult says(const std::string& message, const Words& parts);

class AppTest : public ::testing::Test {
 protected:
  // Runs in dir_ with nothing of the user's.
  Result vpe(const Words& arguments, const std::string& input = "") const;
  Command command_for(const Words& arguments) const;

  // Exit code, a message of these parts on stderr, nothing on stdout.
  void expect_failure(const Words& arguments, int exit_code, const Words& parts) const;

  // A planet of 6 tiles of hills with posts about 42 km apart, made once for the whole program.
  static const std::filesystem::path& planet();

  // Files in dir_ that only unfinished work has.
  std::vector<std::string> leftovers() const;
  bool exists(const std::string& name) const { return std::filesystem::exists(dir_ / name); }
  std::string path(const std::string& name) const { return (dir_ / name).string(); }

  test_support::TempDir dir_;
};

// The whole text as JSON; fails the test otherwise.
nlohmann::json parse_json(const std::string& text);

// Flight of two seconds at 10 frames/s over the planet.
std::string small_flight(const std::string& view = "fov=50 size=96x54 fps=10");

}  // namespace app_test
