// The libFuzzer entry: built by the preset `fuzz` only, run by ./dev fuzz.

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/cloud_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tubetwin::TryCloudBytes({reinterpret_cast<const char*>(data), size});
  return 0;
}
