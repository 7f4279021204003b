#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "objects/files/scene_file.h"
#include "tests/objects/files/scene_texts.h"
#include "vpe/base/quote.h"
#include "vpe/base/toml_fault.h"

namespace objects {
namespace {

using namespace test;

TEST(SceneToml, MessagesNameLineValueAndWhatIsAllowed) {
  const std::string object = kModel + "[[object]]\nmodel = \"m\"\n";  // 4 + 2 lines
  const std::string at = object + "lon = 0\nlat = 0\n";
  const std::string scatter = kModel + "[[scatter]]\nmodels = [\"m\"]\npolygon = [[0, 0], [1, 0], [0, 1]]\n";
  const std::string rocks = scatter + "rock_abundance = 0.1\n";
  const std::string path = kModel + "[[path]]\nmodel = \"m\"\n";
  const std::string long_name(201, 'x');
  const std::string name_rule = "expected a text of 1 to 200 bytes without control characters, found ";
  const std::string form = "expected a list of [lon, lat] or [lon, lat, heading], found ";
  struct Case {
    std::string text;
    int line;
    std::string what;
  };
  const std::vector<Case> cases{
      {"", 1, "version is missing; expected version = 1"},
      {"\nversion = 2", 2, "version: expected an integer in [1, 1], found 2"},
      {"version = 1.0", 1, "version: expected an integer in [1, 1], found 1"},
      {"version = 1\nmodle = 3", 2,
       "unknown key \"modle\" in the file; keys are version, model, volume, object, scatter, path, picture and kiosk"},
      {"version = 1\nmodel = 3", 2, "model: expected tables [[model]], found 3"},
      {"version = 1\nmodel = [1]", 2, "model: expected tables [[model]], found 1"},
      {"version = 1\n[model]", 2, "model: expected tables [[model]], found a table"},
      {"version = 1\n[[model]]\nnam = 'a'", 3,
       "unknown key \"nam\" in [[model]]; keys are name, file, unit_m and up"},
      {"version = 1\n[[model]]\nfile = 'a'", 2, "name is missing in [[model]]"},
      {"version = 1\n[[model]]\nname = 'a'", 2, "file is missing in [[model]]"},
      {"version = 1\n[[model]]\nname = ''", 3, "name: " + name_rule + "\"\""},
      {"version = 1\n[[model]]\nname = \"a\\tb\"", 3, "name: " + name_rule + "\"a?b\""},
      {"version = 1\n[[model]]\nname = '" + long_name + "'", 3,
       "name: " + name_rule + "\"" + std::string(40, 'x') + "...\""},
      {"version = 1\n[[model]]\nname = 7", 3, "name: expected a text, found 7"},
      {"version = 1\n[[model]]\nname = 'a'\nfile = ''", 4,
       "file: expected a text of 1 to 4096 bytes without control characters, found \"\""},
      {"version = 1\n[[model]]\nname = 'a'\nfile = \"b\\u0000\"", 4,
       "file: expected a text of 1 to 4096 bytes without control characters, found \"b?\""},
      {kModel + "unit_m = 0", 5, "unit_m: expected a number in (0, 1000000], found 0"},
      {kModel + "unit_m = 'x'", 5, "unit_m: expected a number in (0, 1000000], found \"x\""},
      {kModel + "up = 'x'", 5, "up: expected auto, y or z, found \"x\""},
      {kModel + "up = 07:32:00", 5, "expected a number, a text, a list or true or false, not a date or time"},
      {kModel + "up = 1979-05-27", 5, "expected a number, a text, a list or true or false, not a date or time"},
      {kModel + "[[model]]\nname = \"m\"\nfile = \"b\"", 6, "there are two models \"m\""},
      {object + "lon = 0", 5, "lat is missing in [[object]]"},
      {object + "lat = 0", 5, "lon is missing in [[object]]"},
      {kModel + "[[object]]\nlon = 0", 5, "model is missing in [[object]]"},
      {kModel + "[[object]]\nmodel = 'q'", 6, "there is no [[model]] with the name \"q\""},
      {kModel + "[[object]]\nmodel = true", 6, "model: expected the name of a model, found true"},
      {at + "colour = 1", 9,
       "unknown key \"colour\" in [[object]]; keys are name, model, lon, lat, at, height, altitude, heading, pitch, roll, scale, align, interest_levels, ground, voxel_m and solid_above"},
      {object + "lat = 0\nlon = 361", 8, "lon: expected a number in [-360, 360], found 361"},
      {object + "lon = 0\nlat = -90.5", 8, "lat: expected a number in [-90, 90], found -90.5"},
      {object + "lon = 0\nlat = nan", 8, "lat: expected a number in [-90, 90], found nan"},
      {object + "lat = 0\nlon = inf", 8, "lon: expected a number in [-360, 360], found inf"},
      {object + "lat = 0\nlon = -inf", 8, "lon: expected a number in [-360, 360], found -inf"},
      {at + "height = 2e9", 9, "height: expected a number in [-1000000, 1000000000], found 2000000000"},
      {at + "altitude = -2e6", 9, "altitude: expected a number in [-1000000, 1000000000], found -2000000"},
      {at + "height = 1\naltitude = 1", 10, "expected altitude or height, not both"},
      {at + "heading = 400", 9, "heading: expected a number in [-360, 360], found 400"},
      {at + "pitch = nan", 9, "pitch: expected a number in [-360, 360], found nan"},
      {at + "roll = -361", 9, "roll: expected a number in [-360, 360], found -361"},
      {at + "scale = 0.0", 9, "scale: expected a number in (0, 1000000], found 0"},
      {at + "scale = -1", 9, "scale: expected a number in (0, 1000000], found -1"},
      {at + "scale = 1e7", 9, "scale: expected a number in (0, 1000000], found 10000000"},
      {at + "scale = 9223372036854775807", 9,
       "scale: expected a number in (0, 1000000], found 9223372036854775807"},
      {at + "align = 'up'", 9, "align: expected vertical or slope, found \"up\""},
      {at + "ground = 'fill'", 9, "ground: expected add or cut, found \"fill\""},
      {at + "voxel_m = 1", 9,
       "voxel_m is for objects that are part of the ground; add ground = \"add\" or \"cut\""},
      {at + "solid_above = 1", 9,
       "solid_above is for objects that are part of the ground; add ground = \"add\" or \"cut\""},
      {at + "ground = 'cut'\nvoxel_m = 0", 10, "voxel_m: expected a number in [0.001, 100000], found 0"},
      {at + "ground = 'add'\nsolid_above = 1", 10,
       "solid_above is for volumes, and \"m\" is none; leave it out"},
      {at + "interest_levels = 17", 9, "interest_levels: expected a number in [0, 16], found 17"},
      {at + "name = ''", 9, "name: " + name_rule + "\"\""},
      {at + "at = [[1, 2]]", 9, "expected at, or lon and lat, not both"},
      {object + "at = []", 7, "at: " + form + "a list of 0"},
      {object + "at = 3", 7, "at: " + form + "3"},
      {object + "at = [[1, 2],\n[1]]", 8, "at: expected [lon, lat] or [lon, lat, heading], found a list of 1"},
      {object + "at = [[1, 2],\n[1, 2, 3, 4]]", 8,
       "at: expected [lon, lat] or [lon, lat, heading], found a list of 4"},
      {object + "at = [[1, 2],\n{a = 1}]", 8, "at: expected [lon, lat] or [lon, lat, heading], found a table"},
      {object + "at = [[1, 2],\n[1, 91]]", 8, "lat: expected a number in [-90, 90], found 91"},
      {object + "at = [[1, 2],\n[true, 1]]", 8, "lon: expected a number in [-360, 360], found true"},
      {object + "at = [[1, 2, nan]]", 7, "heading: expected a number in [-360, 360], found nan"},
      {rocks, 5, "diameter_m is missing in [[scatter]]"},
      {rocks + "diameter_m = 3", 9, "diameter_m: expected [least, most], found 3"},
      {rocks + "diameter_m = [0, 3]", 9, "diameter_m: expected a number in [0.001, 100000], found 0"},
      {rocks + "diameter_m = [1, inf]", 9, "diameter_m: expected a number in [0.001, 100000], found inf"},
      {rocks + "diameter_m = [2, 1]", 9, "diameter_m: expected [least, most], found the larger one first"},
      {rocks + "diameter_m = [1, 1]", 9, "diameter_m: expected two diameters for rock_abundance, found one"},
      {rocks + "diameter_m = [1, 2]\nburied = 1.5", 10, "buried: expected a number in [0, 1], found 1.5"},
      {rocks + "diameter_m = [1, 2]\ntumble = 1", 10, "tumble: expected true or false, found 1"},
      {rocks + "diameter_m = [1, 2]\nmost = 0", 10, "most: expected an integer in [1, 1000000], found 0"},
      {rocks + "diameter_m = [1, 2]\nseed = -1", 10,
       "seed: expected an integer in [0, 9223372036854775807], found -1"},
      {rocks + "diameter_m = [1, 2]\nsize = 1", 10,
       "unknown key \"size\" in [[scatter]]; keys are name, models, polygon, seed, density_per_m2, exponent, rock_abundance, diameter_m, buried, align, tumble and most"},
      {scatter + "rock_abundance = 0", 8, "rock_abundance: expected a number in [0.001, 1], found 0"},
      {scatter + "density_per_m2 = 0\nexponent = 2", 8,
       "density_per_m2: expected a number in (0, 1000000], found 0"},
      {scatter + "density_per_m2 = 1\nexponent = -2", 9, "exponent: expected a number in [0, 20], found -2"},
      {scatter + "density_per_m2 = 1", 5, "exponent is missing in [[scatter]]"},
      {scatter, 5, "expected rock_abundance, or density_per_m2 and exponent, in [[scatter]]"},
      {rocks + "exponent = 1", 5, "expected rock_abundance, or density_per_m2 and exponent, in [[scatter]]"},
      {kModel + "[[scatter]]\nmodels = []", 6, "models: expected a list of names of models, found a list of 0"},
      {kModel + "[[scatter]]\nmodels = 'm'", 6, "models: expected a list of names of models, found \"m\""},
      {kModel + "[[scatter]]\nmodels = ['m', 'n']", 6, "there is no [[model]] with the name \"n\""},
      {kModel + "[[scatter]]\nmodels = ['m']", 5, "polygon is missing in [[scatter]]"},
      {kModel + "[[scatter]]\nmodels = ['m']\npolygon = [[0, 0], [1, 1]]", 7,
       "polygon: expected 3 to 2000 corners [lon, lat], found a list of 2"},
      {kModel + "[[scatter]]\nmodels = ['m']\npolygon = [[0, 0], [1, 1], [2, 2, 2]]", 7,
       "polygon: expected [lon, lat], found a list of 3"},
      {kModel + "[[scatter]]\nmodels = ['m']\npolygon = [[0, 0], [1, 1], [2, -91]]", 7,
       "lat: expected a number in [-90, 90], found -91"},
      {path, 5, "points is missing in [[path]]"},
      {path + "points = []", 7,
       "points: expected a list of [seconds, lon, lat], then heading and height if wanted, found a list of 0"},
      {path + "points = [[0, 0]]", 7,
       "points: expected [seconds, lon, lat], then heading and height if wanted, found a list of 2"},
      {path + "points = [[inf, 0, 0]]", 7,
       "time: expected a number in [-1000000000000, 1000000000000], found inf"},
      {path + "points = [[0, 0, 0],\n[0, 1, 1]]", 8,
       "time: expected a later one than that of the point before, found 0"},
      {path + "points = [[0, 0, 0, 'way']]", 7, "heading: expected a number in [-360, 360], found \"way\""},
      {path + "points = [[0, 0, 0, 'up', 1]]", 7, "heading: expected a number in [-360, 360], found \"up\""},
      {path + "points = [[0, 0, 0, 'way', 1e99]]", 7,
       "height: expected a number in [-1000000, 1000000000], found 1e+99"},
      {path + "points = [[0, 0, 0, 999]]", 7, "heading: expected a number in [-360, 360], found 999"},
      {path + "wheelbase_m = 1", 5, "track_m is missing in [[path]]"},
      {path + "track_m = 1", 5, "wheelbase_m is missing in [[path]]"},
      {path + "wheelbase_m = 0\ntrack_m = 1", 7, "wheelbase_m: expected a number in (0, 10000], found 0"},
      {path + "speed = 1", 7,
       "unknown key \"speed\" in [[path]]; keys are name, model, points, scale, wheelbase_m and track_m"},
      {"version = 1\nname = \"\"\"\n\"\"\"", 2, "expected a text on one line"},
      {"\xef\xbb\xbf[+]", 1, "expected the name of a table in the brackets"},
      {"version = 1\n [ [?x]]", 2, "expected the name of a table in the brackets"},
      {"version = 1\n[[\n]]", 2, "expected the name of a table in the brackets"},
      {"version = 1\n\xc3\xa9 = 1", 2, "expected letters of ASCII outside of texts and comments"},
      {"version = 1\n[[\xc3\xa9]]", 2, "expected the name of a table in the brackets"},
      {"version = 1\n[m\xc3\xa9]", 2, "expected letters of ASCII outside of texts and comments"},
      {"version = 1\nx = [1, }", 2, "expected brackets in pairs"},
      {"version = 1\nx = ]", 2, "expected brackets in pairs"},
      {"version = 1\na.a.a.a.a.a.a.a.a.a.a = 1", 2, "expected keys with fewer dots"},
      {"version = 1\n\"a,\".'b'.a = 1", 2, "expected a separator before the quotation mark"},
      {"version = 1\nx = [1, 30'\xc3\xa9']", 2, "expected a separator before the quotation mark"},
      {"version = 1\nx = 30'\xc3\xa9'", 2, "expected a separator before the quotation mark"},
  };
  for (const Case& one : cases) {
    std::string what = one.what;
    // What the library does not survive is quoted.
    if (const vpe::base::TomlFault fault = vpe::base::hostile_toml(one.text); fault.line != 0) {
      std::istringstream lines(one.text);
      std::string line;
      for (int n = 0; n < one.line; ++n) std::getline(lines, line);
      what = (fault.is_toml ? "" : "not TOML: ") + what + ", found " + vpe::base::quote_text(line);
    }
    EXPECT_EQ(toml_error(one.text), "/scenes/a.scene.toml:" + std::to_string(one.line) + ": " + what)
        << one.text;
  }
}

TEST(SceneToml, SyntaxErrorsNameTheLine) {
  for (const std::string text :
       {"version = 1\n[[model", "version = 1\nversion = 1", "version = 1\na = {", "version = 1\nx = \"\xff\"",
        "version = 1\nx = 1e999999", "version = 1\nx = 99999999999999999999"}) {
    EXPECT_TRUE(toml_error(text).starts_with("/scenes/a.scene.toml:2: ")) << toml_error(text);
  }
}

TEST(SceneToml, ThereIsALimitOfInstances) {
  std::string text = kModel + "[[object]]\nmodel = \"m\"\nat = [";
  for (std::size_t n = 0; n < kMostInstances; ++n) text += "[0,0],";
  EXPECT_EQ(toml_error(text + "]\n[[path]]\nmodel = \"m\"\npoints = [[0, 0, 0]]"),
            "/scenes/a.scene.toml:8: expected at most 1000000 instances in all");
  EXPECT_EQ(toml_error(text + "[0,0]]"), "/scenes/a.scene.toml:7: expected at most 1000000 instances in all");
}

TEST(SceneToml, HugeFilesAreRefused) {
  EXPECT_EQ(toml_error(std::string(kMostSceneFileBytes + 1, ' ')),
            "/scenes/a.scene.toml:1: expected at most 64 MiB");
  EXPECT_EQ(toml_error("version = [" + std::string(10'000'001, ',')),
            "/scenes/a.scene.toml:1: expected at most 10000000 values");
  EXPECT_FALSE(is_read(toml, "version = " + std::string(1'000'000, '[')));
  std::string deep = "version = 1\nx = ";
  for (int n = 0; n < 100'000; ++n) deep += "{a=";
  EXPECT_FALSE(is_read(toml, deep));
  std::string dots = "version = 1\na";
  for (int n = 0; n < 1'000'000; ++n) dots += ".a";
  EXPECT_FALSE(is_read(toml, dots + " = 1"));
  std::string both = "version = 1\nx = ";
  for (int n = 0; n < 300; ++n) both += "{a.a.a.a.a.a.a.a.a = [";
  EXPECT_FALSE(is_read(toml, both));
}

}  // namespace
}  // namespace objects
