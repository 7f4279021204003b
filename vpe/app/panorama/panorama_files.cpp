#include "vpe/app/panorama/panorama_files.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "panorama/image/big_tiff.h"
#include "panorama/image/row_file.h"
#include "panorama/image/tile_codec.h"
#include "panorama/metadata/gpano.h"
#include "vpe/app/cli/output.h"
#include "vpe/base/file.h"
#include "vpe/base/temporary.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

constexpr int kJpegQuality = 92;

using Done = std::function<void(double)>;

std::string software() { return std::string("vpe ") + version(); }

fs::path with_extension(const fs::path& image, const std::string& extension) {
  fs::path path = image;
  return path.replace_extension(extension);
}

// Returns the XMP packet, or "" for images that GPano cannot describe.
std::string packet_of(const PanoramaPlan& plan) {
  if (!plan.has_gpano) return {};
  try {
    panorama::GPano gpano = panorama::gpano_of(plan.map);
    gpano.use_viewer = true;
    gpano.stitching_software = software();
    return panorama::to_xmp(gpano);
  } catch (const panorama::MetadataError&) {
    return {};  // the sidecar still describes the image
  }
}

core::TiffMetadata metadata_of(const panorama::PlaneInfo& info) {
  const std::string unit(info.unit);
  core::TiffMetadata metadata;
  if (info.plane == panorama::Plane::kLonLat) {
    metadata.bands = {{"longitude", unit}, {"latitude", unit}};
  } else {
    metadata.bands = {{std::string(info.name), unit}};
  }
  metadata.items = {{"meaning", std::string(info.meaning)}};
  metadata.nodata = "nan";
  return metadata;
}

// Joins the strips of one run. References are kept.
class StripJoiner {
 public:
  StripJoiner(const PanoramaRequest& request, const PanoramaPlan& plan,
              const std::vector<panorama::StripFile>& strips, base::ThreadPool& pool)
      : request_(request), plan_(plan), strips_(strips), pool_(pool) {}

  void write_layer(base::OutputFile& file, std::size_t number, const Done& done) const {
    const panorama::PlaneInfo& info = panorama::info_of(request_.layers[number]);
    const panorama::SampleFormat format = info.format;
    panorama::BigTiffWriter writer(file, plan_.size.width_px, plan_.size.height_px, format,
                                   {software(), "", metadata_of(info)});
    copy_tiles(
        writer,
        [number](const StripLayout& layout) { return 1 + layout.image_blocks() + number * layout.tiles(); },
        done);
    writer.finish();
  }

  void write_image(base::OutputFile& file, const Done& done) const {
    const panorama::ImageSize& size = plan_.size;
    const std::string packet = packet_of(plan_);
    if (plan_.format != PanoramaFormat::kTiff) {
      const auto writer =
          plan_.format == PanoramaFormat::kPng
              ? panorama::make_png_writer(file, size.width_px, size.height_px, packet, pool_)
              : panorama::make_jpeg_writer(file, size.width_px, size.height_px, packet, kJpegQuality);
      copy_rows(*writer, done);
      return;
    }
    panorama::BigTiffWriter writer(file, size.width_px, size.height_px, panorama::kRgb,
                                   {software(), packet, {}});
    copy_tiles(
        writer, [](const StripLayout&) { return std::size_t{1}; }, [&](double part) { done(0.6 * part); });
    writer.add_reduced_pages(pool_, [&](double part) { done(0.6 + 0.4 * part); });
    writer.finish();
  }

 private:
  StripLayout layout(std::size_t strip) const {
    return layout_of(plan_, plan_.strips[strip], request_.layers.size());
  }

  void copy_tiles(panorama::BigTiffWriter& writer,
                  const std::function<std::size_t(const StripLayout&)>& first_block, const Done& done) const {
    std::int64_t across = 0;
    for (std::size_t n = 0; n < strips_.size(); ++n) {
      const StripLayout strip = layout(n);
      const std::size_t first = first_block(strip);
      for (std::int64_t y = 0; y < strip.tiles_down; ++y) {
        for (std::int64_t x = 0; x < strip.tiles_across; ++x) {
          writer.put(across + x, y,
                     strips_[n].block(first + static_cast<std::size_t>(y * strip.tiles_across + x)));
        }
      }
      across += strip.tiles_across;
      done(static_cast<double>(n + 1) / static_cast<double>(strips_.size()));
    }
  }

  void copy_rows(panorama::RowWriter& writer, const Done& done) const {
    const std::int64_t bands = layout(0).bands;
    const auto width = static_cast<std::size_t>(plan_.size.width_px);
    std::vector<base::Rgb> rows;
    for (std::int64_t band = 0; band < bands; ++band) {
      const std::int64_t begin = band * StripLayout::kBandRows;
      const auto count =
          static_cast<std::size_t>(std::min(StripLayout::kBandRows, plan_.size.height_px - begin));
      rows.resize(count * width);
      for (std::size_t n = 0; n < strips_.size(); ++n) {
        const panorama::Strip& strip = plan_.strips[n];
        const std::vector<std::uint8_t> bytes = strips_[n].block(1 + static_cast<std::size_t>(band));
        const std::size_t row_bytes = static_cast<std::size_t>(strip.width) * sizeof(base::Rgb);
        if (bytes.size() != count * row_bytes) throw std::runtime_error("a strip has another size");
        for (std::size_t y = 0; y < count; ++y) {
          std::memcpy(rows.data() + y * width + static_cast<std::size_t>(strip.x), bytes.data() + y * row_bytes,
                      row_bytes);
        }
      }
      writer.write(rows);
      done(static_cast<double>(band + 1) / static_cast<double>(bands));
    }
    writer.finish();
  }

  const PanoramaRequest& request_;
  const PanoramaPlan& plan_;
  const std::vector<panorama::StripFile>& strips_;
  base::ThreadPool& pool_;
};

void check_size(const fs::path& path, const PanoramaPlan& plan, int memory_mb) {
  if (plan.format == PanoramaFormat::kTiff) return;
  const panorama::ImageSize& image = plan.size;
  const std::string size = std::to_string(image.width_px) + "x" + std::to_string(image.height_px);
  if (plan.format == PanoramaFormat::kJpeg &&
      std::max(image.width_px, image.height_px) > panorama::kMaxJpegSide_px) {
    throw std::runtime_error(path.string() + ": cannot write " + size + " pixels: a JPEG has at most " +
                             std::to_string(panorama::kMaxJpegSide_px) + " a side; let the name end in .tif");
  }
  // One band of rows, unpacked and packed.
  const std::int64_t band_mb = 2 * StripLayout::kBandRows * image.width_px * 3 / (1 << 20);
  if (band_mb > memory_mb) {
    throw std::runtime_error(path.string() + ": cannot write " + size + " pixels: rows this long take " +
                             std::to_string(band_mb) + " MB; let the name end in .tif or raise --memory (now " +
                             std::to_string(memory_mb) + ")");
  }
}

void check_sidecar(const fs::path& image) {
  const fs::path path = sidecar_file(image);
  check_output(path);
  std::error_code error;
  if (!fs::exists(path, error)) return;
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 24;
  const auto bytes = base::read_file(path, kMostBytes);
  if (bytes.empty()) return;
  const auto json = nlohmann::json::parse(bytes, nullptr, false);
  const std::string advice = "; move it or choose another name for " + image.filename().string();
  if (!json.is_object() || !json.contains("vpe"))
    throw std::runtime_error(path.string() + ": exists, and 'vpe panorama' did not write it" + advice);
  const auto described = json.find("image");
  if (described == json.end() || !described->is_string() || *described == image.filename().string()) return;
  throw std::runtime_error(path.string() + ": describes the image '" + described->get<std::string>() +
                           "', which would lose its recipe" + advice);
}

// Returns true for names that strip_file() makes.
bool is_strip_name(const std::string& name) {
  constexpr std::string_view kBegin = "strip_";
  constexpr std::size_t kFewestDigits = 6;
  return name.starts_with(kBegin) && name.size() >= kBegin.size() + kFewestDigits &&
         name.find_first_not_of("0123456789", kBegin.size()) == std::string::npos;
}

}  // namespace

PanoramaFormat panorama_format(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (extension == ".tif" || extension == ".tiff") return PanoramaFormat::kTiff;
  if (extension == ".png") return PanoramaFormat::kPng;
  if (extension == ".jpg" || extension == ".jpeg") return PanoramaFormat::kJpeg;
  throw std::runtime_error(path.string() +
                           ": cannot write: no known image format; let the name end in .tif, .png or .jpg");
}

fs::path layer_file(const fs::path& image, panorama::Plane layer) {
  return with_extension(image, "." + std::string(panorama::info_of(layer).name) + ".tif");
}

fs::path sidecar_file(const fs::path& image) { return with_extension(image, ".json"); }

fs::path strips_folder(const fs::path& image) { return image.string() + ".parts"; }

fs::path strip_file(const fs::path& image, std::size_t number) {
  std::array<char, 40> name{};
  std::snprintf(name.data(), name.size(), "strip_%06zu", number);
  return strips_folder(image) / name.data();
}

void remove_stale_strips(const fs::path& image) {
  base::remove_stale_temporaries(strips_folder(image), is_strip_name);
}

void remove_strips(const fs::path& image) {
  remove_stale_strips(image);
  std::error_code error;
  std::vector<fs::path> files;
  const fs::path folder = strips_folder(image);
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (is_strip_name(entry->path().filename().string())) files.push_back(entry->path());
  }
  for (const fs::path& file : files) fs::remove(file, error);
  fs::remove(folder, error);  // fails when it holds other files
}

void check_files(const PanoramaRequest& request, const PanoramaPlan& plan, int memory_mb) {
  const core::SettingsValues& settings = request.settings.values();
  std::vector<fs::path> inputs{request.planet, settings.names, settings.palette, settings.scene};
  const fs::path sidecar = sidecar_file(request.output);
  std::error_code none;
  // An image that is made again gets its own sidecar again.
  if (!fs::equivalent(request.from_sidecar, sidecar, none)) inputs.emplace_back(request.from_sidecar);
  std::vector<Output> outputs{{"-o", request.output, FileKind::kPanorama}};
  for (const panorama::Plane layer : request.layers)
    outputs.push_back({"--aux-layers", layer_file(request.output, layer), FileKind::kPanoramaPlane});
  check_size(request.output, plan, memory_mb);
  check_outputs(outputs, inputs);
  for (const fs::path& input : inputs) {
    if (fs::equivalent(sidecar, input, none))
      throw UsageError(sidecar.string() + ": is an input; choose another name for " +
                       request.output.filename().string());
  }
  check_sidecar(request.output);
}

void remove_stale_files(const fs::path& image) {
  std::vector<std::string> names{image.filename().string(), sidecar_file(image).filename().string()};
  for (const panorama::PlaneInfo& info : panorama::all_planes())
    names.push_back(layer_file(image, info.plane).filename().string());
  const fs::path folder = image.has_parent_path() ? image.parent_path() : fs::path(".");
  base::remove_stale_temporaries(folder, [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  });
}

void join_strips(const PanoramaRequest& request, const PanoramaPlan& plan, const std::string& sidecar,
                 const std::vector<panorama::StripFile>& strips, base::ThreadPool& pool,
                 const std::function<void(double)>& done) {
  const StripJoiner joiner(request, plan, strips, pool);
  const std::size_t layers = request.layers.size();
  const double steps = static_cast<double>(1 + layers);
  std::vector<std::unique_ptr<base::OutputFile>> files;
  const auto make = [&](const fs::path& path) -> base::OutputFile& {
    return *files.emplace_back(std::make_unique<base::OutputFile>(path));
  };
  for (std::size_t n = 0; n < layers; ++n) {
    joiner.write_layer(make(layer_file(request.output, request.layers[n])), n,
                       [&](double part) { done((static_cast<double>(n) + part) / steps); });
  }
  joiner.write_image(make(request.output), [&](double part) { done((steps - 1.0 + part) / steps); });
  for (const auto& file : files) file->commit();
  base::write_file(sidecar_file(request.output), sidecar);
}

}  // namespace vpe::app
