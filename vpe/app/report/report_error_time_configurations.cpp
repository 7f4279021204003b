#include "vpe/app/report/report_error_time_configurations.h"

#include <stdexcept>

#include "vpe/app/panorama/panorama_requests.h"
#include "vpe/app/picture/backend_choice.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/base/number.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/report/resampling.h"

namespace vpe::app {

namespace {

using Words = std::vector<std::string>;

// Groups of configurations that show the same image, and names of plots.
constexpr const char* kGeometry = "geometry";
constexpr const char* kTexture = "textures and levels";
constexpr const char* kSamples = "samples";
constexpr const char* kPanorama = "panorama";

core::DrawRequest with(core::DrawRequest request, const Words& assignments, const mars::Pose& pose) {
  core::Settings settings;
  for (const std::string& assignment : assignments) {
    if (const std::string trouble = settings.assign(assignment); !trouble.empty())
      throw std::logic_error(trouble);
  }
  request.settings = settings.values();
  request.sun = sun_for(request.settings, pose);
  return request;
}

std::string join(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

class Planner {
 public:
  Planner(const NamedView& view, const paging::PlanetFile& planet, const ConfigurationOptions& options)
      : view_(view), planet_(planet), options_(options) {
    base_.view.camera = mars::to_camera(view.pose, planet.radius_m());
    base_.view.width = options.width;
    base_.view.height = options.height;
    subject_.view = view.name;
    subject_.about = view.about;
    chosen_ = choose_backend({}, {}, {&base_, 1}, planet.radius_m(), options.has_gpu).backend;
  }

  report::Subject plan() {
    add_reference();
    add_rays();
    add_tolerances();
    add_levels();
    add_samples();
    if (view_.panorama) add_panoramas();
    if (options_.with_embree) add_embree();
    return std::move(subject_);
  }

 private:
  report::Configuration& add(const std::string& sweep, const std::string& knob, const char* renderer,
                             std::vector<core::DrawRequest> requests) {
    report::Configuration configuration;
    configuration.sweep = sweep;
    configuration.knob = knob;
    configuration.renderer = renderer;
    configuration.requests = std::move(requests);
    if (renderer != std::string(kRayImages)) configuration.range_error = gl::kRangeError;
    subject_.configurations.push_back(std::move(configuration));
    return subject_.configurations.back();
  }

  // Adds an image of the view itself, with these settings.
  report::Configuration& add_image(const std::string& sweep, const char* renderer, const Words& settings,
                                   const std::string& knob = "") {
    report::Configuration& configuration =
        add(sweep, knob.empty() ? join(settings) : knob, renderer, {with(base_, settings, view_.pose)});
    configuration.comparison_group = configuration.plot = kGeometry;
    return configuration;
  }

  std::vector<double> values(double first, double last, double step_short) const {
    std::vector<double> all;
    double value = first;
    while (value >= last) {
      all.push_back(value);
      value /= options_.is_short ? step_short : 2;
    }
    return all;
  }

  void add_reference() {
    subject_.references.push_back({base_.view, kRayImages, {with(base_, {}, view_.pose)}, {}, true});
  }

  void add_rays() {
    add_image("rays, exact", kRayImages, {}, "rays.mode=exact").is_default = true;
    if (!options_.is_short) add_image("rays, reference", kRayImages, {"rays.mode=reference"}).most_rounds = 1;
    for (const double cell : values(core::RayLimits::kMostCell_px, core::RayLimits::kLeastCell_px, 8)) {
      report::Configuration& configuration = add_image(
          "rays by cell", kRayImages, {"rays.mode=multires", "rays.cell=" + base::format_number(cell)},
          "rays.cell=" + base::format_number(cell));
      configuration.is_chosen =
          chosen_ == core::Backend::kRay && cell == core::SettingsValues().lod_tolerance_px;
    }
  }

  void add_tolerances() {
    for (const double tolerance : values(64, 0.0625, 8)) {
      report::Configuration& configuration =
          add_image("triangles by tolerance", kTriangles, {"lod.tolerance=" + base::format_number(tolerance)});
      configuration.colour_plot = kTexture;
      configuration.is_default = tolerance == core::SettingsValues().lod_tolerance_px;
      configuration.is_chosen = configuration.is_default && chosen_ == core::Backend::kPolygon;
    }
  }

  // Adds levels by distance (Hitchner 1992): one level fewer for each doubling, so that triangles have about
  // the same size all over the image. At the finest level it is one pixel. Untextured triangles have one colour
  // each; the paper's were Gouraud-shaded.
  void add_levels() {
    const int finest = planet_.meta().finest_level + 1;  // number of levels, as in the table
    const double spacing_m =
        lod::post_spacing_m(finest - 1, planet_.meta().tile.intervals(), planet_.radius_m());
    const double pixel_m = core::focal_px(base_.view) * spacing_m;
    const bool has_images = planet_.meta().image_tiles > 0;
    for (const bool textured : {true, false}) {
      if (!textured && !has_images) continue;
      for (int level = std::max(1, finest - 5); level <= finest + 3; level += options_.is_short ? 2 : 1) {
        std::string table = "0:" + std::to_string(level);
        for (int down = 1; down < level; ++down) {
          table += "," + base::format_number(pixel_m * (1 << (down - 1))) + ":" + std::to_string(level - down);
        }
        Words settings{"lod.metric=distance", "lod.distance.table=" + table};
        if (!textured) settings.insert(settings.end(), {"mode=coloured", "colour=image", "shading=flat"});
        report::Configuration& configuration = add_image(
            textured ? "textured, by level" : "untextured, by level", textured ? kTriangles : kPlainTriangles,
            settings,
            std::to_string(level) + " levels within " + base::format_number(std::round(pixel_m)) + " m");
        configuration.colour_plot = kTexture;
        if (!textured) configuration.plot = configuration.comparison_group = "";
      }
    }
  }

  // Adds smaller images, because the reference takes a thousand samples a pixel.
  void add_samples() {
    core::DrawRequest small = base_;
    small.view.width = options_.width / 2;
    small.view.height = options_.height / 2;
    const std::size_t reference = subject_.references.size();
    const core::DrawRequest hard = with(small, {"edges=hard"}, view_.pose);
    const int samples_a_side = options_.is_short ? 16 : 32;
    subject_.references.push_back({small.view, kRayImages, report::enlarged(hard, samples_a_side),
                                   report::average(small.view, samples_a_side), false});
    const auto describe = [&](report::Configuration& configuration) {
      configuration.kind = report::ErrorKind::kColour;
      configuration.plot = configuration.comparison_group = kSamples;
      configuration.reference = reference;
      configuration.has_ranges = false;
    };
    const std::string tolerance = base::format_number(core::SettingsValues().lod_tolerance_px);
    for (const char* renderer : {kRayImages, kTriangles}) {
      const bool is_rays = renderer == std::string(kRayImages);
      // The settings of --backend auto.
      const auto settings = [&](const std::string& one) {
        return is_rays ? Words{"rays.mode=multires", "rays.cell=" + tolerance, one} : Words{one};
      };
      const core::DrawRequest plain = with(small, settings("edges=hard"), view_.pose);
      const std::string sweep = std::string(renderer) + " by resolution";
      const int step = options_.is_short ? 4 : 2;
      for (int factor = options_.is_short ? 16 : 32; factor > 1; factor /= step) {
        report::Configuration& configuration =
            add(sweep, "1/" + std::to_string(factor), renderer, {report::reduced(plain, factor)});
        configuration.compose = report::magnified(small.view, factor);
        describe(configuration);
      }
      for (int factor = 1; factor <= samples_a_side / 2; factor *= step) {
        report::Configuration& configuration =
            add(sweep, std::to_string(factor), renderer, report::enlarged(plain, factor));
        configuration.compose = report::average(small.view, factor);
        describe(configuration);
      }
      // Three values of a setting are too few for a sweep.
      for (const int samples : {1, 2, 4}) {
        const std::string setting = "samples=" + std::to_string(samples);
        report::Configuration& configuration = add(std::string(renderer) + ", " + setting, setting, renderer,
                                                   {with(small, settings(setting), view_.pose)});
        describe(configuration);
        configuration.is_chosen = samples == 1 && is_rays == (chosen_ == core::Backend::kRay);
      }
    }
  }

  void add_panoramas() {
    const PanoramaView camera{view_.pose, planet_.radius_m(), with(base_, {"edges=hard"}, view_.pose)};
    // No power of two, so that its pixel centres coincide with those of no other width.
    const panorama::PanoramaMap exact = cylinder_of(500);
    const std::size_t reference = subject_.references.size();
    subject_.references.push_back(
        {panorama::round_view(exact, panorama::viewpoint_of(view_.pose, planet_.radius_m())),
         kRayImages,
         requests_of(exact, camera),
         {},
         true});
    std::vector<int> facets{0, 4, 8, 16};
    if (options_.is_short) facets = {0, 8};
    std::vector<std::int64_t> widths{128, 256, 512, 1024, 2048, 4096, 8192, 16384};
    if (options_.is_short) widths = {64, 256, 1024, 8192};
    for (const int count : facets) {
      const std::string sweep =
          count == 0 ? "cylinder by columns" : std::to_string(count) + " facets by columns";
      for (const std::int64_t width : widths) {
        const panorama::PanoramaMap map = count == 0 ? cylinder_of(width) : facets_of(count, width);
        report::Configuration& configuration =
            add(sweep, std::to_string(width) + " columns", kRayImages, requests_of(map, camera));
        configuration.compose = resample(map, exact);
        configuration.plot = configuration.comparison_group = kPanorama;
        configuration.reference = reference;
      }
    }
  }

  void add_embree() {
    report::Configuration& configuration = add_image("Embree, ranges alone", kEmbreeRanges, {}, "exact");
    configuration.comparison_group = "";
    configuration.has_colours = false;
    subject_.baseline = subject_.configurations.size() - 1;
  }

  const NamedView& view_;
  const paging::PlanetFile& planet_;
  ConfigurationOptions options_;
  core::DrawRequest base_;
  core::Backend chosen_ = core::Backend::kPolygon;  // when none is named
  report::Subject subject_;
};

}  // namespace

report::Subject subject_of(const NamedView& view, const paging::PlanetFile& planet,
                           const ConfigurationOptions& options) {
  return Planner(view, planet, options).plan();
}

}  // namespace vpe::app
