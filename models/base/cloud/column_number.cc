#include "models/base/cloud/column_number.h"

#include <cstdint>
#include <cstring>

namespace tubetwin {
namespace {

template <class T>
double ValueOf(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

}  // namespace

double ColumnNumber(const char* bytes, char kind, int size) {
  const bool sign = kind == 'I';
  switch (size) {
    case 1:
      return sign ? ValueOf<std::int8_t>(bytes) : ValueOf<std::uint8_t>(bytes);
    case 2:  // A half float is passed over by all who read; they ask for wider ones.
      return sign ? ValueOf<std::int16_t>(bytes) : ValueOf<std::uint16_t>(bytes);
    case 4:
      if (kind == 'F') return ValueOf<float>(bytes);
      return sign ? ValueOf<std::int32_t>(bytes) : ValueOf<std::uint32_t>(bytes);
    default:
      if (kind == 'F') return ValueOf<double>(bytes);
      return sign ? ValueOf<std::int64_t>(bytes) : ValueOf<std::uint64_t>(bytes);
  }
}

}  // namespace tubetwin
