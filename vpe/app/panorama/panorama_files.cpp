#include "vpe/app/panorama/panorama_files.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "panorama/image/big_tiff.h"
#include "panorama/image/row_file.h"
#include "panorama/image/tile_codec.h"
#include "panorama/metadata/gpano.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/temporary.h"
#include "vpe/base/file.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

constexpr int kJpegQuality = 92;

fs::path with_end(const fs::path& image, const std::string& end) {
  fs::path path = image;
  return path.replace_extension(end);
}

// Empty for images that GPano cannot describe.
std::string packet_of(const PanoramaJob& job) {
  if (!job.has_gpano) return {};
  try {
    panorama::GPano gpano = panorama::gpano_of(job.map);
    gpano.use_viewer = true;
    gpano.stitching_software = job.software;
    return panorama::to_xmp(gpano);
  } catch (const panorama::MetadataError&) {
    return {};  // the sidecar has it all
  }
}

void copy_tiles(panorama::BigTiffWriter& writer, const PanoramaJob& job,
                const std::vector<panorama::StripFile>& strips,
                std::size_t first_of_strip(const StripLayout&, std::size_t), std::size_t plane,
                const std::function<void(double)>& done) {
  std::int64_t across = 0;
  for (std::size_t n = 0; n < strips.size(); ++n) {
    const StripLayout layout = layout_of(job.format, job.size.height_px, job.strips[n], job.planes.size());
    const std::size_t first = first_of_strip(layout, plane);
    for (std::int64_t y = 0; y < layout.tiles_down; ++y) {
      for (std::int64_t x = 0; x < layout.tiles_across; ++x) {
        writer.put(across + x, y,
                   strips[n].block(first + static_cast<std::size_t>(y * layout.tiles_across + x)));
      }
    }
    across += layout.tiles_across;
    done(static_cast<double>(n + 1) / static_cast<double>(strips.size()));
  }
}

std::size_t first_of_image(const StripLayout& /*layout*/, std::size_t /*plane*/) { return 1; }
std::size_t first_of_plane(const StripLayout& layout, std::size_t plane) {
  return 1 + layout.image_blocks() + plane * layout.tiles();
}

void copy_rows(panorama::RowWriter& writer, const PanoramaJob& job,
               const std::vector<panorama::StripFile>& strips, const std::function<void(double)>& done) {
  const std::int64_t bands = layout_of(job.format, job.size.height_px, job.strips.front(), 0).bands;
  const auto width = static_cast<std::size_t>(job.size.width_px);
  std::vector<base::Rgb> rows;
  for (std::int64_t band = 0; band < bands; ++band) {
    const std::int64_t begin = band * StripLayout::kBandRows;
    const auto count = static_cast<std::size_t>(std::min(StripLayout::kBandRows, job.size.height_px - begin));
    rows.resize(count * width);
    for (std::size_t n = 0; n < strips.size(); ++n) {
      const std::vector<std::uint8_t> bytes = strips[n].block(1 + static_cast<std::size_t>(band));
      const std::size_t row_bytes = static_cast<std::size_t>(job.strips[n].width) * sizeof(base::Rgb);
      if (bytes.size() != count * row_bytes) throw std::runtime_error("a strip of another size");
      for (std::size_t y = 0; y < count; ++y) {
        std::memcpy(rows.data() + y * width + static_cast<std::size_t>(job.strips[n].x),
                    bytes.data() + y * row_bytes, row_bytes);
      }
    }
    writer.write(rows);
    done(static_cast<double>(band + 1) / static_cast<double>(bands));
  }
  writer.finish();
}

void write_image(base::OutputFile& file, const PanoramaJob& job, const std::vector<panorama::StripFile>& strips,
                 base::ThreadPool& pool, const std::function<void(double)>& done) {
  const panorama::ImageSize& size = job.size;
  const std::string packet = packet_of(job);
  if (job.format != PanoramaFormat::kTiff) {
    const auto writer =
        job.format == PanoramaFormat::kPng
            ? panorama::make_png_writer(file, size.width_px, size.height_px, packet, pool)
            : panorama::make_jpeg_writer(file, size.width_px, size.height_px, packet, kJpegQuality);
    copy_rows(*writer, job, strips, done);
    return;
  }
  panorama::BigTiffWriter writer(file, size.width_px, size.height_px, panorama::kRgb,
                                 {job.software, packet, false});
  copy_tiles(writer, job, strips, first_of_image, 0, [&](double part) { done(0.6 * part); });
  writer.add_reduced_pages(pool, [&](double part) { done(0.6 + 0.4 * part); });
  writer.finish();
}

}  // namespace

PanoramaFormat panorama_format(const fs::path& path) {
  std::string end = path.extension().string();
  for (char& c : end) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  std::optional<PanoramaFormat> format;
  if (end == ".tif" || end == ".tiff") format = PanoramaFormat::kTiff;
  if (end == ".png") format = PanoramaFormat::kPng;
  if (end == ".jpg" || end == ".jpeg") format = PanoramaFormat::kJpeg;
  if (!format) {
    throw std::runtime_error(path.string() +
                             ": cannot write: no known picture format; let the name end in .tif, .png or .jpg");
  }
  check_output(path);
  return *format;
}

void check_panorama_size(const fs::path& path, const panorama::ImageSize& image, int memory_mb) {
  const std::string size = std::to_string(image.width_px) + "x" + std::to_string(image.height_px);
  const PanoramaFormat format = panorama_format(path);
  if (format == PanoramaFormat::kTiff) return;
  if (format == PanoramaFormat::kJpeg &&
      std::max(image.width_px, image.height_px) > panorama::kMaxJpegSide_px) {
    throw std::runtime_error(path.string() + ": cannot write " + size + " pixels: a JPEG has at most " +
                             std::to_string(panorama::kMaxJpegSide_px) + " a side; let the name end in .tif");
  }
  // A band of rows, as it is and packed.
  const std::int64_t band_mb = 2 * StripLayout::kBandRows * image.width_px * 3 / (1 << 20);
  if (band_mb > memory_mb) {
    throw std::runtime_error(path.string() + ": cannot write " + size + " pixels: rows this long take " +
                             std::to_string(band_mb) + " MB; let the name end in .tif or raise --memory (now " +
                             std::to_string(memory_mb) + ")");
  }
}

fs::path plane_file(const fs::path& image, panorama::Plane plane) {
  return with_end(image, "." + std::string(panorama::info_of(plane).name) + ".tif");
}

fs::path sidecar_file(const fs::path& image) { return with_end(image, ".json"); }

void check_sidecar(const fs::path& image) {
  const fs::path path = sidecar_file(image);
  check_output(path);
  std::error_code error;
  if (!fs::exists(path, error)) return;
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 24;
  const auto bytes = base::read_file(path, kMostBytes);
  const auto json = nlohmann::json::parse(bytes, nullptr, false);
  if (json.is_object() && json.contains("vpe")) return;
  throw std::runtime_error(
      path.string() + ": is there, and 'vpe panorama' did not write it; move it or choose another name for " +
      image.filename().string());
}

void remove_stale_files(const fs::path& image) {
  std::vector<std::string> names{image.filename().string(), sidecar_file(image).filename().string()};
  for (const panorama::PlaneInfo& info : panorama::all_planes())
    names.push_back(plane_file(image, info.plane).filename().string());
  const fs::path folder = image.has_parent_path() ? image.parent_path() : fs::path(".");
  remove_stale_temporaries(folder, [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  });
}

fs::path strips_folder(const fs::path& image) { return image.string() + ".parts"; }

StripLayout layout_of(PanoramaFormat format, std::int64_t height_px, const panorama::Strip& strip,
                      std::size_t planes) {
  const auto tiles = [](std::int64_t px) { return (px + panorama::kTile_px - 1) / panorama::kTile_px; };
  StripLayout layout;
  layout.in_tiles = format == PanoramaFormat::kTiff;
  layout.tiles_across = tiles(strip.width);
  layout.tiles_down = tiles(height_px);
  layout.bands = (height_px + StripLayout::kBandRows - 1) / StripLayout::kBandRows;
  layout.planes = planes;
  return layout;
}

void join_strips(const PanoramaJob& job, const std::vector<panorama::StripFile>& strips, base::ThreadPool& pool,
                 const std::function<void(double)>& done) {
  const double steps = static_cast<double>(1 + job.planes.size());
  std::vector<std::unique_ptr<base::OutputFile>> files;
  const auto make = [&](const fs::path& path) -> base::OutputFile& {
    return *files.emplace_back(std::make_unique<base::OutputFile>(path, temporary_name(path)));
  };
  for (std::size_t n = 0; n < job.planes.size(); ++n) {
    const panorama::SampleFormat format = panorama::info_of(job.planes[n]).format;
    panorama::BigTiffWriter writer(make(plane_file(job.output, job.planes[n])), job.size.width_px,
                                   job.size.height_px, format, {job.software, "", true});
    copy_tiles(writer, job, strips, first_of_plane, n,
               [&](double part) { done((static_cast<double>(n) + part) / steps); });
    writer.finish();
  }
  write_image(make(job.output), job, strips, pool, [&](double part) { done((steps - 1.0 + part) / steps); });
  for (const auto& file : files) file->commit();
  write_whole(sidecar_file(job.output), job.sidecar);
}

}  // namespace vpe::app
