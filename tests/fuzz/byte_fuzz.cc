// The libFuzzer entry of a decoder: built by the preset `fuzz` only, run by ./dev fuzz NAME.

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/byte_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tubetwin::TryBytes({reinterpret_cast<const char*>(data), size});
  return 0;
}
