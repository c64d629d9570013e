#include "hw_bridge/codecs/gvsp.h"

#include "hw_bridge/codecs/big_endian.h"

namespace tubetwin {
namespace {

constexpr unsigned kLeader = 1, kTrailer = 2, kPayload = 3, kPartsPayload = 7;
constexpr unsigned kImagePayload = 0x0001, kPartsFrame = 0x000a, kWithChunks = 0x4000;
constexpr unsigned kLongIds = 0x80;

void PutU48(std::string& out, std::uint64_t value) {
  PutU16(out, static_cast<unsigned>(value >> 32 & 0xffff));
  PutU32(out, static_cast<std::uint32_t>(value));
}

void PutU64(std::string& out, std::uint64_t value) {
  PutU32(out, static_cast<std::uint32_t>(value >> 32));
  PutU32(out, static_cast<std::uint32_t>(value));
}

std::string ImageHeader(const GvspFrame& frame, unsigned kind, std::uint32_t packet_id) {
  std::string out;
  PutU16(out, 0);  // Status: good.
  PutU16(out, GvspShortId(frame));
  PutU32(out, kind << 24 | (packet_id & 0xffffff));
  return out;
}

std::string PartsHeader(const GvspFrame& frame, unsigned kind, std::size_t parts,
                        std::uint32_t packet_id) {
  std::string out;
  PutU16(out, 0);  // Status: good.
  PutU16(out, 0);
  PutU32(out, (kLongIds | kind) << 24 | static_cast<std::uint32_t>(parts & 0xff));
  PutU64(out, frame.id);
  PutU32(out, packet_id);
  return out;
}

}  // namespace

std::uint16_t GvspShortId(const GvspFrame& frame) {
  return static_cast<std::uint16_t>((frame.id - 1) % 0xffff + 1);
}

std::string EncodeGvspImageLeader(const GvspFrame& frame, const GvspPart& image, bool chunks) {
  std::string out = ImageHeader(frame, kLeader, 0);
  PutU16(out, 0);
  PutU16(out, kImagePayload | (chunks ? kWithChunks : 0));
  PutU64(out, frame.timestamp_ns);
  PutU32(out, image.pixel_format);
  PutU32(out, image.width);
  PutU32(out, image.height);
  PutU32(out, 0);  // Offset of the image.
  PutU32(out, 0);
  PutU16(out, 0);  // Padding of lines and image.
  PutU16(out, 0);
  return out;
}

std::string EncodeGvspImageHeader(const GvspFrame& frame, std::uint32_t packet_id) {
  return ImageHeader(frame, kPayload, packet_id);
}

std::string EncodeGvspImageTrailer(const GvspFrame& frame, const GvspPart& image, bool chunks,
                                   std::uint32_t packet_id) {
  std::string out = ImageHeader(frame, kTrailer, packet_id);
  PutU16(out, 0);
  PutU16(out, kImagePayload | (chunks ? kWithChunks : 0));
  PutU32(out, image.height);
  return out;
}

std::string EncodeGvspPartsLeader(const GvspFrame& frame, const std::vector<GvspPart>& parts) {
  std::string out = PartsHeader(frame, kLeader, parts.size(), 0);
  PutU16(out, 0);
  PutU16(out, kPartsFrame);
  PutU64(out, frame.timestamp_ns);
  for (const GvspPart& part : parts) {
    PutU16(out, static_cast<unsigned>(part.data));
    PutU48(out, part.bytes);
    PutU32(out, part.pixel_format);
    PutU16(out, 0);
    PutU8(out, 0);  // Source.
    PutU8(out, 0);  // Further zones, and their directions.
    PutU32(out, 0);
    PutU16(out, part.purpose_id);
    PutU16(out, 0);  // Region.
    PutU32(out, part.width);
    PutU32(out, part.height);
    PutU32(out, 0);  // Offset of the image.
    PutU32(out, 0);
    PutU16(out, 0);  // Padding of lines and image.
    PutU16(out, 0);
    PutU32(out, 0);
  }
  return out;
}

std::string EncodeGvspPartsHeader(const GvspFrame& frame, std::uint32_t packet_id, unsigned part,
                                  std::uint64_t offset) {
  std::string out = PartsHeader(frame, kPartsPayload, 0, packet_id);
  PutU8(out, part);
  PutU8(out, 0);  // Zone.
  PutU48(out, offset);
  return out;
}

std::string EncodeGvspPartsTrailer(const GvspFrame& frame, std::uint32_t packet_id) {
  std::string out = PartsHeader(frame, kTrailer, 0, packet_id);
  PutU16(out, 0);
  PutU16(out, kPartsFrame);
  return out;
}

}  // namespace tubetwin
