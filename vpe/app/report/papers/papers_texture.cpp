#include "vpe/app/report/papers/papers_texture.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "vpe/app/picture/image_options.h"
#include "vpe/app/report/papers/paper_images.h"
#include "vpe/base/number.h"
#include "vpe/core/image_metrics.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/report/interleaved_timing.h"

namespace vpe::app {

namespace {

// Renderers keep the pages of one appearance.
enum class TextureLook : std::uint8_t { kLit, kColoured, kTextured };

struct TextureCandidate {
  const char* name;
  TextureLook look;
  int share;  // of the triangles: one of so many
};

constexpr std::array<TextureCandidate, 6> kCandidates{
    {{"vertex Gouraud, one colour", TextureLook::kLit, 1},
     {"vertex Gouraud, colours of elevation", TextureLook::kColoured, 1},
     {"textured", TextureLook::kTextured, 1},
     {"textured, 1/4", TextureLook::kTextured, 4},
     {"textured, 1/16", TextureLook::kTextured, 16},
     {"textured, 1/64", TextureLook::kTextured, 64}}};
constexpr std::size_t kGouraudLit = 0, kGouraudColoured = 1, kSixteenth = 4, kSixtyFourth = 5;

core::DrawRequest candidate_request(const TexturePaperPlan& plan, const TexturePaperView& view, double radius_m,
                                    TextureLook look) {
  core::DrawRequest request;
  request.view.camera = mars::to_camera(view.pose, radius_m);
  request.view.width = plan.width_px;
  request.view.height = plan.height_px;
  request.view.fov_deg = plan.fov_deg;
  core::SettingsValues& settings = request.settings;
  settings.lod_tolerance_px = 0.5;
  settings.occlusion = core::Occlusion::kOff;
  settings.mode = look == TextureLook::kLit        ? core::Mode::kLit
                  : look == TextureLook::kColoured ? core::Mode::kColoured
                                                   : core::Mode::kTextured;
  if (look != TextureLook::kTextured) settings.shading = core::Shading::kVertex;
  request.sun = sun_for(settings, view.pose);
  return request;
}

// What was measured of one candidate in one view.
struct CandidateFigures {
  double triangles = 0;
  double to_full = 0;  // triangles over those of all
  double similarity = 0;
  double time_s = 0;
  double time_to_gouraud = 0;
  core::RgbImage image;
};
using ViewFigures = std::array<CandidateFigures, kCandidates.size()>;

class TextureBench {
 public:
  // Throws gl::ContextError.
  TextureBench(const TexturePaperPlan& plan, std::shared_ptr<const paging::PlanetFile> planet)
      : plan_(plan), planet_(std::move(planet)), context_(gl::Context::create()) {
    gl::RendererOptions options;
    options.memory_bytes = plan.memory_bytes / renderers_.size();
    for (auto& renderer : renderers_) renderer = gl::make_polygon_renderer(context_, planet_, options);
  }

  ViewFigures measure(const TexturePaperView& view, const std::function<void()>& step) {
    std::array<core::DrawRequest, kCandidates.size()> requests;
    for (std::size_t k = 0; k < kCandidates.size(); ++k)
      requests[k] = candidate_request(plan_, view, planet_->radius_m(), kCandidates[k].look);
    const core::DrawResult reference =
        renderer(TextureLook::kTextured)
            .draw(candidate_request(plan_, view, planet_->radius_m(), TextureLook::kTextured));
    const std::int64_t full = std::max<std::int64_t>(1, reference.stats.triangles);
    std::array<core::DrawResult, kCandidates.size()> results;
    std::vector<report::BenchmarkCase> cases;
    for (std::size_t k = 0; k < kCandidates.size(); ++k) {
      if (kCandidates[k].share > 1)
        requests[k].settings.lod_triangles = static_cast<int>(
            std::clamp<std::int64_t>(full / kCandidates[k].share, 1, std::numeric_limits<int>::max()));
      cases.push_back(
          {[&, k] { results[k] = renderer(kCandidates[k].look).draw(requests[k]); }, [&](double) { step(); }});
    }
    const std::vector<report::Timing> timings = report::time_interleaved(cases, plan_.rounds);
    ViewFigures figures;
    for (std::size_t k = 0; k < kCandidates.size(); ++k) {
      core::Frame& frame = results[k].frame;
      CandidateFigures& of = figures[k];
      of.triangles = static_cast<double>(results[k].stats.triangles);
      of.to_full = of.triangles / static_cast<double>(full);
      of.similarity =
          core::structural_similarity(frame.colour, reference.frame.colour, frame.width, frame.height);
      of.time_s = timings[k].median_s();
      of.time_to_gouraud = report::ratio(timings[k], timings[kGouraudLit]);
      of.image = {frame.width, frame.height, std::move(frame.colour)};
    }
    return figures;
  }

 private:
  core::Renderer& renderer(TextureLook look) { return *renderers_[static_cast<std::size_t>(look)]; }

  const TexturePaperPlan& plan_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  std::shared_ptr<gl::Context> context_;
  std::array<std::unique_ptr<core::Renderer>, 3> renderers_;
};

// Returns the median over the views of a figure of one candidate; NaN without views.
template <typename Figure>
double median_of_views(const std::vector<ViewFigures>& views, std::size_t candidate,
                       Figure CandidateFigures::*figure) {
  std::vector<double> values;
  for (const ViewFigures& view : views) values.push_back(view[candidate].*figure);
  return report::median(std::move(values));
}

report::Table texture_table(const std::vector<ViewFigures>& views) {
  report::Table table;
  table.name = "environment-texture";
  table.caption = "Section 3.4.1: textures in place of triangles, medians over the views";
  table.columns = {
      {"terrain", "how it is drawn"},
      {"triangles", "drawn"},
      {"triangles_to_full", "over those of the full resolution"},
      {"similarity", "structural similarity with the textured image of the full resolution"},
      {"similarity_least", "the least of all views"},
      {"time_s", "from request to colours in memory"},
      {"time_to_gouraud", "over that of vertex Gouraud, one colour (median of ratios within a round)"}};
  for (std::size_t k = 0; k < kCandidates.size(); ++k) {
    std::vector<report::Cell> row(table.columns.size());
    row[0] = std::string(kCandidates[k].name);
    if (!views.empty()) {
      double least = 1;
      for (const ViewFigures& view : views) least = std::min(least, view[k].similarity);
      row[1] = median_of_views(views, k, &CandidateFigures::triangles);
      row[2] = median_of_views(views, k, &CandidateFigures::to_full);
      row[3] = median_of_views(views, k, &CandidateFigures::similarity);
      row[4] = least;
      row[5] = median_of_views(views, k, &CandidateFigures::time_s);
      row[6] = median_of_views(views, k, &CandidateFigures::time_to_gouraud);
    }
    table.add(std::move(row));
  }
  return table;
}

report::Table texture_views_table(const TexturePaperPlan& plan, const std::vector<ViewFigures>& views) {
  report::Table table;
  table.name = "environment-texture-views";
  table.caption = "Section 3.4.1, by view";
  table.columns = {{"view", "where the camera is"},
                   {"terrain", "how it is drawn"},
                   {"triangles", "drawn"},
                   {"similarity", "structural similarity with the textured image of the full resolution"},
                   {"time_s", "from request to colours in memory (median)"}};
  for (std::size_t v = 0; v < views.size(); ++v)
    for (std::size_t k = 0; k < kCandidates.size(); ++k)
      table.add({plan.views[v].name, std::string(kCandidates[k].name), views[v][k].triangles,
                 views[v][k].similarity, views[v][k].time_s});
  return table;
}

// Says whether fewer triangles with textures are as good as all with light of vertices: as the better of its two ways in each
// view.
std::string texture_aim(const std::vector<ViewFigures>& views) {
  std::vector<double> gouraud;
  for (const ViewFigures& view : views)
    gouraud.push_back(std::max(view[kGouraudLit].similarity, view[kGouraudColoured].similarity));
  const double of_gouraud = report::median(gouraud);
  const double of_16 = median_of_views(views, kSixteenth, &CandidateFigures::similarity);
  const double of_64 = median_of_views(views, kSixtyFourth, &CandidateFigures::similarity);
  const bool holds = of_16 >= of_gouraud && of_64 >= of_gouraud;
  const auto text = [](double similarity) { return base::format_rounded(similarity, 3); };
  return std::string(
             "Aim: with 1/16 and with 1/64 of the triangles textured terrain is no less similar than vertex Gouraud, in "
             "the median of ") +
         std::to_string(views.size()) + " views: " + (holds ? "holds" : "does not hold") +
         ". Similarity: " + text(of_16) + " with 1/16, " + text(of_64) + " with 1/64, " + text(of_gouraud) +
         " with vertex Gouraud (the better of its two ways in each view).";
}

}  // namespace

int count_texture_steps(const TexturePaperPlan& plan) {
  return static_cast<int>(plan.views.size() * kCandidates.size()) * (plan.rounds + 1);
}

TexturePaper measure_texture_paper(const TexturePaperPlan& plan,
                                   const std::shared_ptr<const paging::PlanetFile>& planet,
                                   const std::filesystem::path& folder, const std::function<void()>& step) {
  TexturePaper paper;
  paper.section.heading = "Textures in place of triangles (Hitchner 1992, section 3.4.1)";
  paper.section.paragraphs = {
      "Published, without figures: textured terrain 2 or 3 levels coarser, with 1/16 or 1/64 of the polygons, is far superior to "
      "Gouraud-shaded terrain.",
      "Here: light of the vertices of the drawn triangles (shading=vertex) at lod.tolerance=0.5, and imagery on all "
      "those triangles, and on 1/4, 1/16 and 1/64 of them (lod.triangles). All are compared with the textured image of all "
      "triangles."};
  std::vector<ViewFigures> views;
  std::optional<std::string> trouble;
  if (plan.views.empty()) trouble = "there are no views";
  if (planet->meta().finest_image_level < 0) trouble = "the planet has no imagery";
  if (!trouble) {
    std::unique_ptr<TextureBench> bench;
    try {
      bench = std::make_unique<TextureBench>(plan, planet);
    } catch (const gl::ContextError& e) {
      trouble = std::string("there is no OpenGL: ") + e.what();
    }
    if (bench)
      for (const TexturePaperView& view : plan.views) views.push_back(bench->measure(view, step));
  }
  if (trouble) {
    paper.section.paragraphs.push_back("Not measured: " + *trouble + ".");
  } else {
    paper.section.paragraphs.push_back(texture_aim(views));
    // A view with a skyline.
    const ViewFigures& shown = views[std::min<std::size_t>(3, views.size() - 1)];
    paper.section.images = {write_paper_image(folder, "environment-texture-gouraud.png",
                                              "Vertex Gouraud, all triangles", shown[kGouraudLit].image),
                            write_paper_image(folder, "environment-texture-16.png",
                                              "Textured, 1/16 of the triangles", shown[kSixteenth].image),
                            write_paper_image(folder, "environment-texture-64.png",
                                              "Textured, 1/64 of the triangles", shown[kSixtyFourth].image)};
  }
  paper.tables = {texture_table(views), texture_views_table(plan, views)};
  paper.section.tables = paper.tables;
  return paper;
}

}  // namespace vpe::app
