#pragma once

#include <string>
#include <string_view>

namespace tubetwin {

/// What a file is that begins with `head` (64 bytes are enough), and what to do about it, for the
/// message that refuses it: "is packed by gzip; unpack it first". Empty where it looks like none of
/// those that are mistaken for clouds, meshes and piles.
std::string MistakenContent(std::string_view head);

}  // namespace tubetwin
