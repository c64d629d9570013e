#include "hw_bridge/recording/zstd_frame.h"

#include <memory>

#include <zstd.h>

#include "models/base/error.h"

namespace tubetwin {
namespace {

/// Level 1: recordings are written while a cell runs.
constexpr int kLevel = 1;

}  // namespace

std::string Compressed(std::string_view content) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                     ZSTD_freeCCtx);
  TT_CHECK(context != nullptr);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
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
  const auto fail = [&](const std::string& what) -> std::string {
    throw Error(ErrorKind::kBadData, source + ": " + what);
  };
  const unsigned long long stated = ZSTD_getFrameContentSize(frame.data(), frame.size());
  if (stated == ZSTD_CONTENTSIZE_ERROR) return fail("damaged: no zstd frame");
  if (stated != size) {
    return fail("damaged: its zstd frame does not have the " + std::to_string(size) +
                " bytes that it should have");
  }
  std::string content(static_cast<std::size_t>(size), '\0');
  const std::size_t got =
      ZSTD_decompress(content.data(), content.size(), frame.data(), frame.size());
  if (ZSTD_isError(got)) return fail(std::string("damaged: ") + ZSTD_getErrorName(got));
  if (got != content.size()) return fail("damaged: its zstd frame is too short");
  return content;
}

}  // namespace tubetwin
