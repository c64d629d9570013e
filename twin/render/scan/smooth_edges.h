#pragma once

#include "twin/render/gl/scene_renderer.h"

namespace tubetwin {

/// Softens the stairs of edges in a picture drawn with one sample per pixel: fast approximate
/// anti-aliasing (FXAA, T. Lottes, Nvidia 2009, the short form). Four samples per pixel would take
/// software rendering twice as long. One thread; about 10 ms for 1280 x 720.
void SmoothEdges(Image& image);

}  // namespace tubetwin
