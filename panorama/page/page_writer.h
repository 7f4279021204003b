// Writes the web page of a panorama: one folder that any browser opens from disk.
//
//   index.html, data.js     the page, and the description of the panorama
//   viewer/                 scripts and style sheet, the same for all pages
//   tiles/EYE/LEVEL/X_Y.js  the pyramid of the picture (page_pyramid.h), EYE "left" or "right"
//   layers/X_Y.js           auxiliary layers (page_layers.h), if there are any
//   preview.jpg             all of the panorama, at most 2048 pixels a side
//   picture.EXT             a copy of the image's file, for downloading
// docs/design/web-page.md describes the formats.
//
// Typical usage:
//   check_page_folder(folder, false);  // before any work
//   write_page(folder, {"Gale", description, {*image, {}, description.map}, std::nullopt, marks}, {}, pool);
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "panorama/metadata/open_panorama.h"
#include "panorama/page/page_folder.h"
#include "panorama/page/page_marks.h"
#include "panorama/page/page_pyramid.h"
#include "vpe/base/parallel.h"

namespace panorama {

enum class PageTileFormat : std::uint8_t { kJpeg, kPng };

struct PageContent {
  std::string title;  // empty: the name of the image's file
  PanoramaDescription description;
  PageImage left;  // also of panoramas for one eye
  std::optional<PageImage> right;
  PageMarks marks;
};

struct PageOptions {
  PageTileFormat tiles = PageTileFormat::kJpeg;
  // 1 to 100. Larger: closer to the image, larger page. Colour has half the resolution below 90.
  int jpeg_quality = 90;
  // Columns and rows of the image to one of the layers; 0: as layers_of(). Larger: a smaller page, coarser
  // read-outs.
  int layer_step = 0;
  bool with_image = true;
  bool force = false;  // as check_page_folder()
  // Receives the finished fraction, from one thread at a time; may throw to stop.
  std::function<void(double fraction)> progress;
};

// Describes what was written.
struct PageReport {
  std::int64_t tiles = 0;
  std::int64_t layer_tiles = 0;
  int levels = 0;
  int layer_step = 0;  // 0: no layers
};

// Writes a page. The folder appears, or is replaced, only when all of it is written; what progress() throws and
// errors leave nothing behind. Takes memory for a tile a thread beside that of the images. Throws
// vpe::base::FileError, as for a full disk.
PageReport write_page(const std::filesystem::path& folder, const PageContent& content,
                      const PageOptions& options, vpe::base::ThreadPool& pool);

}  // namespace panorama
