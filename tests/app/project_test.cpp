// Tests of `vpe explore` with a project file: faults are told before a window opens.
#include <gtest/gtest.h>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

class ProjectTest : public AppTest {};

TEST_F(ProjectTest, BadProjectsAreToldByLine) {
  write_text(path("bad.vpeproj"), "format = 1\nplanets = \"mars.vpe\"\n[view]\nfov_deg = \"wide\"\n");
  expect_failure({"explore", path("bad.vpeproj")}, 1,
                 {"bad.vpeproj:2: unknown key \"planets\"", "bad.vpeproj:4: fov_deg: expected a number"});
  write_text(path("newer.vpeproj"), "format = 7\n");
  expect_failure({"explore", path("newer.vpeproj")}, 1, {"newer.vpeproj:1: expected format = 1, found \"7\""});
  write_text(path("binary.vpeproj"), std::string("\x89PNG\0\xff", 6));
  expect_failure({"explore", path("binary.vpeproj")}, 1, {"binary.vpeproj:", "not TOML"});
}

TEST_F(ProjectTest, MissingFilesAreNamed) {
  expect_failure({"explore", path("none.vpeproj")}, 1, {"none.vpeproj", "No such file"});
}

}  // namespace
}  // namespace app_test
