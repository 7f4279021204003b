#include "vpe/app/commands.h"

int main(int argc, char** argv) { return vpe::app::run(argc, argv); }
