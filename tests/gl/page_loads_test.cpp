// Page loader of the polygon backend under a pager, without OpenGL. Above all for the thread sanitizer.
#include <set>

#include "paging/pager.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/gl/tile_page.h"

namespace {

using namespace std::chrono_literals;
using paging::ShadingParams;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::Random;
using vpe::gl::Page;
using vpe::gl::PageKey;
using vpe::gl::PageKeyHash;
using vpe::gl::PageKind;
using vpe::gl::PageLoader;
using TilePager = paging::Pager<PageKey, Page, PageKeyHash>;

// Returns any page that the planet has: meshes of all variants, textures with all shadings, posts.
PageKey random_page(const paging::PlanetFile& planet, Random& random,
                    const std::vector<std::shared_ptr<const ShadingParams>>& shadings) {
  const lod::TileTree& tree = planet.tree();
  const lod::TileInfo& tile =
      tree[static_cast<lod::TileTree::Index>(random.integer(0, static_cast<int>(tree.size()) - 1))];
  PageKey page;
  page.tile = tile.key;
  switch (random.integer(0, tile.has_children ? 1 : 2)) {
    case 0:
      page.detail = random.integer(0, static_cast<int>(tile.variants.size()) - 1);
      page.occluders = page.detail % 2 == 0;
      break;
    case 1:
      page.kind = PageKind::kTexture;
      page.shading =
          shadings[static_cast<std::size_t>(random.integer(0, static_cast<int>(shadings.size()) - 1))];
      page.detail = page.shading->flat
                        ? vpe::gl::facet_texture(random.integer(0, static_cast<int>(tile.variants.size()) - 1))
                        : planet.meta().tile.intervals() << random.integer(0, 1);
      break;
    default: page.kind = PageKind::kGround;
  }
  return page;
}

std::shared_ptr<const paging::PlanetFile> build_bumpy(const std::filesystem::path& file) {
  const test_support::FakeImage image;
  paging::BuildOptions options;
  options.output = file.string();
  options.base_spacing_m = 100000;
  options.threads = 2;
  options.tile_k = 4;
  options.resampling_posts = 1000;
  paging::build_planet(options, FakeElevation(bumpy_height), &image);
  return paging::PlanetFile::open(options.output);
}

// Owners request, take, cancel and end at random, while the shader's small caches evict.
TEST(PageLoadsThreads, RequestedCancelledEvictedAndShutDownAtRandom) {
  const test_support::TempDir dir;
  const auto planet = build_bumpy(dir / "p.vpe");
  std::vector<std::shared_ptr<const ShadingParams>> shadings;
  for (const auto colour_source : {paging::ColourSource::kElevation, paging::ColourSource::kImage}) {
    ShadingParams shading;
    shading.colour_source = colour_source;
    shading.scale = std::make_shared<const vpe::core::ColourScale>(vpe::core::Appearance());
    shadings.push_back(std::make_shared<const ShadingParams>(shading));
    shading.flat = true;
    shading.shadows = true;
    shadings.push_back(std::make_shared<const ShadingParams>(shading));
  }
  Random random(17);
  std::size_t taken = 0;
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    const auto shader = std::make_shared<const paging::TerrainShader>(planet, std::size_t{50000});
    const PageLoader loader(planet, shader);
    TilePager pager([&](const PageKey& key) { return loader.load(key); }, random.integer(1, 4), 200000);
    for (int step = 0; step < 25; ++step) {
      std::vector<TilePager::Want> wants;
      for (int k = random.integer(step == 0 ? 1 : 0, 30); k > 0; --k) {
        wants.push_back({random_page(*planet, random, shadings), random.uniform(0, 1)});
      }
      pager.want(std::move(wants));
      if (step == 0) {
        // However slow the machine is, each round takes something.
        pager.wait(TilePager::Clock::time_point::max());
      } else if (random.integer(0, 2) == 0) {
        pager.wait(TilePager::Clock::now() + 2ms);
      }
      for (const TilePager::Loaded& page : pager.take(static_cast<std::size_t>(random.integer(0, 100000)))) {
        ++taken;
        EXPECT_GT(page.bytes, 0U);
        EXPECT_EQ(page.value.ground != nullptr, page.key.kind == PageKind::kGround);
        EXPECT_EQ(page.value.shaded.texels.empty(), page.key.kind != PageKind::kTexture);
        EXPECT_EQ(page.value.geometry.positions_m.empty(), page.key.kind != PageKind::kMesh);
      }
      EXPECT_EQ(pager.counts().failed, 0U);
    }
  }
  EXPECT_GE(taken, static_cast<std::size_t>(kRounds));
}

// They take a third of the time of a mesh.
TEST(PageLoads, OccluderProfilesAreMadeOnRequest) {
  const test_support::TempDir dir;
  const auto planet = build_bumpy(dir / "p.vpe");
  const PageLoader loader(planet, std::make_shared<const paging::TerrainShader>(planet, std::size_t{50000}));
  PageKey page;
  page.tile = planet->tree()[0].key;
  EXPECT_EQ(loader.load(page).first.occluders, nullptr);
  page.occluders = true;
  EXPECT_NE(loader.load(page).first.occluders, nullptr);
}

}  // namespace
