// vpe verify: no problem in a good file, and a message for each kind of wrong content, also when checksums
// match.
#include "paging/planet/verify.h"

#include <gtest/gtest.h>

#include <fstream>

#include "paging/planet/sqlite.h"
#include "tests/paging/planet_fixture.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::fine_around;
using test_support::Random;
using test_support::TempDir;

class Verify : public testing::Test {
 protected:
  void SetUp() override {
    const FakeElevation source(bumpy_height, fine_around(glm::normalize(glm::dvec3(1, 1, 1)), 0.05, 40000));
    build_fake(path_, source, 300000);
  }

  paging::VerifyReport verify(std::size_t deep = 0) const {
    paging::VerifyOptions options;
    options.threads = 2;
    options.deep_tiles = deep;
    return paging::verify(*paging::PlanetFile::open(path_), options);
  }

  // Returns the problems, line by line.
  std::string words(std::size_t deep = 0) const {
    std::string all;
    for (const paging::Problem& p : verify(deep).problems) all += p.where + ": " + p.what + "\n";
    return all;
  }

  void expect_found(const std::string& what, std::size_t deep = 0) const {
    const std::string all = words(deep);
    EXPECT_NE(all.find(what), std::string::npos) << "'" << what << "' is not among:\n" << all;
  }

  // Returns one of the finest tiles.
  lod::TileInfo leaf() const {
    const auto planet = paging::PlanetFile::open(path_);
    for (const lod::TileInfo& tile : planet->tree().tiles()) {
      if (!tile.has_children && tile.key.level == planet->meta().finest_level) return tile;
    }
    throw std::logic_error("no leaf");
  }

  // Replaces a payload and its checksum. The identity no longer matches, which must not be the only finding.
  void replace(const std::string& table, const lod::TileKey& key, const paging::Bytes& data,
               int variant = 0) const {
    paging::Database db(path_, paging::Database::Mode::kCreate);
    const std::int64_t row = lod::pack(key);
    const bool mesh = table == "mesh";
    paging::Statement update(db, "UPDATE " + table + " SET checksum = ?, data = ? WHERE key = ?" +
                                     (mesh ? " AND variant = " + std::to_string(variant) : ""));
    update.bind(1, paging::checksum(row + (mesh ? variant : 0), data))
        .bind(2, std::span(data))
        .bind(3, row)
        .step();
  }

  void run_sql(const std::string& sql) const {
    paging::Database(path_, paging::Database::Mode::kCreate).execute(sql);
  }

  TempDir dir_;
  std::string path_ = (dir_ / "p.vpe").string();
};

TEST_F(Verify, FindsNoProblemInAGoodFile) {
  const paging::VerifyReport report = verify(1000);
  EXPECT_EQ(words(1000), "");
  const auto planet = paging::PlanetFile::open(path_);
  EXPECT_EQ(report.tiles, planet->meta().tiles);
  EXPECT_GT(report.meshes, report.tiles);
  EXPECT_GT(report.borders, 2 * planet->meta().leaf_tiles - 1);  // each tile has four, shared by two
  EXPECT_GT(report.measured, report.meshes);
  EXPECT_EQ(report.largest_share, 1.0);  // all finest tiles were measured: some bound is met exactly
}

TEST_F(Verify, APostThatMoved) {
  const lod::TileInfo tile = leaf();
  const auto planet = paging::PlanetFile::open(path_);
  const auto heights = planet->heights(tile.key);
  std::vector<std::int32_t> quanta;
  for (const double h : heights.posts.height_m) {
    quanta.push_back(static_cast<std::int32_t>(std::llround(h / planet->meta().quantum_m)));
  }
  const int side = heights.posts.side();
  quanta[static_cast<std::size_t>(side) * 16] += 1;  // on the west border
  replace("heights", tile.key, paging::encode_heights(quanta, side));
  expect_found("its posts differ from those of");
  expect_found("its posts are not those of " + lod::to_string(tile.key));
  expect_found("identity");
}

TEST_F(Verify, WrongMeshes) {
  const lod::TileInfo tile = leaf();
  const auto planet = paging::PlanetFile::open(path_);
  paging::PackedMesh mesh = planet->mesh(tile.key, 0);
  // A vertex off its post.
  paging::PackedMesh moved = mesh;
  moved.height_q.front() += 1;
  replace("mesh", tile.key, paging::encode_mesh(moved));
  expect_found("a vertex is not on its post");
  // A missing triangle.
  paging::PackedMesh open = mesh;
  open.mesh.triangles.resize(open.mesh.triangles.size() - 3);
  replace("mesh", tile.key, paging::encode_mesh(open));
  expect_found("its number of triangles differs from the index");
  // A reversed triangle.
  paging::PackedMesh turned = mesh;
  std::swap(turned.mesh.triangles[0], turned.mesh.triangles[1]);
  replace("mesh", tile.key, paging::encode_mesh(turned));
  expect_found("reversed");
  // Another tile's mesh: whole, but with other borders and heights.
  const auto other = planet->mesh(lod::child(lod::parent(tile.key), 3), 0);
  replace("mesh", tile.key, paging::encode_mesh(other));
  EXPECT_NE(words(), "");
}

TEST_F(Verify, BoundsThatAreTooSmallAreFoundByMeasuringAgain) {
  // Every stated error a hundredth too small, with checksums that fit.
  {
    paging::Database db(path_, paging::Database::Mode::kCreate);
    std::vector<paging::NodeRow> rows;
    ASSERT_FALSE(paging::read_nodes(db, rows));
    db.execute("UPDATE variant SET relief_m = 0.99 * relief_m, sag_m = 0.99 * sag_m, total_m = 0.99 * total_m");
    for (paging::NodeRow& row : rows) {
      for (lod::MeshVariant& v : row.variants) {
        v.terms = {0.99 * v.terms.height_error_m, 0.99 * v.terms.sagitta_m, 0.99 * v.terms.total_m};
      }
      paging::Statement update(db, "UPDATE node SET checksum = ? WHERE key = ?");
      update.bind(1, paging::checksum(row)).bind(2, row.key).step();
    }
  }
  EXPECT_EQ(words().find("than it states"), std::string::npos);
  expect_found("than it states", 1000);
}

TEST_F(Verify, RowsThatAreTooManyOrMissing) {
  run_sql("DELETE FROM mesh WHERE id = 3");
  expect_found("mesh: ");
  expect_found("is missing");
  run_sql("INSERT INTO image VALUES(5, 5, x'00')");
  EXPECT_THROW(paging::PlanetFile::open(path_), paging::PlanetError);
}

TEST_F(Verify, EveryFlippedBitOfThePayloadsIsFound) {
  const std::string good = [&] {
    std::ifstream in(path_, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }();
  Random random(91);
  int opened = 0;
  for (int n = 0; n < 40; ++n) {
    std::string bad = good;
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(good.size()) - 1));
    bad[at] = static_cast<char>(bad[at] ^ (1 << random.integer(0, 7)));
    std::ofstream(path_, std::ios::binary).write(bad.data(), static_cast<std::streamsize>(bad.size()));
    try {
      const auto found = verify();
      ++opened;
      // Unused bits (free space of pages) may differ; then the content is the same.
      if (found.problems.empty()) {
        const auto planet = paging::PlanetFile::open(path_);
        paging::Database db(path_, paging::Database::Mode::kReadOnly);
        EXPECT_EQ(paging::content_identity(db), planet->meta().identity);
      }
    } catch (const paging::PlanetError&) {
    }
  }
  EXPECT_GT(opened, 0);
}

}  // namespace
