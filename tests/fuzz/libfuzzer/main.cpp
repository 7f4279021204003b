// One libFuzzer program for all targets: vpe_fuzz_NAME is this with VPE_FUZZ_TARGET.
#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::VPE_FUZZ_TARGET.run({data, size});
  return 0;
}
