#include "vpe/app/commands.h"

#include "vpe/app/cli/manual.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/contour/commands.h"
#include "vpe/app/film/commands.h"
#include "vpe/app/get/commands.h"
#include "vpe/app/map/commands.h"
#include "vpe/app/match/commands.h"
#include "vpe/app/measure/commands.h"
#include "vpe/app/panorama/commands.h"
#include "vpe/app/picture/commands.h"
#include "vpe/app/planet/commands.h"
#include "vpe/app/planet/info/commands.h"
#include "vpe/app/report/commands.h"
#include "vpe/app/route/commands.h"
#include "vpe/app/scene/commands.h"
#include "vpe/app/sun/commands.h"
#include "vpe/app/surface/commands.h"
#include "vpe/app/viewshed/commands.h"
#include "vpe/app/visibility/commands.h"

namespace vpe::app {

int run(int argc, char** argv) {
  // In the order of --help.
  static constexpr AddCommand kCommands[] = {
      add_get,    add_build,   add_patch,   add_merge,    add_info,    add_verify,   add_find,     add_query,
      add_map,    add_contour, add_profile, add_measure,  add_compare, add_horizon,  add_sight,    add_viewshed,
      add_route,  add_sun,     add_match,   add_render,   add_fly,     add_panorama, add_traverse, add_object,
      add_sculpt, add_surface, add_explore, add_overlook, add_report,  add_settings, add_doctor,   add_manual};
  return run_program(argc, argv, kCommands);
}

}  // namespace vpe::app
