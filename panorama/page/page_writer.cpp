#include "panorama/page/page_writer.h"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "panorama/page/base64.h"
#include "panorama/page/page_files.h"
#include "panorama/page/page_layers.h"
#include "vpe/base/file.h"
#include "vpe/core/image/image.h"

namespace panorama {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kPreviewSide_px = 2048;

// Reports progress of work on several threads.
class PageProgress {
 public:
  PageProgress(const std::function<void(double)>& report, std::int64_t steps)
      : report_(report), steps_(steps) {}

  // Counts one finished step. Throws what the report throws.
  void step() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (report_) report_(static_cast<double>(done_) / static_cast<double>(std::max<std::int64_t>(steps_, 1)));
  }

 private:
  std::mutex mutex_;
  const std::function<void(double)>& report_;
  std::int64_t steps_;
  std::int64_t done_ = 0;
};

struct TileJob {
  const PageImage* image = nullptr;
  std::string eye;
  int level = 0;
  std::int64_t column = 0;
  std::int64_t row = 0;
};

// Lists the tiles of an eye and makes their folders.
void add_jobs(const PageFolder& page, const PageImage& image, const std::string& eye,
              const PagePyramid& pyramid, std::vector<TileJob>& jobs) {
  for (int level = 0; level < pyramid.levels; ++level) {
    page.make(fs::path("tiles") / eye / std::to_string(level));
    for (std::int64_t row = 0; row < pyramid.rows(level); ++row) {
      for (std::int64_t column = 0; column < pyramid.columns(level); ++column)
        jobs.push_back({&image, eye, level, column, row});
    }
  }
}

void write_tile(const PageFolder& page, const TileJob& job, const PagePyramid& pyramid,
                const PageOptions& options) {
  const vpe::core::RgbImage tile = read_page_tile(*job.image, pyramid, job.level, job.column, job.row);
  const bool is_jpeg = options.tiles == PageTileFormat::kJpeg;
  const auto bytes = is_jpeg
                         ? vpe::core::encode_jpeg(tile.pixels, tile.width, tile.height, options.jpeg_quality)
                         : vpe::core::encode_png(tile.pixels, tile.width, tile.height);
  const std::string name = job.eye + "/" + std::to_string(job.level) + "/" + std::to_string(job.column) + "_" +
                           std::to_string(job.row);
  page.write("tiles/" + name + ".js", "vpeTile(\"" + name + "\",\"image/" + (is_jpeg ? "jpeg" : "png") +
                                          "\",\"" + to_base64(bytes) + "\");\n");
}

void write_preview(const PageFolder& page, const PageImage& image, const PagePyramid& pyramid) {
  int level = 0;
  while (std::max(pyramid.level_width_px(level), pyramid.level_height_px(level)) > kPreviewSide_px) ++level;
  const vpe::core::RgbImage preview =
      read_page_pixels(image, level, {0, 0, pyramid.level_width_px(level), pyramid.level_height_px(level)});
  constexpr int kQuality = 85;
  const auto bytes = vpe::core::encode_jpeg(preview.pixels, preview.width, preview.height, kQuality);
  page.write("preview.jpg", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

// Returns the name of the copy of the image, which has letters and digits only.
std::string image_name(const fs::path& image) {
  std::string extension;
  for (const char c : image.extension().string()) {
    if (c >= 'A' && c <= 'Z') extension += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) extension += c;
  }
  return "picture." + (extension.empty() ? "bin" : extension);
}

PageFacts facts_of(const PageContent& content, const PageOptions& options) {
  PageFacts facts;
  facts.title = content.title.empty() ? content.description.image.filename().string() : content.title;
  facts.description = content.description;
  facts.pyramid = pyramid_of(content.description.map);
  facts.has_right_eye = content.right.has_value();
  PageLayers layers = layers_of(content.description, options.layer_step);
  if (!layers.bands.empty()) facts.layers = std::move(layers);
  facts.marks = content.marks;
  if (options.with_image) facts.picture = image_name(content.description.image);
  return facts;
}

void write_layers(const PageFolder& page, const PageContent& content, const PageLayers& layers,
                  vpe::base::ThreadPool& pool, PageProgress& progress) {
  page.make("layers");
  const LayerPacker packer(content.description, layers);
  const std::int64_t columns = layers.columns();
  pool.run(static_cast<std::size_t>(columns * layers.rows()), [&](std::size_t n) {
    const std::int64_t column = static_cast<std::int64_t>(n) % columns;
    const std::int64_t row = static_cast<std::int64_t>(n) / columns;
    page.write("layers/" + std::to_string(column) + "_" + std::to_string(row) + ".js",
               packer.tile_script(column, row));
    progress.step();
  });
}

}  // namespace

PageReport write_page(const fs::path& folder, const PageContent& content, const PageOptions& options,
                      vpe::base::ThreadPool& pool) {
  PageFolder page(folder, options.force);
  const PageFacts facts = facts_of(content, options);
  const PagePyramid& pyramid = facts.pyramid;
  std::vector<TileJob> jobs;
  add_jobs(page, content.left, "left", pyramid, jobs);
  if (content.right) add_jobs(page, *content.right, "right", pyramid, jobs);
  PageReport report{static_cast<std::int64_t>(jobs.size()), 0, pyramid.levels, 0};
  if (facts.layers) {
    report.layer_tiles = facts.layers->columns() * facts.layers->rows();
    report.layer_step = facts.layers->step;
  }
  PageProgress progress(options.progress, report.tiles + report.layer_tiles);
  pool.run(jobs.size(), [&](std::size_t n) {
    write_tile(page, jobs[n], pyramid, options);
    progress.step();
  });
  if (facts.layers) write_layers(page, content, *facts.layers, pool, progress);
  write_preview(page, content.left, pyramid);
  if (options.with_image) page.copy(content.description.image, facts.picture);
  page.make(kViewerFolder);
  for (const ViewerFile& file : viewer_files()) page.write(fs::path(kViewerFolder) / file.name, file.text);
  page.write("data.js", data_script(facts));
  page.write("index.html", index_html(facts));
  page.finish();
  return report;
}

}  // namespace panorama
