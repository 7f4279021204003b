#include "vpe/app/program.h"

int main(int argc, char** argv) { return vpe::app::run(argc, argv); }
