// Image layers of planet files: how they are stored, composed and numbered, and builds that are stopped, divided, merged and
// patched.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "mars/sources/layered_image.h"
#include "paging/build/estimate.h"
#include "paging/build/merge.h"
#include "paging/build/overwrite_check.h"
#include "paging/build/verify_shard.h"
#include "paging/planet/image_stretch.h"
#include "paging/planet/layer_tile.h"
#include "paging/planet/planet_look.h"
#include "paging/planet/sqlite.h"
#include "paging/planet/tile_patch.h"
#include "paging/planet/verify.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/core/appearance/nodata_pattern.h"

namespace {

using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::TempDir;
using vpe::base::Rgb;
using vpe::core::ImageLayerLook;
using vpe::core::parse_image_layers;

constexpr std::size_t kSide = paging::kImageIntervals + 1;
constexpr double kEverywhere = 4;  // rad

// Gives smooth colours in a cap.
class CapImage : public mars::ImageSource {
 public:
  CapImage(std::string name, double resolution_m, mars::Cap cap, glm::dvec3 tint)
      : name_(std::move(name)), resolution_m_(resolution_m), cap_(cap), tint_(tint) {}

  std::vector<mars::SourceInfo> infos() const override {
    mars::SourceInfo info;
    info.name = name_;
    info.resolution_m = resolution_m_;
    return {info};
  }
  void sample(std::span<const glm::dvec3> directions, double, std::span<Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const glm::dvec3& d = directions[n];
      const double wave = 0.5 + 0.2 * std::sin(9 * d.x) + 0.2 * std::cos(7 * d.y + 3 * d.z);
      const auto byte = [&](double tint) { return static_cast<std::uint8_t>(255 * tint * wave); };
      colours[n] = {byte(tint_.x), byte(tint_.y), byte(tint_.z)};
      alpha[n] = mars::angle_between_rad(d, cap_.centre) <= cap_.radius_rad ? 255 : 0;
    }
  }
  double spacing_in(const mars::Cap& cap) const override {
    const bool touches = mars::angle_between_rad(cap.centre, cap_.centre) <= cap.radius_rad + cap_.radius_rad;
    return touches ? resolution_m_ : std::numeric_limits<double>::infinity();
  }

 private:
  std::string name_;
  double resolution_m_;
  mars::Cap cap_;
  glm::dvec3 tint_;
};

const glm::dvec3 kCentre = glm::normalize(glm::dvec3(1, 0.1, 0.2));

mars::NamedImage base() {
  return {"base", std::make_shared<CapImage>("base.tif", 40000, mars::Cap{kCentre, kEverywhere},
                                             glm::dvec3(1, 0.8, 0.6))};
}
mars::NamedImage inset() {
  return {"inset",
          std::make_shared<CapImage>("inset.tif", 8000, mars::Cap{kCentre, 0.15}, glm::dvec3(0.5, 0.9, 1))};
}
mars::NamedImage beside() {
  return {"beside",
          std::make_shared<CapImage>("beside.tif", 12000, mars::Cap{{0, 1, 0}, 0.1}, glm::dvec3(1, 0.3, 0.3))};
}

class PlanetLayers : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (dir_ / name).string(); }

  paging::BuildOptions options(const std::string& name, int threads = 2) const {
    paging::BuildOptions o;
    o.output = path(name);
    o.base_spacing_m = 400000;
    o.threads = threads;
    o.tile_k = 4;
    o.resampling_posts = 1000;
    o.commit_s = 0;
    return o;
  }

  paging::BuildSummary build(const paging::BuildOptions& o, const mars::ImageSource& image,
                             const paging::ProgressFunction& progress = {}) const {
    return paging::build_planet(o, elevation_, &image, progress);
  }

  // Copies the planet of two layers, which is built once a process, to p.vpe and opens it.
  std::shared_ptr<const paging::PlanetFile> planet() const {
    static const TempDir folder;
    const std::filesystem::path built = folder / "p.vpe";
    if (!std::filesystem::exists(built)) {
      paging::BuildOptions o = options("p.vpe");
      o.output = built.string();
      build(o, *two_);
    }
    std::filesystem::copy_file(built, path("p.vpe"));
    return paging::PlanetFile::open(path("p.vpe"));
  }

  // Returns a stored tile; nullopt if there is none of this key.
  static std::optional<paging::LayerTile> stored(const paging::PlanetFile& planet, int layer,
                                                 const lod::TileKey& key) {
    const paging::Database db = planet.connect();
    paging::Statement row(db, "SELECT data FROM image_layer WHERE layer = ? AND key = ?");
    if (!row.bind(1, std::int64_t{layer}).bind(2, lod::pack(key)).step()) return std::nullopt;
    return paging::decode_layer_tile(row.blob(0));
  }

  TempDir dir_;
  FakeElevation elevation_{bumpy_height};
  std::shared_ptr<const mars::ImageSource> two_ = mars::stack_images_apart({inset(), base()});
};

struct Sample {
  glm::dvec3 colour{};
  double share = 0;
};

// Interpolates a layer at a texel of a tile, by the definition: in its deepest tile there, weighted by shares.
Sample sample_layer(const std::function<std::optional<paging::LayerTile>(const lod::TileKey&)>& tile_at,
                    const lod::TileKey& key, std::size_t i, std::size_t j, const ImageLayerLook& look) {
  lod::TileKey at = key;
  std::optional<paging::LayerTile> tile = tile_at(at);
  while (!tile && at.level > 0) tile = tile_at(at = lod::parent(at));
  if (!tile || tile->is_empty()) return {};
  const double scale = std::ldexp(1.0, at.level - key.level);
  const double x = (key.i * 256.0 + static_cast<double>(i)) * scale - at.i * 256.0;
  const double y = (key.j * 256.0 + static_cast<double>(j)) * scale - at.j * 256.0;
  const auto table = paging::stretch_table({look.low, look.high, look.gamma});
  Sample out;
  for (const double row : {std::floor(y), std::floor(y) + 1}) {
    for (const double column : {std::floor(x), std::floor(x) + 1}) {
      const double near = (1 - std::abs(x - column)) * (1 - std::abs(y - row));
      if (near <= 0) continue;
      const auto n = static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column);
      const double weight = near * (tile->shares.empty() ? 1.0 : tile->shares[n] / 255.0);
      const Rgb& texel = tile->texels[n];
      out.colour += weight * glm::dvec3(table[texel.r], table[texel.g], table[texel.b]);
      out.share += weight;
    }
  }
  if (out.share > 0) out.colour /= out.share;
  return out;
}

TEST_F(PlanetLayers, AreEqualToACompositeByHand) {
  const auto plain = planet();
  for (const char* text : {"base;inset", "base low=20 high=200 gamma=1.5;inset@0.6 low=250 high=10", "inset",
                           "inset;base@0.3", "base@0.5"}) {
    SCOPED_TRACE(text);
    const std::vector<ImageLayerLook> looks = parse_image_layers(text);
    const auto shown = plain->with_images(looks);
    const std::vector<lod::TileKey> keys = shown->image_keys();
    ASSERT_GE(keys.size(), 6U);
    for (std::size_t n = 0; n < keys.size(); n += 1 + keys.size() / 7) {
      const paging::ImageTile tile = shown->image(keys[n]);
      ASSERT_EQ(tile.texels.size(), kSide * kSide);
      std::map<std::pair<int, lod::TileKey>, std::optional<paging::LayerTile>> read;
      for (std::size_t at = 0; at < tile.texels.size(); at += 911) {
        glm::dvec3 expected(vpe::core::kMissingImagery);
        for (const ImageLayerLook& look : looks) {
          const int layer = look.name == "base" ? 0 : 1;
          const auto tile_at = [&](const lod::TileKey& key) {
            auto& known = read[{layer, key}];
            if (!known) known = stored(*plain, layer, key);
            return known;
          };
          const Sample sample = sample_layer(tile_at, keys[n], at % kSide, at / kSide, look);
          expected += look.opacity * sample.share * (sample.colour - expected);
        }
        EXPECT_NEAR(tile.texels[at].r, expected.x, 0.6);
        EXPECT_NEAR(tile.texels[at].g, expected.y, 0.6);
        EXPECT_NEAR(tile.texels[at].b, expected.z, 0.6);
      }
    }
  }
}

TEST_F(PlanetLayers, AllInTheirOrderLookLikeTheBuild) {
  const auto plain = planet();
  const auto shown = plain->with_images(parse_image_layers("base;inset"));
  EXPECT_EQ(shown->image_keys(), plain->image_keys());
  double sum = 0;
  std::int64_t count = 0;
  for (const lod::TileKey& key : plain->image_keys()) {
    const auto a = plain->image(key).texels;
    const auto b = shown->image(key).texels;
    for (std::size_t n = 0; n < a.size(); ++n, ++count) sum += std::abs(a[n].g - b[n].g);
  }
  // JPEG of the edge between both.
  EXPECT_LT(sum / static_cast<double>(count), 1.0);
}

TEST_F(PlanetLayers, AnOpacityOfZeroIsLikeLeavingItOut) {
  const auto plain = planet();
  const auto with = plain->with_images(parse_image_layers("base;inset@0"));
  const auto without = plain->with_images(parse_image_layers("base"));
  ASSERT_EQ(with->image_keys(), without->image_keys());
  for (const lod::TileKey& key : with->image_keys())
    EXPECT_EQ(with->image(key).texels, without->image(key).texels) << lod::to_string(key);
}

TEST_F(PlanetLayers, GroundWithoutChosenLayersIsGrey) {
  const auto shown = planet()->with_images(parse_image_layers("inset"));
  const lod::TileKey behind{mars::Face::kMinusX, 0, 0, 0};
  ASSERT_EQ(shown->image_key({mars::Face::kMinusX, 3, 1, 1}), behind);
  for (const Rgb& texel : shown->image(behind).texels)
    ASSERT_EQ(texel, (Rgb{vpe::core::kMissingImagery, vpe::core::kMissingImagery, vpe::core::kMissingImagery}));
}

TEST_F(PlanetLayers, MetaAndIdentityTellOfThem) {
  const auto with = planet();
  const auto& layers = with->meta().image_layers;
  ASSERT_EQ(layers.size(), 2U);
  EXPECT_EQ(layers[0].name, "base");
  EXPECT_EQ(layers[1].name, "inset");
  for (const paging::ImageLayer& layer : layers) {
    EXPECT_EQ(with->meta().image_sources.at(static_cast<std::size_t>(layer.source)).name, layer.name + ".tif");
    EXPECT_GE(layer.tiles, 6);
    EXPECT_GT(layer.bytes, 0);
  }
  EXPECT_LT(layers[0].finest_level, layers[1].finest_level);
  EXPECT_EQ(layers[1].finest_level, with->meta().finest_image_level);
  EXPECT_EQ(paging::from_rows(paging::to_rows(with->meta()), "x"), with->meta());
  EXPECT_EQ(paging::to_rows(with->meta()).at("format"), "1.5");
  const auto report = paging::verify(*with, {.threads = 2, .deep_tiles = 2});
  EXPECT_TRUE(report.problems.empty()) << report.problems.front().where << report.problems.front().what;
  EXPECT_GT(report.images, with->meta().image_tiles);

  // A file without layers is what it was before there were any.
  build(options("plain.vpe"), *mars::stack_images({inset().source, base().source}));
  const auto plain = paging::PlanetFile::open(path("plain.vpe"));
  EXPECT_EQ(paging::to_rows(plain->meta()).at("format"), "1.4");
  EXPECT_FALSE(paging::to_rows(plain->meta()).contains("image_layers"));
  EXPECT_NE(plain->meta().identity, with->meta().identity);
  paging::Database db = plain->connect();
  EXPECT_EQ(db.integer("SELECT count(*) FROM sqlite_schema WHERE name LIKE 'image_layer%'"), 0);
  for (const lod::TileKey& key : plain->image_keys())
    EXPECT_EQ(plain->image(key).texels, with->image(key).texels);
}

TEST_F(PlanetLayers, NamesThatAreNotThereAreRefused) {
  const auto with = planet();
  const auto message = [](const paging::PlanetFile& of, const char* text) -> std::string {
    try {
      of.with_images(parse_image_layers(text));
    } catch (const paging::PlanetError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message(*with, "base;viking").find("no image layer 'viking'; its layers are base, inset"),
            std::string::npos);
  EXPECT_EQ(paging::layers_problem("base", with->meta()), "");
  EXPECT_NE(paging::layers_problem("x", with->meta()), "");
  build(options("plain.vpe"), *base().source);
  const auto plain = paging::PlanetFile::open(path("plain.vpe"));
  EXPECT_NE(message(*plain, "base").find("build the planet with --images-apart"), std::string::npos);
  EXPECT_EQ(plain->with_images({}), plain);
}

TEST_F(PlanetLayers, NumbersChangeWithTheChoiceAlone) {
  using paging::MadeOf;
  const auto plain = planet();
  const lod::TileKey root{mars::Face::kPlusX, 0, 0, 0};
  const auto numbers = [&](const paging::PlanetFile& p) {
    std::vector<std::uint64_t> all;
    for (const MadeOf made_of : {MadeOf::kTile, MadeOf::kBorders, MadeOf::kArea, MadeOf::kImage})
      all.push_back(p.version(root, made_of));
    return all;
  };
  const auto one = paging::with_layers_of(plain, "base;inset@0.5");
  EXPECT_EQ(numbers(*one)[0], numbers(*plain)[0]);
  EXPECT_EQ(numbers(*one)[1], numbers(*plain)[1]);
  EXPECT_NE(numbers(*one)[2], numbers(*plain)[2]);
  EXPECT_NE(numbers(*one)[3], numbers(*plain)[3]);
  EXPECT_EQ(paging::with_layers_of(one, "base;inset@0.5"), one);
  EXPECT_EQ(numbers(*plain->with_images(one->shown_layers(), one)), numbers(*one));

  // The ground goes over to a patch and the layers stay.
  const auto patch = std::make_shared<paging::TilePatch>();
  patch->meta = plain->meta();
  const auto patched = paging::keep_layers(plain->with(patch), one);
  EXPECT_EQ(patched->shown_layers(), one->shown_layers());
  EXPECT_EQ(patched->version(root, MadeOf::kImage), one->version(root, MadeOf::kImage));
  EXPECT_EQ(patched->image(root).texels, one->image(root).texels);
  const auto again = one->with(patch, one);
  EXPECT_EQ(again->version(root, MadeOf::kImage), one->version(root, MadeOf::kImage));

  // Another choice, and none, never have a number of before.
  const auto other = paging::with_layers_of(patched, "base");
  EXPECT_GT(other->version(root, MadeOf::kImage), patched->version(root, MadeOf::kImage));
  const auto none = paging::with_layers_of(other, "");
  EXPECT_GT(none->version(root, MadeOf::kImage), other->version(root, MadeOf::kImage));
  EXPECT_EQ(none->image(root).texels, plain->image(root).texels);
  EXPECT_EQ(paging::keep_layers(plain, none)->image(root).texels, plain->image(root).texels);
  EXPECT_EQ(paging::with_layers_of(plain, ""), plain);
  const auto dropped = plain->with(patch, patched);
  EXPECT_GT(dropped->version(root, MadeOf::kImage), patched->version(root, MadeOf::kImage));

  const auto compared = one->compared_with(plain);
  EXPECT_EQ(compared->image(root).texels, one->image(root).texels);
  EXPECT_FALSE(one->is_same_file(*paging::PlanetFile::open(path("p.vpe"))));
}

TEST_F(PlanetLayers, ThreadsStopsAndPartsMakeTheSame) {
  const paging::PlanetMeta whole = build(options("p.vpe"), *two_).meta;
  EXPECT_EQ(build(options("one.vpe", 1), *two_).meta, whole);

  struct Stopped {};
  int stops = 0;
  for (int n = 0; n < 200; ++n) {
    try {
      std::int64_t done = 0;
      build(options("stopped.vpe"), *two_, [&](const paging::BuildProgress& p) {
        if (std::string(p.stage) == "image layers" && ++done == 12) throw Stopped();
      });
      break;
    } catch (const Stopped&) {
      ++stops;
    }
  }
  EXPECT_GT(stops, 1);
  EXPECT_EQ(paging::PlanetFile::open(path("stopped.vpe"))->meta(), whole);

  paging::MergeOptions merge;
  merge.output = path("merged.vpe");
  std::int64_t tiles = 0;
  std::int64_t all = 0;
  for (const paging::ImageLayer& layer : whole.image_layers) all += layer.tiles;
  for (std::int64_t part = 1; part <= 3; ++part) {
    paging::BuildOptions o = options("part" + std::to_string(part) + ".vpe");
    o.shard = {part, 3};
    tiles += paging::estimate_build(o, paging::plan_tiles(o, elevation_), elevation_, two_.get()).layer_tiles;
    build(o, *two_);
    EXPECT_TRUE(paging::verify_shard(o.output).problems.empty());
    EXPECT_TRUE(build(o, *two_).is_kept_whole);
    merge.shards.push_back(o.output);
  }
  EXPECT_EQ(tiles, all);
  EXPECT_EQ(paging::merge_shards(merge).meta, whole);
}

TEST_F(PlanetLayers, APatchIsTheFullBuild) {
  planet();
  // A layer between both gives the upper one another number.
  const auto three = mars::stack_images_apart({inset(), base(), beside()});
  const paging::PatchedPlanet patched{
      path("p.vpe"), [](const mars::Cap&) { return false; },
      [source = beside().source](const mars::Cap& cap) { return std::isfinite(source->spacing_in(cap)); }};
  const paging::PlanetMeta by_patch =
      paging::patch_planet(options("patched.vpe"), patched, elevation_, three.get()).meta;
  const paging::PlanetMeta full = build(options("full.vpe"), *three).meta;
  EXPECT_EQ(by_patch.identity, full.identity);
  EXPECT_EQ(by_patch.image_layers, full.image_layers);
  ASSERT_EQ(full.image_layers.size(), 3U);
  EXPECT_EQ(full.image_layers[1].name, "beside");
  EXPECT_TRUE(paging::verify(*paging::PlanetFile::open(path("patched.vpe")), {.threads = 2}).problems.empty());

  const auto renamed = mars::stack_images_apart({{"other", inset().source}, base(), beside()});
  EXPECT_THROW(paging::patch_planet(options("no.vpe"), patched, elevation_, renamed.get()),
               paging::PlanetError);
  EXPECT_FALSE(std::filesystem::exists(path("no.vpe.part")));
}

TEST_F(PlanetLayers, AnotherChoiceOfLayersIsAnotherPlanet) {
  planet();
  const auto plan = paging::plan_tiles(options("p.vpe"), elevation_);
  EXPECT_TRUE(paging::differences(path("p.vpe"),
                                  paging::planned_content(options("p.vpe"), plan, elevation_, two_.get()))
                  .empty());
  const auto plain = mars::stack_images({inset().source, base().source});
  const auto texts = paging::differences(
      path("p.vpe"), paging::planned_content(options("p.vpe"), plan, elevation_, plain.get()));
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_EQ(texts.front(), "its image layers is base, inset, not none");
}

TEST_F(PlanetLayers, DamageIsFoundAndNamed) {
  const auto sound = planet();
  const lod::TileKey root{mars::Face::kPlusX, 0, 0, 0};
  {
    paging::Database db(path("p.vpe"), paging::Database::Mode::kCreate);
    db.execute("UPDATE image_layer SET data = zeroblob(length(data)) WHERE layer = 1 AND key = " +
               std::to_string(lod::pack(root)));
  }
  const auto planet = paging::PlanetFile::open(path("p.vpe"));
  EXPECT_EQ(planet->with_images(parse_image_layers("base"))->image(root).texels,
            planet->with_images(parse_image_layers("base;inset@0"))->image(root).texels);
  const auto shown = planet->with_images(parse_image_layers("base;inset"));
  try {
    shown->image(root);
    FAIL();
  } catch (const paging::PlanetError& e) {
    EXPECT_NE(std::string(e.what()).find("image layer 'inset': wrong checksum"), std::string::npos) << e.what();
  }
  bool is_named = false;
  for (const paging::Problem& problem : paging::verify(*planet, {.threads = 2}).problems)
    is_named = is_named || problem.what.find("image layer 'inset'") != std::string::npos;
  EXPECT_TRUE(is_named);
  {
    paging::Database db(path("p.vpe"), paging::Database::Mode::kCreate);
    db.execute("DELETE FROM image_layer WHERE layer = 0 AND key = " + std::to_string(lod::pack(root)));
  }
  EXPECT_THROW(paging::PlanetFile::open(path("p.vpe")), paging::PlanetError);
  {
    paging::Database db(path("p.vpe"), paging::Database::Mode::kCreate);
    db.execute("DROP TABLE image_layer");
  }
  EXPECT_THROW(paging::PlanetFile::open(path("p.vpe")), paging::PlanetError);
}

TEST(LayerTile, KeepsSharesAndColours) {
  test_support::Random random(4711);
  std::vector<Rgb> texels(kSide * kSide, {90, 120, 200});
  std::vector<std::uint8_t> shares(texels.size());
  EXPECT_EQ(paging::encode_layer_tile(texels, shares, 90).size(), 1U);
  EXPECT_TRUE(paging::decode_layer_tile(paging::encode_layer_tile(texels, shares, 90)).is_empty());
  for (std::uint8_t& share : shares) share = static_cast<std::uint8_t>(random.integer(1, 255));
  for (std::size_t n = 0; n < shares.size(); n += 3) shares[n] = 0, texels[n] = {0, 0, 0};
  const paging::Bytes packed = paging::encode_layer_tile(texels, shares, 90);
  const paging::LayerTile tile = paging::decode_layer_tile(packed);
  EXPECT_EQ(tile.shares, shares);
  // The black of nodata texels is in no JPEG block.
  for (const Rgb& texel : tile.texels) ASSERT_NEAR(texel.r, 90, 2);
  std::fill(shares.begin(), shares.end(), std::uint8_t{255});
  EXPECT_TRUE(paging::decode_layer_tile(paging::encode_layer_tile(texels, shares, 90)).shares.empty());

  EXPECT_THROW(paging::encode_layer_tile(texels, std::vector<std::uint8_t>(5), 90), paging::CodecError);
  EXPECT_THROW(paging::decode_layer_tile({}), paging::CodecError);
  EXPECT_THROW(paging::decode_layer_tile(paging::Bytes{0, 0}), paging::CodecError);
  EXPECT_THROW(paging::decode_layer_tile(paging::Bytes{3}), paging::CodecError);
  for (std::size_t size = 1; size < packed.size(); size += 1 + packed.size() / 50)
    EXPECT_THROW(paging::decode_layer_tile(std::span(packed).first(size)), std::runtime_error) << size;
  for (int n = 0; n < 200; ++n) {
    paging::Bytes changed = packed;
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(changed.size()) - 1));
    changed[at] = static_cast<std::uint8_t>(changed[at] ^ 0x55);
    try {
      const paging::LayerTile read = paging::decode_layer_tile(changed);
      EXPECT_TRUE(read.is_empty() || read.texels.size() == kSide * kSide);
    } catch (const std::runtime_error&) {  // CodecError, ImageError
    }
  }
}

}  // namespace
