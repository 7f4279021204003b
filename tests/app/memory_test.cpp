// --memory bounds the memory that a build uses for its sources.
#include "tests/app/support/app_fixture.h"
#include "tests/support/sanitized.h"

namespace app_test {
namespace {

class Memory : public AppTest {};

TEST_F(Memory, BoundsTheRastersOfABuild) {
  Dem dem;
  dem.width = 6144;
  dem.height = 3072;
  dem.cell_deg = 360.0 / dem.width;
  dem.height_m = [](int column, int row) { return (column * 7 + row * 13) % 1000; };
  write_dem(dir_ / "x.tif", dem);
  std::int64_t peak[2] = {};
  std::string identity[2];
  for (const int n : {0, 1}) {
    Command command = command_for({"build", "x.tif", "-o", "x.vpe", "--base-spacing", "60000", "--spacing",
                                   "60000", "--threads", "2", "--json", "--memory", n == 0 ? "64" : "1024"});
    const Result result = run(command);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    peak[n] = result.peak_bytes;
    identity[n] = parse_json(result.out)["identity"];
  }
  EXPECT_EQ(identity[0], identity[1]);
  // The check reads all of the raster: 75 MB decoded, and as much in GDAL's blocks, where there is room.
  if (!test_support::kIsSanitized) {
    EXPECT_LT(peak[0] + (20 << 20), peak[1]);
  }
  RecordProperty("peak_small", std::to_string(peak[0]));
  RecordProperty("peak_large", std::to_string(peak[1]));
}

}  // namespace
}  // namespace app_test
