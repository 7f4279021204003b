// Fingerprints, digests and figures of frames.
#include "vpe/app/film/film_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/support.h"
#include "vpe/app/cli/digest.h"
#include "vpe/app/picture/fingerprint.h"
#include "vpe/app/picture/scene_digests.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace {

using vpe::app::Digest;
using vpe::app::fingerprint_of;
using vpe::app::RenderBasis;
using vpe::core::DrawRequest;
using vpe::core::Settings;

struct Inputs {
  RenderBasis basis{"1.2.3", "abcdef", vpe::core::Backend::kPolygon, 1024};
  DrawRequest request;
  Settings settings;
  std::string fingerprint() const { return fingerprint_of(basis, request, settings); }
};

TEST(FilmFrame, WhatMovesObjectsIsInItsFingerprint) {
  using vpe::core::ObjectTrack;
  Inputs i;
  const auto of = [&](std::vector<ObjectTrack> tracks, double time_s) {
    i.request.tracks = std::make_shared<const std::vector<ObjectTrack>>(std::move(tracks));
    i.request.time_s = time_s;
    return i.fingerprint();
  };
  const std::string without = of({{"a", {}, {{1, false}}}}, 2);
  i.request.tracks = nullptr;
  EXPECT_EQ(i.fingerprint(), without);  // without a scene nothing moves
  ASSERT_EQ(i.settings.set("scene", VPE_SOURCE_DIR "/scripts/scenes/gale.scene.toml"), "");
  std::set<std::string> seen{i.fingerprint()};
  const std::vector<std::vector<ObjectTrack>> kinds{
      {{"a", {}, {{1, false}}}},         {{"b", {}, {{1, false}}}},
      {{"a", {}, {{1.5, false}}}},       {{"a", {}, {{1, true}}}},
      {{"a", {{1, {2, 3, 4, {}}}}, {}}}, {{"a", {{1, {2, 3, 4, 0}}}, {}}},
      {{"a", {{1, {2, 3, 5, {}}}}, {}}}, {{"a", {{1, {2, 3, 4, {}}}}, {}}, {"b", {}, {{1, false}}}},
  };
  for (const auto& tracks : kinds) EXPECT_TRUE(seen.insert(of(tracks, 2)).second);
  EXPECT_TRUE(seen.insert(of(kinds[0], 3)).second);
}

TEST(FilmFrame, FilesOfASceneCountAsTheyAreNow) {
  const test_support::TempDir folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  };
  const std::string scene = (folder / "a.scene.toml").string();
  write("a.scene.toml", "version = 1\n[[model]]\nname = \"m\"\nfile = \"m.obj\"\n");
  write("m.obj", "mtllib m.mtl\n");
  write("m.mtl", "map_Kd t.png\n");
  write("t.png", "red");
  Inputs i;
  ASSERT_EQ(i.settings.set("scene", scene), "");
  const std::string alone = i.fingerprint();
  i.basis.scenes = std::make_shared<vpe::app::SceneDigests>();
  EXPECT_EQ(i.fingerprint(), alone);
  EXPECT_EQ(i.fingerprint(), alone);
  EXPECT_FALSE(i.basis.scenes->of(scene).has_paths);
  EXPECT_EQ(i.basis.scenes->of(scene).checksums.size(), 4U);
  // A texture, then the scene.
  write("t.png", "green, and longer");
  const std::string green = i.fingerprint();
  EXPECT_NE(green, alone);
  write("a.scene.toml",
        "version = 1\n[[model]]\nname = \"m\"\nfile = \"m.obj\"\n[[path]]\nmodel = \"m\"\n"
        "points = [[0, 1, 2]]\n");
  EXPECT_NE(i.fingerprint(), green);
  EXPECT_TRUE(i.basis.scenes->of(scene).has_paths);
  std::filesystem::remove(folder / "m.obj");
  EXPECT_THROW(i.fingerprint(), vpe::base::FileError);
}

TEST(FilmFrame, TheEyesAreInItsFingerprint) {
  using vpe::core::StereoLayout;
  const Inputs i;
  const auto of = [&](const std::optional<vpe::core::StereoPair>& stereo) {
    return fingerprint_of(i.basis, i.request, i.settings, 0, {stereo, {}, {}});
  };
  EXPECT_EQ(of(std::nullopt), i.fingerprint());
  std::set<std::string> seen{i.fingerprint()};
  for (const auto layout : {StereoLayout::kSideBySide, StereoLayout::kOverUnder, StereoLayout::kAnaglyph}) {
    for (const double base_m : {1.0, std::nextafter(1.0, 2.0)})
      EXPECT_TRUE(seen.insert(of(vpe::core::StereoPair{layout, base_m})).second);
  }
  const vpe::core::StereoPair pair{StereoLayout::kSideBySide, 1};
  for (const double gap_px : {1.0, 2.0})
    EXPECT_TRUE(seen.insert(fingerprint_of(i.basis, i.request, i.settings, 0, {pair, gap_px, {}})).second);
  // A frame depends on its key frame, how far off its pixels may be, and the key frame's margin.
  using Reuse = vpe::app::FingerprintOrigin::Reuse;
  for (const Reuse& reuse : {Reuse{"a", 0.5, {0, 0}}, Reuse{"b", 0.5, {0, 0}}, Reuse{"a", 0.25, {0, 0}},
                             Reuse{"a", 0.5, {4, 0}}, Reuse{"a", 0.5, {0, 4}}})
    EXPECT_TRUE(seen.insert(fingerprint_of(i.basis, i.request, i.settings, 0, {{}, {}, reuse})).second);
}

TEST(FilmFrame, EverythingThatAnImageDependsOnIsInItsFingerprint) {
  const std::string base = Inputs{}.fingerprint();
  EXPECT_EQ(base.size(), 32U);
  EXPECT_EQ(base, Inputs{}.fingerprint());
  std::set<std::string> seen{base};
  const auto change = [&](const char* what, const auto& edit) {
    Inputs inputs;
    edit(inputs);
    EXPECT_TRUE(seen.insert(inputs.fingerprint()).second) << what;
  };
  change("program version", [](Inputs& i) { i.basis.program = "1.2.4"; });
  change("planet", [](Inputs& i) { i.basis.planet = "abcdee"; });
  change("backend", [](Inputs& i) { i.basis.backend = vpe::core::Backend::kRay; });
  change("memory", [](Inputs& i) { i.basis.memory_mb = 512; });
  change("boundary between texts", [](Inputs& i) {
    i.basis.program = "1.2.3a";
    i.basis.planet = "bcdef";
  });
  auto& next = std::nextafter<double, double>;
  for (int n = 0; n < 3; ++n) {
    change("camera", [&](Inputs& i) {
      i.request.view.camera.position_m[n] = next(i.request.view.camera.position_m[n], 9);
    });
    change("right", [&](Inputs& i) { i.request.view.camera.axes.right[n] += 0.5; });
    change("up", [&](Inputs& i) { i.request.view.camera.axes.up[n] += 0.5; });
    change("forward", [&](Inputs& i) { i.request.view.camera.axes.forward[n] += 0.5; });
    change("sun", [&](Inputs& i) { i.request.sun[n] = next(i.request.sun[n], 9); });
  }
  change("width", [](Inputs& i) { ++i.request.view.width; });
  change("height", [](Inputs& i) { ++i.request.view.height; });
  change("fov", [&](Inputs& i) { i.request.view.fov_deg = next(i.request.view.fov_deg, 180); });
  change("projection", [](Inputs& i) { i.request.view.projection = vpe::core::Projection::kCylinder; });
  change("offset", [](Inputs& i) { i.request.view.principal_offset_px.y = 1; });
  change("part", [](Inputs& i) { i.request.view.part.width = 8; });
  change("coarsening", [](Inputs& i) { i.request.coarsening = 2; });
  change("levels kept", [](Inputs& i) { i.request.keeps_levels = true; });
  change("a region", [](Inputs& i) { i.request.interest = {{1, 2, 3, 4}}; });
  change("its longitude", [](Inputs& i) { i.request.interest = {{9, 2, 3, 4}}; });
  change("its latitude", [](Inputs& i) { i.request.interest = {{1, 9, 3, 4}}; });
  change("its radius", [](Inputs& i) { i.request.interest = {{1, 2, 9, 4}}; });
  change("its levels", [](Inputs& i) { i.request.interest = {{1, 2, 3, 9}}; });
  change("two regions", [](Inputs& i) { i.request.interest = {{1, 2, 3, 4}, {1, 2, 3, 4}}; });
}

TEST(FilmFrame, EverySettingIsInItsFingerprint) {
  if (!vpe::core::overlays_refused().empty()) GTEST_SKIP() << vpe::core::overlays_refused();
  std::set<std::string> seen{Inputs{}.fingerprint()};
  for (const vpe::core::SettingInfo& info : Settings::list()) {
    Inputs inputs;
    std::string other = info.choices.empty() ? "1" : std::string(info.choices.front());
    if (info.type == vpe::core::SettingType::kTable) other = "0:1";
    if (info.type == vpe::core::SettingType::kText) {
      other = info.key == "palette"          ? "viridis"
              : info.key == "sun"            ? "2026-11-20T12:00Z"
              : info.key == "overlay.names"  ? "/dev/null"
              : info.key == "overlay.layers" ? "/dev/null"
              : info.key == "scene"          ? VPE_SOURCE_DIR "/scripts/scenes/gale.scene.toml"
                                             : "Other";
    }
    if (info.type == vpe::core::SettingType::kNumber && info.max < 1)
      other = vpe::base::format_number(info.max);
    if (other == info.default_text) other = info.choices.empty() ? "2" : std::string(info.choices.back());
    ASSERT_EQ(inputs.settings.set(info.key, other), "") << info.key;
    EXPECT_TRUE(seen.insert(inputs.fingerprint()).second) << info.key;
  }
}

TEST(FilmFrame, ThePaletteFilesContentIsInItsFingerprint) {
  const test_support::TempDir dir;
  const std::string file = (dir / "p.txt").string();
  Inputs inputs;
  std::set<std::string> seen;
  for (const char* text :
       {"0 1 2 3\n9 4 5 6", "0 1 2 3\n9 4 5 7", "0 1 2 3\n8 4 5 6", "0 1 2 3\n1 4 5 6", "5 1 2 3"}) {
    vpe::base::write_file(file, std::string_view(text));
    ASSERT_EQ(inputs.settings.set("palette", file), "");
    const std::string fingerprint = inputs.fingerprint();
    EXPECT_TRUE(seen.insert(fingerprint).second) << text;
    vpe::base::write_file(file, "# the same\n" + std::string(text));
    EXPECT_EQ(inputs.fingerprint(), fingerprint) << text;
  }
}

TEST(FilmFrame, TheGazetteersContentIsInItsFingerprint) {
  if (!vpe::core::overlays_refused().empty()) GTEST_SKIP() << vpe::core::overlays_refused();
  const test_support::TempDir dir;
  const std::string file = (dir / "n.csv").string();
  Inputs inputs;
  vpe::base::write_file(file, std::string_view("name,lon,lat\nA,1,2\n"));
  ASSERT_EQ(inputs.settings.set("overlay.names", file), "");
  const std::string before = inputs.fingerprint();
  EXPECT_EQ(inputs.fingerprint(), before);
  vpe::base::write_file(file, std::string_view("name,lon,lat\nA,1,3\n"));
  EXPECT_NE(inputs.fingerprint(), before);
  std::filesystem::remove(file);
  EXPECT_THROW(inputs.fingerprint(), vpe::base::FileError);
}

TEST(FilmFrame, ItsTimeCountsOnlyWhereItIsShown) {
  if (!vpe::core::overlays_refused().empty()) GTEST_SKIP() << vpe::core::overlays_refused();
  Inputs inputs;
  const auto at = [&](double time_s) {
    return fingerprint_of(inputs.basis, inputs.request, inputs.settings, time_s);
  };
  EXPECT_EQ(at(1), at(2));
  ASSERT_EQ(inputs.settings.set("overlay.time", "on"), "");
  EXPECT_NE(at(1), at(2));
  EXPECT_EQ(at(1), at(1));
}

TEST(FilmDigest, DistinguishesSequences) {
  std::set<std::string> seen;
  EXPECT_TRUE(seen.insert(Digest().hex()).second);
  EXPECT_TRUE(seen.insert(Digest().add("").hex()).second);
  EXPECT_TRUE(seen.insert(Digest().add("ab").add("c").hex()).second);
  EXPECT_TRUE(seen.insert(Digest().add("a").add("bc").hex()).second);
  EXPECT_TRUE(seen.insert(Digest().add(std::int64_t{0}).hex()).second);
  EXPECT_TRUE(seen.insert(Digest().add(0.0).hex()).second);
  EXPECT_TRUE(seen.insert(Digest().add(-0.0).hex()).second);
  // The reference implementation's value for no bytes.
  EXPECT_EQ(vpe::app::checksum_of(std::span<const std::uint8_t>{}), "99aa06d3014798d86001c324468d497f");
}

TEST(FilmFigures, ComeBackFromJson) {
  vpe::app::FrameFigures figures;
  figures.stats.tiles_drawn = 12;
  figures.stats.triangles = std::int64_t{1} << 40;
  figures.stats.tiles_by_level = {0, 5, 7};
  figures.certificate.shift_bound_px = 0.1 + 0.2;
  figures.certificate.screen_space_error_px = INFINITY;
  const auto back = vpe::app::figures_from(nlohmann::json::parse(to_json(figures).dump()));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stats.tiles_drawn, 12);
  EXPECT_EQ(back->stats.triangles, std::int64_t{1} << 40);
  EXPECT_EQ(back->stats.tiles_by_level, figures.stats.tiles_by_level);
  EXPECT_EQ(back->certificate.shift_bound_px, 0.1 + 0.2);
  EXPECT_FALSE(std::isfinite(back->certificate.screen_space_error_px));
  EXPECT_TRUE(std::isnan(back->stats.draw_ms));
  EXPECT_LT(back->stats.bytes_resident, 0);
  for (const char* bad : {"null", "[]", "{}", "{\"tiles_visited\": \"x\"}"}) {
    EXPECT_FALSE(vpe::app::figures_from(nlohmann::json::parse(bad))) << bad;
  }
}

}  // namespace
