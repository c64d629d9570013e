#include "models/base/foreign/content.h"

#include <algorithm>

#include "models/base/text.h"

namespace tubetwin {
namespace {

using namespace std::string_view_literals;

struct Known {
  std::string_view begin;
  const char* what;
};

/// Magic numbers as the formats' own descriptions give them.
constexpr Known kBytes[] = {
    {"\x1f\x8b"sv, "is packed by gzip; unpack it first (gunzip)"},
    {"PK\x03\x04"sv, "is a zip archive; unpack it first (unzip)"},
    {"BZh"sv, "is packed by bzip2; unpack it first (bunzip2)"},
    {"\xfd\x37zXZ\0"sv, "is packed by xz; unpack it first (unxz)"},
    {"7z\xbc\xaf\x27\x1c"sv, "is a 7z archive; unpack it first"},
    {"Rar!"sv, "is a rar archive; unpack it first"},
    {"\x28\xb5\x2f\xfd"sv, "is packed by zstd; give it a name that ends in .zst"},
    {"\xff\xfe"sv, "is text in UTF-16; save it as UTF-8"},
    {"\xfe\xff"sv, "is text in UTF-16; save it as UTF-8"},
    {"\x89PNG"sv, "is a PNG picture"},
    {"\xff\xd8\xff"sv, "is a JPEG picture"},
    {"%PDF"sv, "is a PDF document"},
    {"LASF"sv, "is a LAS cloud; convert it to PCD or PLY"},
    {"ASTM-E57"sv, "is an E57 cloud; convert it to PCD or PLY"},
    {"glTF"sv, "is a glTF mesh; convert it to STL, OBJ or PLY"},
    {"ISO-10303-21"sv, "is a STEP model; export it as STL, OBJ or PLY"},
    {"version https://git-lfs"sv,
     "is a pointer of Git LFS, not the file itself; fetch it (git lfs pull)"},
};

/// Words that begin a text, after blanks and a byte order mark, in small letters.
constexpr Known kTexts[] = {
    {"<!doctype html"sv, "is a web page, not the file behind it"},
    {"<html"sv, "is a web page, not the file behind it"},
    {"<?xml"sv, "is XML"},
    {"# .pcd"sv, "is a PCD cloud"},
    {"ply\n"sv, "is a PLY file"},
    {"ply\r"sv, "is a PLY file"},
    {"solid "sv, "is an STL mesh"},
    {"tube,index"sv, "is a pile in CSV"},
    {"{"sv, "is JSON"},
};

}  // namespace

std::string MistakenContent(std::string_view head) {
  for (const Known& known : kBytes) {
    if (head.starts_with(known.begin)) return known.what;
  }
  if (head.starts_with("\xef\xbb\xbf"sv)) head.remove_prefix(3);
  head.remove_prefix(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
  const std::string text = LowerCase(head.substr(0, 64));
  for (const Known& known : kTexts) {
    if (text.starts_with(known.begin)) return known.what;
  }
  return "";
}

}  // namespace tubetwin
