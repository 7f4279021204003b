// What an appearance takes from a planet file, and the flag of imagery with its own light in it.
#include "paging/planet/planet_look.h"

#include <gtest/gtest.h>

#include "tests/paging/forged_planet.h"
#include "tests/paging/planet_fixture.h"

namespace {

using paging::PlanetMeta;
using vpe::core::Appearance;
using vpe::core::Light;
using vpe::core::Mode;

mars::SourceInfo image(bool has_own_light) {
  mars::SourceInfo info;
  info.name = has_own_light ? "photo" : "mosaic";
  info.has_own_light = has_own_light;
  return info;
}

Light light_of(const PlanetMeta& meta, Mode mode, Light asked = Light::kAuto) {
  Appearance appearance;
  appearance.mode = mode;
  appearance.light = asked;
  paging::fit_to_planet(appearance, meta);
  const Appearance once = appearance;
  paging::fit_to_planet(appearance, meta);
  EXPECT_EQ(appearance, once);
  return appearance.light;
}

TEST(PlanetLook, AllImageryMustHaveItsOwnLight) {
  EXPECT_FALSE(paging::have_own_light({}));
  EXPECT_FALSE(paging::have_own_light({image(false)}));
  EXPECT_TRUE(paging::have_own_light({image(true)}));
  EXPECT_TRUE(paging::have_own_light({image(true), image(true)}));
  EXPECT_FALSE(paging::have_own_light({image(true), image(false)}));
}

TEST(PlanetLook, LightFollowsTheImagery) {
  PlanetMeta meta;
  meta.image_sources = {image(true)};
  EXPECT_EQ(light_of(meta, Mode::kTextured), Light::kOn);  // no tile of it
  meta.finest_image_level = 2;
  EXPECT_EQ(light_of(meta, Mode::kTextured), Light::kOff);
  EXPECT_EQ(light_of(meta, Mode::kTextured, Light::kOn), Light::kOn);
  EXPECT_EQ(light_of(meta, Mode::kLit), Light::kOn);
  EXPECT_EQ(light_of(meta, Mode::kLit, Light::kOff), Light::kOff);
  EXPECT_EQ(light_of(meta, Mode::kColoured), Light::kOn);  // elevation
  meta.image_sources.push_back(image(false));
  EXPECT_EQ(light_of(meta, Mode::kTextured), Light::kOn);
}

TEST(PlanetLook, SkyAndPaletteFollowTheBody) {
  PlanetMeta meta;
  meta.body = "Moon";
  Appearance appearance;
  paging::fit_to_planet(appearance, meta);
  EXPECT_EQ(appearance.atmosphere, vpe::core::Atmosphere::kNone);
  EXPECT_EQ(appearance.palette, "grey");
}

class PhotoImage : public test_support::FakeImage {
 public:
  std::vector<mars::SourceInfo> infos() const override { return {image(true)}; }
};

std::shared_ptr<const paging::PlanetFile> build(const std::filesystem::path& path,
                                                const mars::ImageSource& source) {
  paging::BuildOptions options;
  options.output = path.string();
  options.base_spacing_m = 400000;
  options.threads = 2;
  options.tile_k = 5;
  options.resampling_posts = 1000;
  paging::build_planet(options, test_support::FakeElevation(test_support::bumpy_height), &source);
  return paging::PlanetFile::open(options.output);
}

TEST(PlanetLook, TheFlagIsInTheFileWhereItIsTrueAlone) {
  const test_support::TempDir folder;
  const auto photo = build(folder / "photo.vpe", PhotoImage());
  const auto plain = build(folder / "plain.vpe", test_support::FakeImage());
  EXPECT_TRUE(photo->meta().image_sources.at(0).has_own_light);
  EXPECT_FALSE(photo->meta().sources.at(0).has_own_light);
  EXPECT_FALSE(plain->meta().image_sources.at(0).has_own_light);
  const auto rows = paging::to_rows(photo->meta());
  EXPECT_NE(rows.at("image_sources").find("\"own_light\":true"), std::string::npos) << rows.at("image_sources");
  EXPECT_EQ(rows.at("sources").find("own_light"), std::string::npos);
  for (const auto& [key, value] : paging::to_rows(plain->meta()))
    EXPECT_EQ(value.find("own_light"), std::string::npos) << key;
  EXPECT_TRUE(paging::from_rows(rows, "x") == photo->meta());
  PlanetMeta other = photo->meta();
  other.image_sources[0].has_own_light = false;
  EXPECT_FALSE(other == photo->meta());
}

// Files of before have no such field: their imagery is unknown.
TEST(PlanetLook, OlderFilesOpenAndAreLit) {
  const test_support::TempDir folder;
  const std::string path = (folder / "p.vpe").string();
  EXPECT_EQ(light_of(build(path, PhotoImage())->meta(), Mode::kTextured), Light::kOff);
  {
    paging::Database db(path, paging::Database::Mode::kCreate);
    db.execute("UPDATE meta SET value = replace(value, '\"own_light\":true,', '') WHERE key = 'image_sources'");
    test_support::forge_meta_checksum(db);
  }
  {
    const auto planet = paging::PlanetFile::open(path);
    EXPECT_FALSE(planet->meta().image_sources.at(0).has_own_light);
    EXPECT_EQ(light_of(planet->meta(), Mode::kTextured), Light::kOn);
  }
  test_support::make_older(path, "1.0");
  EXPECT_EQ(light_of(paging::PlanetFile::open(path)->meta(), Mode::kTextured), Light::kOn);
}

}  // namespace
