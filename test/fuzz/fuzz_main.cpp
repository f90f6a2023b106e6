// libFuzzer's way in: the build names the target.
#include "fuzz/fuzz_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  pcl_floam::test::PCL_FLOAM_FUZZ_TARGET(bytes, size);
  return 0;
}
