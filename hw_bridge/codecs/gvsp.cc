#include "hw_bridge/codecs/gvsp.h"

#include "hw_bridge/codecs/big_endian.h"

namespace tubetwin {
namespace {

constexpr unsigned kLeader = 1, kTrailer = 2, kPayload = 3;
constexpr unsigned kImagePayload = 1;

std::string Header(std::uint16_t frame_id, unsigned kind, std::uint32_t packet_id) {
  std::string out;
  PutU16(out, 0);  // Status: good.
  PutU16(out, frame_id);
  PutU32(out, kind << 24 | (packet_id & 0xffffff));
  return out;
}

}  // namespace

std::string EncodeGvspLeader(const GvspImage& image) {
  std::string out = Header(image.frame_id, kLeader, 0);
  PutU16(out, 0);
  PutU16(out, kImagePayload);
  PutU32(out, static_cast<std::uint32_t>(image.timestamp_ns >> 32));
  PutU32(out, static_cast<std::uint32_t>(image.timestamp_ns));
  PutU32(out, image.pixel_format);
  PutU32(out, image.width);
  PutU32(out, image.height);
  PutU32(out, 0);  // Offset of the image.
  PutU32(out, 0);
  PutU16(out, 0);  // Padding of lines and image.
  PutU16(out, 0);
  return out;
}

std::string EncodeGvspPayloadHeader(std::uint16_t frame_id, std::uint32_t packet_id) {
  return Header(frame_id, kPayload, packet_id);
}

std::string EncodeGvspTrailer(const GvspImage& image, std::uint32_t packet_id) {
  std::string out = Header(image.frame_id, kTrailer, packet_id);
  PutU16(out, 0);
  PutU16(out, kImagePayload);
  PutU32(out, image.height);
  return out;
}

}  // namespace tubetwin
