#include "hw_bridge/codecs/gvsp.h"

#include "tests/codecs/hex.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using test::ToSpacedHex;

constexpr GvspFrame kFrame = {0x0102, 0x1122334455667788};

GvspPart RangePart() {
  return {4, GvspData::kImage3d, kPixelCoord3dAbc32f, 2064, 1544, 2064 * 1544 * 12};
}

TEST_CASE("A range image is announced, carried and ended by the bytes of GVSP", "[unit]") {
  // Status, frame, kind and packet; reserved, payload type; time; pixels; size; offset; padding.
  CHECK(ToSpacedHex(EncodeGvspImageLeader(kFrame, RangePart(), false)) ==
        "00 00 01 02 01 00 00 00 00 00 00 01 11 22 33 44 55 66 77 88 02 60 00 C0 "
        "00 00 08 10 00 00 06 08 00 00 00 00 00 00 00 00 00 00 00 00");
  CHECK(ToSpacedHex(EncodeGvspImageHeader(kFrame, 0x030405)) == "00 00 01 02 03 03 04 05");
  CHECK(ToSpacedHex(EncodeGvspImageTrailer(kFrame, RangePart(), false, 7)) ==
        "00 00 01 02 02 00 00 07 00 00 00 01 00 00 06 08");
}

TEST_CASE("An image with chunks says so in leader and trailer", "[unit]") {
  CHECK(ToSpacedHex(EncodeGvspImageLeader(kFrame, RangePart(), true).substr(8, 4)) ==
        "00 00 40 01");
  CHECK(ToSpacedHex(EncodeGvspImageTrailer(kFrame, RangePart(), true, 7)) ==
        "00 00 01 02 02 00 00 07 00 00 40 01 00 00 06 08");
}

TEST_CASE("Parts are announced, carried and ended with long ids", "[unit]") {
  const GvspPart confidence = {6, GvspData::kConfidence, kPixelConfidence8, 3, 2, 6};
  GvspPart large = RangePart();
  large.bytes = 0x010203040506;
  // Status, flags, long ids and kind, number of parts, frame, packet; reserved, payload type; time.
  CHECK(ToSpacedHex(EncodeGvspPartsLeader(kFrame, {confidence, large})) ==
        "00 00 00 00 81 00 00 02 00 00 00 00 00 00 01 02 00 00 00 00 "
        "00 00 00 0A 11 22 33 44 55 66 77 88 "
        // Each: kind and length; pixels; reserved, source, zones; directions; purpose, region;
        // size; offset; padding; reserved.
        "00 09 00 00 00 00 00 06 01 08 00 C6 00 00 00 00 00 00 00 00 00 06 00 00 "
        "00 00 00 03 00 00 00 02 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
        "00 05 01 02 03 04 05 06 02 60 00 C0 00 00 00 00 00 00 00 00 00 04 00 00 "
        "00 00 08 10 00 00 06 08 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00");
  CHECK(ToSpacedHex(EncodeGvspPartsHeader(kFrame, 0x01020304, 1, 0x0a0b0c0d0e0f)) ==
        "00 00 00 00 87 00 00 00 00 00 00 00 00 00 01 02 01 02 03 04 01 00 0A 0B 0C 0D 0E 0F");
  CHECK(ToSpacedHex(EncodeGvspPartsTrailer(kFrame, 9)) ==
        "00 00 00 00 82 00 00 00 00 00 00 00 00 00 01 02 00 00 00 09 00 00 00 0A");
  CHECK(EncodeGvspPartsHeader(kFrame, 1, 0, 0).size() + 28 == kGvspPartsOverhead);
  CHECK(EncodeGvspImageHeader(kFrame, 1).size() + 28 == kGvspImageOverhead);
}

TEST_CASE("No image has the id 0, which is no frame's", "[unit]") {
  const auto short_id = [](std::uint64_t id) { return GvspShortId({id, 0}); };
  CHECK(short_id(1) == 1);
  CHECK(short_id(0xffff) == 0xffff);
  CHECK(short_id(0x10000) == 1);
  CHECK(short_id(2 * 0xffff + 5) == 5);
}

TEST_CASE("A pixel format tells how many bytes a pixel takes", "[unit]") {
  CHECK(BytesPerPixel(kPixelMono10) == 2);
  CHECK(BytesPerPixel(kPixelConfidence8) == 1);
  CHECK(BytesPerPixel(kPixelCoord3dA32f) == 4);
  CHECK(BytesPerPixel(kPixelCoord3dAc8) == 2);
  CHECK(BytesPerPixel(kPixelCoord3dAbc32f) == 12);
}

}  // namespace
}  // namespace tubetwin
