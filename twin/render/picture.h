#pragma once

#include <string>

#include "models/bin.h"
#include "twin/render/gl/scene_renderer.h"

namespace tubetwin {

/// Camera of pile pictures: over a long side of the bin, the whole bin in view.
View PileView(const Bin& bin);

/// Camera of films and pictures of the cell: arm, bin and tray in view.
View CellView();

/// A tag with a tube's id at its highest node, small enough to hide nothing.
void DrawTag(Image& image, const View& view, const Polyline& line_B, const Vector3& up_B,
             const std::string& text);

/// Writes a PNG by rename. Throws Error(kCannotCreate | kIo).
void WritePng(const Image& image, const std::string& path);

}  // namespace tubetwin
