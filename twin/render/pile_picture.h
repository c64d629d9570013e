#pragma once

#include <string>

#include "scenes/pile.h"

namespace tubetwin {

/// Picture (PNG, 1280 x 720) of the bin from above at an angle, each tube in a colour of its own
/// with its id beside it. Throws Error(kDevice) when there is no EGL, Error(kCannotCreate | kIo)
/// when the file cannot be written.
void RenderPilePicture(const Pile& pile, const std::string& path);

}  // namespace tubetwin
