#include "hw_bridge/codecs/gvsp.h"

#include "tests/codecs/hex.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using test::ToSpacedHex;

TEST_CASE("A range image is announced, carried and ended by the bytes of GVSP", "[unit]") {
  GvspImage image;
  image.frame_id = 0x0102;
  image.timestamp_ns = 0x1122334455667788;
  image.pixel_format = kPixelCoord3dAbc32f;
  image.width = 2064;
  image.height = 1544;
  // Status, frame, kind and packet; reserved, payload type; time; pixels; size; offset; padding.
  CHECK(ToSpacedHex(EncodeGvspLeader(image)) ==
        "00 00 01 02 01 00 00 00 00 00 00 01 11 22 33 44 55 66 77 88 02 60 00 C0 "
        "00 00 08 10 00 00 06 08 00 00 00 00 00 00 00 00 00 00 00 00");
  CHECK(ToSpacedHex(EncodeGvspPayloadHeader(0x0102, 0x030405)) == "00 00 01 02 03 03 04 05");
  CHECK(ToSpacedHex(EncodeGvspTrailer(image, 7)) ==
        "00 00 01 02 02 00 00 07 00 00 00 01 00 00 06 08");
}

}  // namespace
}  // namespace tubetwin
