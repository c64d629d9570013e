#pragma once

#include <string>

#include "models/bin.h"
#include "twin/render/gl/scene_renderer.h"

namespace tubetwin {

/// Camera of pile pictures: over a long side of the bin, the whole bin in view.
View PileView(const Bin& bin);

/// Camera of films and pictures of the cell: arm, bin and tray in view.
View CellView();

/// Writes a PNG by rename. Throws Error(kCannotCreate | kIo).
void WritePng(const Image& image, const std::string& path);

}  // namespace tubetwin
