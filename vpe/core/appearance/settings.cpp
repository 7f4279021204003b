#include "vpe/core/appearance/settings.h"

#include "mars/geodesy/mars_time.h"
#include "vpe/core/appearance/gazetteer.h"
#include "vpe/core/appearance/image_layers.h"
#include "vpe/core/appearance/layer_list.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/core/registry/former_names.h"
#include "vpe/core/registry/key_registry.h"

namespace vpe::core {

namespace {

constexpr std::size_t kLongestShown = 64;  // of a user's text in a message
constexpr double kMostLevels = LevelTableLimits::kMaxLevels;

std::string no_problem(const std::string&) { return {}; }

const KeyRegistry<SettingsValues>& registry() {
  using V = SettingsValues;
  using Declare = KeyMembers<SettingsValues>;
  static const KeyRegistry<SettingsValues> keys({
      {"mode",
       Declare::choice<&V::mode>({word("wireframe", Mode::kWireframe), word("markers", Mode::kMarkers),
                                  word("unlit", Mode::kUnlit), word("lit", Mode::kLit),
                                  word("coloured", Mode::kColoured), word("textured", Mode::kTextured)}),
       "",
       "how the surface is painted: edges of triangles; a dot at each vertex; colour without light; light "
       "without colour; both; or imagery with light (coloured where there is no imagery)"},
      {"shading",
       Declare::choice<&V::shading>({word("flat", Shading::kFlat), word("gouraud", Shading::kGouraud),
                                     word("vertex", Shading::kVertex)}),
       "",
       "flat: one light and colour for each drawn triangle; gouraud: light and colour of the posts, "
       "interpolated between them; vertex: light of the drawn triangles' vertices, interpolated over the "
       "triangles (backend polygon)"},
      {"colour",
       Declare::choice<&V::colour>({word("none", Colour::kNone), word("elevation", Colour::kElevation),
                                    word("slope", Colour::kSlope), word("aspect", Colour::kAspect),
                                    word("image", Colour::kImage), word("difference", Colour::kDifference)}),
       "",
       "value that the colour of coloured and unlit surfaces shows; image: the planet file's imagery at each "
       "post; difference: height above the earlier planet of --compare"},
      {"palette", Declare::text<&V::palette>(palette_grammar(), palette_problem), "",
       "colours of elevation, slope, aspect and difference; auto: a palette that suits the value shown"},
      {"palette.low", Declare::number_or_word<&V::palette_low>(-1e6, 1e6, "auto"), "",
       "value at the palette's lower end, metres or degrees; both ends equal: a range that suits the value "
       "shown; auto: 2 % of what the view shows lie below, and of differences both ends are as far from 0 as the "
       "largest one in view"},
      {"palette.high", Declare::number_or_word<&V::palette_high>(-1e6, 1e6, "auto"), "",
       "value at the palette's upper end; auto: 2 % of what the view shows lie above"},
      {"ramp.low.hue", Declare::number<&V::low_hue_deg>(-360, 720), "deg", "palette=hsv: hue at the lower end"},
      {"ramp.low.saturation", Declare::number<&V::low_saturation>(0, 1), "",
       "palette=hsv: saturation at the lower end"},
      {"ramp.low.value", Declare::number<&V::low_value>(0, 1), "", "palette=hsv: brightness at the lower end"},
      {"ramp.high.hue", Declare::number<&V::high_hue_deg>(-360, 720), "deg",
       "palette=hsv: hue at the upper end"},
      {"ramp.high.saturation", Declare::number<&V::high_saturation>(0, 1), "",
       "palette=hsv: saturation at the upper end"},
      {"ramp.high.value", Declare::number<&V::high_value>(0, 1), "",
       "palette=hsv: brightness at the upper end"},
      {"colourise", Declare::toggle<&V::colourise>(), "",
       "imagery keeps its brightness and takes hue and saturation from the value that 'colour' shows"},
      {"light",
       Declare::choice<&V::light>(
           {word("auto", Light::kAuto), word("on", Light::kOn), word("off", Light::kOff)}),
       "",
       "the sun lights ground in the modes with light; off: colours and imagery are as they are; auto: off for imagery that "
       "the planet file knows as photographs with the light of their own sun, on otherwise"},
      {"image.low", Declare::number<&V::image_low>(0, 255), "",
       "value of the imagery that is shown black; above image.high: the negative"},
      {"image.high", Declare::number<&V::image_high>(0, 255), "", "value of the imagery that is shown white"},
      {"image.gamma", Declare::number<&V::image_gamma>(0.1, 10), "",
       "gamma of the imagery between image.low and image.high; larger: brighter"},
      {"image.layers",
       Declare::text<&V::image_layers>(
           "names of the planet file's image layers with ';' between them, each with @OPACITY, low=, high=, gamma= or without",
           image_layers_problem),
       "", "image layers that are shown, the lowest first; none: the imagery as the planet file was built"},
      {"exaggeration", Declare::number<&V::exaggeration>(0.1, 100), "",
       "factor on every elevation, about the planet's sphere"},
      {"sun",
       Declare::text<&V::sun>(mars::sun_grammar(),
                              [](const std::string& text) { return mars::sun_problem(text); }),
       "",
       "position of the sun: from sun.azimuth and sun.elevation (local), a date, or a season and hour at the "
       "ground below the camera (in a film: below its start)"},
      {"sun.azimuth", Declare::number<&V::sun_azimuth_deg>(0, 360), "deg",
       "sun=local: direction of the sun, clockwise from north, at the ground below the camera (in a film: "
       "below its start)"},
      {"sun.elevation", Declare::number<&V::sun_elevation_deg>(0, 90), "deg",
       "sun=local: height of the sun above the horizon, at the same place"},
      {"sun.ambient", Declare::number<&V::sun_ambient>(0, 1), "",
       "share of the light that reaches shaded slopes"},
      {"sun.diffuse", Declare::number<&V::sun_diffuse>(0, 10), "", "light on slopes that face the sun"},
      {"shadows", Declare::toggle<&V::shadows>(), "", "ground casts shadows on ground"},
      {"gamma", Declare::number<&V::gamma>(0.1, 10), "", "gamma correction of the display; larger: brighter"},
      {"haze.visibility", Declare::number<&V::haze_visibility_m>(0, 1e9), "m",
       "distance at which haze leaves 2 % of the contrast, in air as dense as at the planet's sphere (thinner "
       "above, thicker below); 0 = clear air"},
      {"markers.size", Declare::number<&V::marker_px>(1, 64), "px", "side of a dot of mode markers"},
      {"overlay.legend", Declare::toggle<&V::legend>(), "", "palette with values and units"},
      {"overlay.graticule", Declare::toggle<&V::graticule>(), "", "lines of longitude and latitude"},
      {"overlay.graticule.step", Declare::number<&V::graticule_deg>(0, 90), "deg",
       "distance between the lines; 0 = a step that suits the image"},
      {"overlay.contours", Declare::toggle<&V::contours>(), "", "lines of equal elevation"},
      {"overlay.contours.step", Declare::number<&V::contour_m>(0, 1e6), "m",
       "difference between the lines; 0 = a step that suits the image"},
      {"overlay.contours.tolerance", Declare::number<&V::contour_tolerance_px>(0, 1000), "px",
       "largest error of the ground that the lines are taken from; where the image is coarser, finer ground is "
       "looked at for them alone; 0: the exact surface"},
      {"overlay.scale", Declare::toggle<&V::scale_bar>(), "",
       "bar of a round length at the ground in the image centre"},
      {"overlay.north", Declare::toggle<&V::north_arrow>(), "", "arrow to the north"},
      {"overlay.time",
       Declare::choice<&V::time_code>(
           {word("off", TimeCode::kOff), word("on", TimeCode::kFlight), word("ltst", TimeCode::kSolar)}),
       "",
       "time of the frame in its flight (on), or local true solar time and solar longitude below the camera (ltst; the sun "
       "must be a date or a season)"},
      {"overlay.compass",
       Declare::choice<&V::compass>({word("off", CompassStrip::kOff), word("on", CompassStrip::kBottom),
                                     word("top", CompassStrip::kTop), word("horizon", CompassStrip::kHorizon)}),
       "", "marks of azimuth along the lower edge (on), the upper edge or the horizon"},
      {"overlay.title", Declare::text<&V::title>("any text", no_problem), "", "a line of text at the top"},
      {"overlay.names", Declare::text<&V::names>("a CSV file with columns name, lon, lat", gazetteer_problem),
       "", "names of places, except those hidden by ground"},
      {"overlay.distances", Declare::toggle<&V::distances>(), "",
       "distance from the camera beside each name, in a straight line"},
      {"overlay.layers",
       Declare::text<&V::layers>("vector files with ';' between them, each with @OPACITY or without",
                                 layers_problem),
       "",
       "points, lines and polygons of vector files on the ground, the first file lowest: GeoPackage, GeoJSON, Shapefile, KML, "
       "GPX, CSV"},
      {"overlay.layers.hidden",
       Declare::choice<&V::hidden_lines>(
           {word("off", HiddenLines::kLeftOut), word("dashed", HiddenLines::kDashed)}),
       "", "parts of lines of layers that ground hides"},
      {"overlay.layers.legend", Declare::toggle<&V::layers_legend>(), "",
       "what the colours and patterns of layers stand for"},
      {"lod.tolerance", Declare::number<&V::lod_tolerance_px>(0, 1000), "px",
       "largest screen-space error that may be drawn; 0 draws the exact surface (backend ray: see rays.mode)"},
      {"lod.triangles", Declare::integer<&V::lod_triangles>(0, 1'000'000'000), "",
       "upper limit of the triangles of a frame, which takes precedence over the tolerance; 0 = none"},
      {"lod.metric",
       Declare::choice<&V::lod_metric>(
           {word("error", LodMetric::kError), word("distance", LodMetric::kDistance)}),
       "",
       "measure that selects the level of a tile: its screen-space error, or only its distance and place in "
       "the image (the level control functions lod.distance, lod.centre and lod.interest)"},
      {"lod.distance.scale", Declare::number<&V::lod_distance_scale_m>(0, 1e12), "m",
       "metric distance: a tile at distance x from the camera gets scale / x + offset levels"},
      {"lod.distance.offset", Declare::number<&V::lod_distance_offset>(-kMostLevels, kMostLevels), "levels",
       "metric distance: levels that a tile gets at any distance"},
      {"lod.distance.weight", Declare::number<&V::lod_distance_weight>(0, 100), "",
       "metric distance: factor on the levels by distance"},
      {"lod.distance.table", Declare::table<&V::lod_distance_table>(), "",
       "metric distance: levels from each distance on, metres, in place of scale and offset; as in "
       "0:12,1e5:8,1e6:4"},
      {"lod.centre.scale", Declare::number<&V::lod_centre_scale>(0, 1000), "",
       "a tile at distance x from the image centre, in halves of the image's height, gets scale / x + offset "
       "levels"},
      {"lod.centre.offset", Declare::number<&V::lod_centre_offset>(-kMostLevels, kMostLevels), "levels",
       "levels that a tile gets at any place in the image"},
      {"lod.centre.weight", Declare::number<&V::lod_centre_weight>(0, 100), "",
       "factor on the levels by distance from the image centre; 0 = the same everywhere in the image"},
      {"lod.centre.table", Declare::table<&V::lod_centre_table>(), "",
       "levels from each distance from the image centre on, halves of the image's height, in place of scale "
       "and offset"},
      {"lod.interest.weight", Declare::number<&V::lod_interest_weight>(0, 100), "",
       "factor on the levels of regions of interest"},
      {"lod.frame_ms", Declare::number<&V::lod_frame_ms>(0, 10000), "ms",
       "time that a frame should take while the camera moves, held by drawing coarser; 0 = none; single images "
       "and films are always drawn in full"},
      {"degrade.distance", Declare::number<&V::degrade_distance>(0, 100), "",
       "factor on the levels that a budget (lod.triangles, lod.frame_ms) takes away from the image centre and from "
       "regions of interest; 0 = none"},
      {"degrade.centre", Declare::number<&V::degrade_centre>(0, 100), "",
       "factor on the levels that a budget takes at the image centre; fades into degrade.distance up to half an "
       "image height from it"},
      {"degrade.interest", Declare::number<&V::degrade_interest>(0, 100), "",
       "factor on the levels that a budget takes in regions of interest with more levels"},
      {"cull.occlusion",
       Declare::choice<&V::occlusion>(
           {word("auto", Occlusion::kAuto), word("off", Occlusion::kOff), word("on", Occlusion::kOn)}),
       "",
       "leaves out what nearer ground hides, which changes no pixel of complete images; auto: in windows, while "
       "it saves more time than it costs"},
      {"rays.mode",
       Declare::choice<&V::ray_mode>({word("exact", RayMode::kExact), word("multires", RayMode::kMultires),
                                      word("reference", RayMode::kReference),
                                      word("perturbation", RayMode::kPerturbation),
                                      word("discrete", RayMode::kDiscrete), word("volume", RayMode::kVolume),
                                      word("boundary", RayMode::kBoundary)}),
       "",
       "backend ray: exact casts against the exact surface; multires takes coarser cells far away; reference "
       "follows each ray in steps of 0.6 cells, slowly, for comparison; perturbation casts against smooth patches "
       "through the same posts, without facets; discrete takes one voxel at each grid line (Cohen-Or 1996); volume "
       "samples densities of voxels, boundary ends in the first cell that their surface passes (Wan 1999)"},
      {"rays.patch",
       Declare::choice<&V::ray_patch>(
           {word("bicubic", RayPatch::kBicubic), word("bilinear", RayPatch::kBilinear)}),
       "", "backend ray, mode perturbation: heights between posts; bilinear has creases at the lines of posts"},
      {"rays.cell", Declare::number<&V::ray_cell_px>(RayLimits::kLeastCell_px, RayLimits::kMostCell_px), "px",
       "backend ray, mode multires: largest distance in the image between a cell and the surface; larger: "
       "faster"},
      {"rays.sample",
       Declare::choice<&V::ray_sample>({word("auto", RaySample::kAuto), word("pixel", RaySample::kPixel),
                                        word("nearest", RaySample::kNearest)}),
       "",
       "backend ray, modes exact and multires, perspective: pixels have their own ray, or that of the nearest column "
       "(nearest: faster, up to half of rays.spacing away); auto: nearest with several samples and while the camera of "
       "a window moves"},
      {"rays.spacing",
       Declare::number<&V::ray_spacing_px>(RayLimits::kLeastSpacing_px, RayLimits::kMostSpacing_px), "px",
       "backend ray, modes exact and multires, perspective: largest distance between columns; larger: faster, misses "
       "wider ridges"},
      {"rays.fovea",
       Declare::number_or_word<&V::ray_fovea>(RayLimits::kLeastFovea, RayLimits::kMostFovea, "off"), "",
       "backend ray, mode multires, perspective: share of the image's sides, about its middle, that has a ray for "
       "each pixel; the rest has half as many columns and rows; off: all of the image"},
      {"rays.ratio", Declare::number<&V::ray_ratio>(RayLimits::kLeastRatio, RayLimits::kMostRatio), "px",
       "backend ray, mode discrete: largest width of a voxel in the image, for heights and colours; larger: faster, "
       "blurred"},
      {"rays.blend", Declare::choice<&V::ray_blend>({word("off", false), word("on", true)}), "",
       "backend ray, mode discrete: fades levels of heights and colours into each other by distance"},
      {"rays.vertical", Declare::choice<&V::ray_vertical>({word("1", 1), word("2", 2), word("4", 4)}), "",
       "backend ray, mode discrete: rays in each pixel, one above the other"},
      {"rays.columns",
       Declare::choice<&V::ray_columns>(
           {word("sectors", RayColumns::kSectors), word("lines", RayColumns::kLines)}),
       "",
       "backend ray, mode discrete: columns are vertical planes (sectors), or parallel lines of pixels taken as such, "
       "as in the papers (lines)"},
      {"rays.volume.filter",
       Declare::choice<&V::ray_volume_filter>({word("none", RayVolumeFilter::kNone),
                                               word("gaussian", RayVolumeFilter::kGaussian),
                                               word("box", RayVolumeFilter::kBox)}),
       "",
       "backend ray, modes volume and boundary: densities are full or empty (none), smoothed (gaussian), or follow the "
       "distance from the ground (box)"},
      {"rays.volume.step",
       Declare::number<&V::ray_volume_step>(RayLimits::kLeastVolumeStep, RayLimits::kMostVolumeStep), "",
       "backend ray, modes volume and boundary: interval of samples, in voxels; larger: faster, narrow ridges may be "
       "missed"},
      {"rays.volume.near", Declare::number_or_word<&V::ray_volume_near_m>(0, 1e12, "all"), "m",
       "backend ray, mode volume: tiles nearer to the camera are cast by densities, the others by boundary cells as in "
       "mode boundary"},
      {"scene", Declare::text<&V::scene>("a scene file, *.scene.toml or GeoJSON points", no_problem), "",
       "objects on the ground: models and their places"},
      {"samples", Declare::choice<&V::samples>({word("1", 1), word("2", 2), word("4", 4)}), "",
       "colour samples in each pixel (anti-aliasing), backend ray: rays in each pixel; without a GPU, more "
       "than one more than doubles the time"},
      {"edges", Declare::choice<&V::smooth_edges>({word("hard", false), word("smooth", true)}), "",
       "smooth: stair steps at ridges and the skyline are smoothed when there is one sample in each pixel"},
      {"background",
       Declare::choice<&V::background>({word("black", Background::kBlack), word("white", Background::kWhite),
                                        word("sky", Background::kSky)}),
       "", "colour behind the planet; sky: the air of `atmosphere` by day and night, black seen from space"},
      {"atmosphere",
       Declare::choice<&V::atmosphere>({word("auto", Atmosphere::kAuto), word("none", Atmosphere::kNone),
                                        word("mars", Atmosphere::kMars), word("earth", Atmosphere::kEarth),
                                        word("venus", Atmosphere::kVenus), word("titan", Atmosphere::kTitan)}),
       "", "colours of sky and haze; auto: those of the planet's body, none where it has no air"},
      {"inspect",
       Declare::choice<&V::inspect>({word("none", Inspect::kNone), word("borders", Inspect::kBorders),
                                     word("levels", Inspect::kLevels), word("synthetic", Inspect::kSynthetic)}),
       "",
       "shows how the image is made: lines along the borders of tiles, tiles tinted by their level, or synthetic "
       "ground tinted blue"},
  });
  return keys;
}

SettingInfo setting_info(const KeyInfo& key, const KeyValue& default_value) {
  SettingInfo info;
  info.key = key.name;
  info.default_text = print_value(key, default_value);
  info.unit = key.unit;
  info.meaning = key.meaning;
  if (const auto* number = std::get_if<NumberKey>(&key.type)) {
    info.min = number->min;
    info.max = number->max;
  } else if (const auto* either = std::get_if<NumberOrWordKey>(&key.type)) {
    info.min = either->min;
    info.max = either->max;
    info.word = either->word;
  } else if (const auto* integer = std::get_if<IntegerKey>(&key.type)) {
    info.type = SettingType::kInteger;
    info.min = integer->min;
    info.max = integer->max;
  } else if (std::holds_alternative<TableKey>(key.type)) {
    info.type = SettingType::kTable;
    info.grammar = allowed_text(key);
  } else if (std::holds_alternative<TextKey>(key.type)) {
    info.type = SettingType::kText;
    info.grammar = allowed_text(key);
  } else {
    info.type = SettingType::kChoice;
    if (const auto* choice = std::get_if<ChoiceKey>(&key.type)) {
      for (const KeyWord& w : choice->words) info.choices.push_back(w.text);
    } else {
      info.choices = {SwitchWords().off, SwitchWords().on};
    }
  }
  return info;
}

std::string unknown_key(std::string_view name) {
  const std::string_view shown = name.substr(0, kLongestShown);
  std::string text = "unknown setting \"" + std::string(shown) + "\"; ";
  const std::span<const KeyInfo> keys = registry().infos();
  if (const std::string near = did_you_mean(shown, keys); !near.empty()) return text + near;
  std::vector<std::string_view> all;
  for (const KeyInfo& key : keys) all.push_back(key.name);
  return text + "the settings are " + join(all);
}

}  // namespace

std::span<const SettingInfo> Settings::list() {
  static const std::vector<SettingInfo> infos = [] {
    std::vector<SettingInfo> all;
    const std::vector<KeyValue> defaults = registry().values(SettingsValues());
    for (const KeyInfo& key : registry().infos()) all.push_back(setting_info(key, defaults[all.size()]));
    return all;
  }();
  return infos;
}

std::string Settings::set(std::string_view former_or_current, std::string_view text) {
  const std::string_view name = current_name(NameKind::kSetting, former_or_current);
  const std::optional<std::size_t> index = registry().find(name);
  if (!index) return unknown_key(name);
  const KeyInfo& key = registry().infos()[*index];
  text = current_value(NameKind::kSettingValue, name, text);
  if (name.starts_with("overlay.") && !overlays_refused().empty() && text != list()[*index].default_text) {
    return std::string(name) + ": " + std::string(overlays_refused());
  }
  std::string problem;
  if (const auto value = parse_value(key, text, problem)) {
    registry().set(*index, values_, *value);
    return {};
  }
  return std::string(name) + "=" + std::string(text.substr(0, kLongestShown)) +
         " is not allowed: " + (problem.empty() ? "" : problem + "; ") + "expected " + allowed_text(key);
}

std::string Settings::assign(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    return "expected KEY=VALUE, found \"" + std::string(assignment.substr(0, kLongestShown)) + "\"";
  }
  return set(assignment.substr(0, equals), assignment.substr(equals + 1));
}

std::optional<std::string> Settings::get(std::string_view former_or_current) const {
  const std::optional<std::size_t> key = registry().find(current_name(NameKind::kSetting, former_or_current));
  if (!key) return std::nullopt;
  return print_value(registry().infos()[*key], registry().get(*key, values_));
}

}  // namespace vpe::core
