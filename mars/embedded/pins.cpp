#include "mars/embedded/pins.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

constexpr int kColumns = kMeasuredColumns;
constexpr int kRows = kColumns / 2;

// Returns the direction of a fractional column and row.
glm::dvec3 direction_at(double column, double row) {
  return place((column + 0.5) * kMeasuredPost_deg, 90.0 - (row + 0.5) * kMeasuredPost_deg);
}

struct PostIndex {
  int column, row;
};

// Returns the post that stands for one beyond the seam or a pole.
PostIndex canonical(int column, int row) {
  if (row < 0 || row >= kRows) {
    row = row < 0 ? -1 - row : kColumns - 1 - row;
    column += kRows;
  }
  column %= kColumns;
  return {column < 0 ? column + kColumns : column, row};
}

int log2_of(double spacing_m) {
  int k = 0;
  double power_m = kFinestDetail_m;
  while (power_m < spacing_m) {
    power_m *= 2.0;
    ++k;
  }
  return k;
}

// Remembers values by key: a slot each for keys that are equal modulo its size.
template <typename Value, std::size_t kSlots>
class Memo {
 public:
  Value* find(std::uint64_t key) {
    Slot& slot = slots_[index(key)];
    return slot.key == key ? &slot.value : nullptr;
  }
  Value& set(std::uint64_t key, const Value& value) {
    Slot& slot = slots_[index(key)];
    slot.key = key;
    slot.value = value;
    return slot.value;
  }

 private:
  struct Slot {
    std::uint64_t key = ~std::uint64_t{0};
    Value value{};
  };
  static std::size_t index(std::uint64_t key) { return mix_bits(key) % kSlots; }
  std::vector<Slot> slots_ = std::vector<Slot>(kSlots);
};

// Holds the relief at a post, and how it is drawn out there.
struct Pin {
  float group[kPinnedGroups];
  float east = 0, north = 0;  // unit vector along the fall line
  float along = 1;            // how much longer the relief is along it than across
};

// Returns the key of a post in a memo. Tests have other data besides the carried ones.
std::uint64_t key_of(const MeasuredMars& mars, int column, int row, int detail) {
  const std::uint64_t post = static_cast<std::uint64_t>(row) * kColumns + static_cast<std::uint64_t>(column);
  return (mars.id() << 40) | (post << 6) | static_cast<std::uint64_t>(detail);
}

// Evaluates the relief at posts.
class PinMaker {
 public:
  void make(const MeasuredMars& mars, std::span<const PostIndex> posts, double detail_m, Simd simd, Pin* out) {
    for (std::size_t first = 0; first < posts.size(); first += kBlock) {
      Block block;
      block.simd = simd;
      block.count = std::min(kBlock, posts.size() - first);
      for (std::size_t i = 0; i < block.count; ++i) {
        const PostIndex& p = posts[first + i];
        const glm::dvec3 d = direction_at(p.column, p.row);
        block.x[i] = d.x;
        block.y[i] = d.y;
        block.z[i] = d.z;
      }
      block.finish();
      lay_ground(block, mars, ground_);
      add_octaves(block, detail_m, octaves_);
      craters_.clear();
      lay_relief(block, detail_m, ground_, octaves_, craters_, relief_);
      for (std::size_t i = 0; i < block.count; ++i) {
        Pin& pin = out[first + i];
        pin = Pin{};
        for (std::size_t g = 0; g < kPinnedGroups; ++g) pin.group[g] = relief_.group[g][i];
        if (!ground_.has_walls) continue;
        pin.east = static_cast<float>(ground_.fall_east[i]);
        pin.north = static_cast<float>(ground_.fall_north[i]);
        pin.along = 1.0F + 2.0F * ground_.wall[i];
      }
    }
  }

 private:
  Ground ground_;
  Octaves octaves_;
  CraterSum craters_;
  Relief relief_;
};

// Returns 1 at 0, falling to 0 at 1 and beyond: C1, and shares of two neighbours add up to 1.
[[gnu::always_inline]] inline float share_at(float t) {
  const float s = std::max(0.0F, 1.0F - t);
  return s * s * (3.0F - 2.0F * s);
}

// Returns how many posts of a row one area takes: a power of two, so that areas are about as wide as high.
int posts_in_area(int row) {
  const double cosine = exact_sin_cos_deg(90.0 - (row + 0.5) * kMeasuredPost_deg).cos;
  int n = 1;
  while (n < 64 && 2.0 * n * cosine <= 1.0) n *= 2;
  return n;
}

// The mean of the detail of an area is subtracted in this shape: 0 at its borders and along the posts, C1, mean 1 (kShape).
// u and v are -1/2 to 1/2 across the area; `is_row` tells that posts lie all along v = 0.
[[gnu::always_inline]] inline float area_shape(float u, float v, bool is_row) {
  const float a = std::max(0.0F, 1.0F - 4.0F * u * u);
  const float b = std::max(0.0F, 1.0F - 4.0F * v * v);
  const float r = std::max(0.0F, 1.0F - (is_row ? v * v : u * u + v * v) * (1.0F / (0.3F * 0.3F)));
  return a * a * b * b * (1.0F - r * r * r);
}

// Returns the mean of area_shape(), by the midpoints of a fine grid.
float mean_shape(bool is_row) {
  constexpr int kSteps = 128;
  double sum = 0.0;
  for (int j = 0; j < kSteps; ++j) {
    for (int i = 0; i < kSteps; ++i) {
      sum += static_cast<double>(area_shape((static_cast<float>(i) + 0.5F) / kSteps - 0.5F,
                                            (static_cast<float>(j) + 0.5F) / kSteps - 0.5F, is_row));
    }
  }
  return static_cast<float>(sum / (kSteps * kSteps));
}

// Finds the mean of the detail over an area, whose first column is `column`.
float mean_detail(const MeasuredMars& mars, int column, int row, int posts, double detail_m, Simd simd) {
  // Half the wavelength of the shortest octave between two directions, or less.
  const int steps = detail_m >= 1024.0 ? 8 : 16;
  std::vector<glm::dvec3> directions;
  directions.reserve(static_cast<std::size_t>(steps * steps));
  for (int b = 0; b < steps; ++b) {
    for (int a = 0; a < steps; ++a) {
      directions.push_back(
          direction_at(column - 0.5 + posts * (a + 0.5) / steps, row - 0.5 + (b + 0.5) / steps));
    }
  }
  double sum = 0.0;
  evaluate_all(mars, directions, detail_m, simd, Wanted::kHeightsWithoutMeans,
               [&](const Block&, std::span<const std::uint32_t> index, const Surface& s) {
                 for (std::size_t i = 0; i < index.size(); ++i) {
                   // In an order that does not depend on the blocks: whole 1/1024 metres.
                   sum += static_cast<double>(static_cast<std::int32_t>(s.detail_m[i] * 1024.0F));
                 }
               });
  return static_cast<float>(sum / (1024.0 * steps * steps));
}

}  // namespace

void sum_pinned(const Block& block, const MeasuredMars& mars, double detail_m, const Ground& ground,
                const Relief& relief, Lane<float>& out) {
  static thread_local Memo<Pin, 8192> memo;
  static thread_local std::unique_ptr<PinMaker> maker = std::make_unique<PinMaker>();
  static thread_local std::vector<PostIndex> absent;
  static thread_local std::vector<std::size_t> slots;
  static thread_local std::vector<Pin> pins, made;

  // The posts around all directions, as a window of columns and rows. Columns count from that of the first direction.
  const int detail = log2_of(detail_m);
  Lane<std::int32_t> column, row;
  const std::int32_t start = floor_int(ground.places.column[0]);
  std::int32_t first_column = 0, last_column = 0;
  std::int32_t first_row = floor_int(ground.places.row[0]), last_row = first_row;
  for (std::size_t i = 0; i < block.padded; ++i) {
    std::int32_t apart = floor_int(ground.places.column[i]) - start;
    apart += apart < -kRows ? kColumns : (apart >= kRows ? -kColumns : 0);
    column[i] = apart;
    row[i] = floor_int(ground.places.row[i]);
    first_column = std::min(first_column, apart);
    last_column = std::max(last_column, apart);
    first_row = std::min(first_row, row[i]);
    last_row = std::max(last_row, row[i]);
  }
  const auto wide = static_cast<std::size_t>(last_column - first_column + 2);
  const auto high = static_cast<std::size_t>(last_row - first_row + 2);
  pins.resize(wide * high);
  absent.clear();
  slots.clear();
  for (std::size_t j = 0; j < high; ++j) {
    for (std::size_t i = 0; i < wide; ++i) {
      const PostIndex p =
          canonical(start + first_column + static_cast<int>(i), first_row + static_cast<int>(j));
      if (const Pin* known = memo.find(key_of(mars, p.column, p.row, detail))) {
        pins[j * wide + i] = *known;
      } else {
        absent.push_back(p);
        slots.push_back(j * wide + i);
      }
    }
  }
  if (!absent.empty()) {
    made.resize(absent.size());
    maker->make(mars, absent, detail_m, block.simd, made.data());
    for (std::size_t k = 0; k < absent.size(); ++k) {
      pins[slots[k]] = made[k];
      memo.set(key_of(mars, absent[k].column, absent[k].row, detail), made[k]);
    }
  }

  for (std::size_t i = 0; i < block.padded; ++i) {
    const auto x = static_cast<float>(ground.places.column[i] - floor_int(ground.places.column[i]));
    const auto y = static_cast<float>(ground.places.row[i] - static_cast<double>(row[i]));
    const Pin* north = &pins[static_cast<std::size_t>(row[i] - first_row) * wide +
                             static_cast<std::size_t>(column[i] - first_column)];
    const Pin* south = north + wide;
    float sum = 0.0F;
    for (const auto& group : relief.group) sum += group[i];
    sum -= relief.group[kPinnedGroups][i];
    const auto wide_m = static_cast<float>(ground.column_m[i]);
    for (int corner = 0; corner < 4; ++corner) {
      const float dx = x - static_cast<float>(corner & 1), dy = y - static_cast<float>(corner >> 1);
      const Pin& pin = corner < 2 ? north[corner] : south[corner - 2];
      const float cell = share_at(magnitude(dx)) * share_at(magnitude(dy));
      if (cell == 0.0F) continue;
      sum -= cell * pin.group[0];
      const float e = dx * wide_m, n = -dy * static_cast<float>(kMeasuredPost_m);
      const float along = (e * pin.east + n * pin.north) / pin.along;
      const float across = n * pin.east - e * pin.north;
      // Off walls the pin has no direction.
      const float r2 = pin.along > 1.0F ? along * along + across * across : e * e + n * n;
      for (std::size_t g = 1; g < kPinnedGroups; ++g) {
        const float reach = kPinnedReach_m[g];
        const float t = 1.0F - r2 / (reach * reach);
        if (t > 0.0F) sum -= cell * t * t * t * pin.group[g];
      }
    }
    // Boulders and ripples end beside a post.
    const auto apart = static_cast<float>(ground.post_m[i]);
    out[i] = sum + relief.group[kPinnedGroups][i] * ramp(2.0F, 12.0F, apart);
  }
}

void subtract_means(const Block& block, const MeasuredMars& mars, double spacing_m, const Ground& ground,
                    Lane<float>& detail_m) {
  static thread_local Memo<float, 4096> memo;
  static const float kShape[2] = {mean_shape(false), mean_shape(true)};
  const double coarse_m = std::max(spacing_m, kMeanDetail_m);
  const int level = log2_of(coarse_m);
  // Neighbours share an area: what belongs to it is found again only where it changes.
  int row = -1, column = -1, posts = 1;
  float mean = 0.0F;
  for (std::size_t i = 0; i < block.padded; ++i) {
    const int own_row = std::clamp(floor_int(ground.places.row[i] + 0.5), 0, kRows - 1);
    if (own_row != row) posts = posts_in_area(own_row);
    const int own_column = floor_int((ground.places.column[i] + 0.5) / posts) * posts;
    if (own_row != row || own_column != column) {
      row = own_row;
      column = own_column;
      const std::uint64_t key = key_of(mars, column, row, level);
      const float* known = memo.find(key);
      mean = known != nullptr ? *known
                              : memo.set(key, mean_detail(mars, column, row, posts, coarse_m, block.simd));
    }
    const auto u = static_cast<float>((ground.places.column[i] + 0.5 - column) / posts - 0.5);
    const auto v = static_cast<float>(ground.places.row[i] - row);
    detail_m[i] -= mean * area_shape(u, v, posts > 1) / kShape[posts > 1 ? 1 : 0];
  }
}

}  // namespace mars::embedded
