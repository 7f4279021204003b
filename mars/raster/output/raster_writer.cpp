#include "mars/raster/output/raster_writer.h"

#include <utility>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/output/raster_file.h"
#include "vpe/base/file.h"

namespace mars {

struct RasterWriter::Parts {
  RasterInfo info;
  vpe::base::OutputFile plain;  // beside the file, by its name
  vpe::base::OutputFile output;
  DatasetPointer dataset;

  Parts(const std::filesystem::path& path, RasterInfo described)
      : info(std::move(described)),
        plain(path),
        output(path),
        dataset(make_plain_raster(plain.temporary(), info)) {}
};

RasterWriter::RasterWriter(std::filesystem::path path, RasterInfo info)
    : parts_(std::make_unique<Parts>(path, std::move(info))) {}

RasterWriter::~RasterWriter() = default;

void RasterWriter::write(int band, int first_row, std::span<const float> values) {
  write_rows(*parts_->dataset, parts_->info, band, first_row, values);
}

void RasterWriter::finish() {
  const GdalScope scope;
  write_optimised(*parts_->dataset, parts_->info, parts_->output.temporary());
  parts_->dataset.reset();
  parts_->output.commit();
}

}  // namespace mars
