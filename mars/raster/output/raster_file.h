// Makes the files of RasterWriter: plain GeoTIFFs that are written by rows, and cloud-optimised ones made from them.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>

#include "mars/raster/output/raster_strips.h"
#include "mars/raster/output/raster_writer.h"

class GDALDataset;

namespace mars {

using DatasetPointer = std::unique_ptr<GDALDataset, std::function<void(GDALDataset*)>>;

// Makes a GeoTIFF without contents and without compression, for a short time. Throws SourceError.
DatasetPointer make_plain_raster(const std::filesystem::path& path, const RasterInfo& info);

// Writes whole rows of one band, as RasterWriter::write() does. Throws SourceError.
void write_rows(GDALDataset& dataset, const RasterInfo& info, int band, int first_row,
                std::span<const float> values);

// Copies a raster to a cloud-optimised GeoTIFF with overviews. Throws SourceError.
void write_optimised(GDALDataset& dataset, const RasterInfo& info, const std::filesystem::path& path);

// Writes what a raster still holds, and closes it. `path` is for messages. Throws SourceError, for example if the disk
// is full.
void close_raster(DatasetPointer dataset, const std::filesystem::path& path);

// Opens strips of rows, from north to south, as one raster without a copy. `info` describes all of it. The strips
// must exist as long as it. Throws SourceError.
DatasetPointer open_joined(std::span<const RasterStrip> strips, const RasterInfo& info);

}  // namespace mars
