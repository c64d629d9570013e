#include "models/base/cloud/zstd_frame.h"

#include <memory>

#include <zstd.h>

#include "models/base/error.h"

namespace tubetwin {
namespace {

[[noreturn]] void Fail(const std::string& source, const std::string& what) {
  throw Error(ErrorKind::kBadData, source + ": " + what);
}

}  // namespace

std::string Compressed(std::string_view content, int level) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                     ZSTD_freeCCtx);
  TT_CHECK(context != nullptr);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, level);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string frame(ZSTD_compressBound(content.size()), '\0');
  const std::size_t size =
      ZSTD_compress2(context.get(), frame.data(), frame.size(), content.data(), content.size());
  if (ZSTD_isError(size)) {
    throw Error(ErrorKind::kInternal, std::string("zstd: ") + ZSTD_getErrorName(size));
  }
  frame.resize(size);
  return frame;
}

std::string Decompressed(std::string_view frame, std::uint64_t size, const std::string& source) {
  const unsigned long long stated = ZSTD_getFrameContentSize(frame.data(), frame.size());
  if (stated == ZSTD_CONTENTSIZE_ERROR) Fail(source, "damaged: no zstd frame");
  if (stated != size) {
    Fail(source, "damaged: its zstd frame does not have the " + std::to_string(size) +
                     " bytes that it should have");
  }
  std::string content(static_cast<std::size_t>(size), '\0');
  const std::size_t got =
      ZSTD_decompress(content.data(), content.size(), frame.data(), frame.size());
  if (ZSTD_isError(got)) Fail(source, std::string("damaged: ") + ZSTD_getErrorName(got));
  if (got != content.size()) Fail(source, "damaged: its zstd frame is too short");
  return content;
}

std::string DecompressedFile(std::string_view frame, std::uint64_t max_size,
                             const std::string& source) {
  const unsigned long long stated = ZSTD_getFrameContentSize(frame.data(), frame.size());
  if (stated == ZSTD_CONTENTSIZE_ERROR) Fail(source, "damaged: no zstd frame");
  if (stated == ZSTD_CONTENTSIZE_UNKNOWN) {
    Fail(source,
         "its zstd frame does not state its size, as one of a pipe: unpack it first (zstd -d)");
  }
  if (stated > max_size) {
    Fail(source, "unpacks to " + std::to_string(stated) + " bytes, allowed are up to " +
                     std::to_string(max_size));
  }
  return Decompressed(frame, stated, source);
}

}  // namespace tubetwin
