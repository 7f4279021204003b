#include "mars/raster/output/raster_strips.h"

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/output/raster_file.h"
#include "vpe/base/file.h"

namespace mars {

void write_strip(const std::filesystem::path& path, const RasterInfo& info,
                 std::span<const std::vector<float>> channels) {
  vpe::base::OutputFile output(path);
  DatasetPointer dataset = make_plain_raster(output.temporary(), info);
  for (std::size_t band = 0; band < channels.size(); ++band)
    write_rows(*dataset, info, static_cast<int>(band), 0, channels[band]);
  close_raster(std::move(dataset), path);
  output.commit();
}

void join_strips(const std::filesystem::path& path, const RasterInfo& info,
                 std::span<const RasterStrip> strips) {
  vpe::base::OutputFile output(path);
  const DatasetPointer joined = open_joined(strips, info);
  write_optimised(*joined, info, output.temporary());
  output.commit();
}

}  // namespace mars
