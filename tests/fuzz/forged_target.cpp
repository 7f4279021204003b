// Planet files that were changed by somebody who knows how rows are summed: every checksum is right, so the code
// behind the checksums is reached.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "paging/build/builder.h"
#include "paging/planet/verify.h"
#include "paging/surface/query.h"
#include "tests/fuzz/targets.h"
#include "tests/paging/forged_planet.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/core/image/image.h"

namespace fuzz {

namespace {

namespace fs = std::filesystem;

constexpr int kMostChanges = 4;

// Takes an input apart; past its end everything is zero.
class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool at_end() const { return bytes_.empty(); }
  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  template <class T, std::size_t N>
  const T& one_of(const std::array<T, N>& all) {
    return all[byte() % N];
  }
  Bytes piece() {
    const std::size_t asked = byte();
    const std::size_t size = std::min(asked, bytes_.size());
    Bytes out(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size));
    bytes_ = bytes_.subspan(size);
    return out;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

constexpr std::array kTables{"heights",    "mesh", "image",   "missing",     "origin",
                             "resampling", "node", "variant", "posts_error", "meta"};
constexpr std::array kPayloads{"heights", "mesh", "image", "missing", "origin"};
constexpr std::array kNodeColumns{"min_m", "max_m", "slope", "inner", "steps", "sources"};
constexpr std::array kTermColumns{"relief_m", "sag_m", "total_m"};
constexpr std::array kMetaKeys{"format",
                               "body",
                               "radius_m",
                               "datum",
                               "shape",
                               "tile_k",
                               "quantum_m",
                               "fill_m",
                               "sources",
                               "image_sources",
                               "resampling_max_m",
                               "resampling_rms_m",
                               "resampling_posts",
                               "lowest_radius_m",
                               "highest_radius_m",
                               "leaf_tiles",
                               "tiles",
                               "image_tiles",
                               "finest_level",
                               "finest_image_level",
                               "levels",
                               "illustration",
                               "part"};
constexpr std::array kValues{"0",
                             "1",
                             "-1",
                             "7",
                             "78",
                             "1e300",
                             "-1e300",
                             "9e999",
                             "NULL",
                             "'x'",
                             "''",
                             "'0,0'",
                             "'99999999999'",
                             "'{}'",
                             "'[]'",
                             "'[[]]'",
                             "'[{}]'",
                             "x'ff00'",
                             "2147483648",
                             "-9223372036854775808",
                             "3396190",
                             "0.5",
                             "'nan'",
                             "'true'",
                             "'null'",
                             "1e-300"};

std::string nth_row(const std::string& table, int n) {
  return " WHERE rowid = (SELECT rowid FROM " + table + " LIMIT 1 OFFSET " + std::to_string(n) +
         " % max(1, (SELECT count(*) FROM " + table + ")))";
}

// Changes numbers inside the compressed payload of a row, or the bytes of an image.
void change_payload(paging::Database& db, const std::string& table, int n, Input& input) {
  Bytes data;
  {
    paging::Statement row(db, "SELECT data FROM " + table + nth_row(table, n));
    if (!row.step()) return;
    data.assign(row.blob(0).begin(), row.blob(0).end());
  }
  const bool is_packed = table != "image";
  if (is_packed) data = paging::decompress(data, std::size_t{1} << 24);
  for (int changes = input.byte() % 8; changes >= 0 && !data.empty(); --changes) {
    const std::size_t at = (std::size_t{input.byte()} << 8 | input.byte()) % data.size();
    // The head of a payload has the sizes.
    data[input.byte() % 2 == 0 ? at : at % std::min<std::size_t>(16, data.size())] = input.byte();
  }
  if (input.byte() % 8 == 0) data.resize(data.size() / 2);
  if (is_packed) data = paging::compress(data, 1);
  paging::Statement(db, "UPDATE " + table + " SET data = ?" + nth_row(table, n))
      .bind(1, std::span(data))
      .step();
}

void change(paging::Database& db, Input& input) {
  // A view of the last branch has rows without end, which a change of it would count.
  if (db.integer("SELECT count(*) FROM sqlite_schema WHERE type = 'view'") > 0) return;
  const int kind = input.byte() % 8;
  const int n = input.byte();
  switch (kind) {
    case 0: {
      const std::string key = input.one_of(kMetaKeys);
      db.execute("INSERT OR REPLACE INTO meta VALUES('" + key + "', coalesce(" + input.one_of(kValues) +
                 ", ''))");
      break;
    }
    case 1:
      db.execute(std::string("UPDATE node SET ") + input.one_of(kNodeColumns) + " = " + input.one_of(kValues) +
                 nth_row("node", n));
      break;
    case 2: {
      // The table has no rowid.
      const std::string column = input.byte() % 4 == 0 ? "triangles" : input.one_of(kTermColumns);
      db.execute("UPDATE variant SET " + column + " = " + input.one_of(kValues) +
                 " WHERE (key, variant) = (SELECT key, variant FROM variant LIMIT 1 OFFSET " +
                 std::to_string(n) + " % max(1, (SELECT count(*) FROM variant)))");
      break;
    }
    case 3:
      db.execute(std::string("UPDATE posts_error SET ") + input.one_of(kTermColumns) + " = " +
                 input.one_of(kValues) + nth_row("posts_error", n));
      break;
    case 4: {
      const std::string table = input.one_of(kPayloads);
      change_payload(db, table, n, input);
      break;
    }
    case 5: {
      const std::string table = input.one_of(kPayloads);
      db.execute("DELETE FROM " + table + nth_row(table, n));
      break;
    }
    case 6: {
      const std::string table = input.one_of(kPayloads);
      const Bytes data = input.piece();
      paging::Statement(db, "UPDATE " + table + " SET data = ?" + nth_row(table, n))
          .bind(1, std::span(data))
          .step();
      break;
    }
    default: {
      const std::string table = input.one_of(kTables);
      db.execute("ALTER TABLE " + table + " RENAME TO kept_" + std::to_string(n));
      db.execute(
          "CREATE VIEW " + table +
          " AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT x AS key, x AS value, "
          "x AS variant, x AS checksum, x AS data FROM c");
    }
  }
}

// Reads all of a planet as commands do.
void use(const std::shared_ptr<const paging::PlanetFile>& planet, bool is_sound) {
  const paging::PlanetMeta& meta = planet->meta();
  for (const lod::TileInfo& tile : planet->tree().tiles()) {
    try {
      const paging::TileHeights heights = planet->heights(tile.key);
      const auto [low, high] =
          std::minmax_element(heights.posts.height_m.begin(), heights.posts.height_m.end());
      if (is_sound) {
        require(meta.radius_m + *low >= meta.lowest_radius_m && meta.radius_m + *high <= meta.highest_radius_m,
                "the surface of a sound planet lies within its bounds");
      }
    } catch (const paging::PlanetError&) {
      require(!is_sound, "tiles of a sound planet can be read");
    }
  }
  try {
    const paging::Surface surface(planet, std::size_t{1} << 22);
    for (const mars::LonLat place : {mars::LonLat{10, 20}, mars::LonLat{-170, -80}, mars::LonLat{45, 35}})
      paging::query(surface, place);
  } catch (const paging::PlanetError&) {
    require(!is_sound, "a sound planet can be queried");
  }
}

const std::string& forged_file() {
  static const std::string path = [] {
    const fs::path folder = fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
    static const std::string kept = (folder / ("vpe-forged-" + std::to_string(::getpid()) + ".vpe")).string();
    std::atexit([] {
      std::error_code none;
      fs::remove(kept, none);
    });
    return kept;
  }();
  return path;
}

// A planet with inner tiles, nodata and images.
const Bytes& original() {
  static const Bytes file = [] {
    const auto height = [](const glm::dvec3& d) {
      return d.z > 0.9 ? std::nan("") : test_support::bumpy_height(d);
    };
    const test_support::FakeElevation source(
        height, test_support::fine_around(glm::normalize(glm::dvec3(1, 1, 1)), 0.05, 400000));
    paging::BuildOptions options;
    options.output = forged_file();
    options.base_spacing_m = 1e6;
    options.tile_k = 3;
    options.threads = 1;
    options.resampling_posts = 100;
    options.finest_image_m = 1e5;
    const test_support::FakeImage image;
    paging::build_planet(options, source, &image);
    std::ifstream in(forged_file(), std::ios::binary);
    return Bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }();
  return file;
}

void run_forged(std::span<const std::uint8_t> bytes) {
  const Bytes& file = original();
  std::ofstream(forged_file(), std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
  Input input(bytes);
  const bool is_changed = !bytes.empty();
  try {
    {
      paging::Database db(forged_file(), paging::Database::Mode::kCreate);
      db.execute("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF");
      for (int n = 0; n < kMostChanges && !input.at_end(); ++n) change(db, input);
    }
    // Views cannot be summed; such a file is opened as it is.
    paging::Database probe(forged_file(), paging::Database::Mode::kReadOnly);
    if (probe.integer("SELECT count(*) FROM sqlite_schema WHERE type = 'view'") == 0)
      test_support::forge_checksums(forged_file());
  } catch (const paging::DatabaseError&) {
  } catch (const paging::CodecError&) {
  }
  try {
    const auto planet = paging::PlanetFile::open(forged_file());
    const std::vector<paging::Problem> problems =
        paging::verify(*planet, {.threads = 1, .deep_tiles = 2}).problems;
    const bool is_sound = problems.empty();
    require(is_sound || is_changed, is_sound ? "" : (problems[0].where + ": " + problems[0].what).c_str());
    use(planet, is_sound);
  } catch (const paging::PlanetError& e) {
    require(is_changed, e.what());
  }
}

std::vector<Bytes> forged_seeds() {
  std::vector<Bytes> all;
  for (std::uint8_t kind = 0; kind < 8; ++kind) {
    for (std::uint8_t what = 0; what < 24; ++what)
      all.push_back({kind, what, what, static_cast<std::uint8_t>(3 * what + kind), 1, 0, 1, 1, 255, 9});
  }
  return all;
}

}  // namespace

const Target kForged{"forged", run_forged, forged_seeds};

}  // namespace fuzz
